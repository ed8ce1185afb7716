#pragma once
/** @file ImplicitMidpoint.hpp
 * The implicit midpoint rule. */
#include "lab/methods/NewtonMethod.hpp"

namespace lab {

/** v1 = v0 + dt F(x, v)/m, x1 = x0 + dt v, at x = (x0 + x1)/2 and v = (v0 +
 * v1)/2. Symmetric and symplectic; conserves linear and angular momentum.
 * Source: E. Hairer, C. Lubich, G. Wanner, Geometric Numerical Integration,
 * II.1.3. */
class ImplicitMidpoint : public NewtonMethod {
 public:
  // Force evaluations if the force is linear. Otherwise one more for each
  // further Newton iteration: 4 to 6 in all on a cloth, more when it buckles.
  // Each iteration takes about dt omega products with the matrix, each as
  // expensive as one evaluation.
  static constexpr MethodInfo info = {
      "implicit-midpoint",
      2,
      2,
      no_limit,
      "Hairer, Lubich, Wanner 2006, II.1.3",
      "stiff springs that oscillate without loss, as in a chain",
      "buckling cloth at large dt: nothing damps the fast waves"};

  using NewtonMethod::NewtonMethod;

  double step(Cloth& g, double t, double dt, const ForcePlan& force,
              const ConstraintPlan& constraint) override;
};

}  // namespace lab
