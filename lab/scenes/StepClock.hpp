#pragma once
/** @file StepClock.hpp
 * StepClock: the number of steps done and the time reached. */
#include <cmath>

#include "lab/methods/Method.hpp"

namespace lab {

/** Counts steps. The time is from + (steps - from_steps) dt: in a sum of steps
 * rounding errors would add up. */
struct StepClock {
  double dt = 0, from = 0;              ///< step; time of the last change [s]
  long long steps = 0, from_steps = 0;  ///< done now; done then

  StepTimes times() const { return {from, dt, steps - from_steps}; }
  double time() const { return times()(0); }
  void set_time(double t) { from = t, from_steps = steps; }
  void set_dt(double next) {
    set_time(time());
    dt = next;
  }
  void archive(Archive& a) {
    a(dt)(from)(steps)(from_steps);
    a.require(dt > 0 && std::isfinite(dt) && from >= 0 && 0 <= from_steps &&
              from_steps <= steps && steps < 1LL << 53 &&
              std::isfinite(time()));
  }
};

}  // namespace lab
