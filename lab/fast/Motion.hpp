#pragma once
/** @file Motion.hpp
 * Motion: how obstacles and held nodes move. */
#include <algorithm>
#include <limits>

#include "CME212/Point.hpp"

namespace lab {

/** Motion at constant velocity until a time. */
struct Motion {
  Point velocity;  ///< [m/s], from t = 0 on
  /** The time at which it stops [s], >= 0. */
  double until = std::numeric_limits<double>::infinity();

  /** Displacement [m] at time @a t [s]. Also for @a t < 0, where the first step
   * of some methods evaluates it. */
  Point way(double t) const { return std::min(t, until) * velocity; }
  /** [m/s]; 0 after it has stopped */
  Point velocity_at(double t) const { return t < until ? velocity : Point(); }
  bool operator==(const Motion&) const = default;
};

}  // namespace lab
