#pragma once
/** @file contenders.hpp
 * The same square of 100 x 100 nodes as a Graph, a graph of Boost and one of
 * LEMON; for graph_peers.cpp.
 *
 * Each library is used as its manual suggests, with the values of a cloth at
 * all nodes and edges and with the same formula for springs. */
#if !__has_include(<boost/graph/adjacency_list.hpp>) || \
    !__has_include(<lemon/smart_graph.h>)
#error "Boost or LEMON is missing: make peers-deps"
#endif

#include <lemon/smart_graph.h>

#include <algorithm>
#include <array>
#include <boost/graph/adjacency_list.hpp>
#include <optional>
#include <random>
#include <set>
#include <vector>

#include "lab/fast/Energy.hpp"

namespace lab {

// ------------------------------------------------------------------ The mesh

using Pair = std::array<unsigned, 2>;

/** What all graphs are made from and asked for. */
struct Square {
  static constexpr unsigned side = 100;
  std::vector<Point> points = grid_points(side);
  std::vector<Pair> quad_sides;  // by quad: a side of two quads comes twice
  std::vector<Pair> springs;     // each once
  std::vector<Pair> questions;   // for has_edge: every other one is an edge
  std::vector<unsigned> doomed;  // a random half of the nodes

  Square() {
    for (const Quad& q : grid_quads(side))
      for (auto [a, b] : {Pair{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}})
        quad_sides.push_back({q[a], q[b]});
    std::set<Pair> seen;
    for (const Pair& p : quad_sides)
      if (seen.insert(p).second) springs.push_back(p);
    std::mt19937 random(212);
    auto below = [&random](std::size_t n) {
      return std::uniform_int_distribution<unsigned>(0,
                                                     unsigned(n - 1))(random);
    };
    for (unsigned k = 0; k < 20'000; ++k)
      questions.push_back(
          k % 2 == 0 ? springs[below(springs.size())]
                     : Pair{below(points.size()), below(points.size())});
    std::shuffle(questions.begin(), questions.end(), random);
    for (unsigned i = 0; i < points.size(); ++i) doomed.push_back(i);
    std::shuffle(doomed.begin(), doomed.end(), random);
    doomed.resize(points.size() / 2);
  }
  NodeData node_value() const { return {Point(), 1.0 / double(points.size())}; }
  EdgeData spring(Pair p) const {
    return {100, 0.9 * norm(points[p[0]] - points[p[1]])};
  }
};
inline const Square square;

// ------------------------------------------------------------- The contenders
// Each has: build(edges, may_repeat), forces(f), energy(), count(questions)
// and remove(nodes); and make_room() if it can be told its size before.

struct Ours {
  static constexpr const char* name = "ours";
  Cloth g;

  void make_room() {
    g.reserve(unsigned(square.points.size()), unsigned(square.springs.size()));
  }
  void build(const std::vector<Pair>& edges, bool /*may_repeat*/) {
    for (const Point& p : square.points) g.add_node(p, square.node_value());
    for (Pair p : edges)
      g.add_edge(g.node(p[0]), g.node(p[1]), square.spring(p));
  }
  void forces(std::vector<Point>& force) {
    std::size_t i = 0;
    for (auto n : g.nodes()) {
      Point f;
      for (auto e : n.edges())
        f += spring_force(e.node2().position() - n.position(), e.value());
      force[i++] = f;
    }
  }
  double energy() {
    double sum = 0;
    for (auto e : g.edges()) {
      Point u = e.node1().position() - e.node2().position();
      sum += spring_energy(norm(u), e.value());
    }
    return sum;
  }
  std::size_t count(const std::vector<Pair>& questions) {
    std::size_t yes = 0;
    for (auto [i, j] : questions) yes += g.has_edge(g.node(i), g.node(j));
    return yes;
  }
  void remove(const std::vector<unsigned>& nodes) {
    std::vector<Node> node(g.node_begin(), g.node_end());
    for (unsigned i : nodes) g.remove_node(node[i]);
  }
};

/** A graph of LEMON's that can only grow. */
struct Lemon {
  static constexpr const char* name = "LEMON SmartGraph";
  using G = lemon::SmartGraph;
  template <typename Key, typename Value>
  using Map = lemon::VectorMap<G, Key, Value>;
  G g;
  // Made when the graph is complete: so they are allocated just once.
  std::optional<Map<G::Node, Point>> position;
  std::optional<Map<G::Node, NodeData>> node_value;
  std::optional<Map<G::Edge, EdgeData>> edge_value;

