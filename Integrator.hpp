#pragma once
/** @file Integrator.hpp
 * Steps in time. Each takes the cloth from t to t + dt and returns t + dt. The
 * order within a step: positions, constraints, forces, velocities. */
#include <concepts>
#include <span>
#include <type_traits>
#include <vector>

#include "Cloth.hpp"
#include "Constraint.hpp"
#include "Force.hpp"

/** One step of symplectic Euler, as the assignment writes it down:
 *   x += dt v;   v += dt F(x, t) / m.
 * Nodes that lie exactly at a corner, (0,0,0) or (1,0,0), are skipped
 * (section 5.2): they do not move.
 * @param g  a graph whose node values have vel [m/s] and mass [kg]
 * @param t  time at the start of the step [s]   @param dt step [s]
 * @param force  Point(Node, double): the force [N] on a node at time t
 * @return t + dt
 * Complexity: a call of @a force for each node.
 * Order 1; bounded while dt omega < 2 for every frequency omega [1/s]. */
template <typename G, typename F>
double symp_euler_step(G& g, double t, double dt, F&& force) {
  for (auto n : g.nodes())
    if (!is_corner(n.position())) n.position() += dt * n.value().vel;
  for (auto n : g.nodes())
    if (!is_corner(n.position()))
      n.value().vel += (dt / n.value().mass) * force(n, t);
  return t + dt;
}

/** The same with a constraint (section 6.2), and no node is skipped:
 *   x += dt v;   constrain;   v += dt F(x, t) / m.
 * @param constraint  void(G&, double), called once; it may remove nodes */
template <typename G, typename F, typename C>
double symp_euler_step(G& g, double t, double dt, F&& force, C&& constraint) {
  for (auto n : g.nodes()) n.position() += dt * n.value().vel;
  constraint(g, t);
  for (auto n : g.nodes()) n.value().vel += (dt / n.value().mass) * force(n, t);
  stop_held(g, constraint);
  return t + dt;
}

/** Symplectic Euler again, for speed: one sweep over the cloth's arrays takes
 * all forces. Equal to symp_euler_step() to round-off.
 *
 * No allocation in a step, but for the first one and when the cloth grew. */
class SymplecticEuler {
 public:
  static constexpr int order = 1;     // test_integrator measures it
  static constexpr int sweeps = 1;    // force sweeps a step; counted there
  static constexpr double limit = 2;  // bounded while dt omega < limit

  /** As symp_euler_step(g, t, dt, force). */
  template <typename F>
  double operator()(Cloth& g, double t, double dt, F&& force) {
    drift<true>(g, dt);
    kick<true>(g, t, dt, force);
    return t + dt;
  }
  /** As symp_euler_step(g, t, dt, force, constraint). */
  template <typename F, typename C>
  double operator()(Cloth& g, double t, double dt, F&& force, C&& constraint) {
    drift<false>(g, dt);
    constraint(g, t);
    kick<false>(g, t, dt, force);
    stop_held(g, constraint);
    return t + dt;
  }

 private:
  std::vector<Point> force_;  // [N], by node id

  template <bool skip_corners>
  void drift(Cloth& g, double dt) {
    auto x = g.positions();
    auto node = g.node_values();
    for (unsigned i = 0; i < g.node_slots(); ++i)
      if (!skip_corners || !is_corner(x[i])) x[i] += dt * node[i].vel;
  }
  template <bool skip_corners, typename F>
  void kick(Cloth& g, double t, double dt, F& force) {
    force_.assign(g.node_slots(), Point());
    if constexpr (std::derived_from<std::remove_cvref_t<F>, ZeroForce>)
      force.add_to(g, t, force_);
    else
      for (Node n : g.nodes()) force_[n.id()] = force(n, t);
    auto x = g.positions();
    auto node = g.node_values();
    for (unsigned i = 0; i < g.node_slots(); ++i)
      if (g.node_in_use(i) && !(skip_corners && is_corner(x[i])))
        node[i].vel += (dt / node[i].mass) * force_[i];
  }
};
