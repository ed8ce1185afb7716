#pragma once
/** @file ConstraintPlan.hpp
 * ConstraintPlan: how the laboratory applies a constraint of the course. The
 * one place that recognises PinConstraint, PlaneConstraint, SphereConstraint,
 * TearConstraint and CombinedConstraints; any other constraint is called. */
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <stdexcept>
#include <typeinfo>
#include <utility>
#include <vector>

#include "mass_spring.hpp"

namespace lab {

/** A step that can't be made: an iteration does not converge, an error
 * tolerance can't be met, or the constraints can't. what() says why. The cloth
 * is then undefined. */
struct StepError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

using NodeVisitor = std::function<void(Node)>;

/** A constraint that knows more than its call: what methods and the guard ask
 * for. Only the laboratory uses it; the defaults are right for every
 * constraint. */
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
  /** Call @a use(node) for each node of @a g that is held at rest: its velocity
   * is 0 although forces act on it. */
  virtual void each_held(const Cloth& /*g*/, const NodeVisitor& /*use*/) const {
  }
  /** The first hit: the first place, to round-off, at which a node on its
   * straight way @a from one place @a to another is inside an obstacle that
   * holds neither of them, so that a look at the ends would miss it:
   * tunnelling. nullopt if there is none. A floor can't be missed. */
  virtual std::optional<Point> first_hit(const Point& /*from*/,
                                         const Point& /*to*/) const {
    return std::nullopt;
  }
  /** The size [m] of the smallest obstacle that can be tunnelled through. */
  virtual double thinnest() const {
    return std::numeric_limits<double>::infinity();
  }
};

/** A constraint that projects each node independently: its children give
 * project(). */
class NodewiseConstraint : public SweptConstraint {
 public:
  void operator()(Cloth& g, double t) const final {
    project(g, t, 0, g.node_slots());
  }
  bool nodewise() const final { return true; }
  void project(Cloth& g, double t, unsigned first,
               unsigned last) const override = 0;
};

/** Call @a use(node) for each node with an id in [first, last) whose position
 * @a violates. Goes through the positions in the order of memory: few of them
 * ever violate a constraint. */
template <typename Violates, typename Use>
void for_each_violating(Cloth& g, unsigned first, unsigned last,
                        Violates violates, Use use) {
  for (unsigned i = first; i < last; ++i)
    if (violates(g.positions()[i]) && g.node_in_use(i)) use(g.node_with_id(i));
}

/** The first hit of @a ball: as SweptConstraint::first_hit(). */
inline std::optional<Point> first_hit(const Ball& ball, const Point& from,
                                      const Point& to) {
  if (ball.holds(from) || ball.holds(to)) return std::nullopt;
  const Point way = to - from, start = from - ball.center;
  // |start + s way| = radius, of the two s the smaller one
  const double a = normSq(way), b = dot(start, way);
  const double c = normSq(start) - ball.radius * ball.radius;
  const double root = b * b - a * c;
  if (!(root > 0) || b >= 0 || -b >= a) return std::nullopt;
  const Point on = start + (c / (-b + std::sqrt(root))) * way;
  return ball.center + (1 - 1e-9) * on;
}

/** Pinned nodes by id, so that those of a part are found at once. */
class PinnedNodes {
 public:
  explicit PinnedNodes(const std::vector<PinConstraint::Pin>& pins) {
    for (const auto& [node, place] : pins)
      pins_.push_back({node, node.id(), place});
    std::ranges::sort(pins_, {}, &Pin::id);
  }
  /** Put the pinned nodes of ids in [first, last) to their places, moved by
   * @a way [m], at rest.  O(log(pins) + those of the part) */
  void project(Cloth& g, const Point& way, unsigned first,
               unsigned last) const {
    const auto begin = std::ranges::lower_bound(pins_, first, {}, &Pin::id);
    for (auto pin = begin; pin != pins_.end() && pin->id < last; ++pin)
      if (g.has_node(pin->node)) {
        Node n = pin->node;
        n.position() = pin->place + way;
        n.value().vel = Point();
      }
  }
  void each_held(const Cloth& g, const NodeVisitor& use) const {
    for (const Pin& pin : pins_)
      if (g.has_node(pin.node)) use(pin.node);
  }

