#include "lab/methods/ImplicitEuler.hpp"

#include "lab/fast/GraphArrays.hpp"

namespace lab {

double ImplicitEuler::step(Cloth& g, double t, double dt,
                           const ForcePlan& force,
                           const ConstraintPlan& constraint) {
  auto& stage = stage_.begin(info.name, t, dt, g, force, constraint);
  stage.solve_linearized(t + dt, dt);
  auto node = arrays(g).node_values();
  for (unsigned i = 0; i < arrays(g).node_slots(); ++i)
    node[i].vel = stage.w[i];
  return implicit_detail::finish(g, t + dt, constraint);
}

}  // namespace lab
