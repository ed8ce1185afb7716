#pragma once
/** @file Constraint.hpp
 * What a cloth must not do. A constraint is anything that can be called as
 * void(Cloth& g, double t): it mends the nodes that violate it at time t [s].
 * Steps call it after the positions moved and before any force sees them. */
#include <algorithm>
#include <cmath>
#include <concepts>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <typeinfo>
#include <utility>
#include <vector>

#include "Cloth.hpp"

/** A step that can't be made: an iteration does not converge, an error
 * tolerance can't be met, or the constraints can't. what() says why. The cloth
 * is then undefined. */
struct StepError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

using NodeVisitor = std::function<void(Node)>;

/** No constraint, and the base of all constraints (section 6.2). */
class ZeroConstraint {
 public:
  virtual ~ZeroConstraint() = default;

  /** Mend @a g. Twice equals once, to round-off.  O(N) unless it says less */
  virtual void operator()(Cloth& /*g*/, double /*t*/) const {}

  /** Does it mend each node by itself, whatever the others do, and remove
   * none? Then steps may call mend() for all nodes, part by part, in place of
   * the call. NodeConstraint is the base of those that do; this base itself has
   * nothing to mend. */
  virtual bool by_node() const {
    return typeid(*this) == typeid(ZeroConstraint);
  }
  /** Mend the nodes of @a g with ids in [first, last), as far as these are in
   * use. The others need not have moved yet. Several threads may mend several
   * parts at once.  @pre by_node() */
  virtual void mend(Cloth& /*g*/, double /*t*/, unsigned /*first*/,
                    unsigned /*last*/) const {}

  /** Call @a use(node) for each node of @a g that the constraint holds still:
   * it stays where it is, and its velocity is 0. Steps need to know, since a
   * force goes on pulling at it. */
  virtual void each_held(const Cloth& /*g*/, const NodeVisitor& /*use*/) const {
  }

  /** Where a node that goes straight @a from one place @a to another enters an
   * obstacle in which neither of them lies, so that looking at the ends only
   * would miss it: the first place inside, to round-off. Nothing if it hits
   * none. A floor can't be missed: who gets past it, is below it. */
  virtual std::optional<Point> entry(const Point& /*from*/,
                                     const Point& /*to*/) const {
    return std::nullopt;
  }
  /** The size [m] of the smallest obstacle that can be missed. */
  virtual double thinnest() const {
    return std::numeric_limits<double>::infinity();
  }
};

/** Set the velocity of the held nodes to 0: after a kick. Positions and other
 * velocities are not touched, so no trajectory changes, only energies. A
 * function as constraint holds none. */
template <typename G, typename C>
void stop_held(G& g, const C& constraint) {
  if constexpr (std::derived_from<C, ZeroConstraint>)
    constraint.each_held(g, [](Node n) { n.value().vel = Point(); });
}

namespace constraint_detail {

/** Call @a mend(node) for each node with an id in [first, last) whose position
 * @a violates. Goes through the positions in the order of memory: few of them
 * ever need mending. */
template <typename Violates, typename Mend>
void for_each_violating(Cloth& g, unsigned first, unsigned last,
                        Violates violates, Mend mend) {
  for (unsigned i = first; i < last; ++i)
    if (violates(g.positions()[i]) && g.node_in_use(i)) mend(g.node_with_id(i));
}

/** How a contact changes a velocity [m/s] that is @a u relative to what is
 * touched. The part of u that goes in is taken away, and with it, by Coulomb's
 * law for impulses, up to @a friction times as much of the part along the
 * surface, but no more than there is of it. Nothing is ever added, so the
 * energy of the relative motion does not grow. Source: R. Bridson, R. Fedkiw,
 * J. Anderson, ACM Trans. Graph. 21 (2002) 594.
 * @param out of length 1, the way out   @param friction coefficient, >= 0 */
inline Point contact_kick(const Point& u, const Point& out, double friction) {
  const double in = -dot(u, out);
  if (!(in > 0)) return Point();  // it is about to leave
  const Point along = u + in * out;
  const double slide = norm(along), brake = std::min(friction * in, slide);
  return in * out + (slide > 0 ? along * (-brake / slide) : Point());
}

}  // namespace constraint_detail

/** A constraint that mends each node by itself: its children say how, in
 * mend(). */
class NodeConstraint : public ZeroConstraint {
 public:
  void operator()(Cloth& g, double t) const final {
    mend(g, t, 0, g.node_slots());
  }
  bool by_node() const final { return true; }
  void mend(Cloth& g, double t, unsigned first,
            unsigned last) const override = 0;
};

/** Holds nodes where they were when the pin was made.
 * @post at each call: their positions are those, and their velocities 0.
 * Removing a pinned node is fine: the pin goes on with the others.
 * Complexity of a call: O(pins). */
