// The implicit methods and XPBD against exact solutions of the difference
// equations, and where others fail.
#include <gtest/gtest.h>

#include "lab/methods/ImplicitMethods.hpp"
#include "lab/methods/Splitting.hpp"
#include "lab/methods/Xpbd.hpp"
#include "tests/PinnedSheet.hpp"
#include "tests/Says.hpp"
#include "tests/SweptForces.hpp"

using namespace lab;
using namespace lab::sheets;

namespace {

/** One mass on a spring along x: y'' + w^2 y = 0, y = x - 1. */
struct Oscillator {
  Cloth g;
  Node wall = g.add_node(Point()), a;
  double w;
  CombinedForces force;
  PinConstraint pin;
  static constexpr double y0 = 0.1;  // [m], at rest

  /** @param w [1/s] */
  explicit Oscillator(double w_)
      : a(g.add_node(Point(1 + y0, 0, 0), {Point(), 0.5})),
        w(w_),
        force(make_combined_force(MassSpringForce())),
        pin(g) {
    g.add_edge(wall, a, {0.5 * w * w, 1});
  }
  double y() const { return a.position().x - 1; }
  double v() const { return a.value().vel.x; }
  /** w^2 y^2 + v^2 [m^2/s^2] */
  double energy() const { return w * w * y() * y() + v() * v(); }

