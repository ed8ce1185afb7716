#pragma once
/** @file Graph.hpp
 * A struct of vectors. A Node is an index: a removal, which swaps with the last
 * and pops, changes what it refers to. */
#include <vector>

#include "CME212/Point.hpp"

template <typename V, typename E = int>
class Graph {
 public:
  using size_type = unsigned;
  using node_value_type = V;
  using edge_value_type = E;

  struct Node : totally_ordered<Node> {
    Graph* g = nullptr;
    size_type i = 0;
    Node() {}
    Node(const Graph* graph, size_type n)
        : g(const_cast<Graph*>(graph)), i(n) {}
    Point& position() { return g->points_[i]; }
    const Point& position() const { return g->points_[i]; }
    V& value() { return g->values_[i]; }
    const V& value() const { return g->values_[i]; }
    size_type index() const { return i; }
    size_type degree() const { return size_type(g->at_[i].size()); }
    auto edge_begin() const { return IncidentIterator{g, i, 0}; }
    auto edge_end() const { return IncidentIterator{g, i, degree()}; }
    bool operator==(const Node& n) const { return g == n.g && i == n.i; }
    bool operator<(const Node& n) const { return g != n.g ? g < n.g : i < n.i; }
  };
  struct Edge : totally_ordered<Edge> {
    Graph* g = nullptr;
    size_type e = 0, from = 0;
    Edge() {}
    Edge(const Graph* graph, size_type edge, size_type n)
        : g(const_cast<Graph*>(graph)), e(edge), from(n) {}
    Node node1() const { return {g, from}; }
    Node node2() const { return {g, g->a_[e] + g->b_[e] - from}; }
    E& value() { return g->edge_values_[e]; }
    const E& value() const { return g->edge_values_[e]; }
    bool operator==(const Edge& o) const { return g == o.g && e == o.e; }
    bool operator<(const Edge& o) const { return g != o.g ? g < o.g : e < o.e; }
  };
  struct NodeIterator : equality_comparable<NodeIterator> {
    const Graph* g;
    size_type i;
    NodeIterator(const Graph* graph, size_type n) : g(graph), i(n) {}
    Node operator*() const { return {g, i}; }
    NodeIterator& operator++() { return ++i, *this; }
    bool operator==(const NodeIterator& o) const { return i == o.i; }
  };
  struct EdgeIterator : equality_comparable<EdgeIterator> {
    const Graph* g;
    size_type e;
    EdgeIterator(const Graph* graph, size_type n) : g(graph), e(n) {}
    Edge operator*() const { return {g, e, g->a_[e]}; }
    EdgeIterator& operator++() { return ++e, *this; }
    bool operator==(const EdgeIterator& o) const { return e == o.e; }
  };
  struct IncidentIterator : equality_comparable<IncidentIterator> {
    const Graph* g;
    size_type i, k;
    IncidentIterator(const Graph* graph, size_type n, size_type at)
        : g(graph), i(n), k(at) {}
    Edge operator*() const { return {g, g->at_[i][k], i}; }
    IncidentIterator& operator++() { return ++k, *this; }
    bool operator==(const IncidentIterator& o) const { return k == o.k; }
  };
  using node_type = Node;
  using edge_type = Edge;
  using node_iterator = NodeIterator;
  using edge_iterator = EdgeIterator;
  using incident_iterator = IncidentIterator;

  size_type size() const { return size_type(points_.size()); }
  size_type num_nodes() const { return size(); }
  size_type num_edges() const { return size_type(a_.size()); }
  Node node(size_type i) const { return {this, i}; }
  Edge edge(size_type e) const { return {this, e, a_[e]}; }
  bool has_node(const Node& n) const { return n.g == this && n.i < size(); }
  bool has_edge(const Node& a, const Node& b) const {
    return find(a.i, b.i) < num_edges();
  }
  NodeIterator node_begin() const { return {this, 0}; }
  NodeIterator node_end() const { return {this, size()}; }
  EdgeIterator edge_begin() const { return {this, 0}; }
  EdgeIterator edge_end() const { return {this, num_edges()}; }

  Node add_node(const Point& p, const V& value = V()) {
    points_.push_back(p), values_.push_back(value), at_.emplace_back();
    return {this, size() - 1};
  }
  Edge add_edge(const Node& a, const Node& b, const E& value = E()) {
    const size_type e = find(a.i, b.i);
    if (e < num_edges()) return {this, e, a.i};
    a_.push_back(a.i), b_.push_back(b.i), edge_values_.push_back(value);
    at_[a.i].push_back(e), at_[b.i].push_back(e);
    return {this, e, a.i};
  }
  size_type remove_edge(const Node& a, const Node& b) {
    return has_edge(a, b) ? drop(find(a.i, b.i)), 1 : 0;
  }
  size_type remove_edge(const Edge& e) {
    return remove_edge(e.node1(), e.node2());
  }
  EdgeIterator remove_edge(EdgeIterator it) { return drop(it.e), it; }
  size_type remove_node(const Node& n) {
    if (!has_node(n)) return 0;
    const size_type i = n.i, last = size() - 1;
    while (!at_[i].empty()) drop(at_[i].back());
    for (size_type e : at_[last]) (a_[e] == last ? a_ : b_)[e] = i;
    points_[i] = points_[last], values_[i] = values_[last];
    std::swap(at_[i], at_[last]);
    points_.pop_back(), values_.pop_back(), at_.pop_back();
    return 1;
  }
  NodeIterator remove_node(NodeIterator it) { return remove_node(*it), it; }
  void clear() {
    points_.clear(), values_.clear(), at_.clear();
    a_.clear(), b_.clear(), edge_values_.clear();
  }

 private:
  std::vector<Point> points_;
  std::vector<V> values_;
  std::vector<std::vector<size_type>> at_;  // the edges at a node
  std::vector<size_type> a_, b_;            // the ends of an edge
  std::vector<E> edge_values_;

  size_type find(size_type i, size_type j) const {
    for (size_type e : at_[i])
      if (a_[e] == j || b_[e] == j) return e;
    return num_edges();
  }
  void drop(size_type e) {
    const size_type last = num_edges() - 1;
    std::erase(at_[a_[e]], e), std::erase(at_[b_[e]], e);
    for (size_type i : {a_[last], b_[last]})
      std::replace(at_[i].begin(), at_[i].end(), last, e);
    a_[e] = a_[last], b_[e] = b_[last], edge_values_[e] = edge_values_[last];
    a_.pop_back(), b_.pop_back(), edge_values_.pop_back();
  }
};
