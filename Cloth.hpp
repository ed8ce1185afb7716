#pragma once
/** @file Cloth.hpp
 * Cloth: a graph of point masses and springs; its energies, and how it is made
 * from points and quads. SI units throughout; z points up. */
#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <concepts>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "Graph.hpp"
#include "Lanes.hpp"
#include "Mesh.hpp"
#include "Order.hpp"
#include "Stencil.hpp"

/** What a node of a cloth carries. */
struct NodeData {
  Point vel;      ///< velocity [m/s]
  Real mass = 1;  ///< [kg], > 0
};

/** What an edge of a cloth carries: a linear spring. */
struct EdgeData {
  Real K = 100;  ///< spring constant [N/m], >= 0
  Real L = 0;    ///< rest length [m], >= 0
};
// Sweeps read them as rows of numbers.
static_assert(sizeof(NodeData) == 4 * sizeof(Real) &&
              sizeof(EdgeData) == 2 * sizeof(Real));

using Cloth = Graph<NodeData, EdgeData>;
using ClothStencil = Stencil<lanes::width>;
using Node = Cloth::node_type;
using Edge = Cloth::edge_type;

/** Acceleration of free fall [m/s^2]. */
inline constexpr double grav = 9.81;

/** The two corners [m] that the assignment holds fixed. */
inline constexpr std::array<Point, 2> corners = {Point(0, 0, 0),
                                                 Point(1, 0, 0)};
inline constexpr bool is_corner(const Point& p) {
  return p == corners[0] || p == corners[1];
}

// -------------------------------------------------------------------- Springs

/** The pull [N/m] of a spring: the force on its one end is the pull times u,
 * the way [m] to the other end. K (l - L)/l with l = |u|, so positive when
 * longer than L. Finite at l = 0, where no direction is defined: no force.
 *
 * This is the one place that says how a spring pulls.
 * @param lengthSq l^2 [m^2]   @param K [N/m]   @param L rest length [m]
 * @tparam T Real, or Lanes of many springs */
template <typename T>
[[gnu::always_inline]] inline T spring_pull(const T& lengthSq, const T& K,
                                            const T& L) {
  using lanes::sqrt, std::sqrt;
  const T l = sqrt(lengthSq + std::numeric_limits<Real>::min());
  return K * (l - L) / l;
}

/** The force [N] of a spring on its one end, the other end lying at @a u [m]
 * from it. */
inline Point spring_force(const Point& u, const EdgeData& s) {
  return spring_pull<Real>(normSq(u), s.K, s.L) * u;
}

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

namespace cloth_detail {

/** @a x on the heap as a Base: itself if it is one, else in an Adapter. */
template <typename Base, template <typename> class Adapter, typename T>
std::shared_ptr<const Base> shared_as(T x) {
  if constexpr (std::derived_from<T, Base>)
    return std::make_shared<T>(std::move(x));
  else
    return std::make_shared<Adapter<T>>(std::move(x));
}

}  // namespace cloth_detail

// ------------------------------------------------------------------- Building

/** Add to @a g the points as nodes and the sides of the quads as springs, at
 * rest: velocity 0, mass 1/N [kg] for N points, L = the initial length.
 * @param K spring constant of every edge [N/m]
 * @pre g.size() == 0; the indices in @a quads are below points.size(); fewer
 *      than 2^32 springs
 * @post node(i) is at points[i], and the edges have the order of MeshSprings.
 * In memory they have another order (Node::id(), and that of Node::edges()) if
 * that of the mesh is bad: see Order.hpp and docs/graph.md. */
inline void build_cloth(Cloth& g, std::span<const Point> points,
                        std::span<const Quad> quads, Mesh mesh,
                        double K = 100) {
  assert(g.size() == 0);
  const MeshSprings springs(quads, mesh);
  g.reserve(unsigned(points.size()), unsigned(springs.expected(points.size())));
  const NodeData at_rest = {Point(), Real(1.0 / double(points.size()))};
  auto add_spring = [&](Node a, Node b) {
    return g.add_edge(a, b, {Real(K), Real(norm(a.position() - b.position()))});
  };
  if (is_local(quads)) {
    for (const Point& p : points) g.add_node(p, at_rest);
    for (unsigned s = 0; s < springs.size(); ++s) {
      auto [i, j] = springs[s];
      add_spring(g.node(i), g.node(j));
    }
    return;
  }
  const MeshOrder order = cuthill_mckee(points.size(), quads);
  std::vector<unsigned> node_id(points.size());
  for (unsigned i : order.points)
    node_id[i] = g.add_node(points[i], at_rest).id();
  constexpr unsigned none = -1;  // a spring that came before
  std::vector<unsigned> edge_id(springs.size(), none);
  {
    const auto ordered = in_order(quads, order);
    const MeshSprings local(ordered, mesh);
    const auto n = unsigned(quads.size());
    auto number = [&](unsigned s) { return s / n * n + order.quads[s % n]; };
    for (unsigned s : sorted_springs(local, points.size(), number)) {
      auto [i, j] = local[s];
      edge_id[number(s)] = add_spring(g.node(i), g.node(j)).id();
    }
  }
  std::erase(edge_id, none);
  g.reindex_nodes(node_id);
  g.reindex_edges(edge_id);
}

/** Read a cloth from two files, as build_cloth() from parse_points() and
 * parse_quads().
 * @pre g.size() == 0
 * Throws InputError, and then @a g is as before. */
inline void load_cloth(Cloth& g, const std::string& nodes_file,
                       const std::string& tets_file, Mesh mesh,
                       double K = 100) {
  auto points = load_points(nodes_file);
  auto quads = load_quads(tets_file, points.size());
  build_cloth(g, points, quads, mesh, K);
}
