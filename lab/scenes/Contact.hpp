#pragma once
/** @file Contact.hpp
 * The constraints of scenes beyond those of the assignment: walls and balls
 * with friction that may move, and edges that break.
 *
 * The assignment's plane and sphere remove all of a node's normal velocity;
 * walls and balls remove only the inward part, relative to the obstacle. */
#include <cassert>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "lab/fast/ConstraintPlan.hpp"
#include "lab/scenes/Model.hpp"

namespace lab {

namespace contact {

/** The change of a node's velocity [m/s] in a contact.  @param u its velocity
 * relative to the obstacle   @param out the outward unit normal
 * @param friction coefficient, >= 0
 * Removes the inward part of u and, by Coulomb's law for impulses, up to
 * @a friction times as much of the tangential part, at most all of it. So the
 * energy of the relative motion does not grow. Source: R. Bridson, R. Fedkiw,
 * J. Anderson, ACM Trans. Graph. 21 (2002) 594, doi:10.1145/566654.566623 */
Point kick(const Point& u, const Point& out, double friction);

/** Node @a n lies @a depth [m] inside an obstacle that moves at @a velocity
 * [m/s]: put it back to the surface, and change its velocity by kick().
 *
 * The contact began depth/in ago, where in is the inward speed. Had friction
 * acted since then, the node would have slid less: so it also moves along the
 * surface by the tangential kick times depth/in, at most friction times depth.
 * Without that, a node at rest on a slope of angle a would creep by
 * g sin a dt^2 in each step.
 * @return the obstacle's work on the node [J]: impulse . velocity */
double touch(Node n, double depth, const Point& out, const Point& velocity,
             double friction);

}  // namespace contact

/** The common part of wall and ball: an obstacle with friction that may move.
 * While it moves it adds up its work, node by node in a fixed order. */
class Touchable : public NodewiseConstraint {
 protected:
  /** @param zone at t = 0   @param obstacle if it is at rest
   * @param friction coefficient, >= 0 */
  Touchable(const Zone& zone, const std::optional<Ball>& obstacle,
            const Motion& motion, double friction)
      : NodewiseConstraint({.nodewise = motion.velocity == Point(),
                            .zone = zone,
                            .obstacle = obstacle,
                            .motion = motion}),
        friction_(friction) {
    assert(friction >= 0);
  }

 public:
  /** Do not act on nodes that are @a held, by id: pins put them back, so they
   * would get that energy in each step. */
  void leave(std::vector<bool> held) { held_ = std::move(held); }

 protected:
  /** contact::touch(), and count the work. */
  void touch(Node n, double depth, const Point& out,
             const Point& velocity) const;

 private:
  double friction_;
  std::vector<bool> held_;
};

/** A half space bounded by a plane, which no node enters.
 * @post no node lies below the plane by more than round-off; without friction,
 * a node that did is at its nearest point. Velocities: contact::touch(). */
class WallConstraint : public Touchable {
 public:
  /** @param at a point of the plane at t = 0 [m]
   * @param normal pointing out of the wall, of any length > 0
   * @param friction coefficient, >= 0 */
  WallConstraint(const Point& at, const Point& normal,
                 const Motion& motion = {}, double friction = 0);
  void project(Cloth& g, double t, unsigned first,
               unsigned last) const override;

 private:
  Point at_, normal_;
};

/** A solid ball that may move. @post no node lies inside by more than
 * round-off; without friction, a node that did is at the nearest point of the
 * surface (the top, if it was at the center). Velocities: contact::touch().
 *
 * Nodes that tunnel through the ball are found only if the ball is at rest. If
 * it moves, choose steps so short that the speeds of ball and nodes, times dt,
 * stay well below the radius. */
class BallConstraint : public Touchable {
 public:
  /** @param ball at t = 0   @param friction coefficient, >= 0 */
  explicit BallConstraint(const Ball& ball, const Motion& motion = {},
                          double friction = 0);
  /** The speed of the ball while it moves [m/s]. */
  double speed() const { return norm(traits().motion.velocity); }

  void project(Cloth& g, double t, unsigned first,
               unsigned last) const override;

 private:
  Ball ball_;
};

/** Removes overstretched edges. @post no edge is longer than (1 + limit) times
 * its rest length L. Nodes stay, even those without any edge left.
 * Invalidates: as Graph::remove_edge(), for each edge removed.
 * Complexity: O(edges); the first removal as that of the graph. */
class StrainConstraint : public SweptConstraint {
 public:
  /** @param limit of the strain (length - L)/L, >= 0 */
  explicit StrainConstraint(double limit) : most_(1 + limit) {
    assert(limit >= 0);
  }
  void operator()(Cloth& g, double t) const override;

 private:
  double most_;
};

}  // namespace lab
