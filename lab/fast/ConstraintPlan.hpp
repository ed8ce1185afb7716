#pragma once
/** @file ConstraintPlan.hpp
 * ConstraintPlan: how the laboratory applies a constraint of the course. The
 * one place that recognises PinConstraint, PlaneConstraint, SphereConstraint,
 * TearConstraint and CombinedConstraints; any other constraint is called. */
#include <concepts>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <stdexcept>
#include <type_traits>
#include <utility>
#include <vector>

#include "lab/fast/Archive.hpp"
#include "lab/fast/GraphArrays.hpp"
#include "lab/fast/Motion.hpp"
#include "lab/fast/Recognise.hpp"
#include "mass_spring.hpp"

namespace lab {

/** A step can't be made: an iteration does not converge, or an error tolerance
 * or the constraints can't be satisfied. what() says why. The cloth is then
 * undefined. */
struct StepError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

class FlatCloth;
class ForwardingConstraint;

using NodeVisitor = std::function<void(Node)>;

/** Where a held node is at some time, and how it moves then. */
struct Place {
  Point at;        ///< [m]
  Point velocity;  ///< [m/s]
};
using PlaceVisitor = std::function<void(Node, const Place&)>;

/** Energy that a constraint added to a cloth and removed from it, summed over
 * all calls since the constraint was made. */
struct Exchange {
  double work = 0;         ///< by moving obstacles: impulse times velocity [J]
  Point moment = Point();  ///< sum of m x of removed nodes [kg m]
  Exchange& operator+=(const Exchange& b) {
    work += b.work, moment += b.moment;
    return *this;
  }
};

/** Where a constraint lets no node be: inside a ball, or behind a plane. The
 * test is that of project(). */
struct Zone {
  Point at;          ///< the center, or a point of the plane [m]
  Point normal;      ///< of the plane, of length 1, pointing out
  double limit = 0;  ///< of |p - at|^2 [m^2], or of (p - at) . normal [m]
  bool is_ball = false;
  static Zone inside(const Ball& b) {
    return {b.center, Point(), b.radius * b.radius, true};
  }
  static Zone behind(const Point& at, const Point& normal) {
    return {at, normal, 0, false};
  }
};

/** Properties of a constraint's call. The defaults are right for every
 * constraint whose moving parts do no work on nodes. */
struct Traits {
  /** Each node is projected independently and none is removed: then project()
   * may replace the call, part by part. While a constraint adds up its work, it
   * must not be nodewise, so that only one thread does. */
  bool nodewise = false;
  /** The call puts nodes to the places of each_place(), and does no more. */
  bool holds = false;
  /** The call changes no node outside of it. Its place is that at t = 0;
   * nullopt: no zone is known. */
  std::optional<Zone> zone = {};
  /** A ball at rest, through which a node can tunnel: see first_hit(). Nothing
   * can tunnel through a floor. */
  std::optional<Ball> obstacle = {};
  Motion motion = {};  ///< of the zone and of all held nodes
};

/** A constraint with more than its call, for methods and the guard. Only the
 * laboratory uses it. */
class SweptConstraint : public ZeroConstraint {
 public:
  explicit SweptConstraint(const Traits& traits = {}) : traits_(traits) {}

  const Traits& traits() const { return traits_; }
  /** What its calls since it was made have exchanged, without the work on held
   * nodes, which EnergyBalance adds up. */
  const Exchange& exchange() const { return exchange_; }
  void archive(Archive& a) const;

  /** Project the nodes of @a g with ids in [first, last) that are in use. The
   * others need not have moved yet. Threads may project several parts at once.
   * @pre nodewise */
  virtual void project(Cloth& /*g*/, double /*t*/, unsigned /*first*/,
                       unsigned /*last*/) const {}
  /** Call @a use(node, place) for each held node of @a g with an id in [first,
   * last): a node whose place depends only on the time. The place is that at
   * time @a t [s]; stages may use times up to a step before the start. */
  virtual void each_place(const Cloth& /*g*/, double /*t*/, unsigned /*first*/,
                          unsigned /*last*/,
                          const PlaceVisitor& /*use*/) const {}

 protected:
  mutable Exchange exchange_;

