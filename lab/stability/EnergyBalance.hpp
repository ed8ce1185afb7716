#pragma once
/** @file EnergyBalance.hpp
 * What a cloth's energy consists of, and what came in and went out. */
#include <cmath>
#include <vector>

#include "lab/fast/ConstraintPlan.hpp"

namespace lab {

/** The energy of a cloth [J]. */
struct Energies {
  double kinetic = 0, elastic = 0;
  double gravitational = 0;  ///< 0 at z = 0
  double relative = 0;       ///< kinetic, as seen from what carries the cloth
  double fall_power = 0;     ///< of the weight of a loose cloth [W], >= 0
  double total() const { return kinetic + elastic + gravitational; }
  /** That of which a method can make more: it does not depend on who looks. */
  double internal() const { return relative + elastic; }
};

/** What came into a cloth's energy and what left it, since the start [J]; and
 * what carries the cloth now. */
struct EnergyFlow {
  double work = 0;          ///< done by pins and obstacles that move
  double removed = 0;       ///< gravitational energy of nodes that were removed
  double drag = 0;          ///< taken by linear drag, where that is asked for
  Point carried = Point();  ///< mean velocity of the nodes that are held [m/s]
  /** Nothing holds it: its center of mass carries it. */
  bool loose = false;

  void archive(Archive& a) {
    a(work)(removed)(drag)(carried)(loose);
    a.require(std::isfinite(work + removed + drag + norm(carried)));
  }
};

/** Those of @a g.  @param gravity [m/s^2]   @param flow what carries the cloth
 * O(N + springs) */
Energies energies(const Cloth& g, double gravity, const EnergyFlow& flow = {});

/** What a method may gain from nothing, as a share of the energy of motion,
 * unless one says otherwise. */
inline constexpr double energy_tolerance = 0.1;

/** What never rises in the cloth itself [J], see EnergyBalance. */
inline double balance(const Energies& e, const EnergyFlow& flow) {
  return e.total() - flow.work + flow.removed + flow.drag;
}

/** Follows what comes into a cloth's energy and what leaves it, step by step.
 *
 * Contact, friction and tearing only lower kinetic and elastic energy, so
 *   b = energies().total() - work + removed + drag
 * of the cloth itself never rises: if it does, that is the method's error. Work
 * of a moving obstacle: the impulse on a node times the obstacle's velocity;
 * of a moving pin: -F . dx, the mean of the force F on the node before and
 * after a step, and what the node gains in kinetic energy. */
class EnergyBalance {
 public:
  /** @param g at the start, time @a t   @param gravity [m/s^2]
   * @param force all forces on a node */
  EnergyBalance(const Cloth& g, double t, CombinedForces force,
                const ConstraintPlan& constraint, double gravity);

  /** Account for a step that ended at time @a t.
   * O(held nodes + springs at those that moved) */
  void follow(const Cloth& g, double t, const ConstraintPlan& constraint);
  /** Count the work of @a pull on @a n, too, until @a n is removed: a force of
   * which energies() knows nothing; null: of none.
   * @pre @a pull outlives this */
  void watch(Node n, const ZeroForce* pull, double t);
  /** Add the energy that linear drag took [J]. */
  void add_drag(double loss) { flow_.drag += loss; }
  const EnergyFlow& flow() const { return flow_; }

  /** Go on from a state of @a g at time @a t with its @a flow. */
  void resume(const Cloth& g, double t, const ConstraintPlan& constraint,
              const EnergyFlow& flow);

  /** Save or load all that follow() changes. */
  void archive(Archive& a) {
    for (Held& h : held_) {
      a(h.place)(h.velocity)(h.force);
      a.require(
          std::isfinite(norm(h.place) + norm(h.velocity) + norm(h.force)));
    }
    a(seen_)(flow_);
    a.require(std::isfinite(seen_.work + seen_.moment));
  }

 private:
  struct Held {
    Node node;
    Point place, velocity, force;  // after the last step [m, m/s, N]
  };
  CombinedForces force_;
  double gravity_;
  std::vector<Held> held_;
  Held pulled_;  // its force: that of pull_ alone
  const ZeroForce* pull_ = nullptr;
  Exchange seen_;  // of the constraint, until the last step
  EnergyFlow flow_;

  void find_carrier(const Cloth& g, double t, const ConstraintPlan& constraint);
};

}  // namespace lab
