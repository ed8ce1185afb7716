#pragma once
/** @file Graph.hpp
 * No lists of neighbors: the edges at a node are found by looking at all edges.
 * Slow, and right. Values of edges in a deque beside a vector of ends. */
#include <deque>
#include <vector>

#include "CME212/Point.hpp"

template <typename V, typename E>
class Graph {
 public:
  using size_type = unsigned;
  using node_value_type = V;
  using edge_value_type = E;
  class Node;
  class Edge;
  template <typename T>
  class Iterator;
  using node_type = Node;
  using edge_type = Edge;
  using node_iterator = Iterator<Node>;
  using edge_iterator = Iterator<Edge>;

  class Node : private totally_ordered<Node> {
   public:
    Node() : graph_(nullptr), i_(-1) {}
    Point& position() { return graph_->points_[i_]; }
    const Point& position() const { return graph_->points_[i_]; }
    V& value() { return graph_->values_[i_]; }
    const V& value() const { return graph_->values_[i_]; }
    size_type index() const { return i_; }
    size_type degree() const {
      size_type count = 0;
      for (auto it = edge_begin(); it != edge_end(); ++it) ++count;
      return count;
    }
    auto edge_begin() const { return edge_iterator(graph_, 0, i_); }
    auto edge_end() const {
      return edge_iterator(graph_, graph_->num_edges(), i_);
    }
    bool operator==(const Node& n) const {
      return graph_ == n.graph_ && i_ == n.i_;
    }
    bool operator<(const Node& n) const {
      return graph_ < n.graph_ || (graph_ == n.graph_ && i_ < n.i_);
    }

   private:
    friend class Graph;
    Graph* graph_;
    int i_;
    Node(const Graph* g, int i) : graph_(const_cast<Graph*>(g)), i_(i) {}
  };
  class Edge : private totally_ordered<Edge> {
   public:
    Edge() {}
    Node node1() const { return a_; }
    Node node2() const { return b_; }
    E& value() { return a_.graph_->edge_values_[k_]; }
    const E& value() const { return a_.graph_->edge_values_[k_]; }
    bool operator==(const Edge& e) const {
      return a_.graph_ == e.a_.graph_ && k_ == e.k_;
    }
    bool operator<(const Edge& e) const {
      return a_.graph_ < e.a_.graph_ || (a_.graph_ == e.a_.graph_ && k_ < e.k_);
    }

   private:
    friend class Graph;
    Node a_, b_;
    size_type k_;
    Edge(Node a, Node b, size_type k) : a_(a), b_(b), k_(k) {}
  };
  /** Over nodes or edges; if @a at >= 0, over the edges at this node only. */
  template <typename T>
  class Iterator : private equality_comparable<Iterator<T>> {
   public:
    Iterator() {}
    T operator*() const {
      if constexpr (std::is_same_v<T, Node>)
        return g_->node(k_);
      else
        return g_->seen_from(at_, k_);
    }
    Iterator& operator++() { return ++k_, skip(), *this; }
    bool operator==(const Iterator& o) const { return k_ == o.k_; }

   private:
    friend class Graph;
    const Graph* g_ = nullptr;
    size_type k_ = 0;
    int at_ = -1;
    Iterator(const Graph* g, size_type k, int at = -1) : g_(g), k_(k), at_(at) {
      skip();
    }
    void skip() {
      if (at_ >= 0)
        while (k_ < g_->num_edges() && !g_->touches(k_, at_)) ++k_;
    }
  };
  using incident_iterator = edge_iterator;

  size_type size() const { return points_.size(); }
  size_type num_nodes() const { return points_.size(); }
  size_type num_edges() const { return ends_.size(); }
  Node node(size_type i) const { return Node(this, i); }
  Edge edge(size_type k) const { return seen_from(-1, k); }
  bool has_node(const Node& n) const {
    return n.graph_ == this && n.index() < size();
  }
  bool has_edge(const Node& a, const Node& b) const {
    return find(a, b) < num_edges();
  }
  node_iterator node_begin() const { return {this, 0}; }
  node_iterator node_end() const { return {this, size()}; }
  edge_iterator edge_begin() const { return {this, 0}; }
  edge_iterator edge_end() const { return {this, num_edges()}; }

  Node add_node(const Point& p, const V& value = V()) {
    points_.push_back(p), values_.push_back(value);
    return node(size() - 1);
  }
  Edge add_edge(const Node& a, const Node& b, const E& value = E()) {
    const size_type k = find(a, b);
    if (k == num_edges())
      ends_.push_back({a.i_, b.i_}), edge_values_.push_back(value);
    return seen_from(a.i_, k);
  }
  size_type remove_edge(const Node& a, const Node& b) {
    const size_type k = find(a, b);
    if (k == num_edges()) return 0;
    ends_.erase(ends_.begin() + k);
    edge_values_.erase(edge_values_.begin() + k);
    return 1;
  }
  size_type remove_edge(const Edge& e) { return remove_edge(e.a_, e.b_); }
  edge_iterator remove_edge(edge_iterator it) { return remove_edge(*it), it; }
  bool remove_node(Node n) {
    if (!has_node(n)) return false;
    while (n.degree() > 0) remove_edge(*n.edge_begin());
    const int last = size() - 1;
    for (auto& [a, b] : ends_) {
      if (a == last) a = n.i_;
      if (b == last) b = n.i_;
    }
    points_[n.i_] = points_[last], values_[n.i_] = values_[last];
    points_.pop_back(), values_.pop_back();
    return true;
  }
  node_iterator remove_node(node_iterator it) {
    remove_node(*it);
    return node_begin();  // slow, too
  }
  void clear() {
    points_.clear(), values_.clear(), ends_.clear(), edge_values_.clear();
  }

 private:
  std::vector<Point> points_;
  std::deque<V> values_;
  std::vector<std::pair<int, int>> ends_;
  std::deque<E> edge_values_;

  bool touches(size_type k, int i) const {
    return ends_[k].first == i || ends_[k].second == i;
  }
  Edge seen_from(int i, size_type k) const {
    auto [a, b] = ends_[k];
    if (b == i) std::swap(a, b);
    return Edge(Node(this, a), Node(this, b), k);
  }
  size_type find(const Node& a, const Node& b) const {
    size_type k = 0;
    while (k < num_edges() && !(touches(k, a.i_) && touches(k, b.i_))) ++k;
    return k;
  }
};
