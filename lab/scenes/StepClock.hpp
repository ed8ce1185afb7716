#pragma once
/** @file StepClock.hpp
 * StepClock: how many steps are done, and what time they reached. */
#include <cmath>

#include "lab/methods/Method.hpp"

namespace lab {

/** Counts steps. A time is a multiple of dt since dt last changed: a sum of
 * steps would depend on rounding. */
struct StepClock {
  double dt = 0, from = 0;              ///< step, and when dt last changed [s]
  long long steps = 0, from_steps = 0;  ///< done now, and then

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
