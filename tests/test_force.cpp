// Force.hpp: each force against its formula and against its energy, the sweep
// against the call node by node, combinations.
#include <gtest/gtest.h>

#include "lab/fast/Sweep.hpp"

using namespace lab;

namespace {

/** A grid with diagonals, shaken: all springs differ, some are compressed,
 * some nodes are gone. */
class ShakenCloth : public ::testing::Test {
 protected:
  Cloth g;

  void SetUp() override {
    CME212::default_generator.seed(1);
    build_cloth(g, grid_points(6), grid_quads(6), Mesh::diagonals);
    for (Node n : g.nodes()) {
      n.position() += random_vector(0.08);
      n.value().vel = random_vector(1);
      n.value().mass *= CME212::random(0.5, 2);
    }
    for (Edge e : g.edges()) e.value().K *= CME212::random(0.5, 2);
    for (unsigned i : {30u, 14u, 3u}) g.remove_node(g.node(i));
  }
  static Point random_vector(double size) {
    using CME212::random;
    return size * Point(random(-1, 1), random(-1, 1), random(-1, 1));
  }

  /** The largest |force - other| over all nodes [N], by call and by sweep. */
  template <typename F>
  double distance(const ForcePlan& force, F other) {
    std::vector<Point> sweep;
    Sweep()(g, 0, force, sweep);
    double worst = 0;
    for (Node n : g.nodes()) {
      worst = std::max(worst, norm(force(n, 0) - other(n)));
      worst = std::max(worst, norm(sweep[n.id()] - other(n)));
    }
    return worst;
  }

