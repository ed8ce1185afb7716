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
  double work = 0;    ///< by moving obstacles: impulse times velocity [J]
  double moment = 0;  ///< sum of m z of the nodes that were removed [kg m]
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

/** A constraint with functions that methods and the guard use besides its call.
 * Only the laboratory uses it; the defaults are right for every constraint. */
class SweptConstraint : public ZeroConstraint {
 public:
  /** True if each node is projected independently and none is removed. Then
   * project() may replace the call, part by part. */
  virtual bool nodewise() const { return false; }
  /** Project the nodes of @a g with ids in [first, last) that are in use. The
   * others need not have moved yet. Threads may project several parts at once.
   * @pre nodewise() */
  virtual void project(Cloth& /*g*/, double /*t*/, unsigned /*first*/,
                       unsigned /*last*/) const {}
  /** project() for a cloth by component, whose graph is @a g; the positions and
   * velocities in @a g may be out of date.  @pre as project()
   * The default calls project() for each tile that is not idle(). */
  virtual void project_flat(FlatCloth& c, Cloth& g, double t, unsigned first,
                            unsigned last) const;
  /** The call at time @a t [s] changes no node outside of it; nullopt if no
   * zone is known. */
  virtual std::optional<Zone> zone(double /*t*/) const { return std::nullopt; }
  /** True only if the call changes no node with an id in [first, last). */
  bool idle(const FlatCloth& c, double t, unsigned first, unsigned last) const;
  /** The call for a cloth by component. The default applies it to @a g. */
  virtual void apply_flat(FlatCloth& c, Cloth& g, double t) const;
  /** Do what the call does to the nodes with ids in [first, last), if that does
   * not depend on other nodes: project_flat() if nodewise(), nothing if idle().
   * @return false if it depends on them; then @a c is undefined
   * Threads may call it for several parts at once. */
  virtual bool project_alone(FlatCloth& c, Cloth& g, double t, unsigned first,
                             unsigned last) const {
    if (!nodewise()) return idle(c, t, first, last);
    project_flat(c, g, t, first, last);
    return true;
  }
  /** Call @a use(node, place) for each held node of @a g: a node whose place
   * depends only on the time. The place is that at time @a t [s]; stages may
   * use times up to a step before the start. */
  virtual void each_place(const Cloth& /*g*/, double /*t*/,
                          const PlaceVisitor& /*use*/) const {}
  /** The first time [s] after @a t, by more than round-off, at which a place
   * changes its velocity; infinity if none does. */
  virtual double next_velocity_jump(double /*t*/) const {
    return std::numeric_limits<double>::infinity();
  }
  /** The first point, to round-off, of the line @a from one place @a to another
   * that is inside an obstacle, if the obstacle contains neither end: a node on
   * that line would tunnel through it. nullopt if there is none. Nothing can
   * tunnel through a floor. */
  virtual std::optional<Point> first_hit(const Point& /*from*/,
                                         const Point& /*to*/) const {
    return std::nullopt;
  }
  /** True only if nothing in it moves from time @a t [s] on, so that it does no
   * work: exchange() changes only in calls that remove nodes. */
  virtual bool is_at_rest(double /*t*/) const { return false; }
  /** The size [m] of the smallest obstacle through which a node can tunnel. */
  virtual double thinnest() const {
    return std::numeric_limits<double>::infinity();
  }
  /** Without the work on held nodes, which EnergyBalance adds up. */
  virtual Exchange exchange() const { return {}; }
  /** Save or load the sums of exchange(). */
  virtual void archive(Archive& /*a*/) const {}
};

/** A constraint that projects each node independently: derived classes define
 * project(). While one adds up its work, it must not be nodewise(), so that
 * only one thread does. */
class NodewiseConstraint : public SweptConstraint {
 public:
  void operator()(Cloth& g, double t) const final {
    project(g, t, 0, arrays(g).node_slots());
  }
  bool nodewise() const override { return true; }
  void project(Cloth& g, double t, unsigned first,
               unsigned last) const override = 0;
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

/** The first hit of @a ball: as SweptConstraint::first_hit(). */
std::optional<Point> first_hit(const Ball& ball, const Point& from,
                               const Point& to);

/** Holds nodes at their places, or moves all of them along. They are sorted by
 * id, so that those of a part are found. Nodes may be removed. */
class PinnedNodes : public NodewiseConstraint {
 public:
  /** @pre all were in one graph  O(pins log pins) */
  explicit PinnedNodes(const std::vector<PinConstraint::Pin>& pins);
  /** O(log(pins) + those of the part) */
  void project(Cloth& g, double t, unsigned first,
               unsigned last) const override;
  void project_flat(FlatCloth& c, Cloth& g, double t, unsigned first,
                    unsigned last) const override;
  /** O(pins) */
  void each_place(const Cloth& g, double t,
                  const PlaceVisitor& use) const override;
  bool is_at_rest(double /*t*/) const override { return true; }

