// The forces of mass_spring.hpp: each against its formula, and sums of them.
#include <gtest/gtest.h>

#include <vector>

#include "tests/ShakenCloth.hpp"

namespace {

TEST_F(ShakenCloth, GravityIsWeight) {
  EXPECT_LT(
      call_distance(GravityForce(),
                    [](Node n) { return Point(0, 0, -9.81 * n.value().mass); }),
      1e-15);
  EXPECT_EQ(GravityForce(2).gravity(), 2);
}

TEST_F(ShakenCloth, DampingIsLinearDrag) {
  DampingForce drag(0.3);
  EXPECT_LT(call_distance(drag, [](Node n) { return -0.3 * n.value().vel; }),
            1e-15);
  EXPECT_EQ(drag.coefficient(), 0.3);
  EXPECT_EQ(DampingForce().coefficient(), 0);
  double power = 0, speeds = 0;
  for (Node n : g.nodes()) {
    power += dot(drag(n, 0), n.value().vel);
    speeds += normSq(n.value().vel);
  }
  EXPECT_NEAR(power, -0.3 * speeds, 1e-12);
  EXPECT_DEATH(DampingForce(-1), "c >= 0");
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
  EXPECT_EQ(Problem1Force()(a, 0), Point(0, 0, -9.81));
  EXPECT_EQ(Problem1Force(100, 0.5)(a, 0), Point(150, 0, -9.81));
}

TEST(MassSpringForce, IsZeroNotNanAtLengthZero) {
  Cloth g;
  Node a = g.add_node(Point(1)), b = g.add_node(Point(1));
  g.add_edge(a, b, {100, 1});
  EXPECT_EQ(MassSpringForce()(a, 0), Point());
  EXPECT_EQ(MassSpringForce()(b, 0), Point());
  EXPECT_EQ(Problem1Force()(b, 0), Point(0, 0, -9.81));
}

TEST_F(ShakenCloth, CombinedForcesAddUpAnyNumber) {
  auto at = [](double c) { return [c](Node, double) { return Point(c); }; };
  auto combined = make_combined_force(GravityForce(), at(1), at(2), at(3),
                                      DampingForce(1), DampingForce(2));
  EXPECT_LT(call_distance(combined,
                          [](Node n) {
                            return GravityForce()(n, 0) + Point(6) -
                                   3 * n.value().vel;
                          }),
            1e-13);
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

}  // namespace
