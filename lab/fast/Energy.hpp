#pragma once
/** @file Energy.hpp
 * Energies of a cloth, its mass, its center, and the stiffness of its springs.
 * Sums run over the graph's arrays, in the order of memory, in double: a sum of
 * a million floats would lose three digits. */
#include <algorithm>
#include <cmath>

#include "mass_spring.hpp"

namespace lab {

// -------------------------------------------------------------------- Springs

/** How the force between two nodes answers to their moving apart, u = x_j -
 * x_i: the force on i changes by B du, that on j by -B du, B = along n n^T +
 * across (I - n n^T), so B is the Hessian of the energy in u. */
struct Stiffness {
  Point direction;    ///< n, of length 1
  double along = 0;   ///< [N/m]
  double across = 0;  ///< [N/m]; may be negative
  /** B u [N].  @param u [m] */
  Point operator*(const Point& u) const {
    return across * u + ((along - across) * dot(direction, u)) * direction;
  }
};

/** The stiffness of a spring whose ends lie @a u [m] apart: K along it and
 * K (1 - L/l) across, negative while it is compressed. At l = 0, where no
 * direction is defined, K in all directions: that is the limit for L = 0, and
 * as no direction is ever stiffer than K, an upper bound for L > 0. */
inline Stiffness spring_stiffness(const Point& u, const EdgeData& s) {
  double l = norm(u);
  if (l == 0) return {Point(1, 0, 0), s.K, s.K};
  return {u / l, s.K, s.K * (1 - s.L / l)};
}

/** The energy [J] of a spring of length @a l [m]: K (l - L)^2 / 2. */
inline double spring_energy(double l, const EdgeData& s) {
  return 0.5 * s.K * (l - s.L) * (l - s.L);
}

// ------------------------------------------------------------------- Energies

/** Add @a f(id) over all nodes in use, in the order of memory, in double: a sum
 * of a million floats would lose three digits. */
template <typename F>
double sum_over_nodes(const Cloth& g, F f) {
  double sum = 0;
  for (unsigned i = 0; i < g.node_slots(); ++i)
    if (g.node_in_use(i)) sum += f(i);
  return sum;
}

/** Sum of m |v|^2 / 2 [J].  O(N) */
inline double kinetic_energy(const Cloth& g) {
  auto node = g.node_values();
  return sum_over_nodes(
      g, [=](unsigned i) { return 0.5 * node[i].mass * normSq(node[i].vel); });
}

/** Sum of m gravity z [J], zero at z = 0.  O(N)
 * @param gravity acceleration of free fall [m/s^2] */
inline double gravitational_energy(const Cloth& g, double gravity = grav) {
  auto x = g.positions();
  auto node = g.node_values();
  return sum_over_nodes(
      g, [=](unsigned i) { return node[i].mass * gravity * x[i].z; });
}

/** Sum of the springs' energies [J].  O(number of edges) */
inline double elastic_energy(const Cloth& g) {
  auto x = g.positions();
  auto spring = g.edge_values();
  double sum = 0;
  for (unsigned e = 0; e < g.edge_slots(); ++e)
    if (g.edge_in_use(e)) {
      auto [i, j] = g.edge_ends()[e];
      sum += spring_energy(norm(x[j] - x[i]), spring[e]);
    }
  return sum;
}

/** Total mass [kg]. */
inline double total_mass(const Cloth& g) {
  auto node = g.node_values();
  return sum_over_nodes(g, [=](unsigned i) { return node[i].mass; });
}

/** Center of mass [m]; the origin for a cloth without nodes. */
inline Point center_of_mass(const Cloth& g) {
  auto x = g.positions();
  auto node = g.node_values();
  auto moment = [&](Real Point::*along) {
    return sum_over_nodes(
        g, [=](unsigned i) { return double(node[i].mass) * x[i].*along; });
  };
  const double mass = total_mass(g);
  if (!(mass > 0)) return Point();
  return Point(moment(&Point::x) / mass, moment(&Point::y) / mass,
               moment(&Point::z) / mass);
}

/** The highest speed of a node [m/s]; 0 for a cloth without nodes.  O(N) */
inline double max_speed(const Cloth& g) {
  double most = 0;
  for (unsigned i = 0; i < g.node_slots(); ++i)
    if (g.node_in_use(i)) most = std::max(most, normSq(g.node_values()[i].vel));
  return std::sqrt(most);
}

}  // namespace lab
