#pragma once
/** @file Xpbd.hpp
 * Extended position-based dynamics: each spring in turn projects its two ends
 * towards its rest length. */
#include <cassert>
#include <cmath>
#include <memory>
#include <span>
#include <vector>

#include "lab/fast/FlatFlow.hpp"
#include "lab/methods/Method.hpp"

namespace lab {

/** Extended position-based dynamics in n substeps of h = dt/n, each with one
 * round over the springs (Gauss-Seidel, in the order of the edges' ids):
 *   v += h F/m;  v *= e^(-c h/m);  x += h v;
 *   each spring of compliance 1/K:  x_i += w_i d n,  x_j -= w_j d n,
 *     d = (l - L)/(w_i + w_j + 1/(K h^2)),  w = 1/m, n from i to j;
 *   v = (x - x before)/h.
 * F is all forces but springs and drag, evaluated at the start of each step.
 * Held nodes have w = 0. For one spring this is implicit Euler. Linear momentum
 * is conserved to round-off; angular momentum is not.
 *
 * The springs are the cloth's edges. So the force must consist of one
 * MassSpringForce or OneWaySprings, whose slack springs project nothing, and of
 * others without stiffness; or it has no stiffness at all, and then there are
 * no springs. Any other force is rejected.
 * Source: M. Macklin, M. Mueller, N. Chentanez, "XPBD", MIG 2016,
 * doi:10.1145/2994258.2994272; M. Macklin et al., "Small steps in physics
 * simulation", SCA 2019, doi:10.1145/3309486.3340247. */
class Xpbd : public Method {
 public:
  // In addition to the force evaluation: one of the springs, to subtract them,
  // and n rounds, each as expensive as 3.5 to 4 evaluations.
  static constexpr MethodInfo info = {
      .name = "xpbd",
      .family = "implicit",
      .color = "#00858A",
      .order = 1,
      .sweeps = 1,
      .limit = no_limit,
      .cost = {50.5, 50.9},
      .first_steps = {0.5, 1, 2, 0.5, 1},
      .source = "Macklin et al. 2016, 2019",
      .good_for = "plausible motion; nearly rigid springs, K to infinity",
      .fails_when = "accuracy; few substeps: one round is no solution"};

  /** @param substeps n > 0 in each step */
  explicit Xpbd(int substeps = 10) : substeps_(substeps) {
    assert(substeps > 0);
  }

  double step(Cloth& g, double t, double dt, const ForcePlan& force,
              const ConstraintPlan& constraint) override;
  Work work() const override { return {.inner = rounds_}; }
  /** By the multipliers d: d/h^2 along n in each substep. It is not K (l - L):
   * one round does not solve the equations. */
  std::span<const Point> pulls() const override { return pulls_; }
  void archive(Archive& a, const Cloth& /*g*/) override {
    a(pulls_);
    for (const Point& p : pulls_) a.require(std::isfinite(norm(p)));
  }

 private:
  int substeps_;
  long long rounds_ = 0;
  FlatFlow flow_;
  ForcePlan springs_ = MassSpringForce();  // recognised: may be temporary
  std::shared_ptr<const OneWaySprings> one_way_;  // in their place; or null
  std::vector<char> fixed_;  // by node id, as all that follows
  std::vector<Point> free_, acceleration_;
  std::vector<Point> pulls_;  // by edge id

  void accelerate(Cloth& g, double t, const ForcePlan& force, bool springs);
  void pull_together(Cloth& g, double h);
};

}  // namespace lab
