#pragma once
/** @file TrBdf2.hpp
 * TR-BDF2: each step is a stage by the trapezoidal rule and one by BDF2. */
#include <vector>

#include "lab/methods/NewtonMethod.hpp"

namespace lab {

/** The trapezoidal rule up to t + gamma dt, then the backward differentiation
 * formula of order 2 over both parts, gamma = 2 - sqrt 2. L-stable: waves too
 * fast for dt are damped at once.
 * Source: R. E. Bank et al., IEEE Trans. Electron Devices 32 (1985) 1992,
 * doi:10.1109/T-ED.1985.22232. */
class TrBdf2 : public NewtonMethod {
 public:
  // Force evaluations if the force is linear: one at the start and two a stage.
  // On a cloth 6. In addition, each stage takes products with the matrix as in
  // ImplicitMidpoint; at large steps about a quarter of their number.
  static constexpr MethodInfo info = {
      "tr-bdf2",
      2,
      5,
      no_limit,
      "Bank et al. 1985",
      "stiff cloth that moves on large scales, at large dt",
      "energy that must not be lost; steps near verlet's limit"};

  using NewtonMethod::NewtonMethod;
  /** Stages are solved to a tenth of the local error. That raises the error of
   * a run by at most 1 %; 1e-9 m/s^2 would take 2 to 4 times the products. */
  TrBdf2() : NewtonMethod(Share{0.1}) {}

  double step(Cloth& g, double t, double dt, const ForcePlan& force,
              const ConstraintPlan& constraint) override;

 private:
  FlatFlow flow_;
  std::vector<Point> x0_, a0_;  // by node id
};

}  // namespace lab
