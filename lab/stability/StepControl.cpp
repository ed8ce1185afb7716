#include "lab/stability/StepControl.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace lab {

namespace {
constexpr double none = std::numeric_limits<double>::infinity();
constexpr double shorter = 0.7, longer = 1.15;
constexpr double noise = 0.05;    // of the tolerance: no reason to shorten
constexpr double seen = 0.8;      // of it: the rest is for steps between looks
constexpr int most_failures = 6;  // that count
constexpr double at_rest = 1e-6;  // of the largest energy of motion: none
}  // namespace

StepControl::StepControl(double dt, const Energies& start, const Limits& limits,
                         const EnergyFlow& flow)
    : first_(dt), shortest_(dt / 64), limits_(limits), report_{dt, dt} {
  now_.scale = start.internal(), now_.fall = 2 * start.fall_power * dt;
  now_.last = now_.least = balance(start, flow);
  now_.dt = dt, now_.ceiling = now_.low = none;
  now_.base = now_.mark = now_.last;
  now_.drag = now_.lost = flow.drag, now_.kinetic = start.kinetic;
  now_.fall_power = start.fall_power;
}

void StepControl::State::archive(Archive& a) {
  for (double* x : {&scale, &fall, &last, &least, &sum, &gain})
    a(*x).require(std::isfinite(*x));
  a(looks).require(0 <= looks && looks < round);
  for (double* x : {&dt, &ceiling, &base, &low, &mark, &time, &kinetic_time,
                    &drag, &lost, &kinetic, &fall_power})
    // Bounds that are not set yet are infinite.
    a(*x).require(std::isfinite(*x) ||
                  (*x == none && (x == &ceiling || x == &low)));
  a(rounds)(calm)(since)(raises);
  constexpr int most = 1 << 30;  // so that none overflows
  a.require(dt > 0 && 0 <= rounds && rounds < most && 0 <= calm &&
            calm < most && 0 <= since && since < most && 0 <= raises &&
            raises < most);
}

void StepControl::archive(Archive& a) {
  auto& [shortest, longest, shortened, lengthened, taken_back] = report_;
  a(now_)(shortest)(longest)(shortened)(lengthened)(taken_back)(failures_);
  a(limits_.rest);
  a.require(shortest_ <= now_.dt && 0 < shortest && shortest <= longest &&
            std::isfinite(longest) && 0 <= shortened && 0 <= lengthened &&
            0 <= taken_back && 0 <= failures_ && failures_ <= most_failures &&
            std::isfinite(limits_.rest));
}

StepControl::Verdict StepControl::look(const Energies& e,
                                       const EnergyFlow& flow, double h,
                                       double part) {
  State s = now_;
  const double b = balance(e, flow);
  s.low = std::min(s.low, b);
  forget(s, e, flow);
  s.time += h, s.kinetic_time += e.kinetic * h;
  const double most = tolerance(s, s.looks + 1);
  const double least_noise = noise * most;
  const double left = most - (s.base - s.least);
  const bool bursts = s.low - s.base > std::max(0.5 * left, least_noise);
  const bool creeps =
      s.low - s.least > s.fall + (0.3 + 0.4 * part) * (most - s.fall) &&
      s.low - s.mark > least_noise;
  const bool beyond = b - s.least > seen * most && b - s.mark > least_noise;
  const bool good = std::isfinite(b) && !bursts && !creeps && !beyond;
  if (!good && can_shorten()) return Verdict::take_back;
  if (!std::isfinite(b)) return Verdict::go_on;  // the guard ends it
  s.last = b, s.sum += b;
  s.gain = std::max(s.gain, b - s.least);
  now_ = s;
  if (++now_.looks < round) return Verdict::go_on;
  now_.least = std::min(s.least, s.sum / round);
  now_.looks = 0, now_.sum = 0;
  now_.base = std::exchange(now_.low, none);
  ++now_.rounds, ++now_.calm, ++now_.since;
  return Verdict::keep;
}

/** Update scale and fall by @a e; older energies decay with drag. */
void StepControl::forget(State& s, const Energies& e, const EnergyFlow& flow) {
  const double lost = flow.drag - s.lost, twice_mean = s.kinetic + e.kinetic;
  const double more_fall = std::abs(e.fall_power - s.fall_power) * s.dt;
  s.lost = flow.drag, s.kinetic = e.kinetic, s.fall_power = e.fall_power;
  if (!(lost > 0 && twice_mean > 0)) {
    s.scale = std::max(s.scale, e.internal());
    s.fall = std::max(s.fall, 2 * e.fall_power * s.dt);
    return;
  }
  limits_.rest = std::max(limits_.rest, at_rest * e.internal());
  // Drag takes 2 gamma of kinetic energy, half of that of an oscillation.
  const double left = std::exp(-lost / twice_mean);
  s.scale =
      std::max({left * s.scale, std::min(s.scale, limits_.rest), e.relative});
  s.fall = limits_.early
               ? std::max(left * s.fall + more_fall, 2 * e.fall_power * s.dt)
               : 0;
  // In each step contact lifts a resting cloth back to the surface.
  if (flow.loose) s.fall = std::max(s.fall, 4 * limits_.floor);
  s.gain *= left;
  s.least += (1 - left) * std::max(0.0, s.base - s.least);
}

double StepControl::tolerance(const State& s, int looks) const {
  const double most = limits_.share * s.scale + s.fall;
  if (s.rounds > 0) return most;
  // In a fall from rest, speed grows up to a step before height falls.
  return most + 2 * look_interval * looks * limits_.floor;
}

void StepControl::take_back(const State& then, long long steps) {
  const double failed = now_.dt;
  const bool again = failures_ > 0 && now_.since == 0 && now_.raises == 0;
  now_ = then;
  now_.looks = 0, now_.sum = 0, now_.low = none;
  change(std::max(shortest_, shorter * failed), then.drag);
  now_.ceiling = 0.95 * failed;
  now_.raises = now_.since = 0;
  if (!again) failures_ = std::min(failures_ + 1, most_failures);
  ++report_.shortened;
  report_.taken_back += steps;
}

bool StepControl::lengthen(const EnergyFlow& flow) {
  if (now_.looks > 0 || now_.calm == 0) return false;
  // gamma = loss/(2 integral of kinetic energy)
  const double lost = flow.drag - now_.drag;
  const bool damped =
      lost > 0 && now_.time * lost >= 0.25 * 2 * now_.kinetic_time;
  // After each failure wait longer before the ceiling rises; each raise without
  // a failure is larger.
  const int patience = 4 << failures_;
  if (failures_ > 0 && now_.since >= patience) {
    now_.ceiling *= std::pow(1.05, 1 << std::min(now_.raises, 3));
    ++now_.raises;
    if (!damped) now_.since = 0;
  }
  const double most = damped ? std::min(now_.ceiling, limits_.longest)
                      : now_.calm >= 2 * patience
                          ? std::min(first_, now_.ceiling)
                          : 0;
  const double factor = damped && failures_ == 0 ? longer * longer : longer;
  const double next = std::min(factor * now_.dt, most);
  if (!(next > 1.02 * now_.dt)) return false;
  change(next, flow.drag);
  ++report_.lengthened;
  return true;
}

void StepControl::change(double dt, double drag) {
  now_.dt = dt;
  now_.base = now_.mark = now_.last;  // another step, another energy
  now_.time = now_.kinetic_time = 0, now_.drag = drag;
  now_.calm = 0;
  report_.shortest = std::min(report_.shortest, dt);
  report_.longest = std::max(report_.longest, dt);
}

}  // namespace lab
