#include "lab/stability/EnergyBalance.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <utility>

#include "lab/fast/Energy.hpp"

namespace lab {

Energies energies(const Cloth& g, double gravity, const EnergyFlow& flow) {
  Energies e = {kinetic_energy(g), elastic_energy(g),
                gravitational_energy(g, gravity)};
  Point carrier = flow.carried;
  if (flow.loose) {
    Point momentum;
    double mass = 0;
    for (Node n : g.nodes()) {
      momentum += n.value().mass * n.value().vel;
      mass += n.value().mass;
    }
    if (mass > 0) carrier = momentum / mass;
    e.fall_power = std::abs(gravity * momentum.z);
  }
  e.relative = e.kinetic;
  if (carrier == Point()) return e;
  e.relative = 0;
  for (Node n : g.nodes())
    e.relative += 0.5 * n.value().mass * normSq(n.value().vel - carrier);
  return e;
}

EnergyBalance::EnergyBalance(const Cloth& g, double t, CombinedForces force,
                             const ConstraintPlan& constraint, double gravity)
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
  flow_.removed += gravity_ * (now.moment - seen_.moment);
  flow_.torn += now.torn - seen_.torn;
  flow_.contact += now.taken - seen_.taken;
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

// ---------------------------------------------------------------------- Watch

EnergyWatch::EnergyWatch(const Energies& e, const EnergyFlow& flow, double dt,
                         double floor, double round_off, bool ahead)
    : dt_(dt),
      floor_(floor),
      round_off_(round_off),
      ahead_(ahead),
      seen_(e, flow, dt),
      start_(seen_.last),
      contact_(flow.contact) {}

void EnergyWatch::look(const Energies& e, const EnergyFlow& flow) {
  const double b = balance(e, flow) + flow.torn;
  torn_ = flow.torn;
  constexpr double impact = 1.1;  // in its step nodes are moved, too
  taken_ += std::max(
      0., std::min(seen_.last - b, impact * (flow.contact - contact_)));
  contact_ = flow.contact;
  seen_.measure(e, dt_);
  seen_.add(b);
  passed_ = std::max(passed_, std::abs(flow.work) + std::abs(flow.drag));
  round_off_ = std::max(round_off_, e.round_off());
  kinetic_ = std::max(kinetic_, e.kinetic);
  ++looks_;
}

double EnergyWatch::share() const {
  const bool counts = seen_.scale > passed_ &&
                      std::abs(off()) > seen_.fall + floor_ + round_off_;
  return counts ? off() / seen_.scale : 0;
}

/** Tolerated in addition [J]: round-off; 2 % of drag and work. Where velocities
 * are one step ahead of positions, fall() and, after n looks, one of n of the
 * largest internal energy: n steps after the start from rest, the kinetic
 * energy is by that share too large. */
double EnergyWatch::slack() const {
  const double early = ahead_ ? fall() + seen_.scale / std::max(looks_, 1) : 0;
  return round_off_ + 0.02 * passed_ + early;
}

double EnergyWatch::tolerance() const {
  return energy_tolerance * seen_.scale + slack() + lift();
}

bool EnergyWatch::is_off() const {
  const double most = energy_tolerance / 2 * seen_.scale + slack();
  return off() > most + lift() || -off() > most + fall();
}

std::string EnergyWatch::off_text() const {
  std::ostringstream out;
  out.precision(3);
  out << "energy off by " << off() << " J";
  if (share() != 0)
    out << " (" << CME212::percent(share())
        << " of the largest internal energy)";
  return out.str();
}

std::string EnergyWatch::gain_text() const {
  return "an error of the method has added " + CME212::two_digits(gain()) +
         " J of energy, more than the " + CME212::two_digits(tolerance()) +
         " J that --dt auto tolerates: this is not the motion of the scene";
}

void EnergyWatch::archive(Archive& a) {
  a(seen_)(start_)(round_off_)(taken_)(torn_)(passed_)(kinetic_)(contact_);
  a(looks_);
  a.require(std::isfinite(start_ + round_off_ + taken_ + torn_ + passed_ +
                          kinetic_ + contact_) &&
            looks_ >= 0);
}

}  // namespace lab
