#pragma once
/** @file Obstacle.hpp
 * The constraints that scenes ask for beyond those of the assignment: walls and
 * balls that may move and rub, pins that move, and edges that break.
 *
 * Where a node meets an obstacle that moves, only their relative velocity
 * counts (contact::touch()). One difference to the assignment's
 * plane and sphere, which take all of the normal velocity: here a node that is
 * on its way out keeps it. */
#include <algorithm>
#include <cassert>
#include <limits>
#include <optional>
#include <vector>

#include "lab/fast/ConstraintPlan.hpp"

namespace lab {

/** A way along a line: what moves so is at its start + way(t). */
struct Motion {
  Point velocity;  ///< [m/s], from t = 0 on
  /** Stands still from then on [s], >= 0. */
  double until = std::numeric_limits<double>::infinity();

  /** [m] at time @a t [s] */
  Point way(double t) const { return std::clamp(t, 0.0, until) * velocity; }
  /** [m/s]; 0 while it stands */
  Point velocity_at(double t) const {
    return 0 <= t && t < until ? velocity : Point();
  }
};

namespace contact {

/** How a contact changes a velocity [m/s] that is @a u relative to what is
 * touched. The part of u that goes in is taken away, and with it, by Coulomb's
 * law for impulses, up to @a friction times as much of the part along the
 * surface, but no more than there is of it. Nothing is ever added, so the
 * energy of the relative motion does not grow. Source: R. Bridson, R. Fedkiw,
 * J. Anderson, ACM Trans. Graph. 21 (2002) 594.
 * @param out of length 1, the way out   @param friction coefficient, >= 0 */
inline Point kick(const Point& u, const Point& out, double friction) {
  const double in = -dot(u, out);
  if (!(in > 0)) return Point();  // it is about to leave
  const Point along = u + in * out;
  const double slide = norm(along), brake = std::min(friction * in, slide);
  return in * out + (slide > 0 ? along * (-brake / slide) : Point());
}

/** Node @a n is by @a depth [m] inside of what moves at @a velocity [m/s]: put
 * it back to the surface, and let kick() change its velocity.
 *
 * It should have had that kick when it came to the surface: depth/in ago if in
 * is the speed at which it went in. So it also goes back along the surface by
 * the kick times that, which is what it slid too far, and never more than
 * friction times depth. Without this a node at rest on a slope of angle a
 * creeps by g sin a dt^2 in each step; with it, it stands. */
inline void touch(Node n, double depth, const Point& out, const Point& velocity,
                  double friction) {
  const Point change = kick(n.value().vel - velocity, out, friction);
  const double in = dot(change, out);
  n.position() += depth * out;
  n.value().vel += change;
  if (in > std::numeric_limits<Real>::min())
    n.position() += depth * ((change - in * out) / in);
}

}  // namespace contact

/** Moves nodes along: at time t they are where they were when the pin was made
 * + way(t). Steps see a held node: between two calls it stands, and the call
 * moves it. So its velocity is 0, and to its neighbors it comes in jumps of
 * dt times its speed, which should be much less than an edge is long.
 * Removing a pinned node is fine: the pin goes on with the others.
 * Complexity of a call: O(pins). */
class MovingPinConstraint : public NodewiseConstraint {
 public:
  /** The nodes of @a pins move.  @pre all in one graph */
  MovingPinConstraint(const PinConstraint& pins, const Motion& motion)
      : pins_(pins.pins()), motion_(motion) {}
  void project(Cloth& g, double t, unsigned first,
               unsigned last) const override {
    pins_.project(g, motion_.way(t), first, last);
  }
  void each_held(const Cloth& g, const NodeVisitor& use) const override {
    pins_.each_held(g, use);
  }

