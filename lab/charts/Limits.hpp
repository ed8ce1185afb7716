#pragma once
/** @file Limits.hpp
 * The largest stable step of a method on a cloth: predicted from the cloth's
 * frequencies during a run, and measured by bisection. */
#include <vector>

#include "lab/charts/Problem.hpp"

namespace lab {

/** The assignment's cloth of side x side nodes with drag c = 1/N. */
Problem cloth_for_limits(unsigned side, Mesh mesh, double t_end);

/** The highest frequency of a cloth during a run. */
struct Path {
  double dt = 0;              ///< between two values of omega [s]
  std::vector<double> omega;  ///< [1/s]
  double gamma = 0;           ///< largest c/m [1/s]
  double safe = 0;            ///< omega_safe() [1/s]
  /** The highest of them all. */
  double top() const;
};

/** The path of @a p by Verlet at 0.8 of its limit, sampled every 4 steps.
 * Complexity: t_end omega_safe/1.6 steps, each as 10 force evaluations. */
Path find_path(const Problem& p);

/** The largest step [s] with which @a method should stay bounded along a path.
 * A step beyond limit/omega blows up only if omega stays that high for long
 * enough: the fastest wave has to grow from round-off to the size of the cloth.
 * So this is the step where its growth in a row reaches @a growth: the product
 * of amplification() over the steps, from wherever it is highest. For a path of
 * one omega and no end it is step_limit().
 * @pre method.info.limit is finite and > 0 */
double predicted_limit(const MethodEntry& method, const Path& path,
                       double growth = 1e8);

/** True if @a p run by @a method with steps of @a dt [s] stays bounded: nothing
 * gives energy to the cloth, so it never rises by more than a thousandth of
 * M g 1 m above the lowest so far. That also sees an instability which never
 * blows up, as the cloth's own stiffening stops it. By a method of order 1 the
 * energy swings by more than that: there it is 2 %. */
bool stays_bounded(const Problem& p, const MethodEntry& method, double dt);

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
double measured_limit(const Problem& p, const MethodEntry& method, double low,
                      double high, double precision = 0.01);

}  // namespace lab
