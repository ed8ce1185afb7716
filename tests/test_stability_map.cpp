// Growth.hpp: what is measured on a sheet, and amplification() of an
// oscillator, are what theory says.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <complex>
#include <numbers>
#include <stdexcept>
#include <string>
#include <string_view>

#include "lab/charts/Growth.hpp"
#include "lab/fast/Sweep.hpp"
#include "lab/methods/ImplicitMethods.hpp"
#include "lab/methods/Methods.hpp"
#include "lab/methods/Splitting.hpp"
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

using Matrix = std::array<double, 4>;  // by rows, on (x, v/omega)

Matrix product(const Matrix& a, const Matrix& b) {
  return {a[0] * b[0] + a[1] * b[2], a[0] * b[1] + a[1] * b[3],
          a[2] * b[0] + a[3] * b[2], a[2] * b[1] + a[3] * b[3]};
}
double spectral_radius(const Matrix& m) {
  return lab::spectral_radius(m[0], m[1], m[2], m[3]);
}

/** The product of the stages of a splitting: A is x' = v, v' = -gamma v; B is a
 * kick of -omega^2 x. */
template <typename Scheme>
Matrix matrix_of(double y, double d) {
  Matrix all = {1, 0, 0, 1};
  bool kick = Scheme::kicks_first;
  for (double part : Scheme::steps) {
    const double way = d > 0 ? -std::expm1(-d * part) / d : part;
    all = product(kick ? Matrix{1, 0, -part * y, 1}
                       : Matrix{1, y * way, 0, std::exp(-d * part)},
                  all);
    kick = !kick;
  }
  return all;
}

/** The factor per step by which @a method amplifies the oscillator
 * x'' + gamma x' + omega^2 x = 0, by a formula: a check of amplification().
 * Runge-Kutta: the larger |R(z)| of the roots z of z^2 + d z + y^2 = 0, R the
 * Taylor polynomial of exp of the method's order. Others: the spectral radius
 * of the product of their stages.
 * @param y dt omega > 0   @param d dt gamma >= 0
 * Throws std::invalid_argument for methods without a formula here. */
double amplification_by_theory(std::string_view method, double y, double d) {
  if (method == "forward-euler" || method == "rk4") {
    const std::complex<double> root =
        std::sqrt(std::complex(d * d / 4 - y * y));
    const int order = method == "rk4" ? 4 : 1;
    auto R = [order](std::complex<double> z) {
      std::complex<double> sum = 1;
      for (int k = order; k > 0; --k) sum = 1.0 + z / double(k) * sum;
      return std::abs(sum);
    };
    return std::max(R(-d / 2 + root), R(-d / 2 - root));
  }
  if (method == "symplectic-euler")
    return spectral_radius({1, y, -y, 1 - d - y * y});
  if (method == "implicit-euler") {
    const double q = 1 / (1 + d + y * y);
    return spectral_radius({1 - q * y * y, q * y, -q * y, q});
  }
  if (method == "verlet") return spectral_radius(matrix_of<VerletScheme>(y, d));
  if (method == "pefrl") return spectral_radius(matrix_of<PefrlScheme>(y, d));
  if (method == "srkn11b")
    return spectral_radius(matrix_of<Srkn11bScheme>(y, d));
  throw std::invalid_argument("no formula for " + std::string(method));
}

TEST(AmplificationByTheory, IsWhatAStepDoes) {
  for (const char* name : {"forward-euler", "symplectic-euler", "verlet",
                           "pefrl", "srkn11b", "rk4", "implicit-euler"}) {
    auto method = find_method(name)->make();
    for (double y : {0.1, 0.9, 1.6, 2.1, 3.1, 5.5})
      for (double d : {0.0, 0.3, 1.1, 3.0}) {
        const double theory = amplification_by_theory(name, y, d);
        EXPECT_NEAR(amplification(*method, 0.01, 100 * y, 100 * d), theory,
                    1e-9 * theory)
            << name << " dt omega " << y << " dt gamma " << d;
      }
  }
  ImplicitMidpoint midpoint;
  for (double y : {0.1, 1.3, 3.5})
    EXPECT_NEAR(amplification(midpoint, y / 7, 7), 1, 1e-9) << y;
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
       {"symplectic-euler", "verlet", "pefrl", "srkn11b", "rk4"}) {
    const MethodEntry& m = *find_method(name);
    auto method = m.make();
    const double dt = m.info.limit / omega;
    const double right = std::log(amplification(*method, 1.1 * dt, omega));
    // In the later half the other waves are small beside it.
    const auto late = [&](double step, int every) {
      return (growth(p, m, step, 200, every) - growth(p, m, step, 99, every)) /
             101;
    };
    EXPECT_NEAR(late(1.1 * dt, 1), right, 0.02 * right) << name;
    EXPECT_NEAR(late(1.1 * dt, 3), right, 0.02 * right) << name;
    EXPECT_LT(late(0.98 * dt, 1), 0.005) << name;
  }
}

TEST(Growth, IsInfiniteWhereNothingIsFinite) {
  const Problem p = stretched_sheet(5, MeshSprings::diagonals, 1.5, 1);
  EXPECT_EQ(growth(p, table::rk4, 1e200, 4), no_limit);
  EXPECT_EQ(growth(p, table::verlet, 1, 100, 5, 2), no_limit);
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
