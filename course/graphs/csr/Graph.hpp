#pragma once
/** @file Graph.hpp
 * Compressed sparse rows: the ends of the edges in one vector; the lists of all
 * nodes one after the other, made anew when they are asked for after a change.
 */
#include <vector>

#include "CME212/Point.hpp"

template <typename V, typename E = int>
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
  using incident_iterator = Iterator<Edge>;

  class Node : private totally_ordered<Node> {
   public:
    Node() {}
    Point& position() { return g_->points_[i_]; }
    const Point& position() const { return g_->points_[i_]; }
    V& value() { return g_->values_[i_]; }
    const V& value() const { return g_->values_[i_]; }
    size_type index() const { return i_; }
    size_type degree() const { return g_->row(i_ + 1) - g_->row(i_); }
    incident_iterator edge_begin() const { return {g_, g_->row(i_), i_}; }
    incident_iterator edge_end() const { return {g_, g_->row(i_ + 1), i_}; }
    bool operator==(const Node& n) const { return g_ == n.g_ && i_ == n.i_; }
    bool operator<(const Node& n) const {
      return g_ < n.g_ || (g_ == n.g_ && i_ < n.i_);
    }

   private:
    friend class Graph;
    Graph* g_ = nullptr;
    size_type i_ = 0;
    Node(const Graph* g, size_type i) : g_(const_cast<Graph*>(g)), i_(i) {}
  };
  class Edge : private totally_ordered<Edge> {
   public:
    Edge() {}
    Node node1() const { return Node(g_, from_); }
    Node node2() const {
      return Node(g_, g_->ends_[e_].a + g_->ends_[e_].b - from_);
    }
    E& value() { return g_->ends_[e_].value; }
    const E& value() const { return g_->ends_[e_].value; }
    double length() const {
      return norm(node1().position() - node2().position());
    }
    bool operator==(const Edge& e) const { return g_ == e.g_ && e_ == e.e_; }
    bool operator<(const Edge& e) const {
      return g_ < e.g_ || (g_ == e.g_ && e_ < e.e_);
    }

   private:
    friend class Graph;
    Graph* g_ = nullptr;
    size_type e_ = 0, from_ = 0;
    Edge(const Graph* g, size_type e, size_type from)
        : g_(const_cast<Graph*>(g)), e_(e), from_(from) {}
  };
  template <typename T>
  class Iterator : private equality_comparable<Iterator<T>> {
   public:
    Iterator() {}
    T operator*() const {
      if constexpr (std::is_same_v<T, Node>)
        return g_->node(k_);
      else if (from_ == nobody)
        return g_->edge(k_);
      else
        return Edge(g_, g_->columns_[k_], from_);
    }
    Iterator& operator++() { return ++k_, *this; }
    bool operator==(const Iterator& o) const {
      return g_ == o.g_ && k_ == o.k_ && from_ == o.from_;
    }

   private:
    friend class Graph;
    static constexpr size_type nobody = -1;
    const Graph* g_;
    size_type k_, from_;
    Iterator(const Graph* g, size_type k, size_type from = nobody)
        : g_(g), k_(k), from_(from) {}
  };

  size_type size() const { return points_.size(); }
  size_type num_nodes() const { return points_.size(); }
  size_type num_edges() const { return ends_.size(); }
  Node node(size_type i) const { return Node(this, i); }
  Edge edge(size_type e) const { return Edge(this, e, ends_[e].a); }
  bool has_node(const Node& n) const { return n.g_ == this && n.i_ < size(); }
  bool has_edge(const Node& a, const Node& b) const {
    return find(a, b) < num_edges();
  }
  node_iterator node_begin() const { return {this, 0}; }
  node_iterator node_end() const { return {this, size()}; }
  edge_iterator edge_begin() const { return {this, 0}; }
  edge_iterator edge_end() const { return {this, num_edges()}; }

  Node add_node(const Point& p, const V& value = V()) {
    points_.push_back(p), values_.push_back(value);
    return rows_.clear(), node(size() - 1);
  }
  Edge add_edge(const Node& a, const Node& b, const E& value = E()) {
    const size_type e = find(a, b);
    if (e == num_edges()) {
      ends_.push_back({a.i_, b.i_, value});
      rows_.clear();
    }
    return Edge(this, e, a.i_);
  }
  size_type remove_edge(const Node& a, const Node& b) {
    const size_type e = find(a, b);
    if (e == num_edges()) return 0;
    ends_[e] = ends_.back();
    ends_.pop_back();
    return rows_.clear(), 1;
  }
  size_type remove_edge(const Edge& e) {
    return remove_edge(e.node1(), e.node2());
  }
  edge_iterator remove_edge(edge_iterator it) { return remove_edge(*it), it; }
  size_type remove_node(const Node& n) {
    if (!has_node(n)) return 0;
    const size_type i = n.i_, last = size() - 1;
    std::erase_if(ends_, [i](const Ends& e) { return e.a == i || e.b == i; });
    for (Ends& e : ends_) {
      if (e.a == last) e.a = i;
      if (e.b == last) e.b = i;
    }
    points_[i] = points_[last], values_[i] = values_[last];
    points_.pop_back(), values_.pop_back();
    return rows_.clear(), 1;
  }
  node_iterator remove_node(node_iterator it) { return remove_node(*it), it; }
  void clear() {
    points_.clear(), values_.clear(), ends_.clear(), rows_.clear();
  }

 private:
  struct Ends {
    size_type a, b;
    E value;
  };
  std::vector<Point> points_;
  std::vector<V> values_;
  std::vector<Ends> ends_;
  mutable std::vector<size_type> rows_, columns_;  // rows_ is empty: unknown

  size_type row(size_type i) const {
    if (rows_.empty()) {
      rows_.assign(size() + 2, 0);
      columns_.resize(2 * ends_.size());
      for (const Ends& e : ends_) ++rows_[e.a + 2], ++rows_[e.b + 2];
      for (size_type k = 2; k < rows_.size(); ++k) rows_[k] += rows_[k - 1];
      for (size_type e = 0; e < ends_.size(); ++e) {
        columns_[rows_[ends_[e].a + 1]++] = e;
        columns_[rows_[ends_[e].b + 1]++] = e;
      }
    }
    return rows_[i];
  }
  size_type find(const Node& a, const Node& b) const {
    for (auto it = a.edge_begin(); it != a.edge_end(); ++it)
      if ((*it).node2() == b) return (*it).e_;
    return num_edges();
  }
};
