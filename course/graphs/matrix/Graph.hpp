#pragma once
/** @file Graph.hpp
 * An adjacency matrix: cell (i, j) points to the value that the edge has from
 * both ends. Iterators of edges scan rows; a removal erases row and column. */
#include <memory>
#include <vector>

#include "CME212/Point.hpp"

template <typename V, typename E = int>
class Graph {
 public:
  using size_type = unsigned;
  using node_value_type = V;
  using edge_value_type = E;

  struct IncidentIterator;
  struct Node : totally_ordered<Node> {
    Node() {}
    Node(const Graph* graph, unsigned n) : g(const_cast<Graph*>(graph)), i(n) {}
    Point& position() { return g->points_[i]; }
    const Point& position() const { return g->points_[i]; }
    V& value() { return g->values_[i]; }
    const V& value() const { return g->values_[i]; }
    size_type index() const { return i; }
    size_type degree() const {
      return g->size() -
             std::count(g->cells_[i].begin(), g->cells_[i].end(), nullptr);
    }
    IncidentIterator edge_begin() const { return {g, i, 0}; }
    IncidentIterator edge_end() const { return {g, i, g->size()}; }
    bool operator==(const Node& n) const { return g == n.g && i == n.i; }
    bool operator<(const Node& n) const { return g != n.g ? g < n.g : i < n.i; }
    Graph* g = nullptr;
    unsigned i = 0;
  };
  struct Edge : totally_ordered<Edge> {
    Edge() {}
    Edge(const Graph* g, unsigned i, unsigned j) : a(g, i), b(g, j) {}
    Node node1() const { return a; }
    Node node2() const { return b; }
    E& value() { return *a.g->cells_[a.i][b.i]; }
    const E& value() const { return *a.g->cells_[a.i][b.i]; }
    bool operator==(const Edge& e) const {
      return (a == e.a && b == e.b) || (a == e.b && b == e.a);
    }
    bool operator<(const Edge& e) const {
      return std::minmax(a, b) < std::minmax(e.a, e.b);
    }
    Node a, b;
  };
  struct NodeIterator : equality_comparable<NodeIterator> {
    NodeIterator(const Graph* graph, unsigned n) : g(graph), i(n) {}
    Node operator*() const { return {g, i}; }
    NodeIterator& operator++() { return ++i, *this; }
    bool operator==(const NodeIterator& o) const { return i == o.i; }
    const Graph* g;
    unsigned i;
  };
  /** Over the cells (i, j) with j < i. */
  struct EdgeIterator : equality_comparable<EdgeIterator> {
    EdgeIterator(const Graph* graph, unsigned row) : g(graph), i(row), j(0) {
      skip();
    }
    Edge operator*() const { return {g, i, j}; }
    EdgeIterator& operator++() { return ++j, skip(), *this; }
    bool operator==(const EdgeIterator& o) const {
      return i == o.i && j == o.j;
    }
    void skip() {
      for (; i < g->size(); ++i, j = 0)
        for (; j < i; ++j)
          if (g->cells_[i][j]) return;
    }
    const Graph* g;
    unsigned i, j;
  };
  struct IncidentIterator : equality_comparable<IncidentIterator> {
    IncidentIterator(const Graph* graph, unsigned row, unsigned column)
        : g(graph), i(row), j(column) {
      skip();
    }
    Edge operator*() const { return {g, i, j}; }
    IncidentIterator& operator++() { return ++j, skip(), *this; }
    bool operator==(const IncidentIterator& o) const { return j == o.j; }
    void skip() {
      while (j < g->size() && !g->cells_[i][j]) ++j;
    }
    const Graph* g;
    unsigned i, j;
  };
  using node_type = Node;
  using edge_type = Edge;
  using node_iterator = NodeIterator;
  using edge_iterator = EdgeIterator;
  using incident_iterator = IncidentIterator;

  size_type size() const { return points_.size(); }
  size_type num_nodes() const { return points_.size(); }
  size_type num_edges() const { return num_edges_; }
  Node node(size_type i) const { return {this, i}; }
  Edge edge(size_type k) const {
    auto it = edge_begin();
    while (k-- > 0) ++it;
    return *it;
  }
  bool has_node(const Node& n) const { return n.g == this && n.i < size(); }
  bool has_edge(const Node& a, const Node& b) const {
    return cells_[a.i][b.i] != nullptr;
  }
  NodeIterator node_begin() const { return {this, 0}; }
  NodeIterator node_end() const { return {this, size()}; }
  EdgeIterator edge_begin() const { return {this, 0}; }
  EdgeIterator edge_end() const { return {this, size()}; }

  Node add_node(const Point& p, const V& value = V()) {
    points_.push_back(p), values_.push_back(value);
    cells_.emplace_back();
    for (auto& row : cells_) row.resize(size());
    return node(size() - 1);
  }
  Edge add_edge(const Node& a, const Node& b, const E& value = E()) {
    if (!has_edge(a, b)) {
      cells_[a.i][b.i] = cells_[b.i][a.i] = std::make_shared<E>(value);
      ++num_edges_;
    }
    return {this, a.i, b.i};
  }
  size_type remove_edge(const Node& a, const Node& b) {
    if (!has_edge(a, b)) return 0;
    cells_[a.i][b.i] = cells_[b.i][a.i] = nullptr;
    return --num_edges_, 1;
  }
  size_type remove_edge(const Edge& e) { return remove_edge(e.a, e.b); }
  EdgeIterator remove_edge(EdgeIterator it) { return remove_edge(*it), ++it; }
  size_type remove_node(const Node& n) {
    if (!has_node(n)) return 0;
    const unsigned i = n.i;
    num_edges_ -= n.degree();
    points_.erase(points_.begin() + i), values_.erase(values_.begin() + i);
    cells_.erase(cells_.begin() + i);
    for (auto& row : cells_) row.erase(row.begin() + i);
    return 1;
  }
  NodeIterator remove_node(NodeIterator it) { return remove_node(*it), it; }
  void clear() {
    points_.clear(), values_.clear(), cells_.clear();
    num_edges_ = 0;
  }

 private:
  std::vector<Point> points_;
  std::vector<V> values_;
  std::vector<std::vector<std::shared_ptr<E>>> cells_;
  size_type num_edges_ = 0;
};
