#include "lab/methods/TrBdf2.hpp"

#include "lab/fast/GraphArrays.hpp"

namespace lab {

double TrBdf2::step(Cloth& g, double t, double dt, const ForcePlan& force,
                    const ConstraintPlan& constraint) {
  constexpr double root = 1.4142135623730951;
  constexpr double gamma = 2 - root, beyond = (root - 1) / 2;
  const double s = gamma / 2 * dt;  // the same in both stages
  stage_.begin(info.name, t, dt, g, constraint);
  auto x = arrays(g).positions();
  auto node = arrays(g).node_values();
  const unsigned n = arrays(g).node_slots();
  x0_.assign(x.begin(), x.end());
  flow_.accelerate(g, t, force, false);
  a0_.resize(n);
  for (unsigned i = 0; i < n; ++i) {
    a0_[i] = stage_.fixed(i) ? Point() : flow_.acceleration(i);
    stage_.p[i] = x[i] + s * node[i].vel;
    stage_.q[i] = node[i].vel + s * a0_[i];
    stage_.w[i] = stage_.guess[i] = stage_.q[i] + s * a0_[i];
  }
  stage_.hold(g, t + gamma * dt, constraint);
  // The local error, as an acceleration: k dt^2 |a''| (Bank et al.).
  constexpr double k = (3 * gamma * gamma - 4 * gamma + 2) / (12 * (2 - gamma));
  stage_.solve_newton(g, t + gamma * dt, s, force, {k / (gamma * gamma), true});
  for (unsigned i = 0; i < n; ++i) {
    const Point a = (stage_.w[i] - stage_.q[i]) / s;
    stage_.p[i] = x[i] + beyond * (x[i] - x0_[i]);
    stage_.q[i] = stage_.w[i] + beyond * (stage_.w[i] - node[i].vel);
    stage_.guess[i] = stage_.q[i] + s * (a0_[i] + (a - a0_[i]) / gamma);
    stage_.w[i] = stage_.guess[i];
  }
  stage_.hold(g, t + dt, constraint);
  stage_.solve_newton(g, t + dt, s, force, {2 * k / (1 - gamma)});
  for (unsigned i = 0; i < n; ++i) node[i].vel = stage_.w[i];
  return implicit_detail::finish(g, t + dt, constraint);
}

}  // namespace lab
