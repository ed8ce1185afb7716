#include "lab/methods/ImplicitMidpoint.hpp"

#include "lab/fast/GraphArrays.hpp"

namespace lab {

double ImplicitMidpoint::step(Cloth& g, double t, double dt,
                              const ForcePlan& force,
                              const ConstraintPlan& constraint) {
  auto& stage = stage_.begin(info.name, t, dt, g, force, constraint);
  stage.solve_newton(t + dt / 2, dt / 2);
  auto x = arrays(g).positions();
  auto node = arrays(g).node_values();
  for (unsigned i = 0; i < arrays(g).node_slots(); ++i) {
    if (stage.fixed(i)) continue;
    x[i] = stage.p[i] + dt * stage.w[i];
    node[i].vel = 2 * stage.w[i] - stage.q[i];
  }
  return implicit_detail::finish(g, t + dt, constraint);
}

}  // namespace lab
