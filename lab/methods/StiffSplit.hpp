#pragma once
/** @file StiffSplit.hpp
 * Finds the stiff springs, which a multirate method takes in short steps. */
#include <algorithm>
#include <vector>

#include "lab/fast/ConstraintPlan.hpp"
#include "lab/fast/ForcePlan.hpp"
#include "lab/methods/Splitting.hpp"

namespace lab {

/** Inner steps of a multirate method during one step of Verlet at its limit. */
inline constexpr int inner_steps_at_limit = 2;

/** What so many stiff springs cost in addition, in springs of a force
 * evaluation: the filter of a step, and an inner step. By instructions, on
 * sheets with 1 to 1,034 stiff springs, within a third. */
constexpr double cost_of_filter(double stiff) { return 360 + 27 * stiff; }
constexpr double cost_of_inner_step(double stiff) { return 50 + stiff; }

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

  bool empty() const { return springs.empty(); }
  /** The index of the node @a id in nodes; nodes.size() if it is not there. */
  unsigned find(unsigned id) const {
    const auto at = std::ranges::lower_bound(nodes, id);
    return unsigned((at != nodes.end() && *at == id ? at : nodes.end()) -
                    nodes.begin());
  }
  /** The longest inner step [s]. */
  double inner_step() const {
    return Verlet::info.limit / inner_steps_at_limit / omega;
  }
};

/** Split the springs of @a g, each of which is in the force @a multiplicity
 * times. A spring is stiff if omega_e^2 = K (1/m_i + 1/m_j) is above a bound,
 * with 1/m = 0 for held nodes. Of all bounds 2^k the one with the least work
 * per time is taken,
 *     (highest soft omega_e) (all springs + cost_of_filter(stiff springs))
 *   + (highest omega_e) inner_steps_at_limit cost_of_inner_step(stiff springs),
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
