#include "lab/methods/Splitting.hpp"

#include <array>
#include <cmath>
#include <vector>

#include "lab/fast/GraphArrays.hpp"
#include "methods.hpp"

namespace lab {

const std::array<double, 9> PefrlScheme::steps = pefrl_parts;
const std::array<double, 23> Srkn11bScheme::steps = srkn11b_parts;

template <typename Scheme>
int Splitting<Scheme>::steps(Cloth& g, const StepTimes& times, int count,
                             const ForcePlan& force,
                             const ConstraintPlan& constraint) {
  stages_.clear();
  bool has = kept(g, times(0), times.dt);
  const std::size_t before = Scheme::kicks_first && !has;
  for (int k = 0; k < count; ++k, has = Scheme::kicks_first)
    add_step(times(k), times.dt, has, constraint);
  restart();  // if anything throws
  flow_.begin(g, force, true);
  const auto done = (flow_.run(stages_) - before) / stages_a_step;
  flow_.end();
  if (Scheme::kicks_first)
    kept_for_ = &g, kept_version_ = arrays(g).version(),
    kept_time_ = times(int(done) - 1) + times.dt;
  return int(done);
}

/** Add the stages of a step.  @param kept whether the accelerations at its
 * start are kept; otherwise one more stage computes them */
template <typename Scheme>
void Splitting<Scheme>::add_step(double t, double dt, bool kept,
                                 const ConstraintPlan& constraint) {
  constexpr auto& steps = Scheme::steps;
  double first_kick = Scheme::kicks_first ? steps[0] * dt : 0;
  if (Scheme::kicks_first && !kept) {
    stages_.push_back({.t = t, .kick = first_kick});
    first_kick = 0;
  }
  double now = t;
  for (std::size_t k = first_drift; k < steps.size(); k += 2) {
    const bool is_last = k + 2 >= steps.size();
    now = is_last ? t + dt : now + steps[k] * dt;
    stages_.push_back({.t = now,
                       .first_kick = first_kick,
                       .drift = steps[k] * dt,
                       .held = &constraint,
                       .project = is_last ? &constraint : nullptr,
                       .keep = Scheme::kicks_first && is_last,
                       .last = is_last ? &constraint : nullptr});
    if (k + 1 < steps.size()) stages_.back().kick = steps[k + 1] * dt;
    first_kick = 0;
  }
}

template <typename Scheme>
bool Splitting<Scheme>::kept(const Cloth& g, double t, double dt) const {
  // Equal up to round-off: a caller may add up its times or multiply them.
  return kept_for_ == &g && kept_version_ == arrays(g).version() &&
         std::abs(t - kept_time_) < 1e-6 * dt;
}

template <typename Scheme>
void Splitting<Scheme>::archive(Archive& a, const Cloth& g) {
  bool has = kept_for_ == &g && kept_version_ == arrays(g).version();
  a(has);
  if (!has) return restart();
  flow_.archive_kept(a, g);
  a(kept_time_);
  kept_for_ = &g, kept_version_ = arrays(g).version();
}

template class Splitting<VerletScheme>;
template class Splitting<PefrlScheme>;
template class Splitting<Srkn11bScheme>;

}  // namespace lab
