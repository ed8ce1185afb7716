#pragma once
/** @file StiffSplit.hpp
 * Which springs of a cloth a multirate method takes in short steps. */
#include <algorithm>
#include <cmath>
#include <vector>

#include "lab/fast/ConstraintPlan.hpp"
#include "lab/fast/ForcePlan.hpp"
#include "lab/methods/Verlet.hpp"

namespace lab {

/** How many inner steps a multirate method makes in the time that Verlet needs
 * for one at its limit: its frequencies are then right to 1 %. */
inline constexpr int inner_steps_at_limit = 4;

/** The stiff springs of a cloth: few, and so fast that it is cheaper to
 * evaluate them often, and all springs seldom. Empty if there are none. */
struct StiffSplit {
  struct Spring {
    unsigned edge;  ///< its id
    unsigned i, j;  ///< its ends, as indices of nodes
  };
  std::vector<Spring> springs;
  std::vector<unsigned> nodes;  ///< the ids of all ends, ascending
  double omega = 0;  ///< no frequency of the stiff springs is higher [1/s]
  /** The same of those that share a free node with another one; 0: none do. */
  double connected = 0;
  /** The frequencies of the others, each once: omega_e, whatever the
   * configuration [1/s]. */
  std::vector<double> alone;

  bool empty() const { return springs.empty(); }
  /** The longest inner step [s], and how many a step of @a dt has. */
  double inner_step() const {
    return Verlet::info.limit / inner_steps_at_limit / omega;
  }
  int inner_steps(double dt) const {
    return std::max(1, int(std::ceil(dt / inner_step())));
  }
};

/** Split the springs of @a g, each of which is @a multiplicity times in the
 * force: stiff are those of frequency omega_e^2 = K (1/m_i + 1/m_j) above a
 * bound, 1/m of held nodes being 0. Of all bounds 2^k it is the one with the
 * least work per time,
 *   (highest soft omega_e) (all springs)
 *     + (highest omega_e) (inner steps) (stiff springs),
 * if that is at most half of that of Verlet.
 * @post omega^2 = the largest S_i/m_i + S_j/m_j of a stiff spring, S the sum of
 *       K of the stiff ones at a node: Gershgorin's bound of their matrix
 * Complexity: O(nodes + edges) */
StiffSplit split_springs(const Cloth& g, int multiplicity,
                         const ConstraintPlan& constraint);

/** What bounds the step of a multirate method: a plan with the stiffness of
 * @a force but for the springs that split_springs() takes out. No force; made
 * for omega_safe() and its like. @a g and what @a force refers to must outlive
 * it, and the edges of @a g stay. */
ForcePlan soft_stiffness(const Cloth& g, const ForcePlan& force,
                         const ConstraintPlan& constraint);

}  // namespace lab
