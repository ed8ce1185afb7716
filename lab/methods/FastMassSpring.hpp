#pragma once
/** @file FastMassSpring.hpp
 * Fast mass-spring: implicit Euler, solved in a fixed number of rounds with a
 * matrix that is factored once. */
#include <cassert>
#include <vector>

#include "lab/methods/ImplicitStage.hpp"
#include "lab/methods/LaplacianFactor.hpp"

namespace lab {

/** Implicit Euler, M (v1 - v0) = dt (F(x0 + dt v1) - c v1), in n rounds of a
 * local and a global step. The local step turns a vector d of length L into the
 * direction of each spring; the global step minimizes
 *   (v1 - v0) M (v1 - v0)/2 + dt c v1 v1/2 + sum of K |x_i - x_j - d|^2/2,
 * whose matrix A = M + dt c + dt^2 L (LaplacianFactor) is the same in every
 * round. With the force at the present positions both are one line,
 *   v1 += f,   f = A^-1 (dt (F - c v1) - M (v1 - v0)):
 * Newton's method with the largest stiffness that each spring may have. So it
 * takes every force that knows its stiffness.
 *
 * Rounds converge linearly. Anderson's acceleration of depth 1 goes from the
 * last round and this one to where the line through both has the least |f|: on
 * a falling sheet of 100 N/m ten rounds of 1/60 s then end at a third of the
 * distance from implicit Euler. Linear momentum is conserved to round-off after
 * any number of rounds.
 * Source: T. Liu, A. Bargteil, J. O'Brien, L. Kavan, ACM Trans. Graph. 32
 * (2013) 214, doi:10.1145/2508363.2508406; Y. Peng et al., ACM Trans. Graph. 37
 * (2018) 42, doi:10.1145/3197517.3201290, here with a test of |f| in place of
 * one of the energy. */
class FastMassSpring : public Method {
 public:
  // Each force evaluation is followed by a solve with 20 to 60 nonzeros a node.
  static constexpr MethodInfo info = {
      "fast-mass-spring",
      1,
      10,
      no_limit,
      "Liu, Bargteil, O'Brien, Kavan 2013",
      "implicit-euler on soft cloth of many nodes, without its solves",
      "accuracy: damps as implicit-euler; very stiff: rounds fall short"};

  /** @param rounds n > 0 in each step   @param accelerated see above */
  explicit FastMassSpring(int rounds = info.sweeps, bool accelerated = true)
      : rounds_(rounds), accelerated_(accelerated) {
    assert(rounds > 0);
  }

  double step(Cloth& g, double t, double dt, const ForcePlan& force,
              const ConstraintPlan& constraint) override;
  Work work() const override { return {.newton = solves_}; }
  /** How often the matrix was factored since this method was made. */
  int factorizations() const { return factor_.factorizations(); }

 private:
  int rounds_;
  bool accelerated_;
  long long solves_ = 0;
  implicit_detail::ImplicitStage stage_{1, 0};
  LaplacianFactor factor_;
  std::vector<Point> last_f_, last_w_, change_;

  void accelerate(const std::vector<Point>& f, const std::vector<Point>& w);
};

}  // namespace lab
