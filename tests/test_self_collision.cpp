// SelfCollision.hpp: the distances that it promises, by a loop over all pairs;
// what it leaves alone; and how much it looks at.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "lab/fast/Energy.hpp"
#include "lab/fast/GraphArrays.hpp"
#include "lab/fast/Sweep.hpp"
#include "lab/methods/Splitting.hpp"
#include "lab/scenes/Contact.hpp"
#include "lab/scenes/SelfCollision.hpp"
#include "tests/Allocations.hpp"
#include "tests/Momentum.hpp"
#include "tests/Says.hpp"

using namespace lab;

namespace {

using CME212::random;
constexpr double infinity = std::numeric_limits<double>::infinity();

Point random_point(double size) {
  return Point(random(-size, size), random(-size, size), random(-size, size));
}

/** Smallest distance of two nodes without an edge; infinity if there are none.
 * O(N^2) */
double nearest_of_all(const Cloth& g) {
  double least = infinity;
  for (Node a : g.nodes())
    for (Node b : g.nodes())
      if (a.index() < b.index() && !g.has_edge(a, b))
        least = std::min(least, norm(a.position() - b.position()));
  return least;
}

/** @a count nodes at random in a cube, with velocities, masses, and few edges;
 * some slots are empty. */
void scatter(Cloth& g, int count, double size, unsigned seed) {
  CME212::default_generator.seed(seed);
  g.clear();
  for (int i = 0; i < count; ++i)
    g.add_node(random_point(size), {random_point(1), random(0.1, 2)});
  for (int i = 0; i < count; i += 3)
    g.add_edge(g.node(unsigned(i)), g.node(unsigned(i * 7 + 1) % g.size()));
  for (int i = 0; i < count / 10; ++i) g.remove_node(g.node(unsigned(i)));
}

/** Add a square sheet of side^2 nodes, its corner at @a at, with springs. */
void add_sheet(Cloth& g, unsigned side, const Point& at, double K,
               double size = 1) {
  const auto points = grid_points(side);
  const unsigned first = g.num_nodes();
  for (const Point& p : points) g.add_node(at + size * p, {Point(), 0.01});
  const auto quads = grid_quads(side);
  const MeshSprings springs(quads, MeshSprings::diagonals);
  for (unsigned s = 0; s < springs.size(); ++s) {
    auto [i, j] = springs[s];
    Node a = g.node(first + i), b = g.node(first + j);
    g.add_edge(a, b, {K, norm(a.position() - b.position())});
  }
}

// -------------------------------------------------------- nearest_unconnected

TEST(NearestUnconnected, IsTheSmallestDistanceBelowItsBound) {
  Cloth g;
  for (unsigned seed : {1u, 2u, 3u}) {
    scatter(g, 150, 1, seed);
    const double least = nearest_of_all(g);
    for (double up_to : {1.001 * least, 2 * least, 0.3, 5.0})
      EXPECT_EQ(nearest_unconnected(g, up_to), least);
    EXPECT_EQ(nearest_unconnected(g, std::nextafter(least, 1)), least);
    EXPECT_EQ(nearest_unconnected(g, least), infinity);
    EXPECT_EQ(nearest_unconnected(g, 0.5 * least), infinity);
  }
}
TEST(NearestUnconnected, LooksAtNoEdges) {
  Cloth g;
  EXPECT_EQ(nearest_unconnected(g, 1), infinity);
  Node a = g.add_node(Point());
  EXPECT_EQ(nearest_unconnected(g, 1), infinity);
  Node b = g.add_node(Point(0, 0.5, 0));
  g.add_edge(a, b);
  EXPECT_EQ(nearest_unconnected(g, 1), infinity);
  g.remove_edge(a, b);
  EXPECT_EQ(nearest_unconnected(g, 1), 0.5);
}
TEST(NearestUnconnected, IsNotDisturbedByWhatIsFarOutOrNowhere) {
  Cloth g;
  g.add_node(Point());
  g.add_node(Point(0, 0, 0.25));
  for (double far : {1e15, -1e300, infinity, std::nan("")})
    g.add_node(Point(far, 0, 0));
  EXPECT_EQ(nearest_unconnected(g, 1), 0.25);
}

// ------------------------------------------------------------------ One call

TEST(SelfCollision, PushesAPairApartByItsMasses) {
  Cloth g;
  Node a = g.add_node(Point(0.2, 0, 0), {Point(0, 0, 1), 1});
  Node b = g.add_node(Point(0.2, 0.06, 0), {Point(0, -2, 1), 3});
  const SelfCollision c(0.1, 0, make_combined_constraints());
  c(g, 0);
  EXPECT_GE(norm(a.position() - b.position()), 0.1);
  EXPECT_NEAR(norm(a.position() - b.position()), 0.1, 0.00011);
  EXPECT_NEAR(a.position().y + 3 * b.position().y, 0.18, 1e-16);
  EXPECT_EQ(a.position().x, 0.2);
  // Both move alike along y then: as their center of mass does.
  EXPECT_NEAR(a.value().vel.y, -1.5, 1e-15);
  EXPECT_NEAR(b.value().vel.y, -1.5, 1e-15);
  EXPECT_EQ(a.value().vel.z, 1);
  EXPECT_EQ(c.rounds(), 3);  // mends, sees that it is mended, looks anew
}
TEST(SelfCollision, LetsAPairGoThatParts) {
  Cloth g;
  Node a = g.add_node(Point(), {Point(0, -1, 0), 1});
  Node b = g.add_node(Point(0, 0.06, 0), {Point(0, 2, 1), 3});
  SelfCollision(0.1, 1, make_combined_constraints())(g, 0);
  EXPECT_EQ(a.value().vel, Point(0, -1, 0));
  EXPECT_EQ(b.value().vel, Point(0, 2, 1));
}
TEST(SelfCollision, LeavesWhatIsAsFarAsTheThickness) {
  Cloth g;
  Node a = g.add_node(Point(), {Point(0, 1, 0), 1});
  Node b = g.add_node(Point(0, 0.125, 0), {Point(0, -1, 0), 1});
  const SelfCollision c(0.125, 0, make_combined_constraints());
  c(g, 0);
  EXPECT_EQ(b.position(), Point(0, 0.125, 0));
  EXPECT_EQ(b.value().vel, Point(0, -1, 0));
  EXPECT_EQ(c.rounds(), 1);
  b.position().y = std::nextafter(0.125, 0);
  g.add_edge(a, b);  // two that share an edge may be near
  c(g, 0);
  EXPECT_EQ(b.value().vel, Point(0, -1, 0));
  g.remove_edge(a, b);
  c(g, 0);
  EXPECT_EQ(b.value().vel, Point());
  EXPECT_GE(norm(b.position() - a.position()), 0.125);
}
// Coulomb: 2 in, so friction 0.5 takes 1 off the 3 along.
TEST(SelfCollision, RubsAsFrictionSays) {
  Cloth g;
  Node a = g.add_node(Point(), {Point(0, 0, 0), 1});
  Node b = g.add_node(Point(0, 0.06, 0), {Point(3, -2, 0), 1});
  SelfCollision(0.1, 0.5, make_combined_constraints())(g, 0);
  EXPECT_LT(norm(b.value().vel - a.value().vel - Point(2, 0, 0)), 1e-15);
  EXPECT_LT(norm(b.value().vel + a.value().vel - Point(3, -2, 0)), 1e-15);
}
TEST(SelfCollision, PartsTwoAtTheSamePlace) {
  Cloth g;
  for (int k = 0; k < 4; ++k) g.add_node(Point(1, 2, 3));
  SelfCollision(0.1, 0.5, make_combined_constraints())(g, 0);
  EXPECT_GE(nearest_of_all(g), 0.1);
  EXPECT_LT(norm(center_of_mass(g) - Point(1, 2, 3)), 1e-15);
}
TEST(SelfCollision, TakesAnEmptyClothAndOneNode) {
  Cloth g;
  const SelfCollision c(0.1, 0.5, make_combined_constraints());
  c(g, 0);
  Node n = g.add_node(Point(1, 2, 3), {Point(1), 1});
  c(g, 0);
  EXPECT_EQ(n.position(), Point(1, 2, 3));
  EXPECT_EQ(n.value().vel, Point(1));
}

TEST(SelfCollision, InRandomCloudsKeepsMomentumAndDistance) {
  Cloth g;
  for (double friction : {0.0, 0.4, 5.0})
    for (double thickness : {0.05, 0.15, 0.3}) {
      scatter(g, 200, 0.5, 7);
      const Point p = momentum(g), center = center_of_mass(g);
      const double energy = kinetic_energy(g);
      ASSERT_LT(nearest_of_all(g), thickness);
      const SelfCollision c(thickness, friction, make_combined_constraints());
      c(g, 0);
      EXPECT_GE(nearest_of_all(g), thickness);
      EXPECT_LT(norm(momentum(g) - p), 1e-12);
      EXPECT_LT(norm(center_of_mass(g) - center), 1e-14);
      EXPECT_LT(kinetic_energy(g), energy);
      EXPECT_LT(c.rounds(), 150);
      const Cloth once = g;
      c(g, 0);
      EXPECT_EQ(c.rounds(), 1);
      for (unsigned i = 0; i < g.num_nodes(); ++i) {
        EXPECT_EQ(g.node(i).position(), once.node(i).position());
        EXPECT_EQ(g.node(i).value().vel, once.node(i).value().vel);
      }
    }
}
// The same cloud, scattered over memory in another way: nobody is overlooked.
TEST(SelfCollision, FindsAllPairsInCloudsFarFromTheOrigin) {
  Cloth g;
  for (const Point& far : {Point(1e3, -1e3, 5), Point(-1e6, 1e6, -1e6)}) {
    scatter(g, 200, 0.5, 11);
    for (Node n : g.nodes()) n.position() += far;
    SelfCollision(0.1, 0, make_combined_constraints())(g, 0);
    EXPECT_GE(nearest_of_all(g), 0.1);
  }
}

// ---------------------------------------------------------------- With others

TEST(SelfCollision, MovesNoHeldNodes) {
  Cloth g;
  scatter(g, 200, 0.5, 13);
  std::vector<Node> held;
  for (unsigned i = 0; i < g.num_nodes(); ++i) {
    bool apart = i % 10 == 0;
    for (Node h : held)
      apart = apart && norm(h.position() - g.node(i).position()) > 0.1;
    if (apart) held.push_back(g.node(i));
  }
  ASSERT_GT(held.size(), 10u);
  const Cloth before = g;
  const SelfCollision c(0.1, 0.3,
                        make_combined_constraints(PinConstraint(held)));
  c(g, 0);
  EXPECT_GE(nearest_of_all(g), 0.1);
  for (Node n : held) {
    EXPECT_EQ(n.position(), before.node(n.index()).position());
    EXPECT_EQ(n.value().vel, Point());
  }
  std::vector<Node> told;
  ConstraintPlan(c).each_held(g, [&](Node n) { told.push_back(n); });
  std::ranges::sort(told);
  std::ranges::sort(held);
  EXPECT_EQ(told, held);
}
TEST(SelfCollision, TellsOfObstaclesWhatTheOthersTell) {
  const Ball ball = {Point(), 0.5};
  const ConstraintPlan c =
      SelfCollision(0.1, 0, make_combined_constraints(SphereConstraint(ball)));
  EXPECT_EQ(c.thinnest(), 0.5);
  const Point from(-1, 0, 0), to(1, 0, 0);
  EXPECT_EQ(c.first_hit(from, to), lab::first_hit(ball, from, to));
}
TEST(SelfCollision, SaysSoIfTwoHeldNodesAreTooNear) {
  Cloth g;
  for (double x : {5.0, 0.0, 0.0999}) g.add_node(Point(x, 0, 0));
  auto pin = [&] {
    return make_combined_constraints(
        PinConstraint(std::vector<Node>{g.node(1), g.node(2)}));
  };
  EXPECT_TRUE(
      has(error_of<StepError>([&] { SelfCollision(0.1, 0, pin())(g, 0); }),
          "nodes 1 and 2 are held"));
  g.node(2).position().x = 0.1001;
  EXPECT_NO_THROW(SelfCollision(0.1, 0, pin())(g, 0));
}
/** Between a floor and a lid: three nodes in a column need twice the thickness.
 */
struct Lid : ZeroConstraint {
  double height;
  explicit Lid(double h) : height(h) {}
  void operator()(Cloth& g, double) const override {
    for (Node n : g.nodes())
      n.position() = Point(0, 0, std::clamp(n.position().z, 0.0, height));
  }
};
TEST(SelfCollision, SaysSoIfThereIsNoRoom) {
  Cloth g;
  for (double z : {0.05, 0.06, 0.07}) g.add_node(Point(0, 0, z));
  const SelfCollision roomy(0.1, 0, make_combined_constraints(Lid(0.203)));
  roomy(g, 0);
  EXPECT_GE(nearest_of_all(g), 0.1);
  EXPECT_THROW(
      SelfCollision(0.1, 0, make_combined_constraints(Lid(0.1999)))(g, 0),
      StepError);
}

// ------------------------------------------------------------------ Whole runs

/** Runs whose every step is looked at. */
class SelfCollisionRun : public ::testing::Test {
 protected:
  static constexpr double dt = 0.002;
  Cloth g;
  Verlet method;
  int touched = 0;  // steps in which it had to do something

