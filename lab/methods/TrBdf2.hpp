#pragma once
/** @file TrBdf2.hpp
 * The trapezoidal rule and BDF2, in turn. */
#include <vector>

#include "lab/methods/NewtonMethod.hpp"

namespace lab {

/** The trapezoidal rule up to t + gamma dt, then the backward differentiation
 * formula of order 2 over both parts, gamma = 2 - sqrt 2. L-stable: what is
 * too fast for dt dies out at once.
 * Source: R. E. Bank et al., IEEE Trans. Electron Devices 32 (1985) 1992. */
class TrBdf2 : public NewtonMethod {
 public:
  // The sweeps are those of a linear force: one at the start and two a stage.
  // On a cloth 9 to 12; besides, as ImplicitMidpoint in each stage.
  static constexpr MethodInfo info = {
      "tr-bdf2",
      2,
      5,
      no_limit,
      "Bank et al. 1985",
      "stiff cloth that moves on large scales, at large dt",
      "energy must not be lost; verlet's limit is not far"};

  using NewtonMethod::NewtonMethod;

  double step(Cloth& g, double t, double dt, const ForcePlan& force,
              const ConstraintPlan& constraint) override {
    constexpr double root = 1.4142135623730951;
    constexpr double gamma = 2 - root, beyond = (root - 1) / 2;
    const double s = gamma / 2 * dt;  // the same in both stages
    stage_.begin(info.name, dt, g, constraint);
    auto x = g.positions();
    auto node = g.node_values();
    const unsigned n = g.node_slots();
    x0_.assign(x.begin(), x.end());
    sweep_(g, t, force, force_);
    for (unsigned i = 0; i < n; ++i) {
      if (stage_.fixed(i)) force_[i] = Point();
      stage_.p[i] = x[i] + s * node[i].vel;
      stage_.q[i] = node[i].vel + (s / node[i].mass) * force_[i];
    }
    stage_.solve_newton(g, t + gamma * dt, s, force);
    for (unsigned i = 0; i < n; ++i) {
      stage_.p[i] = x[i] + beyond * (x[i] - x0_[i]);
      stage_.q[i] = stage_.w[i] + beyond * (stage_.w[i] - node[i].vel);
    }
    stage_.solve_newton(g, t + dt, s, force);
    for (unsigned i = 0; i < n; ++i) node[i].vel = stage_.w[i];
    return implicit_detail::finish(g, t + dt, constraint);
  }

 private:
  Sweep sweep_;
  std::vector<Point> x0_, force_;  // by node id
};

}  // namespace lab
