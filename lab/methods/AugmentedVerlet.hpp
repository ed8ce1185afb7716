#pragma once
/** @file AugmentedVerlet.hpp
 * Mass-augmented Verlet: explicit, with one prefactored system a step. */
#include <cstddef>
#include <optional>
#include <vector>

#include "lab/methods/FlatFlow.hpp"
#include "lab/methods/Method.hpp"
#include "lab/methods/SparseCholesky.hpp"

namespace lab {

/** Verlet with the mass M + (dt^2/4) L in place of M, where
 *   (L x)_i = sum over the springs at i of K (x_i - x_j).
 * No spring is stiffer than K in any direction, so no frequency reaches 2/dt in
 * any configuration: the linearized method is stable with every dt. (A cloth
 * that buckles may still gain energy at large dt, unless drag removes it.)
 * Springs of rest length 0 oscillate as by the implicit midpoint rule. Linear
 * momentum is conserved to round-off, and so is the angular momentum of the
 * augmented mass, sum x_i x (M v + dt^2/4 L v)_i. Drag as in Splitting, by the
 * true mass.
 *
 * The N x N matrix of the nodes that are not held is the same for x, y and z.
 * Its Cholesky factor is kept until dt, a mass, a spring's K or ends, or the
 * held nodes change.
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
  void restart() override { kept_for_ = nullptr, source_.cloth = nullptr; }
  void archive(Archive& a, const Cloth& g) override;

  /** How often the matrix was factored since this method was made. */
  int factorizations() const { return factorizations_; }

 private:
  /** All that the factor depends on. */
  struct Key {
    double dt = 0;
    std::vector<char> fixed;   // by node id
    std::vector<double> mass;  // [kg], by node id
    struct Spring {
      unsigned i, j;
      double K;
      bool operator==(const Spring&) const = default;
    };
    std::vector<Spring> springs;
    bool operator==(const Key&) const = default;
  };
  Key key_, next_;
  /** The cloth that key_ was made from, if only edges are springs. */
  struct Source {
    std::optional<int> springs;  // nullopt: other forces have springs, too
    const Cloth* cloth = nullptr;
    std::size_t version = 0;
    std::vector<unsigned> held;  // their ids, in the constraint's order
    std::vector<double> K;       // [N/m], by edge id
  };
  Source source_;
  std::vector<unsigned> held_;
  int factorizations_ = 0;
  SparseCholesky<double> factor_;
  FlatFlow flow_;                    // its accelerations: the solution
  std::vector<Point> acceleration_;  // the same by node id [m/s^2]
  const Cloth* kept_for_ = nullptr;  // the cloth to which they belong
  double kept_time_ = 0;
  double loaded_dt_ = 0;  // > 0: they were loaded, computed with this dt

  bool unchanged(const Cloth& g, double dt, const ForcePlan& force,
                 const ConstraintPlan& constraint);
  bool find_factor(const Cloth& g, double dt, const ForcePlan& force,
                   const ConstraintPlan& constraint);
  void factorize();
  void accelerate(double t);
};

}  // namespace lab
