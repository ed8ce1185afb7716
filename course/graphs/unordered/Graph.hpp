#pragma once
/** @file Graph.hpp
 * Hash tables: nodes by a name that is never used again, edges by the names of
 * both ends in one number; beside them the names in the order of the indices.
 */
#include <unordered_map>
#include <vector>

#include "CME212/Point.hpp"

template <typename V, typename E = double>
class Graph {
  using Name = std::uint32_t;
  using EdgeName = std::uint64_t;
  struct Data {
    Point point;
    V value;
    unsigned index;
    std::vector<Name> neighbors;
  };
  struct EdgeData {
    E value;
    unsigned index;
  };

 public:
  using size_type = unsigned;
  using node_value_type = V;
  using edge_value_type = E;
  class Node;
  class Edge;
  class NodeIterator;
  class EdgeIterator;
  class IncidentIterator;
  using node_type = Node;
  using edge_type = Edge;
  using node_iterator = NodeIterator;
  using edge_iterator = EdgeIterator;
  using incident_iterator = IncidentIterator;

  class Node : private totally_ordered<Node> {
   public:
    Node() = default;
    Point& position() { return data().point; }
    const Point& position() const { return data().point; }
    V& value() { return data().value; }
    const V& value() const { return data().value; }
    size_type index() const { return data().index; }
    size_type degree() const { return data().neighbors.size(); }
    IncidentIterator edge_begin() const { return {*this, 0}; }
    IncidentIterator edge_end() const { return {*this, degree()}; }
    bool operator==(const Node& n) const {
      return g_ == n.g_ && name_ == n.name_;
    }
    bool operator<(const Node& n) const {
      return g_ == n.g_ ? name_ < n.name_ : g_ < n.g_;
    }

   private:
    friend class Graph;
    Graph* g_ = nullptr;
    Name name_ = 0;
    Node(const Graph* g, Name name) : g_(const_cast<Graph*>(g)), name_(name) {}
    Data& data() const { return g_->nodes_.at(name_); }
  };
  class Edge : private totally_ordered<Edge> {
   public:
    Edge() = default;
    Node node1() const { return a_; }
    Node node2() const { return b_; }
    E& value() { return a_.g_->edges_.at(name()).value; }
    const E& value() const { return a_.g_->edges_.at(name()).value; }
    bool operator==(const Edge& e) const {
      return a_.g_ == e.a_.g_ && name() == e.name();
    }
    bool operator<(const Edge& e) const {
      return a_.g_ == e.a_.g_ ? name() < e.name() : a_.g_ < e.a_.g_;
    }

   private:
    friend class Graph;
    Node a_, b_;
    Edge(Node a, Node b) : a_(a), b_(b) {}
    Edge(const Graph* g, EdgeName name)
        : a_(g, Name(name >> 32)), b_(g, Name(name)) {}
    EdgeName name() const { return name_of(a_, b_); }
  };
  class NodeIterator {
   public:
    Node operator*() const { return g_->node(k_); }
    NodeIterator& operator++() { return ++k_, *this; }
    bool operator==(const NodeIterator& o) const = default;

   private:
    friend class Graph;
    const Graph* g_;
    size_type k_;
    NodeIterator(const Graph* g, size_type k) : g_(g), k_(k) {}
  };
  class EdgeIterator {
   public:
    Edge operator*() const { return g_->edge(k_); }
    EdgeIterator& operator++() { return ++k_, *this; }
    bool operator==(const EdgeIterator& o) const = default;

   private:
    friend class Graph;
    const Graph* g_;
    size_type k_;
    EdgeIterator(const Graph* g, size_type k) : g_(g), k_(k) {}
  };
  class IncidentIterator {
   public:
    Edge operator*() const {
      return Edge(n_, Node(n_.g_, n_.data().neighbors[k_]));
    }
    IncidentIterator& operator++() { return ++k_, *this; }
    bool operator==(const IncidentIterator& o) const = default;

   private:
    friend class Graph;
    Node n_;
    size_type k_;
    IncidentIterator(Node n, size_type k) : n_(n), k_(k) {}
  };

  size_type size() const { return order_.size(); }
  size_type num_nodes() const { return order_.size(); }
  size_type num_edges() const { return edge_order_.size(); }
  Node node(size_type i) const { return Node(this, order_[i]); }
  Edge edge(size_type i) const { return Edge(this, edge_order_[i]); }
  bool has_node(const Node& n) const {
    return n.g_ == this && nodes_.contains(n.name_);
  }
  bool has_edge(const Node& a, const Node& b) const {
    return edges_.contains(name_of(a, b));
  }
  NodeIterator node_begin() const { return {this, 0}; }
  NodeIterator node_end() const { return {this, size()}; }
  EdgeIterator edge_begin() const { return {this, 0}; }
  EdgeIterator edge_end() const { return {this, num_edges()}; }

  Node add_node(const Point& p, const V& value = V()) {
    nodes_[next_] = {p, value, size(), {}};
    order_.push_back(next_);
    return Node(this, next_++);
  }
  Edge add_edge(const Node& a, const Node& b) {
    if (edges_.emplace(name_of(a, b), EdgeData{E(), num_edges()}).second) {
      edge_order_.push_back(name_of(a, b));
      a.data().neighbors.push_back(b.name_);
      b.data().neighbors.push_back(a.name_);
    }
    return Edge(a, b);
  }
  size_type remove_edge(const Node& a, const Node& b) {
    const auto it = edges_.find(name_of(a, b));
    if (it == edges_.end()) return 0;
    std::erase(a.data().neighbors, b.name_);
    std::erase(b.data().neighbors, a.name_);
    edges_.at(edge_order_.back()).index = it->second.index;
    edge_order_[it->second.index] = edge_order_.back();
    edge_order_.pop_back();
    edges_.erase(it);
    return 1;
  }
  size_type remove_edge(const Edge& e) { return remove_edge(e.a_, e.b_); }
  EdgeIterator remove_edge(EdgeIterator it) { return remove_edge(*it), it; }
  size_type remove_node(const Node& n) {
    if (!has_node(n)) return 0;
    while (n.degree() > 0) remove_edge(*n.edge_begin());
    nodes_.at(order_.back()).index = n.index();
    order_[n.index()] = order_.back();
    order_.pop_back();
    return nodes_.erase(n.name_);
  }
  NodeIterator remove_node(NodeIterator it) { return remove_node(*it), it; }
  void clear() {
    nodes_.clear(), edges_.clear(), order_.clear(), edge_order_.clear();
  }

 private:
  std::unordered_map<Name, Data> nodes_;
  std::unordered_map<EdgeName, EdgeData> edges_;
  std::vector<Name> order_;
  std::vector<EdgeName> edge_order_;
  Name next_ = 0;
  static EdgeName name_of(const Node& a, const Node& b) {
    const auto [low, high] = std::minmax(a.name_, b.name_);
    return EdgeName(low) << 32 | high;
  }
};