  void make_room() {
    g.reserveNode(int(square.points.size()));
    g.reserveEdge(int(square.springs.size()));
  }
  void build(const std::vector<Pair>& edges, bool may_repeat) {
    for (std::size_t i = 0; i < square.points.size(); ++i) g.addNode();
    for (auto [i, j] : edges) {
      auto a = g.nodeFromId(int(i)), b = g.nodeFromId(int(j));
      if (!may_repeat || lemon::findEdge(g, a, b) == lemon::INVALID)
        g.addEdge(a, b);
    }
    position.emplace(g);
    node_value.emplace(g);
    edge_value.emplace(g);
    for (G::NodeIt n(g); n != lemon::INVALID; ++n) {
      (*position)[n] = square.points[std::size_t(g.id(n))];
      (*node_value)[n] = square.node_value();
    }
    for (G::EdgeIt e(g); e != lemon::INVALID; ++e)
      (*edge_value)[e] =
          square.spring({unsigned(g.id(g.u(e))), unsigned(g.id(g.v(e)))});
  }
  void forces(std::vector<Point>& force) {
    for (G::NodeIt n(g); n != lemon::INVALID; ++n) {
      Point f;
      for (G::OutArcIt a(g, n); a != lemon::INVALID; ++a)
        f += spring_force((*position)[g.target(a)] - (*position)[n],
                          (*edge_value)[a]);
      force[std::size_t(g.id(n))] = f;
    }
  }
  double energy() {
    double sum = 0;
    for (G::EdgeIt e(g); e != lemon::INVALID; ++e) {
      Point u = (*position)[g.u(e)] - (*position)[g.v(e)];
      sum += spring_energy(norm(u), (*edge_value)[e]);
    }
    return sum;
  }
  std::size_t count(const std::vector<Pair>& questions) {
    std::size_t yes = 0;
    for (auto [i, j] : questions)
      yes += lemon::findEdge(g, g.nodeFromId(int(i)), g.nodeFromId(int(j))) !=
             lemon::INVALID;
    return yes;
  }
};

struct BoostNode {
  Point position;
  NodeData value;
};

/** A graph of Boost's in arrays: a removal renumbers all nodes. */
struct Boost {
  static constexpr const char* name = "Boost vecS";
  using G = boost::adjacency_list<boost::vecS, boost::vecS, boost::undirectedS,
                                  BoostNode, EdgeData>;
  G g;
  std::vector<G::vertex_descriptor> node;

  void build(const std::vector<Pair>& edges, bool may_repeat) {
    node.reserve(square.points.size());
    for (const Point& p : square.points)
      node.push_back(add_vertex(BoostNode{p, square.node_value()}, g));
    for (Pair p : edges) {
      auto a = node[p[0]], b = node[p[1]];
      if (!may_repeat || !edge(a, b, g).second)
        add_edge(a, b, square.spring(p), g);
    }
  }
  void forces(std::vector<Point>& force) {
    std::size_t i = 0;
    for (auto [n, end] = vertices(g); n != end; ++n) {
      Point f;
      for (auto [e, last] = out_edges(*n, g); e != last; ++e)
        f += spring_force(g[target(*e, g)].position - g[*n].position, g[*e]);
      force[i++] = f;
    }
  }
  double energy() {
    double sum = 0;
    for (auto [e, end] = edges(g); e != end; ++e) {
      Point u = g[source(*e, g)].position - g[target(*e, g)].position;
      sum += spring_energy(norm(u), g[*e]);
    }
    return sum;
  }
  std::size_t count(const std::vector<Pair>& questions) {
    std::size_t yes = 0;
    for (auto [i, j] : questions) yes += edge(node[i], node[j], g).second;
    return yes;
  }
  void remove(std::vector<unsigned> nodes) {
    std::sort(nodes.rbegin(), nodes.rend());  // so numbers stay
    for (unsigned i : nodes) {
      clear_vertex(node[i], g);
      remove_vertex(node[i], g);
    }
  }
};

}  // namespace lab
