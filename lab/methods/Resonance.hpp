#pragma once
/** @file Resonance.hpp
 * Which steps of r-RESPA resonate with its stiff springs. */
#include <string>

#include "lab/methods/StiffSplit.hpp"

namespace lab {

/** Half the trace of a step of r-RESPA of @a dt [s], with @a inner steps, on
 * x'' = -(omega^2 + soft^2) x, of which omega^2 is the stiff spring's [1/s^2]:
 *   c = cos(a) - dt soft^2/(2 omega') sin(a),
 * with a = 2 inner asin(y), omega' = omega sqrt(1 - y^2), y = dt omega/(2
 * inner), as the inner steps are Verlet's. The step is stable if |c| < 1.
 * @pre y < 1 */
struct HalfTrace {
  double phase;  ///< a
  double value;  ///< c
  HalfTrace(double omega, double soft, double dt, int inner);
};

/** The steps of r-RESPA that resonate with stiff springs. Springs that share no
 * node have a frequency each, so there are gaps between their resonances.
 * Connected ones have bands that move as the cloth does: all steps from their
 * first resonance on count as resonant. README.md of this room has the theory.
 */
class Resonances {
 public:
  /** @param split not empty
   * @param soft no frequency of the soft springs is higher [1/s]: that of
   *        soft_stiffness() */
  Resonances(StiffSplit split, double soft);

  /** Whether steps of @a dt [s] may resonate. If not, and dt soft < 2, they are
   * stable by linear theory; beyond first() large motion may change that. */
  bool at(double dt) const;
  /** No shorter step resonates [s]. */
  double first() const { return first_; }
  /** The step up to @a dt [s] to use: the longest one in a gap, a number of few
   * digits; if there is none up to 0.6 of first().
   * Complexity: 100 dt omega calls of at(), at most */
  double below(double dt) const;
  /** @a dt [s] in periods of the stiff springs, in words. */
  std::string text(double dt) const;

 private:
  StiffSplit split_;
  double soft_, first_;
};

}  // namespace lab