class PinConstraint : public NodeConstraint {
 public:
  /** Pin the nodes that lie exactly at one of @a places [m].  O(N places) */
  explicit PinConstraint(const Cloth& g,
                         std::span<const Point> places = corners) {
    for (Node n : g.nodes())
      for (const Point& place : places)
        if (n.position() == place) pins_.push_back({n, n.id(), place});
    sort();
  }
  /** Pin @a nodes where they are now.  @pre all in one graph */
  explicit PinConstraint(std::span<const Node> nodes) {
    for (Node n : nodes) pins_.push_back({n, n.id(), n.position()});
    sort();
  }

  /** O(log(pins) + those of the part) */
  void mend(Cloth& g, double t, unsigned first, unsigned last) const override {
    const Point moved = way(t);
    const auto begin = std::ranges::lower_bound(pins_, first, {}, &Pin::id);
    for (auto pin = begin; pin != pins_.end() && pin->id < last; ++pin)
      if (g.has_node(pin->node)) {
        Node n = pin->node;
        n.position() = pin->place + moved;
        n.value().vel = Point();
      }
  }
  void each_held(const Cloth& g, const NodeVisitor& use) const override {
    for (const Pin& pin : pins_)
      if (g.has_node(pin.node)) use(pin.node);
  }

 protected:
  /** How far the places have moved at time @a t [m]. */
  virtual Point way(double /*t*/) const { return Point(); }

 private:
  struct Pin {
    Node node;
    unsigned id;  // the node's, which one that was removed can't tell
    Point place;
  };
  std::vector<Pin> pins_;  // by id

  void sort() { std::ranges::sort(pins_, {}, &Pin::id); }
};

/** A floor. @post no node lies below z; one that did lies on it, and does not
 * move along z. */
class PlaneConstraint : public NodeConstraint {
 public:
  /** @param z Height of the floor [m] */
  explicit PlaneConstraint(double z = -0.75) : z_(z) {}
  double height() const { return z_; }
  void mend(Cloth& g, double /*t*/, unsigned first,
            unsigned last) const override {
    constraint_detail::for_each_violating(
        g, first, last, [this](const Point& p) { return p.z < z_; },
        [this](Node n) {
          n.position().z = z_;
          n.value().vel.z = 0;
        });
  }

 private:
  double z_;
};

/** A ball: its center and radius [m]. */
struct Ball {
  Point center = Point(0.5, 0.5, -0.5);
  double radius = 0.15;
  /** Strictly inside? */
  bool holds(const Point& p) const {
    return normSq(p - center) < radius * radius;
  }

  /** As ZeroConstraint::entry(). */
  std::optional<Point> entry(const Point& from, const Point& to) const {
    if (holds(from) || holds(to)) return std::nullopt;
    const Point way = to - from, start = from - center;
    // |start + s way| = radius, of the two s the smaller one
    const double a = normSq(way), b = dot(start, way);
    const double c = normSq(start) - radius * radius, root = b * b - a * c;
    if (!(root > 0) || b >= 0 || -b >= a) return std::nullopt;
    const Point on = start + (c / (-b + std::sqrt(root))) * way;
    return center + (1 - 1e-9) * on;
  }
};

/** A solid ball. @post no node lies inside by more than round-off; one that
 * did lies at the nearest point of the surface (the top one, if it was at the
 * center) and does not move along the normal there. */
class SphereConstraint : public NodeConstraint {
 public:
  explicit SphereConstraint(const Ball& ball = {}) : ball_(ball) {}
  void mend(Cloth& g, double /*t*/, unsigned first,
            unsigned last) const override {
    constraint_detail::for_each_violating(
        g, first, last, [this](const Point& p) { return ball_.holds(p); },
        [this](Node n) {
          Point out = n.position() - ball_.center;
          double distance = norm(out);
          Point normal = distance > 0 ? out / distance : Point(0, 0, 1);
          n.position() = ball_.center + ball_.radius * normal;
          n.value().vel -= dot(n.value().vel, normal) * normal;
        });
  }

  std::optional<Point> entry(const Point& from,
                             const Point& to) const override {
    return ball_.entry(from, to);
  }
  double thinnest() const override { return ball_.radius; }

 private:
  Ball ball_;
};

/** A ball that tears (section 7.2). @post no node lies strictly inside.
 * Invalidates: as Graph::remove_node(), for each node removed.
 * Complexity: O(N + the removals). */
class TearConstraint : public ZeroConstraint {
 public:
  explicit TearConstraint(const Ball& ball = {}) : ball_(ball) {}
  void operator()(Cloth& g, double /*t*/) const override {
    constraint_detail::for_each_violating(
        g, 0, g.node_slots(), [this](const Point& p) { return ball_.holds(p); },
        [&g](Node n) { g.remove_node(n); });
  }

