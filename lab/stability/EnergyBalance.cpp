#include "lab/stability/EnergyBalance.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "lab/fast/Energy.hpp"

namespace lab {

Energies energies(const Cloth& g, const Potential& potential,
                  const EnergyFlow& flow) {
  Energies e = {kinetic_energy(g), potential.elastic_energy(g),
                potential.gravitational_energy(g)};
  Point carrier = flow.carried;
  if (flow.loose) {
    Point momentum;
    double mass = 0, power = 0;  // of the loads [W]
    for (Node n : g.nodes()) {
      power += dot(potential.load(n), n.value().vel);
      momentum += n.value().mass * n.value().vel;
      mass += n.value().mass;
    }
    if (mass > 0) carrier = momentum / mass;
    e.fall_power = std::abs(dot(potential.gravity.a, momentum) + power);
  }
  e.relative = e.kinetic;
  if (carrier == Point()) return e;
  e.relative = 0;
  for (Node n : g.nodes())
    e.relative += 0.5 * n.value().mass * normSq(n.value().vel - carrier);
  return e;
}

EnergyBalance::EnergyBalance(const Cloth& g, double t, CombinedForces force,
                             const ConstraintPlan& constraint,
                             const Gravity& gravity)
    : force_(std::move(force)), gravity_(gravity) {
  constraint.each_held(g, [this](Node n) { held_.push_back({n, {}, {}, {}}); });
  std::ranges::sort(held_, {}, &Held::node);
  // Two pins may hold one node.
  const auto same = [](const Held& a, const Held& b) {
    return a.node == b.node;
  };
  held_.erase(std::unique(held_.begin(), held_.end(), same), held_.end());
  resume(g, t, constraint, {});
}

void EnergyBalance::follow(const Cloth& g, double t,
                           const ConstraintPlan& constraint) {
  const Exchange now = constraint.exchange();
  flow_.work += now.work - seen_.work;
  flow_.removed -= dot(gravity_.a, now.moment - seen_.moment);
  seen_ = now;
  const double step = t - time_;
  const bool same = std::abs(step - step_) < 1e-9 * step;
  time_ = t, step_ = step;
  for (Held& h : held_) {
    if (!g.has_node(h.node)) continue;
    const Point x = h.node.position(), v = h.node.value().vel;
    const bool follows = std::exchange(h.follows, false) && same;
    if (x == h.place && v == h.velocity) continue;
    const Point f = force_(h.node, t), change = f - h.force;
    Point mean = 0.5 * (f + h.force);
    if (follows) mean -= (change - h.change) / 12;
    flow_.work += 0.5 * h.node.value().mass * (normSq(v) - normSq(h.velocity)) -
                  dot(mean, x - h.place);
    h = {h.node, x, v, f, change, true};
  }
  if (pull_ && g.has_node(pulled_.node)) {
    const Point before = pulled_.place, f = pulled_.force;
    watch(pulled_.node, pull_, t);
    flow_.work += 0.5 * dot(f + pulled_.force, pulled_.place - before);
  }
  find_carrier(g, t, constraint);
}

void EnergyBalance::watch(Node n, const ZeroForce* pull, double t) {
  pull_ = pull;
  pulled_.node = n;
  if (pull) pulled_.place = n.position(), pulled_.force = (*pull)(n, t);
}

void EnergyBalance::resume(const Cloth& g, double t,
                           const ConstraintPlan& constraint,
                           const EnergyFlow& flow) {
  flow_ = flow;
  seen_ = constraint.exchange();
  time_ = t, step_ = 0;
  for (Held& h : held_)
    if (g.has_node(h.node))
      h = {h.node, h.node.position(), h.node.value().vel, force_(h.node, t)};
  if (pull_ && g.has_node(pulled_.node)) watch(pulled_.node, pull_, t);
  find_carrier(g, t, constraint);
}

/** Takes the prescribed velocities: the initial velocity of a held node may
 * differ, and moves nothing. */
void EnergyBalance::find_carrier(const Cloth& g, double t,
                                 const ConstraintPlan& constraint) {
  Point sum;
  int count = 0;
  constraint.each_place(
      g, t, [&](Node, const Place& place) { sum += place.velocity, ++count; });
  flow_.loose = count == 0;
  flow_.carried = count > 0 ? sum / count : Point();
}

}  // namespace lab
