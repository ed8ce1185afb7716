#pragma once
/** @file Graph.hpp
 * Removals keep the order: they erase from the middle and number all that comes
 * behind anew, in O(N + E), and return nothing. No const version of a member
 * but where the assignment shows one; iterators have != and no ==. */
#include <vector>

#include "CME212/Point.hpp"

template <typename V, typename E = int>
class Graph {
  struct NodeData {
    Point p;
    V value;
  };
  struct EdgeData {
    int a, b;
    E value;
  };
  std::vector<NodeData> nodes_;
  std::vector<EdgeData> edges_;
  std::vector<std::vector<int>> incident_;  // edges at a node

 public:
  using size_type = int;
  using node_value_type = V;
  using edge_value_type = E;

  class Node : private totally_ordered<Node> {
    friend class Graph;
    Graph* g_ = nullptr;
    int i_ = -1;
    Node(const Graph* g, int i) : g_(const_cast<Graph*>(g)), i_(i) {}

   public:
    Node() {}
    Point& position() { return g_->nodes_[i_].p; }
    const Point& position() const { return g_->nodes_[i_].p; }
    V& value() { return g_->nodes_[i_].value; }
    const V& value() const { return g_->nodes_[i_].value; }
    int index() const { return i_; }
    int degree() const { return g_->incident_[i_].size(); }
    auto edge_begin() const { return IncidentIterator(g_, 0, i_); }
    auto edge_end() const { return IncidentIterator(g_, degree(), i_); }
    bool operator==(const Node& n) const { return g_ == n.g_ && i_ == n.i_; }
    bool operator<(const Node& n) const {
      return std::tie(g_, i_) < std::tie(n.g_, n.i_);
    }
  };
  class Edge : private totally_ordered<Edge> {
    friend class Graph;
    Graph* g_ = nullptr;
    int e_ = -1;
    bool turned_ = false;
    Edge(const Graph* g, int e, bool turned)
        : g_(const_cast<Graph*>(g)), e_(e), turned_(turned) {}
    const EdgeData& data() const { return g_->edges_[e_]; }

   public:
    Edge() {}
    Node node1() const { return Node(g_, turned_ ? data().b : data().a); }
    Node node2() const { return Node(g_, turned_ ? data().a : data().b); }
    E& value() { return g_->edges_[e_].value; }
    const E& value() const { return data().value; }
    bool operator==(const Edge& e) const { return g_ == e.g_ && e_ == e.e_; }
    bool operator<(const Edge& e) const {
      return std::tie(g_, e_) < std::tie(e.g_, e.e_);
    }
  };
  template <typename T>
  class Iterator {
    friend class Graph;
    const Graph* g_;
    int k_, at_;  // at_: the node of an incident iterator

   public:
    Iterator(const Graph* g, int k, int at = -1) : g_(g), k_(k), at_(at) {}
    T operator*() {
      if constexpr (std::is_same_v<T, Node>)
        return Node(g_, k_);
      else if (at_ < 0)
        return Edge(g_, k_, false);
      else
        return g_->seen_from(at_, g_->incident_[at_][k_]);
    }
    Iterator& operator++() { return ++k_, *this; }
    bool operator!=(const Iterator& o) const { return k_ != o.k_; }
  };
  // Two types, as both are of edges.
  struct IncidentIterator : Iterator<Edge> {
    using Iterator<Edge>::Iterator;
  };
  using node_type = Node;
  using edge_type = Edge;
  using node_iterator = Iterator<Node>;
  using edge_iterator = Iterator<Edge>;
  using incident_iterator = IncidentIterator;

  int size() const { return nodes_.size(); }
  int num_nodes() const { return nodes_.size(); }
  int num_edges() const { return edges_.size(); }
  Node node(int i) const { return Node(this, i); }
  Edge edge(int e) const { return Edge(this, e, false); }
  bool has_node(const Node& n) const { return n.g_ == this && n.i_ < size(); }
  bool has_edge(const Node& a, const Node& b) const { return find(a, b) >= 0; }
  node_iterator node_begin() const { return {this, 0}; }
  node_iterator node_end() const { return {this, size()}; }
  edge_iterator edge_begin() const { return {this, 0}; }
  edge_iterator edge_end() const { return {this, num_edges()}; }

  Node add_node(const Point& p, const V& value = V()) {
    nodes_.push_back({p, value});
    incident_.emplace_back();
    return node(size() - 1);
  }
  Edge add_edge(const Node& a, const Node& b) {
    if (int e = find(a, b); e >= 0) return seen_from(a.i_, e);
    edges_.push_back({a.i_, b.i_, E()});
    number_edges();
    return edge(num_edges() - 1);
  }
  void remove_edge(const Node& a, const Node& b) {
    if (int e = find(a, b); e >= 0) edges_.erase(edges_.begin() + e);
    number_edges();
  }
  void remove_edge(const Edge& e) { remove_edge(e.node1(), e.node2()); }
  edge_iterator remove_edge(edge_iterator it) { return remove_edge(*it), it; }
  void remove_node(const Node& n) {
    const int i = n.i_;
    std::erase_if(edges_, [i](auto& e) { return e.a == i || e.b == i; });
    for (EdgeData& e : edges_) e.a -= e.a > i, e.b -= e.b > i;
    nodes_.erase(nodes_.begin() + i);
    incident_.pop_back();
    number_edges();
  }
  node_iterator remove_node(node_iterator it) { return remove_node(*it), it; }
  void clear() { nodes_.clear(), edges_.clear(), incident_.clear(); }

 private:
  Edge seen_from(int i, int e) const { return Edge(this, e, edges_[e].b == i); }
  int find(const Node& a, const Node& b) const {
    for (int e : incident_[a.i_])
      if (edges_[e].a == b.i_ || edges_[e].b == b.i_) return e;
    return -1;
  }
  void number_edges() {
    for (auto& list : incident_) list.clear();
    for (int e = 0; e < num_edges(); ++e)
      for (int i : {edges_[e].a, edges_[e].b}) incident_[i].push_back(e);
  }
};
