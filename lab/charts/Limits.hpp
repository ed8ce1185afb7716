#pragma once
/** @file Limits.hpp
 * The largest stable step of a method on a cloth: predicted from the
 * frequencies that the cloth has along its way, and measured by trying. */
#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "lab/charts/Problem.hpp"

namespace lab {

/** The assignment's cloth of side x side nodes with drag c = 1/N. */
inline Problem cloth_for_limits(unsigned side, Mesh mesh, double t_end) {
  Problem p = grid_problem(std::to_string(side), "", t_end, side);
  p.build = [side, mesh](Cloth& g) {
    build_cloth(g, grid_points(side), grid_quads(side), mesh);
  };
  return p;
}

/** The highest frequency of a cloth along its way. */
struct Path {
  double dt = 0;              ///< between two looks at it [s]
  std::vector<double> omega;  ///< [1/s]
  double gamma = 0;           ///< largest c/m [1/s]
  double safe = 0;            ///< omega_safe() [1/s]
  /** The highest of them all. */
  double top() const {
    return omega.empty() ? 0 : *std::max_element(omega.begin(), omega.end());
  }
};

/** The path of @a p, by Verlet at 0.8 of its limit, looked at every 4 steps.
 * Complexity: t_end omega_safe/1.6 steps, each as 10 force sweeps. */
inline Path find_path(const Problem& p) {
  Start s(p);
  Path path;
  path.safe = omega_safe(s.cloth, s.force, s.constraint);
  path.gamma = largest_gamma(s.cloth, s.force.drag());
  const double dt = 0.8 * Verlet::info.limit / path.safe;
  path.dt = 4 * dt;
  Verlet verlet;
  SharpOmega sharp;
  const auto steps = static_cast<long long>(std::ceil(p.t_end / dt));
  for (long long n = 1; n <= steps; ++n) {
    verlet.step(s.cloth, double(n - 1) * dt, dt, s.force, s.constraint);
    if (n % 4 == 0)
      path.omega.push_back(sharp(s.cloth, s.force, s.constraint, 20));
  }
  return path;
}

/** The largest step [s] with which @a method should stay bounded along a path.
 * A step beyond limit/omega blows up only if omega stays that high for long
 * enough: the fastest wave has to grow from round-off to the size of the cloth.
 * So this is the step where its growth in a row reaches @a growth: the product
 * of amplification() over the steps, from wherever it is highest. For a path of
 * one omega and no end it is step_limit().
 * @pre method.info.limit is finite and > 0 */
inline double predicted_limit(const MethodEntry& method, const Path& path,
                              double growth = 1e8) {
  const double limit = method.info.limit, top = path.top();
  // ln amplification per step against dt omega/limit, from 0.9 to 1.7
  constexpr int cells = 400;
  constexpr double first = 0.9, width = 0.8 / cells;
  std::array<double, cells + 1> rate;
  auto made = method.make();
  for (int k = 0; k <= cells; ++k)
    rate[std::size_t(k)] = std::log(amplification(
        *made, limit * (first + width * k), 1, path.gamma / path.safe));
  auto rate_at = [&](double y) {
    const double cell = std::clamp((y - first) / width, 0.0, cells - 1e-9);
    const auto k = static_cast<std::size_t>(cell);
    return rate[k] + (cell - double(k)) * (rate[k + 1] - rate[k]);
  };
  auto blows_up = [&](double dt) {
    double sum = 0;
    for (double omega : path.omega) {
      sum += path.dt / dt * rate_at(dt * omega / limit);
      sum = std::max(0.0, sum);
      if (sum > std::log(growth)) return true;
    }
    return false;
  };
  // Upwards, as a method may be stable again beyond: PEFRL is.
  double dt = 0.9 * limit / top;
  while (dt < 1.6 * limit / top && !blows_up(dt)) dt *= 1.001;
  return dt;
}

/** True if @a p run by @a method with steps of @a dt [s] stays bounded: nothing
 * gives energy to the cloth, so it never rises by more than a thousandth of
 * M g 1 m above the lowest so far. That also sees an instability which never
 * blows up, as the cloth's own stiffening stops it. By a method of order 1 the
 * energy swings by more than that: there it is 2 %. */
inline bool stays_bounded(const Problem& p, const MethodEntry& method,
                          double dt) {
  Start s(p);
  auto energy = [&] {
    return kinetic_energy(s.cloth) + s.force.energy(s.cloth);
  };
  const double share = method.info.order > 1 ? 0.001 : 0.02;
  const double most_gain = share * total_mass(s.cloth) * p.gravity;  // [J]
  double lowest = energy();
  auto made = method.make();
  const auto steps = static_cast<long long>(std::ceil(p.t_end / dt));
  for (long long n = 0; n < steps; ++n) {
    made->step(s.cloth, double(n) * dt, dt, s.force, s.constraint);
    if (n % 8 != 7 && n + 1 != steps) continue;
    const double now = energy();
    if (!(now <= lowest + most_gain)) return false;
    lowest = std::min(lowest, now);
  }
  return true;
}

/** The largest step that is @a good, by halving the interval from @a low, which
 * is, to @a high, which is not, until it is @a precision of itself.
 * @param good as bool(double) */
template <typename Good>
double largest_that(Good&& good, double low, double high, double precision) {
  while (high - low > precision * low) {
    const double middle = (low + high) / 2;
    (good(middle) ? low : high) = middle;
  }
  return low;
}

/** The largest step [s] with which @a p stays bounded, between @a low and
 * @a high. */
inline double measured_limit(const Problem& p, const MethodEntry& method,
                             double low, double high, double precision = 0.01) {
  return largest_that([&](double dt) { return stays_bounded(p, method, dt); },
                      low, high, precision);
}

}  // namespace lab
