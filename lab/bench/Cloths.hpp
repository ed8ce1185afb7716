#pragma once
/** @file Cloths.hpp
 * The cloths that bench measures, and the same as flat arrays. */
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <numeric>
#include <random>
#include <utility>
#include <vector>

#include "lab/fast/GraphArrays.hpp"
#include "lab/fast/OrderedCloth.hpp"

namespace lab::bench {

// --------------------------------------------------------------------- Cloths

/** - grid: ids and springs row by row, as build_cloth() makes them
 * - mixed: the same, but ids and springs are in random order within windows of
 *   64: neighbors are as near in memory, but not at a constant distance
 * - shuffled: read in random order, and order_in_memory()
 * - torn: the grid, after a random half of its nodes was removed
 * - reindexed: torn, and then GraphArrays::reindex() */
enum class Kind { grid, mixed, shuffled, torn, reindexed };

/** 0, ..., count - 1 in random order within windows of 64. */
inline std::vector<unsigned> mixed_order(std::size_t count) {
  std::vector<unsigned> order(count);
  std::iota(order.begin(), order.end(), 0u);
  std::mt19937 random(212);
  for (std::size_t i = 0; i < count; i += 64)
    std::shuffle(order.begin() + std::ptrdiff_t(i),
                 order.begin() + std::ptrdiff_t(std::min(i + 64, count)),
                 random);
  return order;
}

/** Points and quads in random order. */
inline void shuffle(std::vector<Point>& points, std::vector<Quad>& quads) {
  std::mt19937 random(9);
  std::vector<unsigned> place(points.size());
  std::iota(place.begin(), place.end(), 0u);
  std::shuffle(place.begin(), place.end(), random);
  const auto before = points;
  for (std::size_t i = 0; i < points.size(); ++i) points[place[i]] = before[i];
  for (Quad& q : quads)
    for (unsigned& i : q) i = place[i];
  std::shuffle(quads.begin(), quads.end(), random);
}

inline void build(Cloth& g, unsigned side, Kind kind) {
  auto points = grid_points(side);
  auto quads = grid_quads(side);
  if (kind == Kind::shuffled) shuffle(points, quads);
  if (kind == Kind::mixed) {
    Cloth grid;
    build_cloth(grid, points, quads, MeshSprings::diagonals);
    const auto order = mixed_order(points.size());
    std::vector<Node> node(points.size());
    for (unsigned i : order)
      node[i] = g.add_node(points[i], grid.node(i).value());
    for (unsigned e : mixed_order(grid.num_edges())) {
      const Edge edge = grid.edge(e);
      g.add_edge(node[edge.node1().index()], node[edge.node2().index()],
                 edge.value());
    }
    return;
  }
  build_cloth(g, points, quads, MeshSprings::diagonals);
  order_in_memory(g);
  if (kind != Kind::torn && kind != Kind::reindexed) return;
  std::vector<Node> nodes(g.node_begin(), g.node_end());
  std::shuffle(nodes.begin(), nodes.end(), std::mt19937(212));
  for (std::size_t k = 0; k < nodes.size() / 2; ++k) g.remove_node(nodes[k]);
  if (kind == Kind::reindexed) arrays(g).reindex();
}

/** One cloth of each kind for all figures, its nodes moved at random. */
inline Cloth& cloth(unsigned side, Kind kind) {
  static std::map<std::pair<unsigned, Kind>, Cloth> made;
  auto [it, is_new] = made.try_emplace({side, kind});
  if (is_new) {
    build(it->second, side, kind);
    std::mt19937 random(2);
    std::uniform_real_distribution<double> off(-0.1 / side, 0.1 / side);
    for (Node n : it->second.nodes())
      n.position() += Point(off(random), off(random), off(random));
  }
  return it->second;
}

// ----------------------------------------------------- Flat arrays, by hand

/** A cloth in arrays of doubles, which contain only what the loop needs, in the
 * order of the loop: rows of neighbors, each with K and L. */
struct Flat {
  struct Vector {
    double x = 0, y = 0, z = 0;
  };
  std::vector<Vector> x, v, f;
  std::vector<double> mass, K, L;
  std::vector<unsigned> row = {0}, neighbor;

  explicit Flat(const Cloth& g) {
    std::vector<unsigned> place(arrays(g).node_slots());
    unsigned count = 0;
    for (unsigned id = 0; id < arrays(g).node_slots(); ++id)
      if (arrays(g).node_in_use(id)) place[id] = count++;
    for (unsigned id = 0; id < arrays(g).node_slots(); ++id) {
      if (!arrays(g).node_in_use(id)) continue;
      const Node n = arrays(g).node_with_id(id);
      x.push_back({n.position().x, n.position().y, n.position().z});
      mass.push_back(n.value().mass);
      for (Edge e : n.edges()) {
        neighbor.push_back(place[e.node2().id()]);
        K.push_back(e.value().K);
        L.push_back(e.value().L);
      }
      row.push_back(unsigned(neighbor.size()));
    }
    v.resize(x.size());
    f.resize(x.size());
  }

  /** The force of all springs at node i [N]. */
  Vector springs(std::size_t i) const {
    Vector sum;
    for (unsigned k = row[i]; k < row[i + 1]; ++k) {
      const Vector &a = x[i], &b = x[neighbor[k]];
      const double ux = b.x - a.x, uy = b.y - a.y, uz = b.z - a.z;
      const double l = std::sqrt(ux * ux + uy * uy + uz * uz);
      const double c = K[k] * (l - L[k]) / l;
      sum.x += c * ux;
      sum.y += c * uy;
      sum.z += c * uz;
    }
    return sum;
  }
  void forces() {
    for (std::size_t i = 0; i < x.size(); ++i) f[i] = springs(i);
  }
  void step(double dt) {
    for (std::size_t i = 0; i < x.size(); ++i) {
      x[i].x += dt * v[i].x;
      x[i].y += dt * v[i].y;
      x[i].z += dt * v[i].z;
    }
    for (std::size_t i = 0; i < x.size(); ++i) {
      const Vector pull = springs(i);
      const double h = dt / mass[i];
      v[i].x += h * pull.x;
      v[i].y += h * pull.y;
      v[i].z += h * pull.z - dt * grav;
    }
  }
};
inline Flat& flat(unsigned side, Kind kind) {
  static std::map<std::pair<unsigned, Kind>, Flat> made;
  return made.try_emplace({side, kind}, cloth(side, kind)).first->second;
}

}  // namespace lab::bench
