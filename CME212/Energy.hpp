#pragma once
/** @file Energy.hpp
 * Energies of a cloth in any graph, whose nodes' values have mass [kg] and vel
 * [m/s], and the energy at which a run has diverged. */
#include <algorithm>
#include <cmath>
#include <vector>

#include "CME212/AnyGraph.hpp"
#include "CME212/Point.hpp"

namespace CME212 {

struct Energies {
  double kinetic = 0, elastic = 0, height = 0;  ///< [J]
  double total() const { return kinetic + elastic + height; }
};

/** Kinetic and gravitational energy of @a g; elastic is 0.  O(N)
 * @param gravity [m/s^2]   @param held held(position): this node does not move,
 * even if its velocity is not 0, so its kinetic energy does not count */
template <typename G, typename Held>
Energies motion_energy(const G& g, double gravity, Held held) {
  Energies e;
  for (auto n : CME212::nodes(g)) {
    e.height += n.value().mass * gravity * n.position().z;
    if (!held(n.position()))
      e.kinetic += n.value().mass * normSq(n.value().vel) / 2;
  }
  return e;
}

/** The energy of all springs of @a g [J].  O(edges)
 * @param spring spring(Edge) has K [N/m] and L [m] */
template <typename G, typename Spring>
double elastic_energy(const G& g, Spring spring) {
  double sum = 0;
  for (auto e : CME212::edges(g)) {
    const auto s = spring(e);
    const double stretch = CME212::length(e) - s.L;
    sum += s.K * stretch * stretch / 2;
  }
  return sum;
}

/** A step [s] with which small oscillations about any shape are stable: at most
 * 2/omega, as omega^2 is at most twice the sum of K at a node, over its mass.
 * O(N + edges)
 * @param spring spring(Edge) has K [N/m] */
template <typename G, typename Spring>
double stable_step(const G& g, Spring spring) {
  std::vector<double> sums(g.num_nodes());  // of K, by index
  for (auto e : CME212::edges(g))
    for (auto end : {e.node1(), e.node2()}) sums[end.index()] += spring(e).K;
  double most = 0;
  for (auto n : CME212::nodes(g))
    most = std::max(most, 2 * sums[n.index()] / n.value().mass);
  return 2 / std::sqrt(most);
}

/** The motion_energy() [J] above which a run of @a g from rest has diverged.
 * Its springs hold no energy at first, so all other energy does not grow. If it
 * does, by 100 times weight times size, that is divergence. (In a free fall the
 * velocity is one step ahead of the position, hence the last term.)
 * @param start that of @a g, which has a node   @param dt, t_end [s] */
template <typename G>
double divergence_energy(const G& g, double start, double gravity, double dt,
                         double t_end) {
  for (auto n : CME212::nodes(g))
    start += 100 * n.value().mass * gravity *
             (norm(n.position() - g.node(0).position()) + gravity * dt * t_end);
  return start;
}

}  // namespace CME212
