// Growth.hpp: what is measured on a sheet and on an oscillator is what theory
// says. The program on top of it: tools/test_sweep.sh.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "lab/charts/Growth.hpp"
#include "lab/charts/Limits.hpp"
#include "lab/fast/Sweep.hpp"
#include "lab/methods/Methods.hpp"
#include "lab/stability/Spectrum.hpp"
#include "lab/stability/StepLimit.hpp"
#include "tests/SweptForces.hpp"

using namespace lab;

namespace {

/** The highest frequency of a stretched sheet of plain mesh, held at its rim:
 * along x a spring is as stiff as ever, along y by its tension. */
double omega_of_sheet(unsigned side, double stretch) {
  const double edge =
      std::sin(std::numbers::pi * (side - 2) / (2. * (side - 1)));
  return 2 * edge * std::sqrt(100. * side * side * (2 - 1 / stretch));
}

TEST(AmplificationByTheory, IsWhatAStepDoes) {
  for (const char* name :
       {"forward-euler", "symplectic-euler", "verlet", "yoshida4", "pefrl",
        "srkn6b", "rk4", "implicit-euler"}) {
    auto method = find_method(name)->make();
    for (double y : {0.1, 0.9, 1.6, 2.1, 3.1, 5.5})
      for (double d : {0.0, 0.3, 1.1, 3.0}) {
        const double theory = amplification_by_theory(name, y, d);
        EXPECT_NEAR(amplification(*method, 0.01, 100 * y, 100 * d), theory,
                    1e-9 * theory)
            << name << " dt omega " << y << " dt gamma " << d;
      }
  }
  EXPECT_THROW(amplification_by_theory("xpbd", 1, 0), std::invalid_argument);
}

// Known boundaries: h^2 w^2 + 2 h gamma = 4; h gamma = h^2 w^2; for Verlet with
// exact drag y^2 = 2 d coth(d/2), and 2 without drag.
TEST(AmplificationByTheory, IsOneOnKnownBoundaries) {
  auto crosses = [](const char* name, double y, double d) {
    EXPECT_LE(amplification_by_theory(name, y * (1 - 1e-6), d), 1 + 1e-12)
        << name;
    EXPECT_GT(amplification_by_theory(name, y * (1 + 1e-6), d), 1) << name;
  };
  for (double d : {0.5, 1.0, 1.5})
    crosses("symplectic-euler", std::sqrt(4 - 2 * d), d);
  for (double d : {0.01, 0.5}) crosses("forward-euler", std::sqrt(d), d);
  for (double d : {0.5, 2.0})
    crosses("verlet", std::sqrt(2 * d / std::tanh(d / 2)), d);
  crosses("verlet", 2, 0);
  crosses("rk4", 2 * std::sqrt(2), 0);
}

TEST(StretchedSheet, IsAtRestAndHasTheFrequencyOfAMembrane) {
  for (double stretch : {1.05, 1.5, 2.5}) {
    Start s(stretched_sheet(9, MeshSprings::plain, stretch, 0));
    auto f = swept_forces(s.cloth, s.force);
    s.constraint.each_held(s.cloth, [&f](Node n) { f[n.id()] = Point(); });
    for (const Point& p : f) EXPECT_LT(norm(p), 1e-11);
    EXPECT_NEAR(SharpOmega()(s.cloth, s.force, s.constraint, 80),
                omega_of_sheet(9, stretch), 1e-3 * omega_of_sheet(9, stretch));
  }
}

TEST(Growth, IsThatOfTheFastestWaveBeyondTheLimitAndNoneBelow) {
  constexpr double stretch = 1.4;
  const Problem p = stretched_sheet(9, MeshSprings::plain, stretch, 0);
  const double omega = omega_of_sheet(9, stretch);
  for (const char* name :
       {"symplectic-euler", "verlet", "yoshida4", "srkn6b", "rk4"}) {
    const MethodEntry& m = *find_method(name);
    auto method = m.make();
    const double dt = m.info.limit / omega;
    const double right = std::log(amplification(*method, 1.1 * dt, omega));
    EXPECT_NEAR(growth(p, m, 1.1 * dt, 200).per_step, right, 0.02 * right)
        << name;
    EXPECT_NEAR(growth(p, m, 1.1 * dt, 200, 3).per_step, right, 0.02 * right)
        << name;
    EXPECT_LT(growth(p, m, 0.98 * dt, 200).per_step, 0.005) << name;
  }
}

// Compressed, no step is small enough: its energy itself falls when it moves.
TEST(Growth, OfACompressedSheetIsThatOfBuckling) {
  const Problem p = stretched_sheet(9, MeshSprings::plain, 0.9, 0);
  const MethodEntry& verlet = *find_method("verlet");
  const double edge = std::sin(std::numbers::pi * 7 / 16.);
  // Out of the plane K (1/s - 1) pushes from all four sides.
  const double rate = 2 * edge * std::sqrt(2 * 100. * 81 * (1 / 0.9 - 1));
  for (double dt : {1e-4, 5e-4})
    EXPECT_NEAR(growth(p, verlet, dt, 2000).per_step, rate * dt,
                0.03 * rate * dt);
}

TEST(Growth, IsInfiniteWhereNothingIsFinite) {
  const Problem p = stretched_sheet(5, MeshSprings::diagonals, 1.5, 1);
  EXPECT_EQ(growth(p, *find_method("rk4"), 1e200, 4).total, no_limit);
  EXPECT_EQ(growth(p, *find_method("verlet"), 1, 100, 5, 2).total, no_limit);
}

TEST(Growth, GivesTheLimitOfASheetToItsPrecision) {
  for (const char* name : {"symplectic-euler", "verlet", "rk4"}) {
    const MethodEntry& m = *find_method(name);
    const Problem p = stretched_sheet(9, MeshSprings::plain, 1.5, 1);
    const double right = step_limit(m, omega_of_sheet(9, 1.5), 1);
    EXPECT_NEAR(
        measured_sheet_limit(p, m, 0.7 * right, 1.4 * right, 300, 0.002), right,
        0.01 * right)
        << name;
  }
}

}  // namespace
