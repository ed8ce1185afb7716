#include "lab/methods/SymplecticEuler.hpp"

namespace lab {

int SymplecticEuler::steps(Cloth& g, const StepTimes& times, int count,
                           const ForcePlan& force,
                           const ConstraintPlan& constraint) {
  const auto version = g.version();
  const double h = times.dt;
  flow_.begin(g, force, false);
  int k = 0;
  do {
    const double t = times(k);
    flow_.run({.t = t, .drift = h, .project = &constraint, .kick = h});
    flow_.set_held_velocities(constraint, t);
  } while (++k < count && g.version() == version);
  flow_.end();
  return k;
}

}  // namespace lab
