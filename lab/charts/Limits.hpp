#pragma once
/** @file Limits.hpp
 * The largest stable step of a method on a cloth: predicted from the cloth's
 * frequencies during a run, and measured by bisection. */
#include <vector>

#include "lab/charts/Problem.hpp"

namespace lab {

/** The assignment's cloth of side x side nodes with drag c = 1/N. */
Problem cloth_for_limits(unsigned side, MeshSprings::Kind mesh, double t_end);

/** The highest frequency of a cloth during a run. */
struct Path {
  double dt = 0;              ///< between two values of omega [s]
  std::vector<double> omega;  ///< [1/s]
  double gamma = 0;           ///< largest c/m [1/s]
  double safe = 0;            ///< omega_safe() [1/s]
  /** The highest omega of the path. */
  double top() const;
};

/** The path of @a p by Verlet at 0.8 of its limit, sampled every 4 steps.
 * Complexity: t_end omega_safe/1.6 steps, each as 10 force evaluations. */
Path find_path(const Problem& p);

/** The largest step [s] with which @a method should be stable along a path.
 * A run with steps beyond limit/omega diverges only if omega stays that high
 * long enough: the fastest wave has to grow from round-off to the size of the
 * cloth. So this is the step for which the product of amplification() over
 * consecutive steps reaches @a growth in the worst part of the path. If omega
 * is constant and the path endless, it is step_limit().
 * @pre method.info.limit is finite and > 0 */
double predicted_limit(const MethodEntry& method, const Path& path,
                       double growth = 1e8);

/** True if @a p, run by @a method with steps of @a dt [s], is stable. Nothing
 * does work on the cloth, so the energy must not rise by more than 0.001 M g
 * (1 m) above its lowest value so far. That also detects an instability which
 * the stiffening of the cloth stops. With a method of order 1 the energy swings
 * more: there the bound is 0.02 M g (1 m). */
bool stays_bounded(const Problem& p, const MethodEntry& method, double dt);

/** The largest step that is @a good, by bisection between @a low, which is
 * good, and @a high, which is not, to a relative @a precision.
 * @param good as bool(double) */
template <typename Good>
double largest_that(Good&& good, double low, double high, double precision) {
  while (high - low > precision * low) {
    const double middle = (low + high) / 2;
    (good(middle) ? low : high) = middle;
  }
  return low;
}

/** The largest step [s] from @a low to @a high for which stays_bounded(). */
double measured_limit(const Problem& p, const MethodEntry& method, double low,
                      double high, double precision = 0.01);

}  // namespace lab