  /** -dE/dx at @a n by central differences [N]. */
  Point slope(const ForcePlan& force, Node n) {
    const double h = 1e-6;
    Point f;
    for (unsigned k = 0; k < 3; ++k) {
      double x = n.position()[k];
      n.position()[k] = x + h;
      f[k] -= force.energy(g);
      n.position()[k] = x - h;
      f[k] += force.energy(g);
      n.position()[k] = x;
    }
    return f / (2 * h);
  }
};

// h^2 K / L^2 and the round-off 1e-16 E / h are both below 1e-8 N here.
TEST_F(ShakenCloth, ForcesAreTheNegativeGradientOfTheirEnergy) {
  auto expect_gradient = [&](const ForcePlan& force) {
    EXPECT_GT(std::abs(force.energy(g)), 1e-3);
    EXPECT_LT(distance(force, [&](Node n) { return slope(force, n); }), 1e-7);
  };
  expect_gradient(GravityForce());
  expect_gradient(MassSpringForce());
  expect_gradient(make_combined_force(GravityForce(2), MassSpringForce()));
}

TEST_F(ShakenCloth, GravityIsWeight) {
  EXPECT_LT(
      distance(GravityForce(),
               [](Node n) { return Point(0, 0, -9.81 * n.value().mass); }),
      1e-15);
}

TEST_F(ShakenCloth, DampingIsLinearDrag) {
  DampingForce drag(0.3);
  EXPECT_LT(distance(drag, [](Node n) { return -0.3 * n.value().vel; }), 1e-15);
  EXPECT_EQ(drag.drag(), 0.3);
  EXPECT_EQ(DampingForce().drag(), 0);
  double power = 0, speeds = 0;
  for (Node n : g.nodes()) {
    power += dot(drag(n, 0), n.value().vel);
    speeds += normSq(n.value().vel);
  }
  EXPECT_NEAR(power, -0.3 * speeds, 1e-12);
  EXPECT_DEATH(DampingForce(-1), "c >= 0");
}

TEST_F(ShakenCloth, SpringsAloneConserveMomentum) {
  std::vector<Point> f;
  Sweep()(g, 0, MassSpringForce(), f);
  Point sum, torque;
  double size = 0;
  for (Node n : g.nodes()) {
    sum += f[n.id()];
    torque += cross(n.position(), f[n.id()]);
    size += norm(f[n.id()]);
  }
  EXPECT_GT(size, 10);
  EXPECT_LT(norm(sum), 1e-14 * size);
  EXPECT_LT(norm(torque), 1e-14 * size);
}

TEST_F(ShakenCloth, Problem1ForceIsGravityAndSpringsButForCorners) {
  auto both = make_combined_force(GravityForce(), MassSpringForce());
  g.node(0).position() = Point(0, 0, 0);
  g.node(9).position() = Point(1, 0, 0);
  g.node(10).position() = Point(0, 1, 0);
  for (Node n : g.nodes()) {
    Point expected = is_corner(n.position()) ? Point() : both(n, 0);
    EXPECT_LT(norm(Problem1Force()(n, 0) - expected), 1e-14);
  }
  EXPECT_EQ(Problem1Force()(g.node(0), 0), Point());
  EXPECT_EQ(Problem1Force()(g.node(9), 0), Point());
  EXPECT_NE(Problem1Force()(g.node(10), 0), Point());
}

TEST(Problem1Force, CanTakeAllSpringsAlike) {
  Cloth g;
  Node a = g.add_node(Point(0, 0, 1)), b = g.add_node(Point(2, 0, 1));
  g.add_edge(a, b, {7, 2});
  EXPECT_EQ(Problem1Force(0)(a, 0), Point());
  EXPECT_EQ(Problem1Force(100, 0.5, 0)(a, 0), Point(150, 0, 0));
  EXPECT_EQ(Problem1Force(100, 0.5)(a, 0), Point(150, 0, -9.81));
}

TEST(MassSpringForce, IsZeroNotNanAtLengthZero) {
  Cloth g;
  Node a = g.add_node(Point(1)), b = g.add_node(Point(1));
  g.add_edge(a, b, {100, 1});
  std::vector<Point> f;
  Sweep()(g, 0, MassSpringForce(), f);
  for (Point p : {MassSpringForce()(a, 0), f[0], f[1], Problem1Force(0)(b, 0)})
    EXPECT_EQ(p, Point());
}

TEST_F(ShakenCloth, CombinedForcesAddUpAnyNumber) {
  auto at = [](double c) { return [c](Node, double) { return Point(c); }; };
  auto combined = make_combined_force(GravityForce(), at(1), at(2), at(3),
                                      DampingForce(1), DampingForce(2));
  EXPECT_LT(distance(combined,
                     [](Node n) {
                       return GravityForce()(n, 0) + Point(6) -
                              3 * n.value().vel;
                     }),
            1e-13);
  EXPECT_EQ(combined.drag(), 3);
  EXPECT_EQ(make_combined_force()(g.node(0), 0), Point());
  EXPECT_EQ(ZeroForce()(g.node(0), 0), Point());
}

TEST_F(ShakenCloth, CombinedForcesOwnTheirTemporaries) {
  struct Pull : ZeroForce {
    std::vector<double> data = std::vector<double>(1000, 0.5);
    Point operator()(Node, double t) const override {
      return Point(data.back() * t);
    }
  };
  CombinedForces kept = [] {
    return make_combined_force(make_combined_force(Pull(), Pull()), Pull());
  }();
  CombinedForces copy = kept;
  kept = make_combined_force(ZeroForce());
  EXPECT_EQ(copy(g.node(0), 2), Point(3));
}

/** A student's force, as the assignment writes it, with a state. */
struct Counting {
  int calls = 0;
  Point operator()(Node, double) {
    ++calls;
    return Point(calls);
  }
};
TEST_F(ShakenCloth, FunctorsNeedNotBeConst) {
  auto force = make_combined_force(Counting());
  EXPECT_EQ(force(g.node(0), 0), Point(1));
  EXPECT_EQ(force(g.node(0), 0), Point(2));
}

/** All blocks of the stiffness; nothing if the force does not know it. */
struct Block {
  unsigned i, j;
  Stiffness B;
};
std::optional<std::vector<Block>> blocks_of(const ForcePlan& force,
                                            const Cloth& g) {
  std::vector<Block> blocks;
  auto use = [&](unsigned i, unsigned j, const Stiffness& B) {
    blocks.push_back({i, j, B});
  };
  if (!force.add_stiffness(g, use)) return std::nullopt;
  return blocks;
}

// The force on every node as one node moves, by central differences: round-off
// and h^2 K L/l^3 are both below 1e-6 N/m here.
TEST_F(ShakenCloth, StiffnessIsTheDerivativeOfTheForce) {
  auto force = make_combined_force(GravityForce(), MassSpringForce());
  auto blocks = blocks_of(force, g);
  ASSERT_TRUE(blocks);
  EXPECT_EQ(blocks->size(), g.num_edges());
  const double h = 1e-6;
  const unsigned n = g.node_slots();
  Sweep sweep;
  for (Node moved : g.nodes())
    for (unsigned k = 0; k < 3; ++k) {
      Point unit;
      unit[k] = 1;
      std::vector<Point> up, down, expected(n);
      moved.position() += h * unit;
      sweep(g, 0, force, up);
      moved.position() -= 2 * h * unit;
      sweep(g, 0, force, down);
      moved.position() += h * unit;
      for (const auto& [i, j, B] : *blocks) {
        Point du = (j == moved.id() ? unit : i == moved.id() ? -unit : Point());
        expected[i] += B * du;
        expected[j] -= B * du;
      }
      for (unsigned i = 0; i < n; ++i)
        EXPECT_LT(norm((up[i] - down[i]) / (2 * h) - expected[i]), 1e-5);
    }
}

TEST_F(ShakenCloth, StiffnessIsSymmetricAndNoMoreThanK) {
  auto blocks = blocks_of(MassSpringForce(), g);
  ASSERT_TRUE(blocks);
  bool compressed = false, stretched = false;
  for (const auto& [i, j, B] : *blocks) {
    Point a = random_vector(1), b = random_vector(1);
    EXPECT_NEAR(dot(a, B * b), dot(B * a, b), 1e-12);
    EXPECT_NEAR(norm(B.direction), 1, 1e-15);
    EXPECT_EQ((g.node_in_use(i) && g.node_in_use(j)), true);
    EXPECT_LE(B.across, B.along);
    (B.across < 0 ? compressed : stretched) = true;
  }
  EXPECT_TRUE(compressed && stretched);
}

TEST(SpringStiffness, IsIsotropicAtLengthZero) {
  Point u(1, -2, 3);
  EXPECT_EQ(spring_stiffness(Point(), {100, 1}) * u, 100 * u);
  EXPECT_EQ(spring_stiffness(Point(0, 0, 1e-9), {100, 0}) * u, 100 * u);
}

TEST_F(ShakenCloth, ForcesSayHowOftenTheyAreTheSprings) {
  struct Child : MassSpringForce {};  // might be stiffer
  EXPECT_EQ(ZeroForce().spring_multiplicity(), 0);
  EXPECT_EQ(GravityForce().spring_multiplicity(), 0);
  EXPECT_EQ(DampingForce(1).spring_multiplicity(), 0);
  EXPECT_EQ(MassSpringForce().spring_multiplicity(), 1);
  EXPECT_EQ(make_combined_force().spring_multiplicity(), 0);
  EXPECT_EQ(
      make_combined_force(MassSpringForce(), GravityForce(), MassSpringForce())
          .spring_multiplicity(),
      2);
  EXPECT_EQ(Child().spring_multiplicity(), std::nullopt);
  EXPECT_EQ(make_combined_force(MassSpringForce(), Child()).spring_multiplicity(),
            std::nullopt);
  EXPECT_EQ(FunctionForce([](Node, double) { return Point(); }).spring_multiplicity(),
            std::nullopt);
}

TEST_F(ShakenCloth, StiffnessIsUnknownUnlessEachPartKnowsIt) {
  struct Child : ZeroForce {
    Point operator()(Node n, double) const override {
      return -1 * n.position();
    }
  };
  auto zero = [](Node, double) { return Point(); };
  auto knows = [this](const ForcePlan& f, std::size_t blocks) {
    auto found = blocks_of(f, g);
    return found && found->size() == blocks;
  };
  EXPECT_TRUE(knows(ZeroForce(), 0));
  EXPECT_TRUE(knows(GravityForce(), 0));
  EXPECT_TRUE(knows(DampingForce(1), 0));
  EXPECT_TRUE(knows(make_combined_force(), 0));
  EXPECT_TRUE(knows(
      make_combined_force(MassSpringForce(), ZeroForce(), MassSpringForce()),
      2 * g.num_edges()));
  EXPECT_FALSE(blocks_of(Child(), g));
  EXPECT_FALSE(blocks_of(FunctionForce(zero), g));
  for (auto force : {make_combined_force(MassSpringForce(), Child()),
                     make_combined_force(zero, MassSpringForce()),
                     make_combined_force(MassSpringForce(), Problem1Force())})
    EXPECT_FALSE(blocks_of(force, g));
}

}  // namespace