 protected:
  /** How far all have moved from their places at time @a t, and how fast they
   * move then. */
  virtual Place moved(double /*t*/) const { return {}; }

 private:
  std::vector<PinConstraint::Pin> pins_;  // in the order of the nodes

  template <typename Use>
  void each_of_part(const Cloth& g, unsigned first, unsigned last,
                    Use use) const;
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
  ConstraintPlan(const ZeroConstraint& c);  // NOLINT
  /** The same for a temporary, which is kept. */
  template <std::derived_from<ZeroConstraint> C>
  requires(!std::is_reference_v<C> && !std::is_const_v<C>)  //
      ConstraintPlan(C&& c) {
    add(shared_as<ZeroConstraint, FunctionConstraint>(std::move(c)));
  }
  /** A constraint with a call that does not override that of ZeroConstraint. */
  template <typename C>
  requires(std::derived_from<std::remove_const_t<C>, ZeroConstraint> &&
           !Overrides<std::remove_const_t<C>, ZeroConstraint>)  //
      ConstraintPlan(C& c) {
    add(std::make_shared<FunctionConstraint<Pointer<C>>>(Pointer<C>{&c}));
  }

  /** Apply it to @a g at time @a t [s]; then restore_order(), if nodes
   * were removed.  O(N) unless a term takes longer */
  void operator()(Cloth& g, double t) const;
  // As in SweptConstraint, for all terms together:
  bool nodewise() const;
  void project(Cloth& g, double t, unsigned first, unsigned last) const;
  void project_flat(FlatCloth& c, Cloth& g, double t, unsigned first,
                    unsigned last) const;
  void apply_flat(FlatCloth& c, Cloth& g, double t) const;
  bool project_alone(FlatCloth& c, Cloth& g, double t, unsigned first,
                     unsigned last) const;
  void each_place(const Cloth& g, double t, const PlaceVisitor& use) const;
  double next_velocity_jump(double t) const;
  std::optional<Point> first_hit(const Point& from, const Point& to) const;
  double thinnest() const;
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
  std::vector<std::shared_ptr<const SweptConstraint>> terms_;

  void add(std::shared_ptr<const ZeroConstraint> constraint);
};

/** A constraint that forwards all functions to another one. Derived classes
 * define the call, and nodewise() or project() if these differ. */
class ForwardingConstraint : public SweptConstraint {
 public:
  explicit ForwardingConstraint(ConstraintPlan inner)
      : inner_(std::move(inner)) {}
  bool nodewise() const override { return inner_.nodewise(); }
  void project(Cloth& g, double t, unsigned first,
               unsigned last) const override {
    inner_.project(g, t, first, last);
  }
  void each_place(const Cloth& g, double t,
                  const PlaceVisitor& use) const override {
    inner_.each_place(g, t, use);
  }
  double next_velocity_jump(double t) const override {
    return inner_.next_velocity_jump(t);
  }
  std::optional<Point> first_hit(const Point& from,
                                 const Point& to) const override {
    return inner_.first_hit(from, to);
  }
  double thinnest() const override { return inner_.thinnest(); }
  bool is_at_rest(double t) const override { return inner_.is_at_rest(t); }
  Exchange exchange() const override { return inner_.exchange(); }
  void archive(Archive& a) const override { inner_.archive(a); }

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

  using ForwardingConstraint::ForwardingConstraint;

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
  bool nodewise() const override {
    return before_.empty() && inner_.nodewise();
  }
  // While it is off, the graph is not needed:
  void project_flat(FlatCloth& c, Cloth& g, double t, unsigned first,
                    unsigned last) const override {
    inner_.project_flat(c, g, t, first, last);
  }
  void apply_flat(FlatCloth& c, Cloth& g, double t) const override {
    if (before_.empty()) return inner_.apply_flat(c, g, t);
    SweptConstraint::apply_flat(c, g, t);
  }
  bool project_alone(FlatCloth& c, Cloth& g, double t, unsigned first,
                     unsigned last) const override {
    return before_.empty() && inner_.project_alone(c, g, t, first, last);
  }
  void archive(Archive& a) const override {
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
