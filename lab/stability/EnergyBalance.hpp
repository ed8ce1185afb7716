#pragma once
/** @file EnergyBalance.hpp
 * The energy of a cloth, and what entered and left it. */
#include <algorithm>
#include <cmath>
#include <vector>

#include "lab/fast/ConstraintPlan.hpp"

namespace lab {

/** The energy of a cloth [J]. */
struct Energies {
  double kinetic = 0, elastic = 0;
  double gravitational = 0;  ///< 0 at z = 0
  double relative = 0;       ///< kinetic, relative to the carrier: EnergyFlow
  double fall_power = 0;     ///< |power of gravity| on a loose cloth [W]
  double total() const { return kinetic + elastic + gravitational; }
  /** Equal in all frames of reference. Gains are compared with it. */
  double internal() const { return relative + elastic; }
  /** What rounding errors can make of such energies [J]. */
  double round_off() const {
    return 1e-10 * (kinetic + elastic + std::abs(gravitational));
  }
};

/** The energy that entered and left a cloth since the start [J], and its
 * carrier now: the held nodes or, if there are none, the center of mass. */
struct EnergyFlow {
  double work = 0;          ///< done by moving pins and obstacles
  double removed = 0;       ///< gravitational energy of removed nodes
  double torn = 0;          ///< other energy of what was removed
  double drag = 0;          ///< taken by linear drag, if add_drag() is used
  Point carried = Point();  ///< mean velocity of the held nodes [m/s]
  /** No node is held. */
  bool loose = false;
  double contact = 0;  ///< at most what contact took: Exchange::taken

  void archive(Archive& a) {
    a(work)(removed)(torn)(drag)(carried)(loose)(contact);
    a.require(
        std::isfinite(work + removed + torn + drag + contact + norm(carried)));
  }
};

/** The energies of @a g.  O(N + springs)
 * @param gravity [m/s^2]   @param flow only carried and loose are used */
Energies energies(const Cloth& g, double gravity, const EnergyFlow& flow = {});

/** The gain of energy that is tolerated by default, as a share of the largest
 * internal energy; see StepControl. */
inline constexpr double energy_tolerance = 0.1;

/** The balance b of EnergyBalance [J]. */
inline double balance(const Energies& e, const EnergyFlow& flow) {
  return e.total() - flow.work + flow.removed + flow.drag;
}

/** Adds up the energy that enters and leaves a cloth, step by step.
 *
 * Contact, friction and tearing only lower kinetic and elastic energy. So the
 * exact motion never raises the balance
 *   b = energies().total() - work + removed + drag:
 * any rise is the method's error. Work of a moving obstacle: the impulse on a
 * node times the obstacle's velocity. Work of a moving pin: the gain of the
 * node's kinetic energy - F . dx, F the mean force in a step, to order 3: by
 * the forces at its ends and, if the last step was as long, at its start
 * (Adams and Moulton; Hairer, Norsett, Wanner, Solving ODEs I, III.1). */
class EnergyBalance {
 public:
  /** @param g at the start, time @a t   @param gravity [m/s^2]
   * @param force all forces on a node */
  EnergyBalance(const Cloth& g, double t, CombinedForces force,
                const ConstraintPlan& constraint, double gravity);

  /** Add the energy that a step to time @a t brought or removed.
   * O(held nodes + springs at those that moved) */
  void follow(const Cloth& g, double t, const ConstraintPlan& constraint);
  /** From time @a t on, also add the work of @a pull on @a n, a force whose
   * energy is not in energies(), until @a n is removed. Null: no such force.
   * @pre @a pull outlives this */
  void watch(Node n, const ZeroForce* pull, double t);
  /** Add the energy that linear drag took [J]. */
  void add_drag(double loss) { flow_.drag += loss; }
  const EnergyFlow& flow() const { return flow_; }

  /** Continue from the state of @a g at time @a t and its @a flow. */
  void resume(const Cloth& g, double t, const ConstraintPlan& constraint,
              const EnergyFlow& flow);

  /** Save or load all that follow() changes. */
  void archive(Archive& a) {
    for (Held& h : held_) {
      a(h.place)(h.velocity)(h.force)(h.change)(h.follows);
      a.require(std::isfinite(norm(h.place) + norm(h.velocity) + norm(h.force) +
                              norm(h.change)));
    }
    auto& [work, moment, torn, taken] = seen_;
    a(work)(moment)(torn)(taken)(flow_)(time_)(step_);
    a.require(std::isfinite(work + moment + torn + taken + time_ + step_));
  }

 private:
  struct Held {
    Node node;
    Point place, velocity, force;  // after the last step [m, m/s, N]
    Point change = Point();        // of force in that step [N]
    bool follows = false;          // it moved in that step
  };
  CombinedForces force_;
  double gravity_;
  std::vector<Held> held_;
  Held pulled_;  // force: that of pull_ alone
  const ZeroForce* pull_ = nullptr;
  Exchange seen_;               // constraint.exchange() after the last step
  double time_ = 0, step_ = 0;  // then, and its length [s]
  EnergyFlow flow_;