  template <typename M>
  void run(M& method, double h, int steps) {
    for (int n = 0; n < steps; ++n) method(g, n * h, h, force, pin);
  }
};

// ------------------------------------------------------------- Every method

template <typename M>
class Implicit : public ::testing::Test {};
using All = ::testing::Types<ImplicitEuler, ImplicitMidpoint, TrBdf2, Xpbd>;
struct Names {
  template <typename M>
  static std::string GetName(int) {
    return std::string(M::info.name);
  }
};
TYPED_TEST_SUITE(Implicit, All, Names);

TYPED_TEST(Implicit, KeepsMomentumWithoutPinsAndGravity) {
  PinnedSheet s(5);
  s.stir();
  TypeParam method;
  const Point before = momentum(s.g);
  for (int n = 0; n < 100; ++n)
    method(s.g, n * 0.005, 0.005, MassSpringForce());
  EXPECT_LT(norm(momentum(s.g) - before), 5e-8);  // implicit Euler's 1e-8
  EXPECT_GT(elastic_energy(s.g), 1e-4);           // it did move
}

// The constraint sees the end of the step, once.
TYPED_TEST(Implicit, CallsTheConstraintOnceAtTheEnd) {
  Oscillator o(3);
  TypeParam method;
  int calls = 0;
  double t = method(o.g, 2, 0.5, o.force, [&](Cloth&, double now) {
    ++calls;
    EXPECT_EQ(now, 2.5);
    EXPECT_NE(o.y(), Oscillator::y0);
  });
  EXPECT_EQ(calls, 1);
  EXPECT_EQ(t, 2.5);
}

TYPED_TEST(Implicit, TakesAnEmptyCloth) {
  Cloth g;
  TypeParam()(g, 0, 0.1, GravityForce());
}

// At dt w = 1e6 an L-stable method leaves nothing of the oscillation.
template <typename M>
void expect_l_stable() {
  Oscillator o(1e4);
  M method;
  const double before = o.energy();
  o.run(method, 100, 1);
  EXPECT_LT(o.energy(), 1e-9 * before);
  o.run(method, 100, 5);
  EXPECT_LT(std::abs(o.y()), 1e-9);
  EXPECT_TRUE(std::isfinite(o.energy()));
}
TEST(ImplicitEuler, IsLStable) { expect_l_stable<ImplicitEuler>(); }
TEST(TrBdf2, IsLStable) { expect_l_stable<TrBdf2>(); }

TEST(TrBdf2, OnlyLosesEnergy) {
  for (double hw : {0.1, 1.0, 20.0}) {
    Oscillator o(50);
    TrBdf2 method;
    // Below 1e-18 Newton's tolerance shows.
    for (int n = 0; n < 100 && o.energy() > 1e-18; ++n) {
      double before = o.energy();
      o.run(method, hw / o.w, 1);
      EXPECT_LT(o.energy(), before) << "dt w = " << hw << ", step " << n;
    }
  }
}

// ------------------------------------------------------- One method, exactly

// y_n = y_0 cos(2 n atan(h w/2)): also far beyond the explicit limit.
TEST(ImplicitMidpoint, SwingsAtItsNumericalFrequency) {
  for (double hw : {0.1, 1.0, 10.0}) {
    Oscillator o(20);
    ImplicitMidpoint method;
    for (int n = 1; n <= 300; ++n) {
      o.run(method, hw / o.w, 1);
      ASSERT_NEAR(o.y(), 0.1 * std::cos(2 * n * std::atan(hw / 2)), 1e-12)
          << "h w = " << hw << ", step " << n;
    }
  }
}

/** The change of angular momentum [kg m^2/s] in 100 steps of a free sheet. */
template <typename M>
double turn(M method) {
  PinnedSheet s(5);
  s.stir();
  const Point before = angular_momentum(s.g);
  for (int n = 0; n < 100; ++n)
    method(s.g, n * 0.002, 0.002, MassSpringForce());
  return norm(angular_momentum(s.g) - before);
}
TEST(ImplicitMidpoint, KeepsAngularMomentumAsOthersDoNot) {
  EXPECT_LT(turn(ImplicitMidpoint(1e-14)), 1e-10);
  EXPECT_GT(turn(ImplicitEuler()), 1e-4);
  EXPECT_GT(turn(TrBdf2()), 1e-7);
  EXPECT_GT(turn(Xpbd()), 1e-6);
}

TEST(NewtonMethod, SaysWhyAStepCantBeMade) {
  PinnedSheet s(4);
  s.stir();
  for (auto [method, name] :
       {std::pair<std::shared_ptr<Method>, std::string>{
            std::make_shared<ImplicitMidpoint>(1e-9, 1), "implicit-midpoint"},
        {std::make_shared<TrBdf2>(1e-9, 1), "tr-bdf2"}}) {
    const std::string what = error_of<StepError>(
        [&, m = method] { m->step(s.g, 0, 0.02, s.force, s.pin); });
    EXPECT_TRUE(begins(what, name + ": Newton's method is at a residual of "));
    EXPECT_TRUE(has(what, " m/s^2 after 1 iterations, expected 1e-09 m/s^2; "));
  }
}

// What Newton leaves over does as a wrong acceleration would: it adds up to
// tolerance T^2/2 at most, however many steps there are in T.
template <typename M>
void expect_error_of_tolerance(double tolerance) {
  const double T = 0.1;
  for (int steps : {20, 200, 2000}) {
    PinnedSheet loose(5), tight(5);
    M coarse(tolerance), fine(1e-30);  // down to round-off
    for (PinnedSheet* s : {&loose, &tight}) s->stir();
    loose.run(coarse, T / steps, steps);
    tight.run(fine, T / steps, steps);
    double sum = 0;
    for (unsigned i = 0; i < 25; ++i)
      sum += normSq(loose.g.node(i).position() - tight.g.node(i).position());
    EXPECT_LT(std::sqrt(sum / 25), tolerance * T * T / 2) << steps << " steps";
    EXPECT_GT(sum, 0) << steps << " steps";
  }
}
TEST(NewtonMethod, LeavesNoMoreThanItsToleranceHoweverSmallTheSteps) {
  expect_error_of_tolerance<ImplicitMidpoint>(1e-3);
  expect_error_of_tolerance<TrBdf2>(1e-3);
}

// The error of a run is that of the method, at a quarter of the work: on a
// stiff sheet, at 20 times verlet's limit.
TEST(TrBdf2, SolvesAsWellAsItsErrorAsksFor) {
  const double T = 0.125;
  PinnedSheet exact(25, 1e4, 1.0 / 625);
  Srkn11b reference;
  exact.run(reference, T / 150, 150);
  auto error = [&](TrBdf2& method) {
    PinnedSheet s(25, 1e4, 1.0 / 625);
    s.run(method, T / 32, 32);
    double sum = 0;
    for (unsigned i = 0; i < 625; ++i)
      sum += normSq(s.g.node(i).position() - exact.g.node(i).position());
    return std::sqrt(sum / 625);
  };
  TrBdf2 method, tight(1e-9);
  EXPECT_NEAR(error(method) / error(tight), 1, 0.02);
  EXPECT_LT(3 * method.work().products, tight.work().products);
  EXPECT_LT(1.3 * double(method.work().newton), double(tight.work().newton));
}

// Angular momentum [kg m^2/s] shows if Newton stops before round_off().
TEST(NewtonMethod, GoesDownToRoundOffAtSmallSteps) {
  PinnedSheet s(5);
  s.stir();
  ImplicitMidpoint method(1e-30);
  const Point before = angular_momentum(s.g);
  for (int n = 0; n < 500; ++n) method(s.g, n * 2e-5, 2e-5, MassSpringForce());
  EXPECT_LT(norm(angular_momentum(s.g) - before), 1e-13);
}

// Far from the origin positions have fewer digits: no method can do better.
TEST(NewtonMethod, StopsAtRoundOff) {
  for (double dt : {2e-5, 2e-4, 2e-3, 2e-2}) {
    for (double K : {100.0, 1e4}) {
      PinnedSheet s(5, K);
      s.stir();
      for (Node n : s.g.nodes()) n.position() += Point(1000);
      ImplicitMidpoint midpoint(1e-30, 20);
      TrBdf2 tr_bdf2(1e-30, 20);
      EXPECT_NO_THROW(s.run(midpoint, dt, 5)) << dt << " s, K = " << K;
      EXPECT_NO_THROW(s.run(tr_bdf2, dt, 5)) << dt << " s, K = " << K;
    }
  }
}

// Two sheets as far above z = 0 as below: their energies cancel, but not the
// round-off in them, and that hides how far the objective falls.
TEST(NewtonMethod, FindsItsWayWhereRoundOffHidesTheObjective) {
  for (int seed = 1; seed <= 10; ++seed) {
    CME212::default_generator.seed(unsigned(seed));
    using CME212::random;
    Cloth g;
    auto points = grid_points(4);
    for (double z : {-10.0, 10.0})
      for (const Point& p : points)
        g.add_node(p + Point(0, 0, z),
                   {Point(random(-1, 1), random(-1, 1), random(-1, 1)), 0.03});
    for (const Quad& q : grid_quads(4))
      for (unsigned sheet : {0u, 16u})
        for (auto [a, b] : {std::pair(0, 1), {0, 2}, {0, 3}, {1, 2}})
          g.add_edge(g.node(q[a] + sheet), g.node(q[b] + sheet),
                     {100, norm(points[q[a]] - points[q[b]])});
    auto force = make_combined_force(GravityForce(), MassSpringForce());
    TrBdf2 method(1e-9, 20);
    for (int n = 0; n < 20; ++n)
      ASSERT_NO_THROW(method(g, n * 2e-4, 2e-4, force)) << "seed " << seed;
  }
}

// A compressed spring would throw its ends aside: across it has no stiffness.
TEST(ImplicitEuler, TakesCompressedSpringsAsSoftAcross) {
  Oscillator o(100);
  o.a.position().x = 0.5;
  o.a.value().vel = Point(0, 0.1, 0);
  ImplicitEuler method;
  o.run(method, 0.1, 1);
  EXPECT_NEAR(o.a.value().vel.y, 0.1, 1e-6);
}

using implicit_detail::LinearSolver;

// Crumpled, so that A is not positive definite: the factor is that of another
// matrix, and the solution is right still.
TEST(LinearSolver, GivesTheSameOnCompressedCloth) {
  const double limit = 0.0577 / 10;
  auto end_of = [](auto& method, double h, LinearSolver solver) {
    auto s = std::make_unique<PinnedSheet>(10);
    for (Node n : s->g.nodes()) n.position() *= 0.7;
    s->stir();
    method.use(solver);
    s->run(method, h, 3);
    return s;
  };
  ImplicitEuler euler[2] = {ImplicitEuler(1e-12), ImplicitEuler(1e-12)};
  EXPECT_LT(distance(end_of(euler[0], 5 * limit, LinearSolver::gradients)->g,
                     end_of(euler[1], 5 * limit, LinearSolver::cholesky)->g),
            1e-9);
  EXPECT_EQ(euler[0].work().factors, 0);
  EXPECT_GT(euler[0].work().products, 60);
  EXPECT_EQ(euler[1].work().factors, 3);
  EXPECT_LE(euler[1].work().products, 6);
  TrBdf2 tr[2] = {TrBdf2(1e-11), TrBdf2(1e-11)};
  EXPECT_LT(distance(end_of(tr[0], 2 * limit, LinearSolver::gradients)->g,
                     end_of(tr[1], 2 * limit, LinearSolver::cholesky)->g),
            1e-8);
  EXPECT_GT(tr[1].work().factors, 6);
  EXPECT_LT(tr[1].work().products, tr[0].work().products);
}

// By dt omega and tolerance, not by the clock.
TEST(LinearSolver, FactorsWhereThatIsLessWork) {
  struct Case {
    double dt, tolerance;
    bool factors;
  };
  for (auto [dt, tolerance, factors] : {Case{1e-4, 1e-8, false},
                                        {1e-2, 1e-2, false},
                                        {1e-2, 1e-8, true},
                                        {0.1, 1e-8, true}}) {
    auto work = [&, dt = dt, tolerance = tolerance](LinearSolver solver) {
      PinnedSheet s(20, 1e5);
      s.stir();
      ImplicitEuler method(tolerance);
      method.use(solver);
      s.run(method, dt, 2);
      return method.work();
    };
    SCOPED_TRACE(dt);
    const auto automatic = work(LinearSolver::automatic);
    EXPECT_EQ(automatic.factors > 0, factors);
    EXPECT_EQ(work(LinearSolver::gradients).factors, 0);
    EXPECT_EQ(work(LinearSolver::cholesky).factors, 2);
    EXPECT_LE(automatic.products, work(LinearSolver::gradients).products);
  }
}

// A chain takes as many products as it has masses, whatever is expected of it.
TEST(LinearSolver, FactorsWhenGradientsDragOn) {
  Cloth g;
  const unsigned n = 1000;
  for (unsigned i = 0; i < n; ++i)
    g.add_node(Point(0.01 * i, 0, 0), {Point(), 0.001});
  for (unsigned i = 1; i < n; ++i)
    g.add_edge(g.node(i - 1), g.node(i), {1e6, 0.01});
  g.node(0).value().vel = Point(-1, 0, 0);
  ImplicitEuler method;
  method(g, 0, 0.01, MassSpringForce());
  EXPECT_EQ(method.work().factors, 1);
  EXPECT_LT(method.work().products, 130);
}

// Where all may be left over, that is an acceleration, and not a velocity in a
// time step.
TEST(ImplicitEuler, WhatIsLeftOverIsAnAcceleration) {
  const double dt = 1e-5;
  PinnedSheet s(8);
  for (Node n : s.g.nodes()) n.value().vel = Point(1, 2, 3 * n.position().x);
  s.pin(s.g, 0);
  const Cloth before = s.g;
  ImplicitEuler method(1);
  method(s.g, 0, dt, s.force, s.pin);
  for (unsigned i = 0; i < before.num_nodes(); ++i)
    EXPECT_LT(norm(s.g.node(i).value().vel - before.node(i).value().vel),
              10 * grav * dt);
}

TEST(ImplicitEuler, SaysThatItsSystemCantBeSolved) {
  PinnedSheet s(4);
  s.g.node(5).value().vel = Point(HUGE_VAL);
  ImplicitEuler method;
  EXPECT_THROW(method(s.g, 0, 0.02, s.force, s.pin), StepError);
}

// At 100 times the explicit limit full steps only go from one fold to another,
// as if there was no line search: then none of these steps can be made.
template <typename M>
void expect_steps_of_a_stiff_sheet() {
  PinnedSheet s(8, 1e4);
  s.stir();
  M method;
  for (int n = 0; n < 5; ++n)
    ASSERT_NO_THROW(method(s.g, 0.1 * n, 0.1, s.force)) << "step " << n;
}
TEST(NewtonMethod, NeedsItsLineSearchOnBucklingCloth) {
  expect_steps_of_a_stiff_sheet<ImplicitMidpoint>();
  expect_steps_of_a_stiff_sheet<TrBdf2>();
}

// One spring, one substep: the round over the springs is an exact solution.
TEST(Xpbd, IsImplicitEulerOnOneSpring) {
  Oscillator a(20), b(20);
  Xpbd xpbd(1);
  ImplicitEuler euler;
  for (int n = 0; n < 100; ++n) {
    a.run(xpbd, 0.01, 1);
    b.run(euler, 0.01, 1);
    ASSERT_NEAR(a.y(), b.y(), 1e-10);
    ASSERT_NEAR(a.v(), b.v(), 1e-8);
  }
}

// Substeps are steps as far as the springs go.
TEST(Xpbd, TakesSubstepsAsSteps) {
  PinnedSheet a(5), b(5);
  Xpbd one(1), ten(10);
  a.run(one, 0.001, 200);
  b.run(ten, 0.01, 20);
  EXPECT_LT(distance(a.g, b.g), 1e-12);
}

TEST(Xpbd, RefusesSpringsThatAreNotTheEdges) {
  PinnedSheet s(3);
  Xpbd method;
  auto twice = make_combined_force(MassSpringForce(), MassSpringForce());
  EXPECT_THROW(method(s.g, 0, 0.01, twice), std::invalid_argument);
  struct Softer : SweptSprings {
    bool add_stiffness(const Cloth& g,
                       const StiffnessVisitor& use) const override {
      return SweptSprings::add_stiffness(
          g, [&](unsigned i, unsigned j, Stiffness B) {
            B.along /= 2;
            use(i, j, B);
          });
    }
  };
  EXPECT_THROW(method(s.g, 0, 0.01, Softer()), std::invalid_argument);
  EXPECT_NO_THROW(method(s.g, 0, 0.01, s.force));
}

}  // namespace