 private:
  Traits traits_;
};

/** A constraint that projects each node independently: derived classes define
 * project(). */
class NodewiseConstraint : public SweptConstraint {
 public:
  explicit NodewiseConstraint(const Traits& traits = {.nodewise = true})
      : SweptConstraint(traits) {}
  void operator()(Cloth& g, double t) const final {
    project(g, t, 0, arrays(g).node_slots());
  }
  void project(Cloth& g, double t, unsigned first,
               unsigned last) const override = 0;
};

/** A constraint that only holds nodes: derived classes define each_place(). */
class HoldingConstraint : public NodewiseConstraint {
 public:
  explicit HoldingConstraint(const Motion& motion = {})
      : NodewiseConstraint(
            {.nodewise = true, .holds = true, .motion = motion}) {}
  void project(Cloth& g, double t, unsigned first, unsigned last) const final;
  void each_place(const Cloth& g, double t, unsigned first, unsigned last,
                  const PlaceVisitor& use) const override = 0;
};

/** Call @a use(node) for each node with an id in [first, last) whose position
 * @a violates. The positions are tested in the order of memory, before
 * node_in_use(): only a few violate a constraint. */
template <typename Violates, typename Use>
void for_each_violating(Cloth& g, unsigned first, unsigned last,
                        Violates violates, Use use) {
  for (unsigned i = first; i < last; ++i)
    if (violates(arrays(g).positions()[i]) && arrays(g).node_in_use(i))
      use(arrays(g).node_with_id(i));
}

/** The first point, to round-off, of the line @a from one place @a to another
 * that is inside @a ball, if a node on that line would tunnel through it:
 * @a from is not inside, and @a to is beyond it or in the half that is turned
 * away from that point. nullopt if there is none. */
std::optional<Point> first_hit(const Ball& ball, const Point& from,
                               const Point& to);

/** Moves and turns nodes: at time t they are where Motion::place_of() says,
 * with the velocity of that. They are sorted by id, so that those of a part are
 * found. Nodes may be removed; the others are still moved. */
class PinnedNodes final : public HoldingConstraint {
 public:
  /** @param pins with the places at t = 0
   * @pre all were in one graph  O(pins log pins) */
  explicit PinnedNodes(const std::vector<PinConstraint::Pin>& pins,
                       const Motion& motion = {});
  explicit PinnedNodes(const PinConstraint& pins, const Motion& motion = {})
      : PinnedNodes(pins.pins, motion) {}
  /** O(log(pins) + those of the part) */
  void each_place(const Cloth& g, double t, unsigned first, unsigned last,
                  const PlaceVisitor& use) const override;

 private:
  std::vector<PinConstraint::Pin> pins_;  // in the order of the nodes
};

/** The course's function for constraints of which one is swept: such a
 * constraint stays swept instead of becoming a call. */
template <typename... Cs>
requires(std::derived_from<Cs, SweptConstraint> || ...)  //
    CombinedConstraints make_combined_constraints(Cs... cs) {
  return CombinedConstraints(CombinedConstraints::List{
      shared_as<ZeroConstraint, FunctionConstraint>(std::move(cs))...});
}

/** The terms of a constraint, in their order, ready for methods.
 *
 * It is made once for many steps. A ConstraintPlan shares the parts of a
 * CombinedConstraints; any other constraint that it does not recognise must
 * outlive it. */
class ConstraintPlan {
 public:
  /** No constraint. */
  ConstraintPlan() = default;
  /** O(terms + pins log pins). Implicit, so that a constraint can be handed to
   * a method. */
  template <IsA<ZeroConstraint> C>
  ConstraintPlan(C&& c) {  // NOLINT
    add(term_of<ZeroConstraint, FunctionConstraint>(std::forward<C>(c)));
  }

