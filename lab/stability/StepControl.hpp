#pragma once
/** @file StepControl.hpp
 * StepControl: chooses the step by the measured balance of the energy. */
#include <limits>

#include "lab/stability/EnergyBalance.hpp"

namespace lab {

/** Chooses the step by the change of the energy in the last steps.
 *
 * The exact motion never raises the balance b of EnergyBalance. A method may
 * raise it below its linear stability limit, too: a lattice of springs has
 * parametric resonances (Verlet's is strongest at 0.71 of the limit), which
 * need about 1000 steps to become visible. So b is judged in rounds of 8 looks:
 * - If b rises in a round by more than half of the remaining tolerance, or if
 *   the gain grows faster than in proportion to time, this round and the one
 *   before, where the gain may have begun, are taken back; the step shrinks.
 * - While drag removes energy, a longer step is tried after each 1/(4 gamma) of
 *   time, gamma the measured drag, even beyond known limits. Without drag the
 *   step grows at most to the first one. After each failure the control waits
 *   longer before it tries that step again.
 * The tolerance is a share of a scale: the largest internal energy so far. With
 * drag a gain decays by e^{-gamma t}, as all motion does. So with drag gain and
 * scale decay, and the scale is the largest remaining kinetic energy, because
 * even a cloth at rest has elastic energy. A loose cloth may in addition gain
 * the work of gravity in two steps, for as long as it falls: methods of order 1
 * have velocities that are half a step early.
 *
 * As b swings in a round, its least is compared with that of the round before.
 * Losses of energy are accepted. The step changes rarely,
 * since symplectic methods conserve energy well only while it is constant. */
class StepControl {
 public:
  static constexpr int look_interval = 16;  ///< steps between two looks
  /** Looks in a round. With a symplectic method the energy of an oscillation
   * swings by a share of O((dt omega)^2). So gains are measured from the least
   * of the initial b and of its means over all rounds. */
  static constexpr int round = 8;
  /** The measurements of the control: energies in J, times in s. */
  struct State {
    double scale = 0;            ///< largest internal energy; decays with drag
    double fall = 0;             ///< gravity's work in two steps, if loose
    double last = 0, least = 0;  ///< b: now, and its least mean over a round
    double sum = 0;              ///< of b over this round
    double gain = 0;             ///< largest b - least; decays with drag
    int looks = 0;               ///< in this round
    double dt = 0, ceiling = 0;  ///< the step, and its upper bound for now
    double base = 0, low = 0;    ///< b: least in the last round, in this
    double mark = 0;             ///< b: when dt changed
    double time = 0, kinetic_time = 0;  ///< since dt changed; integral of the
                                        ///< kinetic energy [J s]
    double drag = 0;                    ///< flow.drag when dt changed
    double lost = 0, kinetic = 0, fall_power = 0;  ///< at the last look
    int rounds = 0, calm = 0;   ///< of the run; since dt changed
    int since = 0, raises = 0;  ///< rounds since a failure or a raise of the
                                ///< ceiling; raises since a failure
    void archive(Archive& a);
  };
  /** The chosen steps. */
  struct Report {
    double shortest, longest;           ///< [s]
    int shortened = 0, lengthened = 0;  ///< times
    long long taken_back = 0;           ///< steps
  };

  struct Limits {
    double share = energy_tolerance;  ///< tolerated gain/scale
    double floor = 0;                 ///< DivergenceGuard::floor() [J]
    double rest = 0;  ///< energy of a cloth at rest, by round-off [J]
    double longest = std::numeric_limits<double>::infinity();  ///< step [s]
    bool early = true;  ///< order 1: velocities are half a step early
  };
  /** @param dt the first step [s]   @param start energies at the start
   * @param flow until then */
  StepControl(double dt, const Energies& start, const Limits& limits,
              const EnergyFlow& flow = {});

  double dt() const { return now_.dt; }
  const State& state() const { return now_; }
  const Report& report() const { return report_; }
  /** The tolerated gain of the run until now [J]. */
  double tolerance() const { return tolerance(now_, now_.looks); }

  enum class Verdict {
    go_on,
    keep,      ///< a good round ended: keep a copy of the state
    take_back  ///< call take_back()
  };
  /** Judge the state @a h [s] after the last one. The shortest step is never
   * taken back.  @param part of the run that is done, from 0 to 1 */
  Verdict look(const Energies& e, const EnergyFlow& flow, double h,
               double part);
  /** False at the shortest step: a 64th of the first. */
  bool can_shorten() const { return now_.dt > shortest_; }
  /** Go back by @a steps to the state @a then; shorten the step. */
  void take_back(const State& then, long long steps);
  /** Lengthen the next step if it is time.  @return true if dt changed */
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
  void change(double dt, double drag);
};

}  // namespace lab
