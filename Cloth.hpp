#pragma once
/** @file Cloth.hpp
 * Cloth: a graph of point masses and springs; its energies, and how it is made
 * from points and quads. SI units throughout; z points up. */
#include <array>
#include <cassert>
#include <concepts>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "Graph.hpp"
#include "Mesh.hpp"

/** What a node of a cloth carries. */
struct NodeData {
  Point vel;        ///< velocity [m/s]
  double mass = 1;  ///< [kg], > 0
};

/** What an edge of a cloth carries: a linear spring. */
struct EdgeData {
  double K = 100;  ///< spring constant [N/m], >= 0
  double L = 0;    ///< rest length [m], >= 0
};

using Cloth = Graph<NodeData, EdgeData>;
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

/** The force [N] of a spring on its one end, the other end lying at @a u [m]
 * from it: K (l - L) u/l with l = |u|, so it pulls when longer than L.
 * Zero at l = 0, where no direction is defined. */
inline Point spring_force(const Point& u, const EdgeData& s) {
  double l = norm(u);
  return l > 0 ? (s.K * (l - s.L) / l) * u : Point();
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

/** Add @a f(id) over all nodes in use, in the order of memory. */
template <typename F>
auto sum_over_nodes(const Cloth& g, F f) {
  decltype(f(0u)) sum{};
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
  double mass = total_mass(g);
  Point sum =
      sum_over_nodes(g, [=](unsigned i) { return node[i].mass * x[i]; });
  return mass > 0 ? sum / mass : Point();
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
 * @pre g.size() == 0; the indices in @a quads are below points.size() */
inline void build_cloth(Cloth& g, std::span<const Point> points,
                        std::span<const Quad> quads, Mesh mesh,
                        double K = 100) {
  assert(g.size() == 0);
  std::vector<Node> node;
  for (const Point& p : points)
    node.push_back(g.add_node(p, {Point(), 1.0 / double(points.size())}));
  auto add_spring = [&](unsigned i, unsigned j) {
    g.add_edge(node[i], node[j], {K, norm(points[i] - points[j])});
  };
  for (const Quad& q : quads) {
    add_spring(q[0], q[1]);
    add_spring(q[0], q[2]);
    if (mesh == Mesh::diagonals) {
      add_spring(q[0], q[3]);
      add_spring(q[1], q[2]);
    }
    add_spring(q[1], q[3]);
    add_spring(q[2], q[3]);
  }
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
