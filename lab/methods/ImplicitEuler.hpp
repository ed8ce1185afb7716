#pragma once
/** @file ImplicitEuler.hpp
 * Linearly implicit Euler: one linear system a step. */
#include "lab/methods/ImplicitStage.hpp"

namespace lab {

/** Linearly implicit Euler: v += dt F(x + dt v)/m with F linearized at x, then
 * x += dt v. One linear system a step, by conjugate gradients.
 * Source: D. Baraff, A. Witkin, "Large steps in cloth simulation", SIGGRAPH
 * 1998, doi:10.1145/280814.280821; here compressed springs have no stiffness
 * in the perpendicular directions. */
class ImplicitEuler : public Method {
 public:
  // In addition to the force evaluation: about dt omega products with the
  // matrix, each as expensive as one.
  static constexpr MethodInfo info = {
      "implicit-euler",
      1,
      1,
      no_limit,
      "Baraff, Witkin 1998",
      "stiff cloth that comes to rest, at any dt",
      "accurate motion: it damps as a drag of dt omega^2 would"};

  /** @param tolerance > 0, of the linear system: see
   *        ImplicitStep::solve_linearized() */
  explicit ImplicitEuler(double tolerance = 1e-8) : stage_(tolerance, 0) {}

  Work work() const override { return stage_.work(); }
  void use(implicit_detail::LinearSolver solver) { stage_.use(solver); }

  double step(Cloth& g, double t, double dt, const ForcePlan& force,
              const ConstraintPlan& constraint) override;

 private:
  implicit_detail::ImplicitStage stage_;
};

}  // namespace lab
