// Stability.hpp: the guard stops what diverges, and lets pass what does not.
#include <gtest/gtest.h>

#include <limits>

#include "Integrator.hpp"
#include "Stability.hpp"

namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

void build_grid(Cloth& g, unsigned side) {
  build_cloth(g, grid_points(side), grid_quads(side), Mesh::diagonals);
}

/** Run the grid for @a steps of @a dt.  @return the steps that were good */
int good_steps(unsigned side, double dt, int steps) {
  Cloth g;
  build_grid(g, side);
  auto force = make_combined_force(GravityForce(), MassSpringForce());
  PinConstraint pin(g);
  DivergenceGuard guard(g, grav);
  SymplecticEuler euler;
  for (int n = 0; n < steps; ++n) {
    euler(g, 0, dt, force, pin);
    if (!guard.accept(g)) return n;
  }
  return steps;
}

// h_safe = 0.0577/sqrt(N) with diagonals and K = 100: 0.0115 s at 5 x 5 and
// 0.00231 s at 25 x 25, stable in every configuration; twice that is not.
TEST(DivergenceGuard, StopsAboveTheStableStepOnly) {
  EXPECT_EQ(good_steps(5, 0.0115, 2000), 2000);
  EXPECT_EQ(good_steps(25, 0.0023, 2000), 2000);
  EXPECT_LT(good_steps(5, 0.023, 2000), 200);
  EXPECT_LT(good_steps(25, 0.0046, 2000), 200);
}

TEST(DivergenceGuard, LetsAClothFallFreelyForLong) {
  Cloth g;
  build_grid(g, 3);
  for (Node n : g.nodes()) n.position() += Point(5, 5, 5);
  DivergenceGuard guard(g, grav);
  for (int n = 0; n < 2000; ++n) {
    symp_euler_step(g, 0, 0.01, GravityForce());
    ASSERT_TRUE(guard.accept(g)) << "step " << n;
  }
  EXPECT_GT(kinetic_energy(g), 10000);  // J: 20 s of fall
}

TEST(DivergenceGuard, StopsOnEveryNumberThatIsNotFinite) {
  for (double bad : {nan, std::numeric_limits<double>::infinity()}) {
    Cloth g;
    build_grid(g, 3);
    DivergenceGuard guard(g, grav);
    EXPECT_TRUE(guard.accept(g));
    g.node(4).value().vel.x = bad;
    EXPECT_FALSE(guard.accept(g));
    EXPECT_NE(
        WorstPlace(g).text(g).find("node 4 has a position or a velocity that"),
        std::string::npos);
  }
}

TEST(DivergenceGuard, StopsAClothThatIsStretchedBeyondItsEnergy) {
  Cloth g;
  build_grid(g, 5);
  DivergenceGuard guard(g, grav);
  for (int n = 0; n < 20; ++n) EXPECT_TRUE(guard.accept(g));
  for (Node n : g.nodes()) n.position() *= 3;
  int accepted = 0;
  while (accepted < 100 && guard.accept(g)) ++accepted;
  EXPECT_LT(accepted, 10);
}

TEST(DivergenceGuard, RestoresTheLastGoodState) {
  Cloth g;
  build_grid(g, 3);
  DivergenceGuard guard(g, grav);
  g.node(1).position() = Point(1, 2, 3);
  g.node(1).value().vel = Point(1, 0, 0);
  ASSERT_TRUE(guard.accept(g));
  g.remove_node(g.node(5));
  for (Node n : g.nodes()) n.position() = n.value().vel = Point(nan);
  ASSERT_FALSE(guard.accept(g));
  guard.restore(g);
  EXPECT_EQ(g.num_nodes(), 8u);
  EXPECT_EQ(g.node(1).position(), Point(1, 2, 3));
  EXPECT_EQ(g.node(1).value().vel, Point(1, 0, 0));
  EXPECT_EQ(g.node(0).position(), Point(0, 0, 0));
  EXPECT_TRUE(guard.accept(g));
}

TEST(DivergenceGuard, NamesTheFastestNodeAndItsLongestSpring) {
  Cloth g;
  Node a = g.add_node(Point()), b = g.add_node(Point(0.5, 0, 0));
  Node c = g.add_node(Point(0, 0, 8), {Point(3, 4, 0), 1});
  g.add_edge(a, b, {100, 0.5});
  g.add_edge(c, b, {100, 2});
  g.add_edge(c, a, {100, 9});
  EXPECT_EQ(WorstPlace(g).text(g),
            "node 2 moves at 5 m/s, its spring to node 1 is 4.00781 times its "
            "rest length of 2 m");
  g.clear();
  EXPECT_EQ(WorstPlace(g).text(g), "no node is left");
}

}  // namespace
