#pragma once
/** @file AugmentedVerlet.hpp
 * Mass-augmented Verlet: explicit, with one prefactored system a step. */
#include <vector>

#include "lab/methods/FlatFlow.hpp"
#include "lab/methods/LaplacianFactor.hpp"
#include "lab/methods/Method.hpp"

namespace lab {

/** Verlet with the mass M + (dt^2/4) L in place of M, L as in LaplacianFactor.
 * So no frequency reaches 2/dt in any configuration: the linearized method is
 * stable with every dt. (A cloth that buckles may still gain energy at large
 * dt, unless drag removes it.)
 * Springs of rest length 0 oscillate as by the implicit midpoint rule. Linear
 * momentum is conserved to round-off, and so is the angular momentum of the
 * augmented mass, sum x_i x (M v + dt^2/4 L v)_i. Drag as in Splitting, by the
 * true mass.
 * Source: A. Stern, E. Grinspun, Multiscale Model. Simul. 7 (2009) 1779,
 * doi:10.1137/080732936. */
class AugmentedVerlet : public Method {
 public:
  // In addition to the force evaluation: one comparison of all springs with
  // those of the factor, and one solve with 20 to 60 nonzeros a node. A new
  // factor costs about as much as 40 steps at 1e4 nodes.
  static constexpr MethodInfo info = {
      "augmented-verlet",
      2,
      1,
      no_limit,
      "Stern, Grinspun 2009",
      "large N with some drag, at 10 times verlet's dt",
      "dt omega > 1 for waves that matter; 10 times the dt without drag"};

  double step(Cloth& g, double t, double dt, const ForcePlan& force,
              const ConstraintPlan& constraint) override;
  void restart() override { kept_for_ = nullptr, factor_.restart(); }
  void archive(Archive& a, const Cloth& g) override;

  /** How often the matrix was factored since this method was made. */
  int factorizations() const { return factor_.factorizations(); }

 private:
  LaplacianFactor factor_;
  double dt_ = 0;                    // of the last step [s]
  FlatFlow flow_;                    // its accelerations: the solution
  std::vector<Point> acceleration_;  // the same by node id [m/s^2]
  const Cloth* kept_for_ = nullptr;  // the cloth to which they belong
  double kept_time_ = 0;
  double loaded_dt_ = 0;  // > 0: they were loaded, computed with this dt

  void accelerate(double t);
};

}  // namespace lab
