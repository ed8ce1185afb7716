#include "lab/stability/EnergyWatch.hpp"

#include <algorithm>
#include <cmath>

#include "lab/stability/StepControl.hpp"

namespace lab {

EnergyWatch::EnergyWatch(const Energies& start, double dt,
                         const DivergenceGuard& guard)
    : dt_(dt),
      start_(start.total()),
      floor_(guard.floor()),
      round_off_(guard.round_off()),
      largest_(start.internal()),
      fall_(2 * start.fall_power * dt) {}

void EnergyWatch::look(const Energies& e) {
  off_ = e.total() - start_;
  largest_ = std::max(largest_, e.internal());
  fall_ = std::max(fall_, 2 * e.fall_power * dt_);
  sum_ += off_;
  gain_ = std::max(gain_, off_ - least_);
  if (++looks_ % round != 0) return;
  least_ = std::min(least_, sum_ / round);
  sum_ = 0;
}

double EnergyWatch::share() const {
  return largest_ > round_off_ ? off_ / largest_ : 0;
}

double EnergyWatch::tolerance() const {
  return energy_tolerance * largest_ + fall_ + floor_;
}

void EnergyWatch::archive(Archive& a) {
  a(largest_)(fall_)(off_)(sum_)(least_)(gain_)(looks_);
  a.require(std::isfinite(largest_ + fall_ + off_ + sum_ + least_ + gain_) &&
            looks_ >= 0);
}

}  // namespace lab
