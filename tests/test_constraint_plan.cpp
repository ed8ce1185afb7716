// ConstraintPlan: projecting by parts against the call, which nodes are held,
// and which classes it recognises.
#include "lab/fast/ConstraintPlan.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include "lab/scenes/Contact.hpp"
#include "tests/ScatteredCloth.hpp"

using namespace lab;

namespace {

/** Projecting by parts, the last one first, is the call, bit by bit. */
TEST_F(ScatteredCloth, NodewiseByPartsIsTheCall) {
  const std::vector<Node> some = {g.node(60), g.node(0),  g.node(16),
                                  g.node(17), g.node(18), g.node(63)};
  const Motion motion = {Point(0.3, -0.2, 0.1)};
  const PinConstraint pins(some);
  const PlaneConstraint plane(-0.6);
  const SphereConstraint sphere;
  const PinnedNodes moving(PinConstraint(std::vector<Node>{some[1], some[4]}),
                           motion);
  const WallConstraint wall(Point(0, 0, -0.6), Point(1, 0, 5), {}, 0.5);
  const BallConstraint rough_ball(ball, {}, 0.5);
  const auto all = make_combined_constraints(pins, wall, moving, sphere);
  const auto both = make_combined_constraints(all, ZeroConstraint());
  g.remove_node(some[2]);
  for (Node n : some)
    if (g.has_node(n)) n.position() += Point(0.01, -0.02, 0.03);
  const auto before = state();
  for (const ZeroConstraint* c : std::initializer_list<const ZeroConstraint*>{
           &pins, &plane, &sphere, &moving, &wall, &rough_ball, &all, &both}) {
    const double t = 0.5;
    const ConstraintPlan plan(*c);
    EXPECT_TRUE(plan.nodewise());
    (*c)(g, t);
    const auto expected = state();
    EXPECT_FALSE(expected == before);
    set_state(before);
    plan(g, t);
    EXPECT_TRUE(state() == expected);
    set_state(before);
    for (auto [first, last] :
         {std::pair(20u, 64u), {20, 20}, {17, 20}, {0, 17}})
      plan.project(g, t, first, last);
    EXPECT_TRUE(state() == expected);
    set_state(before);
  }
}

TEST_F(ScatteredCloth, WhatRemovesOrIsNotKnownIsNotNodewise) {
  const auto nodewise = [](const ConstraintPlan& c) { return c.nodewise(); };
  EXPECT_TRUE(nodewise(ZeroConstraint()));
  // What moves adds up its work, in one order.
  const Motion motion = {Point(0.3, -0.2, 0.1)};
  EXPECT_FALSE(nodewise(WallConstraint(Point(), Point(0, 0, 1), motion)));
  EXPECT_FALSE(nodewise(BallConstraint(ball, motion)));
  EXPECT_TRUE(nodewise(make_combined_constraints()));
  struct Another : ZeroConstraint {};
  EXPECT_FALSE(nodewise(Another()));
  EXPECT_FALSE(nodewise(TearConstraint()));
  EXPECT_FALSE(nodewise(StrainConstraint(0.1)));
  auto nothing = [](Cloth&, double) {};
  EXPECT_FALSE(nodewise(make_combined_constraints(nothing)));
  EXPECT_FALSE(
      nodewise(make_combined_constraints(PlaneConstraint(), TearConstraint())));
  WatchedConstraint watched(make_combined_constraints(PlaneConstraint(-0.6)));
  EXPECT_TRUE(nodewise(watched));
  watched.watch(g, true);
  EXPECT_FALSE(nodewise(watched));
}

TEST(ConstraintPlanPins, StopsOnlyTheHeldNodes) {
  Cloth g;
  Node a = g.add_node(Point(0, 0, 0)), b = g.add_node(Point(2, 0, 0));
  auto both = make_combined_constraints(PlaneConstraint(), PinConstraint(g));
  a.value().vel = b.value().vel = Point(1);
  ConstraintPlan(both).set_held_velocities(g, 0);
  EXPECT_EQ(a.value().vel, Point());
  EXPECT_EQ(b.value().vel, Point(1));
}

// ------------------------------------------------------------ Exact types

/** Children of the course's constraints, each with another call. */
template <typename Parent>
struct Child : Parent {
  using Parent::Parent;
  void operator()(Cloth& g, double t) const override {
    Parent::operator()(g, t);
    for (Node n : g.nodes()) n.position() += Point(0, 0, 7);
  }
};

TEST_F(ScatteredCloth, AChildNeverTakesItsParentsKernel) {
  const auto before = state();
  const auto expect_called = [&](const ZeroConstraint& c) {
    const ConstraintPlan plan(c);
    EXPECT_FALSE(plan.nodewise());
    EXPECT_EQ(plan.thinnest(), std::numeric_limits<double>::infinity());
    plan.each_held(g, [](Node) { ADD_FAILURE() << "holds a node"; });
    EXPECT_EQ(plan.first_hit(Point(0.5, 0.5, 0), Point(0.5, 0.5, -1)),
              std::nullopt);
    c(g, 0);
    const auto expected = state();
    EXPECT_FALSE(expected == before);
    set_state(before);
    plan(g, 0);
    EXPECT_TRUE(state() == expected);
    set_state(before);
  };
  const std::vector<Node> some = {g.node(3)};
  expect_called(Child<PinConstraint>(some));
  expect_called(Child<PlaneConstraint>());
  expect_called(Child<SphereConstraint>());
  expect_called(Child<CombinedConstraints>(
      CombinedConstraints::List{std::make_shared<PlaneConstraint>(),
                                std::make_shared<SphereConstraint>()}));
  expect_called(make_combined_constraints(Child<PlaneConstraint>()));
  // The parents are recognised, so the expectations above can fail.
  EXPECT_EQ(ConstraintPlan(SphereConstraint()).thinnest(), ball.radius);
  EXPECT_EQ(ConstraintPlan(TearConstraint()).thinnest(), ball.radius);
  EXPECT_EQ(ConstraintPlan(Child<TearConstraint>()).thinnest(),
            std::numeric_limits<double>::infinity());
}

/** A child of a constraint that is swept; its call does not override. */
struct Lift : PlaneConstraint {
  template <typename G>
  void operator()(G& g, double t) const {
    for (auto n : g.nodes()) n.position().z += t;
  }
};

TEST(ConstraintPlan, CallsWhatHidesTheCallOfItsParent) {
  Cloth g;
  Node n = g.add_node(Point());
  Lift lift;
  const Lift same;
  const auto both = make_combined_constraints(lift);
  for (const ConstraintPlan& plan :
       {ConstraintPlan(lift), ConstraintPlan(same), ConstraintPlan(Lift()),
        ConstraintPlan(both)}) {
    n.position() = Point(0, 0, -3);
    plan(g, 1);
    EXPECT_EQ(n.position(), Point(0, 0, -2));
    EXPECT_FALSE(plan.nodewise());
  }
}

TEST_F(ScatteredCloth, TearingByThePlanIsTheCall) {
  Cloth other = g;
  const auto tear = make_combined_constraints(TearConstraint());
  tear(g, 0);
  ConstraintPlan plan(tear);
  plan(other, 0);
  other.check_invariants();
  ASSERT_EQ(g.num_nodes(), other.num_nodes());
  EXPECT_LT(g.num_nodes(), 60u);
  std::vector<Point> a, b;
  for (Node n : g.nodes()) a.push_back(n.position());
  for (Node n : other.nodes()) b.push_back(n.position());
  std::ranges::sort(a, {}, &Point::x), std::ranges::sort(b, {}, &Point::x);
  EXPECT_TRUE(a == b);
}

TEST(ConstraintPlan, KeepsATemporary) {
  Cloth g;
  Node n = g.add_node(Point(1, 2, 3));
  const ConstraintPlan plan = make_combined_constraints(
      [on_the_heap = std::vector{1.}](Cloth& cloth, double) {
        for (Node m : cloth.nodes()) m.position().z = on_the_heap[0];
      });
  plan(g, 0);
  EXPECT_EQ(n.position(), Point(1, 2, 1));
}

}  // namespace
