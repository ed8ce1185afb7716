#pragma once
/** @file Graph.hpp
 * Unique ids, as a lecture shows it: a removal takes the id out of the list of
 * indices, and the data stay where they are. So a Node stays what it is. */
#include <vector>

#include "CME212/Point.hpp"

template <typename V, typename E = int>
class Graph {
 public:
  using size_type = unsigned;
  using node_value_type = V;
  using edge_value_type = E;
  template <typename T>
  class Iterator;
  class Node;
  class Edge;
  class IncidentIterator;
  using node_type = Node;
  using edge_type = Edge;
  using NodeIterator = Iterator<Node>;
  using EdgeIterator = Iterator<Edge>;
  using node_iterator = NodeIterator;
  using edge_iterator = EdgeIterator;
  using incident_iterator = IncidentIterator;

 private:
  struct Internal {
    Point position;
    V value;
    size_type index;
    std::vector<size_type> edges;  // uids
  };
  struct InternalEdge {
    size_type a, b, index;
    E value;
  };
  std::vector<Internal> nodes_;
  std::vector<InternalEdge> edges_;
  std::vector<size_type> i2u_, e2u_;  // the uid of an index

 public:
  class Node : private totally_ordered<Node> {
   public:
    Node() : graph_(nullptr), uid_(0) {}
    Point& position() { return fetch().position; }
    const Point& position() const { return fetch().position; }
    V& value() { return fetch().value; }
    const V& value() const { return fetch().value; }
    size_type index() const { return fetch().index; }
    size_type degree() const { return fetch().edges.size(); }
    IncidentIterator edge_begin() const { return {*this, 0}; }
    IncidentIterator edge_end() const { return {*this, degree()}; }
    bool operator==(const Node& n) const {
      return graph_ == n.graph_ && uid_ == n.uid_;
    }
    bool operator<(const Node& n) const {
      return graph_ < n.graph_ || (graph_ == n.graph_ && uid_ < n.uid_);
    }

   private:
    friend class Graph;
    Graph* graph_;
    size_type uid_;
    Node(const Graph* g, size_type uid)
        : graph_(const_cast<Graph*>(g)), uid_(uid) {}
    Internal& fetch() const { return graph_->nodes_[uid_]; }
  };
  class Edge : private totally_ordered<Edge> {
   public:
    Edge() : uid_(0) {}
    Node node1() const { return a_; }
    Node node2() const { return b_; }
    E& value() { return a_.graph_->edges_[uid_].value; }
    const E& value() const { return a_.graph_->edges_[uid_].value; }
    bool operator==(const Edge& e) const {
      return a_.graph_ == e.a_.graph_ && uid_ == e.uid_;
    }
    bool operator<(const Edge& e) const {
      return a_.graph_ < e.a_.graph_ ||
             (a_.graph_ == e.a_.graph_ && uid_ < e.uid_);
    }

   private:
    friend class Graph;
    Node a_, b_;
    size_type uid_;
    Edge(Node a, Node b, size_type uid) : a_(a), b_(b), uid_(uid) {}
  };
  template <typename T>
  class Iterator : private equality_comparable<Iterator<T>> {
   public:
    Iterator() {}
    T operator*() const { return graph_->at(k_, T()); }
    Iterator& operator++() { return ++k_, *this; }
    bool operator==(const Iterator& o) const { return k_ == o.k_; }

   private:
    friend class Graph;
    const Graph* graph_;
    size_type k_;
    Iterator(const Graph* g, size_type k) : graph_(g), k_(k) {}
  };
  class IncidentIterator {
   public:
    Edge operator*() const {
      return node_.graph_->seen_from(node_.uid_, node_.fetch().edges[k_]);
    }
    IncidentIterator& operator++() { return ++k_, *this; }
    bool operator==(const IncidentIterator& o) const = default;

   private:
    friend class Graph;
    Node node_;
    size_type k_;
    IncidentIterator(Node n, size_type k) : node_(n), k_(k) {}
  };

  size_type size() const { return i2u_.size(); }
  size_type num_nodes() const { return i2u_.size(); }
  size_type num_edges() const { return e2u_.size(); }
  Node node(size_type i) const { return Node(this, i2u_[i]); }
  Edge edge(size_type e) const { return seen_from(edges_[e2u_[e]].a, e2u_[e]); }
  bool has_node(const Node& n) const {
    return n.graph_ == this && n.index() < size() && node(n.index()) == n;
  }
  bool has_edge(const Node& a, const Node& b) const {
    return find(a, b) < edges_.size();
  }
  NodeIterator node_begin() const { return {this, 0}; }
  NodeIterator node_end() const { return {this, size()}; }
  EdgeIterator edge_begin() const { return {this, 0}; }
  EdgeIterator edge_end() const { return {this, num_edges()}; }

  Node add_node(const Point& position, const V& value = V()) {
    nodes_.push_back({position, value, size(), {}});
    i2u_.push_back(nodes_.size() - 1);
    return node(size() - 1);
  }
  Edge add_edge(const Node& a, const Node& b, const E& value = E()) {
    const size_type uid = find(a, b);
    if (uid == edges_.size()) {
      edges_.push_back({a.uid_, b.uid_, num_edges(), value});
      e2u_.push_back(uid);
      a.fetch().edges.push_back(uid);
      b.fetch().edges.push_back(uid);
    }
    return Edge(a, b, uid);
  }
  size_type remove_edge(const Node& a, const Node& b) {
    const size_type uid = find(a, b);
    if (uid == edges_.size()) return 0;
    std::erase(a.fetch().edges, uid);
    std::erase(b.fetch().edges, uid);
    const size_type index = edges_[uid].index;
    edges_[e2u_.back()].index = index;
    e2u_[index] = e2u_.back();
    e2u_.pop_back();
    return 1;
  }
  size_type remove_edge(const Edge& e) { return remove_edge(e.a_, e.b_); }
  EdgeIterator remove_edge(EdgeIterator it) { return remove_edge(*it), it; }
  size_type remove_node(const Node& n) {
    if (!has_node(n)) return 0;
    while (n.degree() > 0) remove_edge(*n.edge_begin());
    const size_type index = n.index();
    nodes_[i2u_.back()].index = index;
    i2u_[index] = i2u_.back();
    i2u_.pop_back();
    return 1;
  }
  NodeIterator remove_node(NodeIterator it) { return remove_node(*it), it; }
  void clear() {
    nodes_.clear(), edges_.clear();
    i2u_.clear(), e2u_.clear();
  }

 private:
  Node at(size_type i, Node) const { return node(i); }
  Edge at(size_type e, Edge) const { return edge(e); }
  Edge seen_from(size_type i, size_type uid) const {
    const InternalEdge& e = edges_[uid];
    return Edge(Node(this, i), Node(this, e.a == i ? e.b : e.a), uid);
  }
  size_type find(const Node& a, const Node& b) const {
    for (size_type uid : a.fetch().edges)
      if (edges_[uid].a == b.uid_ || edges_[uid].b == b.uid_) return uid;
    return edges_.size();
  }
};
