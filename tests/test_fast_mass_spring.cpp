// Fast mass-spring against the step of implicit Euler, by Newton's method.
#include <gtest/gtest.h>

#include "lab/fast/GraphArrays.hpp"
#include "lab/methods/FastMassSpring.hpp"
#include "tests/PinnedSheet.hpp"
#include "tests/SweptForces.hpp"

using namespace lab;
using namespace lab::sheets;

namespace {

/** Implicit Euler by Newton's method, to round-off. */
class NewtonEuler : public Method {
 public:
  double step(Cloth& g, double t, double dt, const ForcePlan& force,
              const ConstraintPlan& constraint) override {
    auto& stage = stage_.begin("newton", t, dt, g, force, constraint);
    stage.solve_newton(t + dt, dt);
    return stage.finish();
  }

 private:
  implicit_detail::ImplicitStage stage_{1e-12, 100};
};

}  // namespace

// Each step from the same state, which Newton's method left. With drag: it is
// in the matrix.
TEST(FastMassSpring, TendsToTheStepOfImplicitEuler) {
  constexpr double h = 0.01;
  for (bool accelerated : {false, true}) {
    PinnedSheet right(6, 100, 0.01), sheet(6, 100, 0.01);
    right.stir();
    NewtonEuler newton;
    FastMassSpring few(2, accelerated), ten(10, accelerated),
        many(1500, accelerated);
    double after_two = 0, after_ten = 0;
    for (int n = 0; n < 10; ++n) {
      PinnedSheet before(6, 100, 0.01);
      auto copy = [](const Cloth& from, Cloth& to) {
        for (unsigned i = 0; i < from.num_nodes(); ++i) {
          to.node(i).position() = from.node(i).position();
          to.node(i).value() = from.node(i).value();
        }
      };
      copy(right.g, before.g);
      newton(right.g, n * h, h, right.force, right.pin);
      auto off = [&](FastMassSpring& method) {
        copy(before.g, sheet.g);
        method(sheet.g, n * h, h, sheet.force, sheet.pin);
        return distance(sheet.g, right.g);
      };
      after_two += off(few), after_ten += off(ten);
      EXPECT_LT(off(many), 1e-10)
          << "step " << n << ", accelerated " << accelerated;
    }
    EXPECT_GT(after_ten, 1e-4);
    EXPECT_LT(after_ten, after_two / (accelerated ? 4 : 2));
  }
}

// No round is a drag: a sheet that flies and a stiff pair that turns move as by
// implicit Euler after any number of them, to round-off.
TEST(FastMassSpring, FliesAndTurnsAsImplicitEulerAfterAnyRounds) {
  for (int rounds : {1, 2, 5, 10}) {
    PinnedSheet a(5, 1e6, 0.01), b(5, 1e6, 0.01);
    for (PinnedSheet* s : {&a, &b})
      for (Node n : s->g.nodes()) n.value().vel = Point(1, 2, 3);
    auto force = make_combined_force(GravityForce(), MassSpringForce(),
                                     DampingForce(.01));
    FastMassSpring fast(rounds);
    NewtonEuler newton;
    for (int n = 0; n < 30; ++n) {
      fast(a.g, n / 60., 1 / 60., force);
      newton(b.g, n / 60., 1 / 60., force);
    }
    EXPECT_LT(distance(a.g, b.g), 1e-9) << rounds;
    EXPECT_GT(norm(b.g.node(0).value().vel - Point(1, 2, 3)), 1);

    Cloth pair[2];
    for (Cloth& g : pair)
      g.add_edge(g.add_node(Point(-.5, 0, 0), {Point(0, -2, 0), 1}),
                 g.add_node(Point(.5, 0, 0), {Point(0, 2, 0), 1}), {1e4, 1});
    FastMassSpring turn(rounds);
    for (int n = 0; n < 30; ++n) {
      turn(pair[0], n / 60., 1 / 60., MassSpringForce());
      newton(pair[1], n / 60., 1 / 60., MassSpringForce());
    }
    EXPECT_LT(distance(pair[0], pair[1]), 1e-9) << rounds;
    EXPECT_GT(norm(angular_momentum(pair[0])), 1);
  }
}

TEST(FastMassSpring, KeepsLinearMomentumAfterAnyRounds) {
  for (int rounds : {1, 3, 12}) {
    PinnedSheet s(5);
    s.stir();
    const Point before = momentum(s.g);
    FastMassSpring method(rounds);
    for (int n = 0; n < 100; ++n)
      method(s.g, n * 0.02, 0.02, MassSpringForce());
    EXPECT_LT(norm(momentum(s.g) - before), 1e-12) << rounds;
  }
}