  std::optional<Point> entry(const Point& from,
                             const Point& to) const override {
    return ball_.entry(from, to);
  }
  double thinnest() const override { return ball_.radius; }

 private:
  Ball ball_;
};

/** Any function or functor void(Cloth&, double) as a ZeroConstraint. */
template <typename C>
class FunctionConstraint : public ZeroConstraint {
 public:
  explicit FunctionConstraint(C c) : c_(std::move(c)) {}
  void operator()(Cloth& g, double t) const override { c_(g, t); }

 private:
  mutable C c_;  // a functor of the assignment need not be const
};

/** Several constraints, one after the other: where two disagree about a node,
 * the later one has its way. Copies share what they are made of. */
class CombinedConstraints final : public ZeroConstraint {
 public:
  using Constraints = std::vector<std::shared_ptr<const ZeroConstraint>>;
  /** @pre no pointer is null */
  explicit CombinedConstraints(Constraints constraints)
      : constraints_(std::move(constraints)) {}
  /** How many they are. */
  std::size_t size() const { return constraints_.size(); }

  void operator()(Cloth& g, double t) const override {
    for (const auto& c : constraints_) (*c)(g, t);
  }
  bool by_node() const override {
    return std::ranges::all_of(constraints_,
                               [](const auto& c) { return c->by_node(); });
  }
  void mend(Cloth& g, double t, unsigned first, unsigned last) const override {
    for (const auto& c : constraints_) c->mend(g, t, first, last);
  }
  void each_held(const Cloth& g, const NodeVisitor& use) const override {
    for (const auto& c : constraints_) c->each_held(g, use);
  }

  std::optional<Point> entry(const Point& from,
                             const Point& to) const override {
    std::optional<Point> first;
    for (const auto& c : constraints_)
      if (auto place = c->entry(from, to);
          place && (!first || norm(*place - from) < norm(*first - from)))
        first = place;
    return first;
  }
  double thinnest() const override {
    double least = std::numeric_limits<double>::infinity();
    for (const auto& c : constraints_) least = std::min(least, c->thinnest());
    return least;
  }

 private:
  Constraints constraints_;
};

/** Any number of constraints in this order: children of ZeroConstraint, and
 * functions of their signature. Each is copied, so temporaries are fine. */
template <typename... Cs>
CombinedConstraints make_combined_constraints(Cs... constraints) {
  return CombinedConstraints(CombinedConstraints::Constraints{
      cloth_detail::shared_as<ZeroConstraint, FunctionConstraint>(
          std::move(constraints))...});
}

/** Another constraint, and an eye on the paths of the nodes: one that would go
 * through an obstacle from one call to the next is put on its surface first,
 * and counted. While nobody watches, this is the other constraint. */
class WatchedConstraint final : public ZeroConstraint {
 public:
  /** A node on its way through an obstacle. */
  struct Missed {
    unsigned node;  ///< its index
    double length;  ///< of its way since the last call [m]
  };

  explicit WatchedConstraint(CombinedConstraints c) : c_(std::move(c)) {}

  /** Watch from the state of @a g on, or no more. O(N) if @a on, then and in
   * each call. */
  void watch(const Cloth& g, bool on) {
    before_.clear();
    if (on) remember(g);
  }
  /** How many were caught, and the first of them.  @pre of first: count > 0 */
  long long count() const { return count_; }
  const Missed& first() const { return first_; }

  void operator()(Cloth& g, double t) const override {
    if (before_.empty()) return c_(g, t);
    for (Node n : g.nodes()) {
      if (n.id() >= before_.size()) continue;  // added since
      auto place = c_.entry(before_[n.id()], n.position());
      if (!place) continue;
      if (count_++ == 0)
        first_ = {n.index(), norm(n.position() - before_[n.id()])};
      n.position() = *place;
    }
    c_(g, t);
    remember(g);
  }
  bool by_node() const override { return before_.empty() && c_.by_node(); }
  void mend(Cloth& g, double t, unsigned first, unsigned last) const override {
    c_.mend(g, t, first, last);
  }
  void each_held(const Cloth& g, const NodeVisitor& use) const override {
    c_.each_held(g, use);
  }
  std::optional<Point> entry(const Point& from,
                             const Point& to) const override {
    return c_.entry(from, to);
  }
  double thinnest() const override { return c_.thinnest(); }

 private:
  CombinedConstraints c_;
  mutable std::vector<Point> before_;  // by node id; empty: nobody watches
  mutable long long count_ = 0;
  mutable Missed first_ = {};

  void remember(const Cloth& g) const {
    auto x = g.positions();
    before_.assign(x.begin(), x.end());
  }
};
