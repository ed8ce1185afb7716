#pragma once
/** @file ImplicitMethods.hpp
 * The methods that solve the equation of ImplicitStage: linearly implicit
 * Euler, the implicit midpoint rule, TR-BDF2. */
#include <vector>

#include "lab/methods/ImplicitStage.hpp"

namespace lab {

/** The base of all methods here. For those that solve the nonlinear equations
 * of motion by Newton's method, the force without drag must be minus the
 * gradient of its energy().
 *
 * A step in which the cloth folds many times may need more than max_iterations:
 * a sheet of 50 x 50 nodes with random velocities of 1 m/s fails in steps of
 * 0.2 s (170 times verlet's limit); one of K = 10000 N/m fails in steps of
 * 0.02 s by the midpoint rule. Shorter steps succeed. */
class ImplicitMethod : public Method {
 public:
  /** @param tolerance > 0; of ImplicitEuler that of the linear system, see
   *        ImplicitStage::solve_linearized(); of the others [m/s^2], of each
   *        stage: the residual acts like an acceleration of that size, see
   *        ImplicitStage::solve_newton()
   * @param max_iterations of Newton's method in a stage; then StepError
   * @param share the residual of a stage, as a share of the local error, of a
   *        method that estimates that */
  explicit ImplicitMethod(double tolerance, int max_iterations = 100,
                          double share = 0)
      : stage_(tolerance, max_iterations, share) {}

  Work work() const override { return stage_.work(); }
  void use(implicit_detail::LinearSolver solver) { stage_.use(solver); }

 protected:
  implicit_detail::ImplicitStage stage_;
};

/** Linearly implicit Euler: v += dt F(x + dt v)/m with F linearized at x, then
 * x += dt v. One linear system a step, by conjugate gradients.
 * Source: D. Baraff, A. Witkin, "Large steps in cloth simulation", SIGGRAPH
 * 1998, doi:10.1145/280814.280821; here compressed springs have no stiffness
 * in the perpendicular directions. */
class ImplicitEuler : public ImplicitMethod {
 public:
  // In addition to the force evaluation: about dt omega products with the
  // matrix, each as expensive as one.
  static constexpr MethodInfo info = {
      .name = "implicit-euler",
      .family = "implicit",
      .color = "#5A2D0C",
      .order = 1,
      .sweeps = 1,
      .limit = no_limit,
      .cost = {43, 223},
      .first_steps = {0.2, 1, 2, 0.2, 0.8},
      .source = "Baraff, Witkin 1998",
      .good_for = "stiff cloth that comes to rest, at any dt",
      .fails_when = "accurate motion: it damps as a drag of dt omega^2 would"};

  using ImplicitMethod::ImplicitMethod;
  ImplicitEuler() : ImplicitMethod(1e-8) {}

  double step(Cloth& g, double t, double dt, const ForcePlan& force,
              const ConstraintPlan& constraint) override;
};

/** v1 = v0 + dt F(x, v)/m, x1 = x0 + dt v, at x = (x0 + x1)/2 and v = (v0 +
 * v1)/2. Symmetric and symplectic; conserves linear and angular momentum.
 * Source: E. Hairer, C. Lubich, G. Wanner, Geometric Numerical Integration,
 * II.1.3. */
class ImplicitMidpoint : public ImplicitMethod {
 public:
  // Force evaluations if the force is linear. Otherwise one more for each
  // further Newton iteration: 4 to 6 in all on a cloth, more when it buckles.
  // Each iteration takes about dt omega products with the matrix, each as
  // expensive as one evaluation.
  static constexpr MethodInfo info = {
      .name = "implicit-midpoint",
      .family = "implicit",
      .color = "#D1495B",
      .order = 2,
      .sweeps = 2,
      .limit = no_limit,
      .cost = {79.1, 231},
      .first_steps = {0.35, 0.5, 2, 0.35, 0.7},
      .source = "Hairer, Lubich, Wanner 2006, II.1.3",
      .good_for = "stiff springs that oscillate without loss, as in a chain",
      .fails_when = "buckling cloth at large dt: nothing damps the fast waves"};

  using ImplicitMethod::ImplicitMethod;
  ImplicitMidpoint() : ImplicitMethod(1e-9) {}

  double step(Cloth& g, double t, double dt, const ForcePlan& force,
              const ConstraintPlan& constraint) override;
};

/** The trapezoidal rule up to t + gamma dt, then the backward differentiation
 * formula of order 2 over both parts, gamma = 2 - sqrt 2. L-stable: waves too
 * fast for dt are damped at once.
 * Source: R. E. Bank et al., IEEE Trans. Electron Devices 32 (1985) 1992,
 * doi:10.1109/T-ED.1985.22232. */
class TrBdf2 : public ImplicitMethod {
 public:
  // Force evaluations if the force is linear: one at the start and two a stage.
  // On a cloth 6. In addition, each stage takes products with the matrix as in
  // ImplicitMidpoint; at large steps about a quarter of their number.
  static constexpr MethodInfo info = {
      .name = "tr-bdf2",
      .family = "implicit",
      .color = "#882255",
      .order = 2,
      .sweeps = 5,
      .limit = no_limit,
      .cost = {71.8, 134},
      .first_steps = {0.35, 0.5, 2, 0.35, 1},
      .source = "Bank et al. 1985",
      .good_for = "stiff cloth that moves on large scales, at large dt",
      .fails_when = "energy that must not be lost; steps near verlet's limit"};

  using ImplicitMethod::ImplicitMethod;
  /** Stages are solved to a tenth of the local error. That raises the error of
   * a run by at most 1 %; 1e-9 m/s^2 would take 2 to 4 times the products. */
  TrBdf2() : ImplicitMethod(1e-9, 100, 0.1) {}

  double step(Cloth& g, double t, double dt, const ForcePlan& force,
              const ConstraintPlan& constraint) override;

 private:
  FlatFlow flow_;
  std::vector<Point> x0_, a0_;  // by node id
};

}  // namespace lab
