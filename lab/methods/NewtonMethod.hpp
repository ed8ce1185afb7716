#pragma once
/** @file NewtonMethod.hpp
 * The base of ImplicitMidpoint and TrBdf2. */
#include "lab/methods/ImplicitStage.hpp"

namespace lab {

/** The base of the methods that solve the nonlinear equations of motion by
 * Newton's method. The force without drag must be minus the gradient of its
 * energy().
 *
 * A step in which the cloth folds many times may need more than max_iterations:
 * a sheet of 50 x 50 nodes with random velocities of 1 m/s fails in steps of
 * 0.2 s (170 times verlet's limit); one of K = 10000 N/m fails in steps of
 * 0.02 s by the midpoint rule. Shorter steps succeed. */
class NewtonMethod : public Method {
 public:
  /** @param tolerance [m/s^2] > 0, of each stage: the residual acts like an
   *        acceleration of that size, see ImplicitStep::solve_newton()
   * @param max_iterations of Newton's method in a stage; then StepError */
  explicit NewtonMethod(double tolerance = 1e-9, int max_iterations = 100)
      : stage_(tolerance, max_iterations) {}

  Work work() const override { return stage_.work(); }
  void use(implicit_detail::LinearSolver solver) { stage_.use(solver); }

 protected:
  /** For a method that estimates its local error.
   * @param share the residual of a stage, as a share of that error */
  struct Share {
    double share;
  };
  explicit NewtonMethod(Share s) : stage_(1e-9, 100, s.share) {}

  implicit_detail::ImplicitStage stage_;
};

}  // namespace lab