 private:
  struct Pin {
    Node node;
    unsigned id;  // the node's, which a removed one can't tell
    Point place;
  };
  std::vector<Pin> pins_;
};

namespace constraint_plan_detail {

// The course's constraints as swept ones.

class Pins final : public NodewiseConstraint {
 public:
  /** @pre all pinned nodes are in their graph */
  explicit Pins(const PinConstraint& c) : pins_(c.pins()) {}
  void project(Cloth& g, double /*t*/, unsigned first,
               unsigned last) const override {
    pins_.project(g, Point(), first, last);
  }
  void each_held(const Cloth& g, const NodeVisitor& use) const override {
    pins_.each_held(g, use);
  }

 private:
  PinnedNodes pins_;
};

class Plane final : public NodewiseConstraint {
 public:
  explicit Plane(const PlaneConstraint& c) : plane_(c) {}
  void project(Cloth& g, double /*t*/, unsigned first,
               unsigned last) const override {
    const double z = plane_.height();
    for_each_violating(
        g, first, last, [z](const Point& p) { return p.z < z; },
        [this](Node n) { plane_.project(n); });
  }

 private:
  PlaneConstraint plane_;
};

/** A sphere or a ball that tears: both can be tunnelled through. */
template <typename Base>
class Round : public Base {
 public:
  explicit Round(const Ball& ball) : ball_(ball) {}
  std::optional<Point> first_hit(const Point& from,
                                 const Point& to) const override {
    return lab::first_hit(ball_, from, to);
  }
  double thinnest() const override { return ball_.radius; }

 protected:
  Ball ball_;
};

class Sphere final : public Round<NodewiseConstraint> {
 public:
  explicit Sphere(const SphereConstraint& c)
      : Round(c.ball()), sphere_(c.ball()) {}
  void project(Cloth& g, double /*t*/, unsigned first,
               unsigned last) const override {
    for_each_violating(
        g, first, last, [this](const Point& p) { return ball_.holds(p); },
        [this](Node n) { sphere_.project(n); });
  }

 private:
  SphereConstraint sphere_;
};

class Tear final : public Round<SweptConstraint> {
 public:
  explicit Tear(const TearConstraint& c) : Round(c.ball()) {}
  void operator()(Cloth& g, double /*t*/) const override {
    for_each_violating(
        g, 0, g.node_slots(), [this](const Point& p) { return ball_.holds(p); },
        [&g](Node n) { g.remove_node(n); });
  }
};

/** Of which nothing is known. */
class Called final : public SweptConstraint {
 public:
  explicit Called(std::shared_ptr<const ZeroConstraint> c) : c_(std::move(c)) {}
  void operator()(Cloth& g, double t) const override { (*c_)(g, t); }

 private:
  std::shared_ptr<const ZeroConstraint> c_;
};

}  // namespace constraint_plan_detail

/** The terms of a constraint, in their order, by what methods need of them.
 *
 * It is made once for many steps, when the pinned nodes are in their graph. A
 * ConstraintPlan shares the parts of a CombinedConstraints; any other
 * constraint that it does not recognise must outlive it. */
class ConstraintPlan {
 public:
  /** No constraint. */
  ConstraintPlan() = default;
  /** O(terms + pins log pins). Implicit, so that a constraint can be handed to
   * a method. */
  ConstraintPlan(const ZeroConstraint& c) {  // NOLINT
    add(std::shared_ptr<const ZeroConstraint>(std::shared_ptr<void>(), &c));
  }

  /** Apply it to @a g at time @a t [s].  O(N) where the terms say nothing */
  void operator()(Cloth& g, double t) const {
    for (const auto& term : terms_) (*term)(g, t);
  }
  // As in SweptConstraint; each is that of all terms together:
  bool nodewise() const {
    return std::ranges::all_of(terms_,
                               [](const auto& c) { return c->nodewise(); });
  }
  void project(Cloth& g, double t, unsigned first, unsigned last) const {
    for (const auto& term : terms_) term->project(g, t, first, last);
  }
  void each_held(const Cloth& g, const NodeVisitor& use) const {
    for (const auto& term : terms_) term->each_held(g, use);
  }
  std::optional<Point> first_hit(const Point& from, const Point& to) const {
    std::optional<Point> first;
    for (const auto& term : terms_)
      if (auto place = term->first_hit(from, to);
          place && (!first || norm(*place - from) < norm(*first - from)))
        first = place;
    return first;
  }
  double thinnest() const {
    double least = std::numeric_limits<double>::infinity();
    for (const auto& term : terms_) least = std::min(least, term->thinnest());
    return least;
  }