  void run(
      int steps, double thickness, const SelfCollision& c,
      const std::function<void(int)>& after = [](int) {}) {
    auto force = make_combined_force(GravityForce(), MassSpringForce());
    for (int k = 0; k < steps; ++k) {
      method(g, k * dt, dt, force, c);
      ASSERT_GE(nearest_of_all(g), thickness) << "step " << k;
      touched += c.rounds() > 1;
      after(k);
    }
  }
};

// Sheets of pieces that tear at a ball and by strain, from pins, one of which
// moves; and the test removes some more.
TEST_F(SelfCollisionRun, HoldsWhileNodesAndEdgesAreRemoved) {
  add_sheet(g, 8, Point(0, 0, 0), 30);
  add_sheet(g, 8, Point(0.05, 0.03, 0.2), 30);
  const SelfCollision c(
      0.12, 0.2,
      make_combined_constraints(
          PinConstraint(std::vector<Node>{g.node(0), g.node(7)}),
          PinnedNodes(PinConstraint(std::vector{g.node(56)}),
                      {Point(0.5, 0.5, 0.2), 0.6}),
          PlaneConstraint(-0.3), TearConstraint({Point(0.5, 0.5, -0.2), 0.1}),
          StrainConstraint(0.8)));
  const unsigned nodes = g.num_nodes(), edges = g.num_edges();
  run(500, 0.12, c, [&](int k) {
    if (k % 50 == 49) {
      g.remove_node(g.node(unsigned(k) % g.num_nodes()));
      g.remove_edge(g.edge(unsigned(k) % g.num_edges()));
      arrays(g).reindex();
    }
    g.check_invariants();
  });
  EXPECT_LT(g.num_nodes(), nodes - 10);
  EXPECT_LT(g.num_edges(), edges - 60);
  EXPECT_GT(touched, 100);
}

// The same bits by any number of threads.
TEST_F(SelfCollisionRun, IsTheSameByAnyNumberOfThreads) {
  std::vector<Point> end[2];
  for (int k : {0, 1}) {
    Sweep::set_threads(k == 0 ? 1 : 3);
    Cloth two;
    Verlet verlet;
    for (double z : {0.1, 0.15}) add_sheet(two, 36, Point(z, z, z), 20);
    const SelfCollision c(0.025, 0.3,
                          make_combined_constraints(PlaneConstraint(0)));
    for (int step = 0; step < 60; ++step)
      verlet(two, step * 0.005, 0.005,
             make_combined_force(GravityForce(), MassSpringForce()), c);
    EXPECT_GT(c.rounds(), 1);
    for (Node n : two.nodes()) end[k].push_back(n.position());
  }
  Sweep::set_threads(0);
  EXPECT_EQ(end[0], end[1]);
}

TEST(SelfCollision, AllocatesInItsFirstCallOnly) {
  Cloth g;
  build_cloth(g, grid_points(20), grid_quads(20), MeshSprings::diagonals);
  Node a = g.node(0);
  a.position() = g.node(210).position() + Point(0, 0, 0.01);
  const SelfCollision c(0.03, 0.3, make_combined_constraints(PinConstraint(g)));
  c(g, 0);
  ASSERT_GT(c.rounds(), 1);
  a.position() = g.node(230).position() + Point(0, 0, 0.01);
  const long before = allocations;
  c(g, 1);
  EXPECT_EQ(allocations, before);
  EXPECT_GT(c.rounds(), 1);
}

}  // namespace
