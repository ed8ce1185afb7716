#pragma once
/** @file Constraint.hpp
 * What a cloth must not do. A constraint is anything that can be called as
 * void(Cloth& g, double t): it mends the nodes that violate it at time t [s].
 * Steps call it after the positions moved and before the forces are taken. */
#include <concepts>
#include <functional>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "Cloth.hpp"

using NodeVisitor = std::function<void(Node)>;

/** No constraint, and the base of all constraints (section 6.2). */
class ZeroConstraint {
 public:
  virtual ~ZeroConstraint() = default;

  /** Mend @a g. Twice equals once, to round-off.  O(N) unless it says less */
  virtual void operator()(Cloth& /*g*/, double /*t*/) const {}

  /** Call @a use(node) for each node of @a g that the constraint holds still:
   * it stays where it is, and its velocity is 0. Steps need to know, since a
   * force goes on pulling at it. */
  virtual void each_held(const Cloth& /*g*/, const NodeVisitor& /*use*/) const {
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

/** Holds nodes where they were when the pin was made.
 * @post at each call: their positions are those, and their velocities 0.
 * Removing a pinned node is fine: the pin goes on with the others.
 * Complexity of a call: O(pins). */
class PinConstraint : public ZeroConstraint {
 public:
  /** Pin the nodes that lie exactly at one of @a places [m].  O(N places) */
  explicit PinConstraint(const Cloth& g,
                         std::span<const Point> places = corners) {
    for (Node n : g.nodes())
      for (const Point& place : places)
        if (n.position() == place) pins_.push_back({n, place});
  }
  /** Pin @a nodes where they are now.  @pre all in one graph */
  explicit PinConstraint(std::span<const Node> nodes) {
    for (Node n : nodes) pins_.push_back({n, n.position()});
  }

  void operator()(Cloth& g, double /*t*/) const override {
    for (auto [n, place] : pins_)
      if (g.has_node(n)) {
        n.position() = place;
        n.value().vel = Point();
      }
  }
  void each_held(const Cloth& g, const NodeVisitor& use) const override {
    for (const Pin& pin : pins_)
      if (g.has_node(pin.node)) use(pin.node);
  }

 private:
  struct Pin {
    Node node;
    Point place;
  };
  std::vector<Pin> pins_;
};

/** A floor. @post no node lies below z; one that did lies on it, and does not
 * move along z. */
class PlaneConstraint : public ZeroConstraint {
 public:
  /** @param z Height of the floor [m] */
  explicit PlaneConstraint(double z = -0.75) : z_(z) {}
  double height() const { return z_; }
  void operator()(Cloth& g, double /*t*/) const override {
    for (Node n : g.nodes())
      if (n.position().z < z_) {
        n.position().z = z_;
        n.value().vel.z = 0;
      }
  }

 private:
  double z_;
};

/** A ball: its center and radius [m]. */
struct Ball {
  Point center = Point(0.5, 0.5, -0.5);
  double radius = 0.15;
  /** Strictly inside? */
  bool holds(const Point& p) const { return norm(p - center) < radius; }
};

/** A solid ball. @post no node lies inside by more than round-off; one that
 * did lies at the nearest point of the surface (the top one, if it was at the
 * center) and does not move along the normal there. */
class SphereConstraint : public ZeroConstraint {
 public:
  explicit SphereConstraint(const Ball& ball = {}) : ball_(ball) {}
  void operator()(Cloth& g, double /*t*/) const override {
    for (Node n : g.nodes()) {
      if (!ball_.holds(n.position())) continue;
      Point out = n.position() - ball_.center;
      double distance = norm(out);
      Point normal = distance > 0 ? out / distance : Point(0, 0, 1);
      n.position() = ball_.center + ball_.radius * normal;
      n.value().vel -= dot(n.value().vel, normal) * normal;
    }
  }

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
    for (auto it = g.node_begin(); it != g.node_end();)
      if (ball_.holds((*it).position()))
        it = g.remove_node(it);  // now at the node that filled the hole
      else
        ++it;
  }

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
class CombinedConstraints : public ZeroConstraint {
 public:
  using Constraints = std::vector<std::shared_ptr<const ZeroConstraint>>;
  /** @pre no pointer is null */
  explicit CombinedConstraints(Constraints constraints)
      : constraints_(std::move(constraints)) {}

  void operator()(Cloth& g, double t) const override {
    for (const auto& c : constraints_) (*c)(g, t);
  }
  void each_held(const Cloth& g, const NodeVisitor& use) const override {
    for (const auto& c : constraints_) c->each_held(g, use);
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
