#include "lab/methods/ImplicitMidpoint.hpp"

#include "lab/fast/GraphArrays.hpp"

namespace lab {

double ImplicitMidpoint::step(Cloth& g, double t, double dt,
                              const ForcePlan& force,
                              const ConstraintPlan& constraint) {
  stage_.begin(info.name, t, dt, g, constraint);
  stage_.hold(g, t + dt / 2, constraint);
  stage_.solve_newton(g, t + dt / 2, dt / 2, force);
  auto x = arrays(g).positions();
  auto node = arrays(g).node_values();
  for (unsigned i = 0; i < arrays(g).node_slots(); ++i) {
    if (stage_.fixed(i)) continue;
    x[i] = stage_.p[i] + dt * stage_.w[i];
    node[i].vel = 2 * stage_.w[i] - stage_.q[i];
  }
  return implicit_detail::finish(g, t + dt, constraint);
}

}  // namespace lab
