#include "lab/methods/SymplecticEuler.hpp"

namespace lab {

int SymplecticEuler::steps(Cloth& g, const StepTimes& times, int count,
                           const ForcePlan& force,
                           const ConstraintPlan& constraint) {
  const double h = times.dt;
  stages_.clear();
  for (int k = 0; k < count; ++k)
    stages_.push_back({.t = times(k),
                       .drift = h,
                       .project = &constraint,
                       .kick = h,
                       .last = &constraint});
  flow_.begin(g, force, false);
  const auto done = flow_.run(stages_);
  flow_.end();
  return int(done);
}

}  // namespace lab