 private:
  PinnedNodes pins_;
  Motion motion_;
};

/** A half space that no node enters, bounded by a plane.
 * @post no node lies below the plane by more than round-off; without friction,
 * one that did lies at the nearest point of it. As to velocities, see
 * contact::touch(). */
class WallConstraint : public NodewiseConstraint {
 public:
  /** @param at a point of the plane at t = 0 [m]
   * @param normal out of the wall, of any length > 0
   * @param friction coefficient, >= 0 */
  WallConstraint(const Point& at, const Point& normal,
                 const Motion& motion = {}, double friction = 0)
      : at_(at),
        normal_(normal / norm(normal)),
        motion_(motion),
        friction_(friction) {
    assert(norm(normal) > 0 && friction >= 0);
  }

  void project(Cloth& g, double t, unsigned first,
               unsigned last) const override {
    using namespace contact;
    const Point at = at_ + motion_.way(t), velocity = motion_.velocity_at(t);
    auto height = [&](const Point& p) { return dot(p - at, normal_); };
    for_each_violating(
        g, first, last, [&](const Point& p) { return height(p) < 0; },
        [&](Node n) {
          touch(n, -height(n.position()), normal_, velocity, friction_);
        });
  }

 private:
  Point at_, normal_;
  Motion motion_;
  double friction_;
};

/** A solid ball that may move. @post no node lies inside by more than
 * round-off; without friction, one that did lies at the nearest point of the
 * surface (the top one, if it was at the center). As to velocities, see
 * contact::touch().
 *
 * A node that passes through a ball within a step is caught while the ball is
 * at rest only. Who lets it move keeps steps so short that speed() + that of
 * the nodes, times dt, stays well below the radius. */
class BallConstraint : public NodewiseConstraint {
 public:
  /** @param ball at t = 0   @param friction coefficient, >= 0 */
  explicit BallConstraint(const Ball& ball, const Motion& motion = {},
                          double friction = 0)
      : ball_(ball), motion_(motion), friction_(friction) {
    assert(friction >= 0);
  }
  /** Of the ball, while it moves [m/s]. */
  double speed() const { return norm(motion_.velocity); }

  void project(Cloth& g, double t, unsigned first,
               unsigned last) const override {
    using namespace contact;
    const Ball ball = {ball_.center + motion_.way(t), ball_.radius};
    const Point velocity = motion_.velocity_at(t);
    for_each_violating(
        g, first, last, [&](const Point& p) { return ball.holds(p); },
        [&](Node n) {
          const Point from_center = n.position() - ball.center;
          const double distance = norm(from_center);
          const Point out =
              distance > 0 ? from_center / distance : Point(0, 0, 1);
          touch(n, ball.radius - distance, out, velocity, friction_);
        });
  }

  std::optional<Point> first_hit(const Point& from,
                                 const Point& to) const override {
    return speed() > 0 ? std::nullopt : lab::first_hit(ball_, from, to);
  }
  double thinnest() const override {
    return speed() > 0 ? SweptConstraint::thinnest() : ball_.radius;
  }

 private:
  Ball ball_;
  Motion motion_;
  double friction_;
};

/** Edges that break. @post no edge is longer than (1 + limit) times its rest
 * length L. Nodes stay, also those without an edge: what hung on them falls.
 * Invalidates: as Graph::remove_edge(), for each edge removed.
 * Complexity: O(edges); the first removal as that of the graph. */
class StrainConstraint : public SweptConstraint {
 public:
  /** @param limit of the strain (length - L)/L, >= 0 */
  explicit StrainConstraint(double limit) : most_(1 + limit) {
    assert(limit >= 0);
  }

  void operator()(Cloth& g, double /*t*/) const override {
    const auto x = g.positions();
    for (unsigned e = 0; e < g.edge_slots(); ++e) {
      const auto [i, j] = g.edge_ends()[e];
      const double longest = most_ * g.edge_values()[e].L;
      // A slot that is not in use has the length 0.
      if (normSq(x[j] - x[i]) > longest * longest)
        g.remove_edge(g.edge_with_id(e));
    }
  }

 private:
  double most_;
};

}  // namespace lab
