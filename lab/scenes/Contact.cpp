#include "lab/scenes/Contact.hpp"

#include <algorithm>
#include <limits>
#include "lab/fast/Energy.hpp"
#include "lab/fast/GraphArrays.hpp"

namespace lab {

namespace contact {

Point kick(const Point& u, const Point& out, double friction) {
  const double in = -dot(u, out);
  if (!(in > 0)) return Point();  // it moves outwards
  const Point along = u + in * out;
  const double slide = norm(along), brake = std::min(friction * in, slide);
  return in * out + (slide > 0 ? along * (-brake / slide) : Point());
}

double touch(Node n, double depth, const Point& out, const Point& velocity,
             double friction) {
  const Point change = kick(n.value().vel - velocity, out, friction);
  const double in = dot(change, out);
  n.position() += depth * out;
  n.value().vel += change;
  if (in > std::numeric_limits<double>::min())
    n.position() += depth * ((change - in * out) / in);
  return n.value().mass * dot(change, velocity);
}

}  // namespace contact

// ------------------------------------------------------------------ Touchable

void Touchable::touch(Node n, double depth, const Point& out,
                      const Point& velocity) const {
  if (n.id() < held_.size() && held_[n.id()]) return;
  const double work = contact::touch(n, depth, out, velocity, friction_);
  if (!traits().nodewise)
    exchange_.work += work;  // else several threads may be here
}

// ----------------------------------------------------------------------- Wall

WallConstraint::WallConstraint(const Point& at, const Point& normal,
                               const Motion& motion, double friction)
    : Touchable(Zone::behind(at, normal / norm(normal)), {}, motion, friction),
      at_(at),
      normal_(normal / norm(normal)) {
  assert(norm(normal) > 0);
}

void WallConstraint::project(Cloth& g, double t, unsigned first,
                             unsigned last) const {
  const Motion& motion = traits().motion;
  const Point at = at_ + motion.way(t), velocity = motion.velocity_at(t);
  auto height = [&](const Point& p) { return dot(p - at, normal_); };
  for_each_violating(
      g, first, last, [&](const Point& p) { return height(p) < 0; },
      [&](Node n) { touch(n, -height(n.position()), normal_, velocity); });
}

// ----------------------------------------------------------------------- Ball

BallConstraint::BallConstraint(const Ball& ball, const Motion& motion,
                               double friction)
    : Touchable(Zone::inside(ball),
                motion.velocity == Point() ? std::optional(ball) : std::nullopt,
                motion, friction),
      ball_(ball) {}

void BallConstraint::project(Cloth& g, double t, unsigned first,
                             unsigned last) const {
  const Motion& motion = traits().motion;
  const Ball ball = {ball_.center + motion.way(t), ball_.radius};
  const Point velocity = motion.velocity_at(t);
  for_each_violating(
      g, first, last, [&](const Point& p) { return ball.holds(p); },
      [&](Node n) {
        const Point from_center = n.position() - ball.center;
        const double distance = norm(from_center);
        const Point out =
            distance > 0 ? from_center / distance : Point(0, 0, 1);
        touch(n, ball.radius - distance, out, velocity);
      });
}

// --------------------------------------------------------------------- Strain

void StrainConstraint::operator()(Cloth& g, double /*t*/) const {
  const auto x = arrays(g).positions();
  for (unsigned e = 0; e < arrays(g).edge_slots(); ++e) {
    const auto [i, j] = arrays(g).edge_ends()[e];
    const double longest = most_ * arrays(g).edge_values()[e].L;
    // A slot that is not in use has the length 0.
    if (!(normSq(x[j] - x[i]) > longest * longest)) continue;
    g.remove_edge(arrays(g).edge_with_id(e));
  }
}

}  // namespace lab
