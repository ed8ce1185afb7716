#pragma once
/** @file Motion.hpp
 * Motion: how obstacles and held nodes move. */
#include <algorithm>
#include <cmath>
#include <limits>

#include "CME212/Point.hpp"

namespace lab {

/** Motion at constant velocity, and for pins also a turn, until a time. */
struct Motion {
  Point velocity;  ///< [m/s], from t = 0 on
  /** The time at which it stops [s], >= 0. */
  double until = std::numeric_limits<double>::infinity();
  Point turn = Point();   ///< angular velocity [rad/s] ...
  Point about = Point();  ///< about an axis that starts through this point [m]

  /** Displacement [m] at time @a t [s]. Also for @a t < 0, where the first step
   * of some methods evaluates it. */
  Point way(double t) const { return std::min(t, until) * velocity; }
  /** [m/s]; 0 after it has stopped */
  Point velocity_at(double t) const { return t < until ? velocity : Point(); }
  /** Where a point is at time @a t [s] that starts at @a start [m]. */
  Point place_of(const Point& start, double t) const {
    const double speed = norm(turn);
    if (speed == 0) return start + way(t);
    // Rodrigues' rotation formula
    const Point axis = turn / speed, arm = start - about;
    const double angle = speed * std::min(t, until), c = std::cos(angle);
    return about + c * arm + std::sin(angle) * cross(axis, arm) +
           (1 - c) * dot(axis, arm) * axis + way(t);
  }
  /** Its velocity then [m/s]. */
  Point velocity_of(const Point& start, double t) const {
    if (!(t < until)) return Point();
    return velocity + cross(turn, place_of(start, t) - way(t) - about);
  }
  bool moves() const { return velocity != Point() || turn != Point(); }
  bool operator==(const Motion&) const = default;
};

}  // namespace lab
