#pragma once
/** @file Resonance.hpp
 * Finds the steps of r-RESPA that resonate with its stiff springs. */
#include <string>

#include "lab/methods/StiffSplit.hpp"

namespace lab {

/** Half the trace of the matrix of a step of r-RESPA, for x'' = -(omega^2 +
 * soft^2) x, where omega [1/s] is the frequency of the stiff spring:
 *   c = cos(a) - dt soft^2/(2 omega') sin(a),
 * with a = 2 inner asin(y), omega' = omega sqrt(1 - y^2), y = dt omega/(2
 * inner), since the inner steps are Verlet's. The step is stable if |c| < 1.
 * @param dt [s]   @param inner number of inner steps   @pre y < 1 */
struct HalfTrace {
  double phase;  ///< a
  double value;  ///< c
  HalfTrace(double omega, double soft, double dt, int inner);
};

/** The steps of r-RESPA that resonate with stiff springs. Springs that share no
 * node have one frequency each, so there are gaps between their resonances.
 * Connected springs have bands of frequencies, which change as the cloth moves:
 * all steps from their first resonance on count as resonant. Theory: README.md.
 */
class Resonances {
 public:
  /** @param split not empty
   * @param soft a bound of the frequencies of the soft springs [1/s]:
   *        omega_safe() of soft_stiffness() */
  Resonances(StiffSplit split, double soft);

  /** True if steps of @a dt [s] may resonate. If not, and dt soft < 2, they are
   * stable by linear theory; beyond first(), large motion may still resonate.
   */
  bool at(double dt) const;
  /** The shortest step that resonates [s]. */
  double first() const { return first_; }
  /** A step up to @a dt [s] that does not resonate, in few digits: the longest
   * one in a gap or, if there is none, at most 0.6 first().
   * Complexity: at most 100 dt omega calls of at() */
  double below(double dt) const;
  /** How @a dt [s] compares with the periods of the stiff springs, in words. */
  std::string text(double dt) const;

 private:
  StiffSplit split_;
  double soft_, first_;
};

}  // namespace lab