 private:
  std::vector<std::shared_ptr<const SweptConstraint>> terms_;

  /** Exact types: a child may have another call. */
  void add(std::shared_ptr<const ZeroConstraint> constraint) {
    using namespace constraint_plan_detail;
    const ZeroConstraint& c = *constraint;
    const auto& type = typeid(c);
    if (type == typeid(CombinedConstraints)) {
      for (const auto& part :
           static_cast<const CombinedConstraints&>(c).parts())
        add(part);
    } else if (type == typeid(PinConstraint)) {
      put<Pins>(static_cast<const PinConstraint&>(c));
    } else if (type == typeid(PlaneConstraint)) {
      put<Plane>(static_cast<const PlaneConstraint&>(c));
    } else if (type == typeid(SphereConstraint)) {
      put<Sphere>(static_cast<const SphereConstraint&>(c));
    } else if (type == typeid(TearConstraint)) {
      put<Tear>(static_cast<const TearConstraint&>(c));
    } else if (auto swept = std::dynamic_pointer_cast<const SweptConstraint>(
                   constraint)) {
      terms_.push_back(std::move(swept));
    } else if (type != typeid(ZeroConstraint)) {
      put<Called>(std::move(constraint));
    }
  }
  template <typename Term, typename C>
  void put(C&& c) {
    terms_.push_back(std::make_shared<const Term>(std::forward<C>(c)));
  }
};

/** Set the velocity of the held nodes to 0: after a kick. Positions and other
 * velocities are not touched, so no trajectory changes, only energies. */
inline void stop_held(Cloth& g, const ConstraintPlan& constraint) {
  constraint.each_held(g, [](Node n) { n.value().vel = Point(); });
}

/** Wraps a constraint; stops nodes that would tunnel through an obstacle within
 * one step, and counts them. Off until watch() turns it on. */
class WatchedConstraint final : public SweptConstraint {
 public:
  /** A node that was stopped. */
  struct Stopped {
    unsigned node;  ///< its index
    double length;  ///< of its way since the last call [m]
  };

  explicit WatchedConstraint(ConstraintPlan c) : c_(std::move(c)) {}

  /** Watch from the state of @a g on, or no more. O(N) if @a on, then and in
   * each call. */
  void watch(const Cloth& g, bool on) {
    before_.clear();
    if (on) remember(g);
  }
  /** How many were stopped, and the first of them.  @pre of first: count > 0 */
  long long count() const { return count_; }
  const Stopped& first() const { return first_; }

  void operator()(Cloth& g, double t) const override {
    if (before_.empty()) return c_(g, t);
    for (Node n : g.nodes()) {
      if (n.id() >= before_.size()) continue;  // added since
      auto place = c_.first_hit(before_[n.id()], n.position());
      if (!place) continue;
      if (count_++ == 0)
        first_ = {n.index(), norm(n.position() - before_[n.id()])};
      n.position() = *place;
    }
    c_(g, t);
    remember(g);
  }
  bool nodewise() const override { return before_.empty() && c_.nodewise(); }
  void project(Cloth& g, double t, unsigned first,
               unsigned last) const override {
    c_.project(g, t, first, last);
  }
  void each_held(const Cloth& g, const NodeVisitor& use) const override {
    c_.each_held(g, use);
  }
  std::optional<Point> first_hit(const Point& from,
                                 const Point& to) const override {
    return c_.first_hit(from, to);
  }
  double thinnest() const override { return c_.thinnest(); }

 private:
  ConstraintPlan c_;
  mutable std::vector<Point> before_;  // by node id; empty: off
  mutable long long count_ = 0;
  mutable Stopped first_ = {};

  void remember(const Cloth& g) const {
    const auto x = g.positions();
    before_.assign(x.begin(), x.end());
  }
};

}  // namespace lab
