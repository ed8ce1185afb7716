// Calls that forces of mass_spring.hpp, sums and steps take beyond those of the
// assignment, to which course/tests holds them.
#include <gtest/gtest.h>

#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <typeinfo>
#include <utility>

#include "mass_spring.hpp"
#include "tests/TestFolder.hpp"

namespace {

TEST(DampingForce, GivesNoEnergy) { EXPECT_DEATH(DampingForce(-1), "c >= 0"); }

TEST(SympEulerStep, TakesLambdasAndGraphsOfAnyKind) {
  struct Mass {
    Point vel;
    double mass = 2;
    int color = 0;
  };
  Graph<Mass, int> g;
  auto a = g.add_node(Point(1));
  auto force = [](auto n, double t) { return Point(n.value().mass * t); };
  double t = symp_euler_step(g, 3, 0.5, force);
  symp_euler_step(g, t, 0.5, force, [](auto& h, double now) {
    EXPECT_EQ(now, 3.5);
    h.node(0).value().color = 1;
  });
  EXPECT_EQ(a.value().vel, Point(0.5 * 3 + 0.5 * 3.5));
  EXPECT_EQ(a.position(), Point(1 + 0.5 * 1.5));
  EXPECT_EQ(a.value().color, 1);
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
