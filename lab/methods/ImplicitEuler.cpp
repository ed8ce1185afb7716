#include "lab/methods/ImplicitEuler.hpp"

#include "lab/fast/GraphArrays.hpp"

namespace lab {

double ImplicitEuler::step(Cloth& g, double t, double dt,
                           const ForcePlan& force,
                           const ConstraintPlan& constraint) {
  stage_.begin(info.name, t, dt, g, constraint);
  stage_.hold(g, t + dt, constraint);
  stage_.solve_linearized(g, t + dt, dt, force);
  auto node = arrays(g).node_values();
  for (unsigned i = 0; i < arrays(g).node_slots(); ++i)
    node[i].vel = stage_.w[i];
  return implicit_detail::finish(g, t + dt, constraint);
}

}  // namespace lab
