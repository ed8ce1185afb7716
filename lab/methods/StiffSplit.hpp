#pragma once
/** @file StiffSplit.hpp
 * Finds the stiff springs, which a multirate method takes in short steps. */
#include <algorithm>
#include <cmath>
#include <vector>

#include "lab/fast/ConstraintPlan.hpp"
#include "lab/fast/ForcePlan.hpp"
#include "lab/methods/Verlet.hpp"

namespace lab {

/** Inner steps of a multirate method during one step of Verlet at its limit:
 * frequencies are then accurate to 1 %. */
inline constexpr int inner_steps_at_limit = 4;

/** The stiff springs of a cloth: so few and so fast that it is cheaper to
 * evaluate them often and the others seldom. Empty if there are none. */
struct StiffSplit {
  struct Spring {
    unsigned edge;  ///< its id
    unsigned i, j;  ///< its ends, as indices of nodes
  };
  std::vector<Spring> springs;
  std::vector<unsigned> nodes;  ///< the ids of all ends, ascending
  double omega = 0;  ///< a bound of the frequencies of stiff springs [1/s]
  /** The same for those that share a free node with another; 0: none do. */
  double connected = 0;
  /** The frequencies omega_e of the other stiff springs, each once [1/s]. They
   * do not depend on the configuration. */
  std::vector<double> alone;

  bool empty() const { return springs.empty(); }
  /** The longest inner step [s], and their number in a step of @a dt. */
  double inner_step() const {
    return Verlet::info.limit / inner_steps_at_limit / omega;
  }
  int inner_steps(double dt) const {
    return std::max(1, int(std::ceil(dt / inner_step())));
  }
};

/** Split the springs of @a g, each of which is in the force @a multiplicity
 * times. A spring is stiff if omega_e^2 = K (1/m_i + 1/m_j) is above a bound,
 * with 1/m = 0 for held nodes. Of all bounds 2^k the one with the least work
 * per time is taken, (highest soft omega_e) (all springs)
 *     + (highest omega_e) (inner steps) (stiff springs),
 * if that is at most half of Verlet's work. Otherwise no spring is stiff.
 * @post omega^2 = the largest S_i/m_i + S_j/m_j of a stiff spring, S the sum of
 *       K of the stiff ones at a node: Gershgorin's bound of their matrix
 * Complexity: O(nodes + edges) */
StiffSplit split_springs(const Cloth& g, int multiplicity,
                         const ConstraintPlan& constraint);

/** The stiffness of @a force without the springs that split_springs() finds: it
 * bounds the step of a multirate method. A plan for omega_safe() and
 * SharpOmega, not for forces. @a g and what @a force refers to must outlive it,
 * and the edges of @a g must stay. */
ForcePlan soft_stiffness(const Cloth& g, const ForcePlan& force,
                         const ConstraintPlan& constraint);

}  // namespace lab