  void find_carrier(const Cloth& g, double t, const ConstraintPlan& constraint);
};

/** The balance b of a run until now [J].
 *
 * With a symplectic method the energy of an oscillation swings by a share of
 * O((dt omega)^2). So gains are measured from the least of the initial b and of
 * the means of all rounds of 8 looks. */
struct Swings {
  static constexpr int round = 8;  ///< looks

  double scale = 0;            ///< largest internal energy
  double fall = 0;             ///< gravity's work in two steps, if loose
  double last = 0, least = 0;  ///< b: now, and its least mean over a round
  double sum = 0;              ///< of b over this round
  double gain = 0;             ///< largest b - least
  int looks = 0;               ///< in this round

  Swings() = default;
  /** @param dt the step [s] */
  Swings(const Energies& e, const EnergyFlow& flow, double dt)
      : scale(e.internal()), fall(2 * e.fall_power * dt) {
    last = least = balance(e, flow);
  }
  /** Compare with the largest energies so far. */
  void measure(const Energies& e, double dt) {
    scale = std::max(scale, e.internal());
    fall = std::max(fall, 2 * e.fall_power * dt);
  }
  /** Take @a b into account.  @return true at the end of a round */
  bool add(double b) {
    last = b, sum += b;
    gain = std::max(gain, last - least);
    if (++looks < round) return false;
    least = std::min(least, sum / round);
    looks = 0, sum = 0;
    return true;
  }
  void archive(Archive& a) {
    a(scale)(fall)(last)(least)(sum)(gain)(looks);
    a.require(std::isfinite(scale + fall + last + least + sum + gain) &&
              0 <= looks && looks < round);
  }
};

/** Follows the balance of a run, plus what was torn: its error is the method's.
 * A gain never has another cause; a loss may be that of contact. What is lost
 * between two looks counts as its, up to the kinetic energy that it took. */
class EnergyWatch {
 public:
  /** @param e, flow at the start   @param dt the step [s]
   * @param floor, round_off of the DivergenceGuard [J]
   * @param ahead MethodInfo::ahead() */
  EnergyWatch(const Energies& e, const EnergyFlow& flow, double dt,
              double floor, double round_off, bool ahead);

  /** From now on the step is @a dt; another method may be @a ahead, too. */
  void change_step(double dt, bool ahead) { dt_ = dt, ahead_ |= ahead; }
  /** Forces or nodes have changed, as at a start: see slack(). */
  void change_system() { looks_ = 0; }
  /** Take the state after some steps into account. */
  void look(const Energies& e, const EnergyFlow& flow);

  /** The change of b [J]: by errors of the method, and by contact. */
  double change() const { return seen_.last - start_; }
  /** The error of the energy now [J], positive if gained; where contact took
   * energy, an upper bound. */
  double off() const { return change() + taken_; }
  /** At most what contact took, and what tearing took [J]. */
  double taken() const { return taken_ + torn_; }
  /** The largest internal or kinetic energy [J]. */
  double largest() const { return std::max(seen_.scale, kinetic_); }
  /** What tearing took [J]. */
  double torn() const { return torn_; }
  /** off() as a share of the largest internal energy; 0 if that is negligible,
   * as in a free fall, or beside work and drag. */
  double share() const;
  /** The largest gain so far [J]. */
  double gain() const { return seen_.gain; }
  /** The gain that is tolerated [J]: the share of the largest internal energy
   * that StepControl tolerates, slack(), lift(). */
  double tolerance() const;
  /** The part of tolerance() besides that share [J]. */
  double slack() const;
  /** The method has added more energy than is tolerated. */
  bool gains() const { return gain() > tolerance(); }
  /** The gain is more than springs and their waves ever had: it is in the
   * motion of the whole. */
  bool gains_beside_springs() const { return gain() > seen_.scale; }
  /** off() in words. */
  std::string off_text() const;
  /** gains() in words. */
  std::string gain_text() const;
  /** The energy is off by more than half of that share, slack(); of a gain,
   * lift(); of a loss, fall(): positions may be ahead. */
  bool is_off() const;

  void archive(Archive& a);

 private:
  double dt_, floor_, round_off_;
  bool ahead_;
  Swings seen_;
  double start_;  // the first b [J]
  double taken_ = 0, torn_ = 0;
  double passed_ = 0;   // the most work and drag [J]
  double kinetic_ = 0;  // the most kinetic energy [J]
  double contact_ = 0;  // flow.contact at the last look
  int looks_ = 0;

  /** Gravity's work in two steps, if the cloth is loose [J]. Unless that is how
   * the method is, it is not small beyond a twentieth of the kinetic energy. */
  double fall() const {
    return ahead_ ? seen_.fall
                  : std::min(seen_.fall, energy_tolerance / 2 * kinetic_);
  }
  /** A cloth at rest on an obstacle, which each step lifts back, has less than
   * this kinetic energy [J]: M (g dt)^2/8, or M (g dt)^2/2 where ahead. */
  double lift() const { return contact_ > 0 ? floor_ / (ahead_ ? 1 : 4) : 0; }
};

}  // namespace lab