  /** Apply it to @a g at time @a t [s]; then restore_order(), if nodes
   * were removed.  O(N) unless a term takes longer */
  void operator()(Cloth& g, double t) const;
  /** All terms are. */
  bool nodewise() const;
  /** As SweptConstraint::project(). */
  void project(Cloth& g, double t, unsigned first, unsigned last) const;
  /** The call for a cloth by component, whose graph is @a g. Positions and
   * velocities in @a g may be out of date, before and after it. */
  void apply(FlatCloth& c, Cloth& g, double t) const;
  /** Do what the call does to the nodes with ids in [first, last), if that does
   * not depend on other nodes: if each term is nodewise or changes none of
   * them. Threads may call it for several parts at once.
   * @return false if it depends on them; then @a c is undefined */
  bool apply_to_part(FlatCloth& c, Cloth& g, double t, unsigned first,
                     unsigned last) const;
  /** As SweptConstraint::each_place(), for all of @a g. */
  void each_place(const Cloth& g, double t, const PlaceVisitor& use) const;
  /** The first time [s] after @a t, by more than round-off, at which a place
   * changes its velocity; infinity if none does. */
  double next_velocity_jump(double t) const;
  /** The first of all obstacles' first_hit(). */
  std::optional<Point> first_hit(const Point& from, const Point& to) const;
  /** The size [m] of the smallest obstacle; infinity if there is none. */
  double thinnest() const;
  /** True only if nothing in it moves from time @a t [s] on, so that it does no
   * work: that changes only in calls that remove nodes. */
  bool is_at_rest(double t) const;
  Exchange exchange() const;
  void archive(Archive& a) const;

  // The held nodes; each takes O(of them), as each_place().
  /** Call @a use(node) for each. */
  void each_held(const Cloth& g, const NodeVisitor& use) const;
  /** Put each to its place at time @a t, at rest: so a drift that ends at @a t
   * leaves it there. */
  void place_held_at_rest(Cloth& g, double t) const;
  /** Only set its velocity: after a kick. Positions and other velocities are
   * not touched, so no trajectory changes, only energies. */
  void set_held_velocities(Cloth& g, double t) const;

 private:
  struct Term {
    std::shared_ptr<const SweptConstraint> constraint;
    const ForwardingConstraint* forwards;  // the same; or null
    const ConstraintPlan* instead() const;
  };
  std::vector<Term> terms_;
  /** The terms, and those of inner plans instead of what forwards to them. */
  std::vector<std::shared_ptr<const SweptConstraint>> leaves_;

  void add(std::shared_ptr<const ZeroConstraint> constraint);
  static bool apply_to_part(const Term& term, FlatCloth& c, Cloth& g, double t,
                            unsigned first, unsigned last);
};

/** A constraint that calls others. A ConstraintPlan asks those for all but the
 * call: held nodes, obstacles, what they exchange. */
class ForwardingConstraint : public SweptConstraint {
 public:
  explicit ForwardingConstraint(ConstraintPlan inner, const Traits& traits = {})
      : SweptConstraint(traits), inner_(std::move(inner)) {}
  const ConstraintPlan& inner() const { return inner_; }
  /** True if at present the call is that of inner(). */
  virtual bool is_inner() const { return false; }

 protected:
  ConstraintPlan inner_;
};

/** Stops nodes that would tunnel through an obstacle of another constraint
 * within one step, and counts them. Off until watch() turns it on. */
class WatchedConstraint final : public ForwardingConstraint {
 public:
  /** A node that was stopped. */
  struct Stopped {
    unsigned node;  ///< its index
    double length;  ///< of its path since the last call [m]
  };

  explicit WatchedConstraint(ConstraintPlan inner)
      : ForwardingConstraint(std::move(inner)) {}

  /** Start watching from the state of @a g, or stop. While on, this and each
   * call take O(N). */
  void watch(const Cloth& g, bool on) {
    before_.clear();
    if (on) remember(g);
  }
  /** How many were stopped, and the first of them.  @pre of first: count > 0 */
  long long count() const { return count_; }
  const Stopped& first() const { return first_; }

  void operator()(Cloth& g, double t) const override;
  bool is_inner() const override { return before_.empty(); }
  /** With that of inner(). */
  void archive(Archive& a) const {
    inner_.archive(a);
    a(before_)(count_)(first_.node)(first_.length).require(count_ >= 0);
  }

 private:
  mutable std::vector<Point> before_;  // by node id; empty: off
  mutable long long count_ = 0;
  mutable Stopped first_ = {};

  void remember(const Cloth& g) const {
    const auto x = arrays(g).positions();
    before_.assign(x.begin(), x.end());
  }
};

}  // namespace lab
