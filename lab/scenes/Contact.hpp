#pragma once
/** @file Contact.hpp
 * The constraints that scenes ask for beyond those of the assignment: walls and
 * balls that may move and rub, pins that move, and edges that break.
 *
 * Where a node meets a moving obstacle, only their relative velocity counts:
 * contact::touch(). One difference to the assignment's plane and sphere, which
 * take all of the normal velocity: here a node on its way out keeps it. */
#include <cassert>
#include <cmath>
#include <optional>
#include <vector>

#include "lab/fast/ConstraintPlan.hpp"
#include "lab/scenes/Model.hpp"

namespace lab {

namespace contact {

/** The change of a velocity [m/s] in a contact, if it is @a u relative to what
 * is touched. The inward part of u is taken away, and with it, by Coulomb's law
 * for impulses, up to @a friction times as much of the part along the surface,
 * but no more than there is of it. Nothing is ever added, so the energy of the
 * relative motion does not grow. Source: R. Bridson, R. Fedkiw, J. Anderson,
 * ACM Trans. Graph. 21 (2002) 594, doi:10.1145/566654.566623
 * @param out of length 1, the way out   @param friction coefficient, >= 0 */
Point kick(const Point& u, const Point& out, double friction);

/** Node @a n lies @a depth [m] inside of what moves at @a velocity [m/s]: put
 * it back to the surface, and let kick() change its velocity.
 *
 * It should have had that kick when it came to the surface: depth/in ago, in =
 * the speed at which it went in. So it also goes back along the surface by the
 * kick times that time, which is what it slid too far, and never more than
 * friction times depth. Without this a node at rest on a slope of angle a
 * creeps by g sin a dt^2 in each step; with it, it stands.
 * @return the work done on the node by what moves [J]: impulse . velocity */
double touch(Node n, double depth, const Point& out, const Point& velocity,
             double friction);

}  // namespace contact

/** Moves nodes along a line: at time t they are where they were when the pin
 * was made + way(t), with the velocity of that. Methods ask where at each of
 * their stages. Removing a pinned node is fine: the pin goes on with the
 * others.  Complexity of a call: O(pins). */
class MovingPinConstraint : public NodewiseConstraint {
 public:
  /** The nodes of @a pins move.  @pre all in one graph */
  MovingPinConstraint(const PinConstraint& pins, const Motion& motion)
      : MovingPinConstraint(pins.pins(), motion) {}
  /** The same by nodes and their places at t = 0. */
  MovingPinConstraint(const std::vector<PinConstraint::Pin>& pins,
                      const Motion& motion)
      : pins_(pins), motion_(motion) {}
  void project(Cloth& g, double t, unsigned first,
               unsigned last) const override;
  void project_flat(FlatCloth& c, Cloth& g, double t, unsigned first,
                    unsigned last) const override;
  void each_place(const Cloth& g, double t,
                  const PlaceVisitor& use) const override;
  double next_velocity_jump(double t) const override;
  bool is_at_rest(double t) const override {
    return motion_.velocity_at(t) == Point() &&
           next_velocity_jump(t) == HUGE_VAL;
  }

 private:
  PinnedNodes pins_;
  Motion motion_;

  Place moved(double t) const {
    return {motion_.way(t), motion_.velocity_at(t)};
  }
};

/** What nodes touch, and what may move and rub: the part that a wall and a ball
 * share. While it moves it adds up its work, node by node in one order. */
class Touchable : public NodewiseConstraint {
 public:
  bool nodewise() const override { return motion_.velocity == Point(); }
  bool is_at_rest(double /*t*/) const override { return nodewise(); }
  Exchange exchange() const override { return {work_, 0}; }
  void archive(Archive& a) const override {
    a(work_).require(std::isfinite(work_));
  }

 protected:
  /** @param friction coefficient, >= 0 */
  Touchable(const Motion& motion, double friction)
      : motion_(motion), friction_(friction) {
    assert(friction >= 0);
  }
  /** contact::touch(), and count the work. */
  void touch(Node n, double depth, const Point& out,
             const Point& velocity) const;

  Motion motion_;

 private:
  double friction_;
  mutable double work_ = 0;  // [J]
};

/** A half space that no node enters, bounded by a plane.
 * @post no node lies below the plane by more than round-off; without friction,
 * one that did lies at the nearest point of it. Velocities: contact::touch().
 */
class WallConstraint : public Touchable {
 public:
  /** @param at a point of the plane at t = 0 [m]
   * @param normal out of the wall, of any length > 0
   * @param friction coefficient, >= 0 */
  WallConstraint(const Point& at, const Point& normal,
                 const Motion& motion = {}, double friction = 0);
  void project(Cloth& g, double t, unsigned first,
               unsigned last) const override;
  bool idle(const FlatCloth& c, double t, unsigned first,
            unsigned last) const override;

 private:
  Point at_, normal_;
};

/** A solid ball that may move. @post no node lies inside by more than
 * round-off; without friction, one that did lies at the nearest point of the
 * surface (the top one, if it was at the center). Velocities:
 * contact::touch().
 *
 * A node that tunnels through a ball within a step is caught only while the
 * ball is at rest. Whoever lets it move keeps steps so short that the speeds
 * of ball and nodes, times dt, stay well below the radius. */
class BallConstraint : public Touchable {
 public:
  /** @param ball at t = 0   @param friction coefficient, >= 0 */
  explicit BallConstraint(const Ball& ball, const Motion& motion = {},
                          double friction = 0);
  /** Of the ball, while it moves [m/s]. */
  double speed() const { return norm(motion_.velocity); }

  void project(Cloth& g, double t, unsigned first,
               unsigned last) const override;
  bool idle(const FlatCloth& c, double t, unsigned first,
            unsigned last) const override;
  std::optional<Point> first_hit(const Point& from,
                                 const Point& to) const override;
  double thinnest() const override;

 private:
  Ball ball_;
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
  void operator()(Cloth& g, double t) const override;
  bool is_at_rest(double /*t*/) const override { return true; }

 private:
  double most_;
};

}  // namespace lab
