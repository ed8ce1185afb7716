// ForcePlan: the sweep against the call node by node, energy and stiffness
// against the force, and which classes it recognises.
#include "lab/fast/ForcePlan.hpp"
#include "lab/fast/GraphArrays.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <optional>
#include <vector>

#include "tests/ShakenCloth.hpp"
#include "tests/SweptForces.hpp"

using namespace lab;

namespace {

class ForcePlanTest : public ShakenCloth {
 protected:
  /** The largest |force - other| over all nodes [N], by call and by sweep. */
  template <typename F>
  double distance(const ZeroForce& force, F other) {
    const auto sweep = swept_forces(g, force);
    double worst = call_distance(force, other);
    for (Node n : g.nodes())
      worst = std::max(worst, norm(sweep[n.id()] - other(n)));
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
TEST_F(ForcePlanTest, ForcesAreTheNegativeGradientOfTheirEnergy) {
  auto expect_gradient = [&](const ZeroForce& force) {
    EXPECT_GT(std::abs(ForcePlan(force).energy(g)), 1e-3);
    EXPECT_LT(distance(force, [&](Node n) { return slope(force, n); }), 1e-7);
  };
  expect_gradient(GravityForce());
  expect_gradient(MassSpringForce());
  expect_gradient(make_combined_force(GravityForce(2), MassSpringForce()));
}

TEST_F(ForcePlanTest, DragMayBeEachNodesOwn) {
  EXPECT_EQ(ForcePlan(DampingForce(0.3)).drag(), 0.3);
  EXPECT_EQ(ForcePlan(DampingForce(0)).drag(), 0);
  std::vector<double> c(arrays(g).node_slots());
  for (Node n : g.nodes()) c[n.id()] = 0.1 * (n.id() % 7);
  const NodeDrag drag(c);
  auto by_hand = [&](Node n) { return -0.1 * (n.id() % 7) * n.value().vel; };
  EXPECT_LT(distance(drag, by_hand), 4e-15);
  const ForcePlan both = make_combined_force(drag, DampingForce(2), drag);
  EXPECT_EQ(both.drag()[0], 2);
  EXPECT_EQ(both.drag()[5], 3);
  EXPECT_EQ(both.drag()[arrays(g).node_slots()],
            2);  // a node that is added later
  EXPECT_FALSE(both.drag().none());
  EXPECT_TRUE(ForcePlan(GravityForce()).drag().none());
  double power = 0;
  for (Node n : g.nodes())
    power -= dot(n.value().vel, both.drag()[n.id()] * -n.value().vel);
  EXPECT_NEAR(both.drag().power(g), power, 1e-13 * power);
  const auto f = swept_forces(g, both);
  for (Node n : g.nodes())
    EXPECT_LT(norm(f[n.id()] - 2 * (by_hand(n) - n.value().vel)), 1e-13);
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
TEST_F(ForcePlanTest, StiffnessIsTheDerivativeOfTheForce) {
  auto force = make_combined_force(GravityForce(), MassSpringForce());
  auto blocks = blocks_of(force, g);
  ASSERT_TRUE(blocks);
  EXPECT_EQ(blocks->size(), g.num_edges());
  const double h = 1e-6;
  const unsigned n = arrays(g).node_slots();
  FlatFlow flow;
  for (Node moved : g.nodes())
    for (unsigned k = 0; k < 3; ++k) {
      Point unit;
      unit[k] = 1;
      std::vector<Point> expected(n);
      moved.position() += h * unit;
      const auto up = swept_forces(g, force, flow);
      moved.position() -= 2 * h * unit;
      const auto down = swept_forces(g, force, flow);
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

TEST(SpringStiffness, IsIsotropicAtLengthZero) {
  Point u(1, -2, 3);
  EXPECT_EQ(spring_stiffness(Point(), {100, 1}) * u, 100 * u);
  EXPECT_EQ(spring_stiffness(Point(0, 0, 1e-9), {100, 0}) * u, 100 * u);
}

// And knows its stiffness, too, if each of its parts does.
TEST_F(ForcePlanTest, SaysHowOftenItIsTheSprings) {
  struct Child : MassSpringForce {};  // might be stiffer
  const auto times = [this](const ForcePlan& force) {
    const auto number = force.spring_multiplicity();
    const auto blocks = blocks_of(force, g);
    EXPECT_EQ(blocks.has_value(), number.has_value());
    if (number && blocks) {
      EXPECT_EQ(blocks->size(), unsigned(*number) * g.num_edges());
    }
    return number;
  };
  EXPECT_EQ(times(ZeroForce()), 0);
  EXPECT_EQ(times(GravityForce()), 0);
  EXPECT_EQ(times(DampingForce(1)), 0);
  EXPECT_EQ(times(MassSpringForce()), 1);
  EXPECT_EQ(times(make_combined_force()), 0);
  EXPECT_EQ(times(make_combined_force(MassSpringForce(), GravityForce(),
                                      MassSpringForce())),
            2);
  EXPECT_EQ(times(Child()), std::nullopt);
  EXPECT_EQ(times(make_combined_force(MassSpringForce(), Child())),
            std::nullopt);
  EXPECT_EQ(times(make_combined_force(MassSpringForce(), Problem1Force())),
            std::nullopt);
  EXPECT_EQ(times(FunctionForce([](Node, double) { return Point(); })),
            std::nullopt);
}

// ------------------------------------------------------------ Exact types

/** Children of the course's forces, each with another call. */
struct HeavierForce : GravityForce {
  Point operator()(Node n, double t) const override {
    return 2 * GravityForce::operator()(n, t);
  }
};
struct SofterForce : MassSpringForce {
  Point operator()(Node n, double t) const override {
    return 0.5 * MassSpringForce::operator()(n, t);
  }
};
struct QuadraticDrag : DampingForce {
  QuadraticDrag() : DampingForce(0.2) {}
  Point operator()(Node n, double) const override {
    return -c * norm(n.value().vel) * n.value().vel;
  }
};
struct HalfOfAll : CombinedForces {
  using CombinedForces::CombinedForces;
  Point operator()(Node n, double t) const override {
    return 0.5 * CombinedForces::operator()(n, t);
  }
};

TEST_F(ForcePlanTest, AChildNeverTakesItsParentsKernel) {
  const HalfOfAll half(
      {std::make_shared<GravityForce>(), std::make_shared<MassSpringForce>()});
  const auto expect_called = [&](const ZeroForce& force) {
    EXPECT_LT(distance(force, [&](Node n) { return force(n, 0); }), 4e-15);
    const ForcePlan plan(force);
    EXPECT_EQ(plan.spring_multiplicity(), std::nullopt);
    EXPECT_EQ(plan.drag(), 0);
    EXPECT_EQ(plan.energy(g), 0);
    EXPECT_FALSE(blocks_of(force, g));
  };
  expect_called(HeavierForce());
  expect_called(SofterForce());
  expect_called(QuadraticDrag());
  expect_called(half);
  expect_called(make_combined_force(HeavierForce(), SofterForce()));
}

/** A force of the laboratory, as a child of the class that is swept. */
struct Swept : SweptForce {
  int& sweeps;
  explicit Swept(int& n) : sweeps(n) {}
  Point operator()(Node n, double t) const override { return t * n.position(); }
  void add_to(const Part& part, double t, std::span<Point> f) const override {
    ++sweeps;
    SweptForce::add_to(part, t, f);
  }
  std::optional<int> spring_multiplicity() const override { return 0; }
};
TEST_F(ForcePlanTest, SweepsAForceOfTheLaboratory) {
  int sweeps = 0;
  const auto force = make_combined_force(GravityForce(), Swept(sweeps));
  EXPECT_LT(distance(force, [&](Node n) { return force(n, 0); }), 4e-15);
  EXPECT_EQ(sweeps, 1);
  EXPECT_EQ(ForcePlan(force).spring_multiplicity(), 0);
}

TEST_F(ForcePlanTest, SharesThePartsOfASum) {
  std::optional<ForcePlan> plan;
  {
    const auto force = make_combined_force(
        GravityForce(3), [on_the_heap = std::vector{1.}](Node, double) {
          return Point(on_the_heap[0], 0, 0);
        });
    plan.emplace(force);
  }
  const auto f = swept_forces(g, *plan);
  for (Node n : g.nodes())
    EXPECT_LT(norm(f[n.id()] - Point(1, 0, -3 * n.value().mass)), 4e-15);
}

/** A child of a force that has a kernel; its call does not override. */
struct Upwards : GravityForce {
  template <typename NODE>
  Point operator()(NODE, double) const {
    return Point(0, 0, 5);
  }
};

TEST(ForcePlan, CallsWhatHidesTheCallOfItsParent) {
  Cloth g;
  g.add_node(Point(1, 2, 3));
  Upwards force;
  const Upwards same;
  const auto sum = make_combined_force(force);
  for (const ForcePlan& plan : {ForcePlan(force), ForcePlan(same),
                                ForcePlan(Upwards()), ForcePlan(sum)}) {
    const auto f = swept_forces(g, plan);
    EXPECT_EQ(f[0], Point(0, 0, 5));
  }
  EXPECT_EQ(ForcePlan(GravityForce()).energy(g), 9.81 * 3);
}

}  // namespace