TEST(FastMassSpring, FactorsAnewOnlyWhenItMust) {
  PinnedSheet s(6);
  FastMassSpring method;
  int expected = 1;
  double t = 0;
  auto step = [&](double dt, const ForcePlan& force, const ConstraintPlan& c) {
    t = method(s.g, t, dt, force, c);
    return method.factorizations();
  };
  for (int n = 0; n < 10; ++n)
    EXPECT_EQ(step(0.01, s.force, s.pin), expected) << n;
  EXPECT_EQ(step(0.02, s.force, s.pin), ++expected);             // dt
  EXPECT_EQ(step(0.02, s.force, ZeroConstraint()), ++expected);  // pins
  EXPECT_EQ(step(0.02, s.force, ZeroConstraint()), expected);
  EXPECT_EQ(step(0.02, GravityForce(), ZeroConstraint()), ++expected);
  EXPECT_EQ(step(0.02, s.force, s.pin), ++expected);
  const auto drag = make_combined_force(MassSpringForce(), DampingForce(0.1));
  EXPECT_EQ(step(0.02, drag, s.pin), ++expected);
  EXPECT_EQ(step(0.02, drag, s.pin), expected);
  EXPECT_EQ(step(0.02, s.force, s.pin), ++expected);
  s.g.edge(3).value().K *= 2;
  EXPECT_EQ(step(0.02, s.force, s.pin), ++expected);
  s.g.node(3).value().mass *= 2;
  EXPECT_EQ(step(0.02, s.force, s.pin), ++expected);
  s.g.remove_edge(s.g.edge(0));
  EXPECT_EQ(step(0.02, s.force, s.pin), ++expected);
  arrays(s.g).reindex();  // no other matrix
  EXPECT_EQ(step(0.02, s.force, s.pin), expected);
}

// The same numbers, but other nodes at the ends of the springs, or held.
TEST(FastMassSpring, SeesOtherEndsAndOtherPins) {
  PinnedSheet s(6);
  FastMassSpring method;
  auto step = [&](const ConstraintPlan& c) {
    method.step(s.g, 0, 0.01, s.force, c);
    return method.factorizations();
  };
  EXPECT_EQ(step(s.pin), 1);
  const EdgeData spring = s.g.edge(0).value();
  s.g.remove_edge(s.g.edge(0));
  s.g.add_edge(s.g.node(0), s.g.node(35)).value() = spring;
  EXPECT_EQ(step(s.pin), 2);
  const std::array<Node, 2> others = {s.g.node(1), s.g.node(30)};
  EXPECT_EQ(step(PinConstraint(others)), 3);
  EXPECT_EQ(step(PinConstraint(others)), 3);
}

namespace {

/** Springs that are stiffer than their edges say. */
struct Stiffer : SweptSprings {
  double factor = 2;
  bool add_stiffness(const Cloth& g,
                     const StiffnessVisitor& use) const override {
    return SweptSprings::add_stiffness(
        g, [&](unsigned i, unsigned j, Stiffness B) {
          B.along *= factor;
          use(i, j, B);
        });
  }
};

// Where a force may be stiffer than the edges, each step asks it anew.
TEST(FastMassSpring, AsksAForceThatIsNotTheEdges) {
  PinnedSheet s(6);
  FastMassSpring method;
  Stiffer stiffer;
  double t = 0;
  int expected = 0;
  auto step = [&](const ForcePlan& force) {
    t = method(s.g, t, 0.01, force, s.pin);
    return method.factorizations();
  };
  EXPECT_EQ(step(s.force), ++expected);
  EXPECT_EQ(step(MassSpringForce()), expected);
  EXPECT_EQ(step(stiffer), ++expected);
  EXPECT_EQ(step(stiffer), expected);
  stiffer.factor = 3;
  EXPECT_EQ(step(stiffer), ++expected);
  EXPECT_EQ(step(make_combined_force(GravityForce(), stiffer)), expected);
  EXPECT_EQ(step(s.force), ++expected);
  auto twice = make_combined_force(MassSpringForce(), MassSpringForce());
  EXPECT_EQ(step(twice), ++expected);
  EXPECT_EQ(step(twice), expected);
  EXPECT_EQ(step(s.force), ++expected);
}

}  // namespace
