#pragma once
/** @file Spectrum.hpp
 * The highest frequency omega [1/s] of a cloth: omega^2 is the largest
 * eigenvalue of M^-1 H, M the masses, H the stiffness of all springs, both of
 * the nodes that are not held. It bounds the step of every explicit method
 * (StepLimit.hpp). Two estimates; the proofs are in README.md beside this.
 *
 * A force without SweptForce::add_stiffness() is taken to have the stiffness of
 * the cloth's edges. Without springs or free nodes, omega is 0. */
#include <algorithm>
#include <vector>

#include "lab/fast/ConstraintPlan.hpp"
#include "lab/fast/ForcePlan.hpp"

namespace lab {

namespace spectrum_detail {

struct Spring {  // between the nodes of ids i and j
  unsigned i, j;
  Stiffness B;
  /** The stiffness in the stiffest direction [N/m]. */
  double K() const { return std::max({0.0, B.along, B.across}); }
};

void find_springs(const Cloth& g, const ForcePlan& force,
                  std::vector<Spring>& springs);

/** m^(-1/2) [kg^(-1/2)] by node id; 0 for held nodes. */
void find_scales(const Cloth& g, const ConstraintPlan& constraint,
                 std::vector<double>& scale);

}  // namespace spectrum_detail

/** The safe estimate: no frequency of the cloth exceeds it in any
 * configuration, even after nodes and edges are removed. It holds while masses
 * and K stay the same and no held node is released. omega^2 is the largest
 * eigenvalue of the mass-scaled Laplacian, (L x)_i = sum of K (x_i - x_j) over
 * the springs at i, because no direction of a spring is stiffer than K.
 * @return omega [1/s], up to 0.1 % too high: the Lanczos value plus its error
 * Complexity: O(N + springs) for each of 20 to 200 products. */
double omega_safe(const Cloth& g, const ForcePlan& force,
                  const ConstraintPlan& constraint);

/** The sharp estimate: the highest frequency in the present configuration. It
 * rises when springs are stretched, up to omega_safe(). The result is at most
 * 2 % too low after 15 products, 0.1 % after 60.
 * Complexity: each product costs one to two force evaluations. Later calls
 * reuse the memory of the first. */
class SharpOmega {
 public:
  double operator()(const Cloth& g, const ForcePlan& force,
                    const ConstraintPlan& constraint, int products = 15);

 private:
  std::vector<spectrum_detail::Spring> springs_;
  std::vector<double> scale_;
};

}  // namespace lab
