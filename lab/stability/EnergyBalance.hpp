#pragma once
/** @file EnergyBalance.hpp
 * The energy of a cloth, and what entered and left it. */
#include <algorithm>
#include <cmath>
#include <vector>

#include "lab/fast/ConstraintPlan.hpp"
#include "lab/fast/ForcePlan.hpp"

namespace lab {

/** The energy of a cloth [J]. */
struct Energies {
  double kinetic = 0, elastic = 0;
  double gravitational = 0;  ///< of loads, too; 0 at the origin
  double relative = 0;       ///< kinetic, relative to the carrier: EnergyFlow
  double fall_power = 0;     ///< |power of gravity and loads|, if loose [W]
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
  double drag = 0;          ///< taken by linear drag, if add_drag() is used
  Point carried = Point();  ///< mean velocity of the held nodes [m/s]
  /** No node is held. */
  bool loose = false;

  void archive(Archive& a) {
    a(work)(removed)(drag)(carried)(loose);
    a.require(std::isfinite(work + removed + drag + norm(carried)));
  }
};

/** The energies of @a g.  O(N + springs)
 * @param flow only carried and loose are used */
Energies energies(const Cloth& g, const Potential& potential,
                  const EnergyFlow& flow = {});

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
  /** @param g at the start, time @a t
   * @param force all forces on a node */
  EnergyBalance(const Cloth& g, double t, CombinedForces force,
                const ConstraintPlan& constraint, const Gravity& gravity);

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
    auto& [work, moment] = seen_;
    a(work)(moment)(flow_)(time_)(step_);
    a.require(std::isfinite(work + norm(moment) + time_ + step_));
  }

 private:
  struct Held {
    Node node;
    Point place, velocity, force;  // after the last step [m, m/s, N]
    Point change = Point();        // of force in that step [N]
    bool follows = false;          // it moved in that step
  };
  CombinedForces force_;
  Gravity gravity_;
  std::vector<Held> held_;
  Held pulled_;  // force: that of pull_ alone
  const ZeroForce* pull_ = nullptr;
  Exchange seen_;               // constraint.exchange() after the last step
  double time_ = 0, step_ = 0;  // then, and its length [s]
  EnergyFlow flow_;

  void find_carrier(const Cloth& g, double t, const ConstraintPlan& constraint);
};

}  // namespace lab
