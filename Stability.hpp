#pragma once
/** @file Stability.hpp
 * Tells when a run failed: DivergenceGuard. */
#include <cmath>
#include <sstream>
#include <string>
#include <vector>

#include "CME212/BoundingBox.hpp"
#include "Cloth.hpp"

/** Watches the energy of a run and keeps the last state that was good.
 *
 * Gravity and springs can't raise the energy of a cloth; a method that is
 * unstable does so without bound. A state is good while it is finite and
 *   kinetic + gravitational energy  <=  total energy at the start + 3 S,
 * S = kinetic and elastic energy at the start + total weight times the
 * diagonal of the cloth + the energy of all springs stretched by 10 %. The
 * margin is for what a stable method does: its energy swings, and a constraint
 * that moves a node stretches springs. Elastic energy is added in every tenth
 * check only, so that most of them are one sweep over the nodes. */
class DivergenceGuard {
 public:
  /** @param g The cloth at the start   @param gravity [m/s^2] */
  DivergenceGuard(const Cloth& g, double gravity) : gravity_(gravity) {
    CME212::BoundingBox box;
    for (Node n : g.nodes()) box |= n.position();
    if (!box.empty()) top_ = box.max().z;
    double size = box.diagonal() > 0 ? box.diagonal() : 1;
    double start = kinetic_energy(g) + elastic_energy(g);
    double scale = start + total_mass(g) * std::abs(gravity) * size;
    for (Edge e : g.edges())
      scale += spring_energy(1.1 * e.value().L, e.value());
    limit_ = start + heights_energy(g) + 3 * scale;
    keep(g);
  }

  /** True if the state of @a g is good; then it is kept.  O(N) */
  bool accept(const Cloth& g) {
    double energy = kinetic_energy(g) + heights_energy(g);
    if (++checks_ % 10 == 0) energy += elastic_energy(g);
    if (!(energy <= limit_)) return false;  // also when it is NaN
    keep(g);
    return true;
  }

  /** Give @a g the positions and velocities of the last good state.
   * @pre no node was added since; nodes removed since stay removed */
  void restore(Cloth& g) const {
    for (Node n : g.nodes()) {
      n.position() = position_[n.id()];
      n.value() = value_[n.id()];
    }
  }

  /** Where the state of @a g is worst: the first node that is not finite, or
   * else the fastest one, and the most stretched spring there. */
  std::string worst(const Cloth& g) const {
    Node at;
    double highest = -1;
    for (Node n : g.nodes()) {
      double speed = norm(n.value().vel);
      if (!std::isfinite(speed + norm(n.position()))) speed = HUGE_VAL;
      if (speed > highest) highest = speed, at = n;
    }
    if (!g.has_node(at)) return "no node is left";
    std::ostringstream out;
    out << "node " << at.index();
    if (std::isfinite(highest))
      out << " moves at " << highest << " m/s";
    else
      out << " has a position or a velocity that is not finite";
    Edge spring;
    double longest = -1;
    for (Edge e : at.edges())
      if (double l = e.length(); !(l <= longest)) longest = l, spring = e;
    if (g.has_edge(spring)) {
      out << ", its spring to node " << spring.node2().index() << " is ";
      if (std::isfinite(longest))
        out << longest << " m long (at rest " << spring.value().L << " m)";
      else
        out << "beyond all bounds";
    }
    return out.str();
  }

 private:
  double gravity_, top_ = 0, limit_ = 0;
  long checks_ = 0;
  std::vector<Point> position_;
  std::vector<NodeData> value_;

  /** Gravitational energy [J], zero at the top of the cloth at the start, so
   * that removing a node that hangs below takes little energy away. */
  double heights_energy(const Cloth& g) const {
    return gravitational_energy(g, gravity_) - total_mass(g) * gravity_ * top_;
  }
  void keep(const Cloth& g) {
    auto x = g.positions();
    auto v = g.node_values();
    position_.assign(x.begin(), x.end());
    value_.assign(v.begin(), v.end());
  }
};
