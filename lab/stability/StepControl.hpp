#pragma once
/** @file StepControl.hpp
 * StepControl: how long the next steps are, by the energy balance measured. */
#include <limits>

#include "lab/stability/EnergyBalance.hpp"

namespace lab {

/** Chooses the step by what the last steps did to the energy.
 *
 * The balance b of EnergyBalance never rises in the cloth itself. A linear
 * limit does not tell when it rises by a method: a lattice of springs has
 * parametric resonances below it (that of Verlet is strongest at 0.71 of it),
 * and their growth shows after some 1000 steps only. So b is watched, in rounds
 * of some steps:
 * - a round that gains more than half of what is left of the tolerance, or a
 *   gain that uses it up faster than the run goes on, is taken back, with the
 *   one before, in which it may have begun; on it goes by a shorter step.
 * - a longer one is tried while drag takes away what a step may give: after
 *   each 1/(4 gamma) of time, gamma the drag measured, beyond any limit known.
 *   Without drag a step goes back to where it started at most. A step that
 *   failed is not tried again soon.
 * What is gained is measured by the largest internal energy until then. Drag
 * takes a gain as it takes all motion, by e^{-gamma t}: so with drag both are
 * leaky, and the scale is the largest kinetic energy that is left, as the
 * elastic energy of a cloth at rest is not motion. A loose cloth in free fall
 * may gain what it falls in two steps besides: speeds of methods of order 1 are
 * half a step early.
 *
 * The energy of an oscillation by a symplectic method swings within a round, by
 * O((dt omega)^2) of it: so a gain is from the least of one round to the least
 * of the next. For methods that lose energy only gains count. Changes are rare,
 * so that symplectic methods keep their virtue. */
class StepControl {
 public:
  static constexpr int look_interval = 16;  ///< steps between two looks
  static constexpr int round = 8;           ///< looks

  /** All that it knows, as plain numbers: energies in J, times in s. */
  struct State {
    double dt = 0, ceiling = 0;  ///< the step, and the longest one for now
    double scale = 0;            ///< what a gain is measured by
    double fall = 0;             ///< the most of a loose cloth in two steps
    double last = 0, least = 0;  ///< b: now, and the least mean of a round
    double base = 0, low = 0;    ///< b: the least of the last round, of this
    double mark = 0, sum = 0;    ///< b: when dt changed; of this round's looks
    double gain = 0;             ///< the most that b was above least; leaky
    double time = 0, kinetic_time = 0;  ///< since dt changed; kinetic energy's
                                        ///< integral [J s]
    double drag = 0;                    ///< loss until dt changed
    double lost = 0, kinetic = 0, fall_power = 0;  ///< at the last look
    int looks = 0;                                 ///< in this round
    int rounds = 0, calm = 0;   ///< of the run, since dt changed
    int since = 0, raises = 0;  ///< rounds since a failure, a raise; raises of
                                ///< the ceiling since a failure
    void archive(Archive& a);
  };
  /** What was chosen. */
  struct Report {
    double shortest, longest;           ///< [s]
    int shortened = 0, lengthened = 0;  ///< times
    long long taken_back = 0;           ///< steps
  };

  struct Limits {
    double share = energy_tolerance;  ///< of the scale: what may be gained
    double floor = 0;  ///< an energy that is next to nothing [J]:
                       ///< DivergenceGuard::floor()
    double rest = 0;   ///< that of a cloth at rest, by round-off [J]
    double longest = std::numeric_limits<double>::infinity();  ///< step [s]
    bool early = true;  ///< speeds are half a step early: order 1
  };
  /** @param dt the first step [s]   @param start energy at the start
   * @param flow into it until then */
  StepControl(double dt, const Energies& start, const Limits& limits,
              const EnergyFlow& flow = {});

  double dt() const { return now_.dt; }
  const State& state() const { return now_; }
  const Report& report() const { return report_; }
  /** The most that the run may gain until now [J]. */
  double tolerance() const { return tolerance(now_, now_.looks); }

  enum class Verdict {
    go_on,
    keep,      ///< the end of a good round: the state is one to go back to
    take_back  ///< call take_back()
  };
  /** Judge the state after @a h [s] more. At the shortest step all is good.
   * @param part of the run that is done, of [0, 1] */
  Verdict look(const Energies& e, const EnergyFlow& flow, double h,
               double part);
  /** False if the step is as short as it gets. */
  bool can_shorten() const { return now_.dt > shortest_; }
  /** To the state @a then, @a steps before, and on by a shorter step. */
  void take_back(const State& then, long long steps);
  /** Before a step: is it time for a longer one?  @return true if dt changed */
  bool lengthen(const EnergyFlow& flow);

  /** Save or load all that changes. */
  void archive(Archive& a);

 private:
  double first_, shortest_;  // steps [s]
  Limits limits_;
  State now_;
  Report report_;
  int failures_ = 0;

  void forget(State& s, const Energies& e, const EnergyFlow& flow);
  double tolerance(const State& s, int looks) const;
  void start_round();
  void change(double dt, double drag);
};

}  // namespace lab
