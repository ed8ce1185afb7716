#include "lab/methods/SymplecticEuler.hpp"

#include "lab/methods/Flow.hpp"

namespace lab {

double SymplecticEuler::step(Cloth& g, double t, double dt,
                             const ForcePlan& force,
                             const ConstraintPlan& constraint) {
  move_and_sweep(
      sweep_, g, t, force, constraint,
      [&](const Part& part) { drift(g, part, dt, 0); },
      [&](const Part& part, std::span<const Point> f) {
        kick(g, part, dt, f);
      });
  constraint.set_held_velocities(g, t);
  return t + dt;
}

}  // namespace lab
