#include "lab/methods/Splitting.hpp"

#include <array>
#include <cmath>
#include <vector>

#include "lab/fast/GraphArrays.hpp"
#include "methods.hpp"

namespace lab {

const std::array<double, 9> PefrlScheme::steps = pefrl_parts;
const std::array<double, 23> Srkn11bScheme::steps = srkn11b_parts;

int Splitting::steps(Cloth& g, const StepTimes& times, int count,
                     const ForcePlan& force, const ConstraintPlan& constraint) {
  stages_.clear();
  bool has = kept(g, times(0), times.dt);
  const std::size_t before = kicks_first_ && !has;
  for (int k = 0; k < count; ++k, has = kicks_first_)
    add_step(times(k), times.dt, has, constraint);
  restart();  // if anything throws
  flow_.begin(g, force, true);
  const std::size_t stages_a_step = (fractions_.size() - kicks_first_ + 1) / 2;
  const auto done = (flow_.run(stages_) - before) / stages_a_step;
  flow_.end();
  if (kicks_first_)
    kept_for_ = &g, kept_version_ = arrays(g).version(),
    kept_time_ = times(int(done) - 1) + times.dt;
  return int(done);
}

/** Add the stages of a step.  @param kept whether the accelerations at its
 * start are kept; otherwise one more stage computes them */
void Splitting::add_step(double t, double dt, bool kept,
                         const ConstraintPlan& constraint) {
  double first_kick = kicks_first_ ? fractions_[0] * dt : 0;
  if (kicks_first_ && !kept) {
    stages_.push_back({.t = t, .kick = first_kick});
    first_kick = 0;
  }
  double now = t;
  for (std::size_t k = kicks_first_; k < fractions_.size(); k += 2) {
    const bool is_last = k + 2 >= fractions_.size();
    now = is_last ? t + dt : now + fractions_[k] * dt;
    stages_.push_back({.t = now,
                       .first_kick = first_kick,
                       .drift = fractions_[k] * dt,
                       .held = &constraint,
                       .project = is_last ? &constraint : nullptr,
                       .keep = kicks_first_ && is_last,
                       .last = is_last ? &constraint : nullptr});
    if (k + 1 < fractions_.size()) stages_.back().kick = fractions_[k + 1] * dt;
    first_kick = 0;
  }
}

bool Splitting::kept(const Cloth& g, double t, double dt) const {
  // Equal up to round-off: a caller may add up its times or multiply them.
  return kept_for_ == &g && kept_version_ == arrays(g).version() &&
         std::abs(t - kept_time_) < 1e-6 * dt;
}

void Splitting::archive(Archive& a, const Cloth& g) {
  bool has = kept_for_ == &g && kept_version_ == arrays(g).version();
  a(has);
  if (!has) return restart();
  flow_.archive_kept(a, g);
  a(kept_time_);
  kept_for_ = &g, kept_version_ = arrays(g).version();
}

}  // namespace lab
