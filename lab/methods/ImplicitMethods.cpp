#include "lab/methods/ImplicitMethods.hpp"

#include "lab/fast/GraphArrays.hpp"

namespace lab {

double ImplicitEuler::step(Cloth& g, double t, double dt,
                           const ForcePlan& force,
                           const ConstraintPlan& constraint) {
  auto& stage = stage_.begin(info.name, t, dt, g, force, constraint);
  stage.solve_linearized(t + dt, dt);
  return stage.finish();
}

double ImplicitMidpoint::step(Cloth& g, double t, double dt,
                              const ForcePlan& force,
                              const ConstraintPlan& constraint) {
  auto& stage = stage_.begin(info.name, t, dt, g, force, constraint);
  stage.solve_newton(t + dt / 2, dt / 2);
  stage.move(dt);
  for (unsigned i = 0; i < stage.w.size(); ++i)
    if (!stage.fixed(i)) stage.w[i] = 2 * stage.w[i] - stage.q[i];
  return stage.finish();
}

double TrBdf2::step(Cloth& g, double t, double dt, const ForcePlan& force,
                    const ConstraintPlan& constraint) {
  constexpr double root = 1.4142135623730951;
  constexpr double gamma = 2 - root, beyond = (root - 1) / 2;
  const double s = gamma / 2 * dt;  // the same in both stages
  auto& stage = stage_.begin(info.name, t, dt, g, force, constraint);
  auto x = arrays(g).positions();
  auto node = arrays(g).node_values();
  const unsigned n = arrays(g).node_slots();
  x0_.assign(x.begin(), x.end());
  flow_.accelerate(g, t, force, false);
  a0_.resize(n);
  for (unsigned i = 0; i < n; ++i) {
    a0_[i] = stage.fixed(i) ? Point() : flow_.acceleration(i);
    stage.p[i] = x[i] + s * node[i].vel;
    stage.q[i] = node[i].vel + s * a0_[i];
    stage.w[i] = stage.guess[i] = stage.q[i] + s * a0_[i];
  }
  // The local error, as an acceleration: k dt^2 |a''| (Bank et al.).
  constexpr double k = (3 * gamma * gamma - 4 * gamma + 2) / (12 * (2 - gamma));
  stage.solve_newton(t + gamma * dt, s, {k / (gamma * gamma), true});
  for (unsigned i = 0; i < n; ++i) {
    const Point a = (stage.w[i] - stage.q[i]) / s;
    stage.p[i] = x[i] + beyond * (x[i] - x0_[i]);
    stage.q[i] = stage.w[i] + beyond * (stage.w[i] - node[i].vel);
    stage.guess[i] = stage.q[i] + s * (a0_[i] + (a - a0_[i]) / gamma);
    stage.w[i] = stage.guess[i];
  }
  stage.solve_newton(t + dt, s, {2 * k / (1 - gamma)});
  return stage.finish();
}

}  // namespace lab
