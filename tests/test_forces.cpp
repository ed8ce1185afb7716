// The forces of mass_spring.hpp: each against its formula, and sums of them.
#include <gtest/gtest.h>

#include <fstream>
#include <map>
#include <memory>
#include <sstream>
#include <string>
#include <type_traits>
#include <typeinfo>
#include <utility>
#include <vector>

#include "tests/ShakenCloth.hpp"
#include "tests/TestFolder.hpp"

namespace {

TEST_F(ShakenCloth, GravityIsWeight) {
  EXPECT_LT(
      call_distance(GravityForce(),
                    [](Node n) { return Point(0, 0, -9.81 * n.value().mass); }),
      1e-15);
}

TEST_F(ShakenCloth, DampingIsLinearDrag) {
  DampingForce drag(0.3);
  EXPECT_LT(call_distance(drag, [](Node n) { return -0.3 * n.value().vel; }),
            1e-15);
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

// ------------------------------------------ children with a call of their own

/** Force k is k t in each coordinate: a sum says which of them were called. */
struct NotConst : ZeroForce {
  Point operator()(Node, double t) { return Point(t); }
};
struct Template : ZeroForce {
  template <typename NODE>
  Point operator()(NODE, double t) const {
    return Point(2 * t);
  }
};
struct NotConstTemplate : ZeroForce {
  template <typename NODE>
  Point operator()(NODE& n, double t) {
    return Point(4 * t + 0 * n.degree());
  }
};
struct ByReference : ZeroForce {
  Point operator()(const Node&, const double& t) const { return Point(8 * t); }
};
struct Sixteen {
  Point operator()(Node, double t) const { return Point(16 * t); }
};
struct OfItsOtherParent : ZeroForce, Sixteen {
  using Sixteen::operator();
};
struct OfAGravity : GravityForce {
  Point operator()(Node, double t) { return Point(32 * t); }
};
struct OfANotConst : NotConst {
  Point operator()(Node, double t) const final { return Point(64 * t); }
};
struct Inherits : OfANotConst {};
struct InheritsGravity : GravityForce {};

template <typename F>
Point called_in_a_sum(F force) {
  Cloth g;
  return make_combined_force(force)(g.add_node(Point()), 1);
}
/** The acceleration in a step that is given the force itself. */
template <typename F>
Point called_in_a_step(F&& force) {
  Cloth g;
  Node n = g.add_node(Point(0, 0, 3), {Point(), 0.5});
  symp_euler_step(g, 1, 0.25, force);
  const Point change = n.value().vel;
  symp_euler_step(g, 1, 0.25, std::forward<F>(force), ZeroConstraint());
  EXPECT_EQ(n.value().vel, 2 * change);
  return 2 * change;
}

template <typename F>
void expect_called(double k) {
  EXPECT_EQ(called_in_a_sum(F()), Point(k)) << typeid(F).name();
  EXPECT_EQ(called_in_a_step(F()), Point(k)) << typeid(F).name();
  F force;
  EXPECT_EQ(called_in_a_step(force), Point(k)) << typeid(F).name();
}

TEST(OwnForces, AreCalledByTheirOwnCall) {
  expect_called<NotConst>(1);
  expect_called<Template>(2);
  expect_called<NotConstTemplate>(4);
  expect_called<ByReference>(8);
  expect_called<OfItsOtherParent>(16);
  expect_called<OfAGravity>(32);
  expect_called<OfANotConst>(64);
  expect_called<Inherits>(64);
  expect_called<ZeroForce>(0);
  const Template constant;
  EXPECT_EQ(called_in_a_step(constant), Point(2));
  EXPECT_EQ(called_in_a_sum(make_combined_force(
                NotConst(), Template(), make_combined_force(NotConstTemplate()),
                ByReference(), OfItsOtherParent(), OfAGravity(), Inherits())),
            Point(127));
}

// The compiler itself is asked: a static_assert can't be seen from inside.
TEST(OwnForces, WhatCannotBeCalledDoesNotCompileAndSaysWhy) {
  CME212::TestFolder folder;
  std::ofstream(folder / "a.cpp") << R"(#include "mass_spring.hpp"
    struct OfTwo : ZeroForce { Point operator()(Node, Node) const; };
    class Private : public ZeroForce {
      Point operator()(Node, double) const override { return Point(); } };
    struct Number { double operator()(Node, double) const; };
    struct OfOne : ZeroConstraint { void operator()(Cloth&) const; };
    void f() {
      make_combined_force(GravityForce(), MassSpringForce());
      make_combined_force(OfTwo());
      make_combined_force(Private());
      make_combined_force(Number());
      make_combined_constraints(PlaneConstraint(), OfOne());
    })";
  const auto result =
      folder.run("c++ -std=c++20 -fsyntax-only -I. " + folder / "a.cpp");
  EXPECT_NE(result.status, 0);
  std::istringstream errors(result.err);
  std::map<std::string, int> times;
  for (std::string line; std::getline(errors, line);)
    if (line.find("error: ") != line.npos)
      for (const char* what : {"A force needs a public call: Point operator()",
                               "A constraint needs a public call: void oper"})
        times[what] += line.find(what) != line.npos;
  const std::map<std::string, int> expected = {
      {"A force needs a public call: Point operator()", 3},
      {"A constraint needs a public call: void oper", 1}};
  EXPECT_EQ(times, expected) << result.err;
}

}  // namespace
