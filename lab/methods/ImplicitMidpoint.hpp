#pragma once
/** @file ImplicitMidpoint.hpp
 * The implicit midpoint rule. */
#include "lab/methods/NewtonMethod.hpp"

namespace lab {

/** v1 = v0 + dt F(x, v)/m, x1 = x0 + dt v, at x = (x0 + x1)/2 and v = (v0 +
 * v1)/2. Symmetric and symplectic; linear and angular momentum are kept.
 * Source: E. Hairer, C. Lubich, G. Wanner, Geometric Numerical Integration,
 * II.1.3. */
class ImplicitMidpoint : public NewtonMethod {
 public:
  // Force evaluations of a linear force. Any other takes one more for each
  // further Newton iteration: on a cloth 4 to 6 in all, and more when it
  // buckles. Each iteration takes about dt omega products with the matrix,
  // each at the cost of one evaluation.
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
