#pragma once
/** @file Stability.hpp
 * How long a step may be, and what happened when it was too long: the limits of
 * the methods, and DivergenceGuard. */
#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <string>
#include <vector>

#include "CME212/BoundingBox.hpp"
#include "CME212/Util.hpp"
#include "lab/methods/SymplecticEuler.hpp"
#include "lab/stability/Spectrum.hpp"

namespace lab {

// --------------------------------------------------------------------- Limits

/** The larger size of the eigenvalues of the matrix (a b; c d). */
inline double spectral_radius(double a, double b, double c, double d) {
  const double half = (a + d) / 2, det = a * d - b * c;
  const double root = half * half - det;
  return root > 0 ? std::abs(half) + std::sqrt(root) : std::sqrt(det);
}

/** By what factor a step of @a method makes an oscillator grow, x'' + gamma x'
 * + omega^2 x = 0, when it is repeated: the spectral radius of the step's
 * matrix. Found by stepping a mass on a spring of rest length 0, which is
 * exactly linear, from two states.
 * @param dt [s] > 0   @param omega [1/s] > 0   @param gamma [1/s] >= 0
 * Throws what the method throws. */
inline double amplification(Method& method, double dt, double omega,
                            double gamma = 0) {
  Cloth g;
  g.add_node(Point());
  Node mass = g.add_node(Point(1, 0, 0));
  g.add_edge(g.node(0), mass, {Real(omega * omega), 0});
  auto force = make_combined_force(MassSpringForce(), DampingForce(gamma));
  const std::array wall = {g.node(0)};
  PinConstraint pin(wall);
  auto image = [&](double x, double v) {  // of (x, v/omega)
    mass.position() = Point(x, 0, 0);
    mass.value().vel = Point(v * omega, 0, 0);
    method.restart();
    method.step(g, 0, dt, force, pin);
    return std::array<double, 2>{mass.position().x, mass.value().vel.x / omega};
  };
  const auto [xx, vx] = image(1, 0);
  const auto [xv, vv] = image(0, 1);
  return spectral_radius(xx, xv, vx, vv);
}

/** The largest step [s] with which @a method stays bounded on all frequencies
 * up to @a omega [1/s], with a drag of @a gamma = c/m [1/s]; no_limit if all
 * do. Without drag info.limit/omega. Drag that is treated exactly does not
 * lower that; drag as a force does: symplectic Euler needs (dt omega)^2 + 2 dt
 * gamma < 4, forward Euler dt < gamma/omega^2. So the limit is the smaller one
 * of that without drag and of what amplification() says with it. */
inline double step_limit(const MethodEntry& method, double omega,
                         double gamma = 0) {
  const MethodInfo& info = method.info;
  if (info.limit == no_limit || info.adaptive || !(omega > 0)) return no_limit;
  double high = (info.limit > 0 ? info.limit : 2) / omega;
  if (!(gamma > 0)) return info.limit > 0 ? high : 0;
  auto made = method.make();
  constexpr double round_off =
      std::max(1e-12, 10. * std::numeric_limits<Real>::epsilon());
  auto stable = [&](double dt) {
    return amplification(*made, dt, omega, gamma) <= 1 + round_off;
  };
  if (info.limit > 0 && stable(high * (1 - 1e-6))) return high;
  double low = 0;
  for (int k = 0; k < 50; ++k) {
    const double middle = (low + high) / 2;
    (stable(middle) ? low : high) = middle;
  }
  return low;
}

/** The largest c/m [1/s] of a cloth with drag @a c [kg/s]. */
inline double largest_gamma(const Cloth& g, double c) {
  double least = no_limit;
  for (Node n : g.nodes()) least = std::min<double>(least, n.value().mass);
  return c / least;
}

/** The share of a safe limit that `--dt auto` takes, and of a sharp one.
 *
 * The safe limit is that of a cloth swinging about any one shape. A cloth
 * without drag that is thrown about violently, springs passing through length
 * 0, also gains energy from changing its shape near the limit: of 1,000 random
 * scenes by Verlet none at 0.8 of it, and of every method none at 0.6
 * (SafeStep.NeverDivergesInRandomScenes). A cloth let go at rest, as the
 * assignment's, can do with 1. The sharp share also covers what SharpOmega
 * misses. */
inline constexpr double safe_share = 0.6, sharp_share = 0.9;

}  // namespace lab
