#pragma once
/** @file NewtonMethod.hpp
 * The base of ImplicitMidpoint and TrBdf2. */
#include "lab/methods/ImplicitStage.hpp"

namespace lab {

/** The base of the methods that solve the nonlinear equations of motion by
 * Newton's method. The force, drag aside, must be minus the gradient of its
 * energy().
 *
 * A step that folds the cloth many times over may need more iterations than
 * there are: a sheet of 50 x 50 nodes, stirred by 1 m/s at random, can't make
 * steps of 0.2 s (170 times verlet's limit), one of K = 10000 N/m none of
 * 0.02 s by the midpoint rule. A shorter step can be made. */
class NewtonMethod : public Method {
 public:
  /** @param tolerance [m/s^2] > 0, of each stage: what is left over does as an
   *        acceleration of that size would, see ImplicitStage::solve_newton()
   * @param max_iterations of Newton in each stage; then StepError
   * @param line_search false to measure its effect */
  explicit NewtonMethod(double tolerance = 1e-9, int max_iterations = 100,
                        bool line_search = true)
      : stage_(tolerance, max_iterations, line_search) {}

  Work work() const override { return stage_.work(); }
  void use(implicit_detail::LinearSolver solver) { stage_.use(solver); }

 protected:
  /** Of a method that tells its local error.
   * @param share of it that each stage may leave over */
  struct Share {
    double share;
  };
  explicit NewtonMethod(Share s) : stage_(1e-9, 100, true, s.share) {}

  implicit_detail::ImplicitStage stage_;
};

}  // namespace lab
