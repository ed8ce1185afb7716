#pragma once
/** @file Spectrum.hpp
 * The highest frequency omega [1/s] of a cloth: omega^2 is the largest
 * eigenvalue of M^-1 H, M the masses, H the stiffness of all springs, without
 * the nodes that are held. It bounds the step of every explicit method
 * (StepLimit.hpp). Three estimates; the proofs are in README.md of this room.
 *
 * A force that does not know its stiffness (SweptForce::add_stiffness) is taken
 * to have that of the cloth's edges. Where nothing can oscillate (no springs,
 * no free node), omega is 0. */
#include <algorithm>
#include <vector>

#include "lab/fast/ConstraintPlan.hpp"
#include "lab/fast/ForcePlan.hpp"

namespace lab {

namespace spectrum_detail {

struct Spring {  // between the nodes of ids i and j
  unsigned i, j;
  Stiffness B;
  /** No direction is stiffer [N/m]. */
  double K() const { return std::max({0.0, B.along, B.across}); }
};

void find_springs(const Cloth& g, const ForcePlan& force,
                  std::vector<Spring>& springs);

/** m^(-1/2) [kg^(-1/2)] by node id; 0 for nodes that do not move. */
void find_scales(const Cloth& g, const ConstraintPlan& constraint,
                 std::vector<double>& scale);

}  // namespace spectrum_detail

/** The safe estimate: no frequency of the cloth exceeds it, in any
 * configuration, also after any removal of nodes and edges. omega^2 is the
 * largest eigenvalue of the mass-scaled Laplacian, (L x)_i = sum of K (x_i -
 * x_j) over the springs at i: the stiffness of MassSpringForce is nowhere above
 * K. It stays valid while masses and K do not change and no held node is let
 * go.
 * @return omega [1/s] to 0.1 %, from above: the Lanczos value plus its error
 * Complexity: O(N + springs) for each of 20 to 200 products. */
double omega_safe(const Cloth& g, const ForcePlan& force,
                  const ConstraintPlan& constraint);

/** The sharp estimate: the highest frequency in the present configuration. It
 * rises when springs are stretched, up to omega_safe(). 15 products find it to
 * 2 %, from below; 60 to a thousandth and better.
 * Complexity: each product costs one to two force evaluations. Keeps its
 * memory. */
class SharpOmega {
 public:
  double operator()(const Cloth& g, const ForcePlan& force,
                    const ConstraintPlan& constraint, int products = 15);

 private:
  std::vector<spectrum_detail::Spring> springs_;
  std::vector<double> scale_;
};

/** The cheap estimate: never below the highest frequency in the present
 * configuration, and up to a third above. By Gershgorin's circles for blocks:
 * (a - b) B (a - b) <= 2 a B a + 2 b B b, so omega^2 is at most the largest
 * eigenvalue of 2 sum B/m over the springs at any one node; a spring to a held
 * node counts once. Negative stiffness counts as 0. The stability map scales
 * its start by it.
 * Complexity: O(N + springs), two or three force evaluations. */
double omega_gershgorin(const Cloth& g, const ForcePlan& force,
                        const ConstraintPlan& constraint);

}  // namespace lab
