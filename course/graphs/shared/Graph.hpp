#pragma once
/** @file Graph.hpp
 * Shared nodes: handles and graph share the data of a node, which live as long
 * as the last of them; so do edges. Each node has a map to its neighbors. */
#include <map>
#include <memory>
#include <vector>

#include "CME212/Point.hpp"

template <typename V, typename E = int>
class Graph {
 public:
  using size_type = std::size_t;
  using node_value_type = V;
  using edge_value_type = E;

  class Node;
  class Edge;
  struct NodeIterator;
  struct EdgeIterator;
  struct IncidentIterator;
  using node_type = Node;
  using edge_type = Edge;
  using node_iterator = NodeIterator;
  using edge_iterator = EdgeIterator;
  using incident_iterator = IncidentIterator;

 private:
  struct Data {
    const Graph* graph;  // null once it was removed
    Point position;
    V value;
    size_type index;
    std::map<size_type, Edge> edges;  // by the other node's key
    size_type key;                    // never used again
  };

 public:
  class Node : private totally_ordered<Node> {
   public:
    Node() {}
    Point& position() { return data_->position; }
    const Point& position() const { return data_->position; }
    V& value() { return data_->value; }
    const V& value() const { return data_->value; }
    size_type index() const { return data_->index; }
    size_type degree() const { return data_->edges.size(); }
    IncidentIterator edge_begin() const { return {data_->edges.begin()}; }
    IncidentIterator edge_end() const { return {data_->edges.end()}; }
    bool operator==(const Node& n) const { return data_ == n.data_; }
    bool operator<(const Node& n) const { return data_ < n.data_; }

   private:
    friend class Graph;
    std::shared_ptr<Data> data_;
  };
  class Edge : private totally_ordered<Edge> {
   public:
    Edge() {}
    Node node1() const { return lock(a_); }
    Node node2() const { return lock(b_); }
    E& value() { return *value_; }
    const E& value() const { return *value_; }
    bool operator==(const Edge& e) const { return value_ == e.value_; }
    bool operator<(const Edge& e) const { return value_ < e.value_; }

   private:
    friend class Graph;
    std::weak_ptr<Data> a_, b_;
    std::shared_ptr<E> value_;  // that both ends share
    static Node lock(const std::weak_ptr<Data>& data) {
      Node n;
      n.data_ = data.lock();
      return n;
    }
  };
  struct NodeIterator : equality_comparable<NodeIterator> {
    const Graph* g;
    size_type k;
    NodeIterator(const Graph* graph, size_type at) : g(graph), k(at) {}
    Node operator*() const { return g->nodes_[k]; }
    NodeIterator& operator++() { return ++k, *this; }
    bool operator==(const NodeIterator& o) const { return k == o.k; }
  };
  struct EdgeIterator : equality_comparable<EdgeIterator> {
    const Graph* g;
    size_type k;
    EdgeIterator(const Graph* graph, size_type at) : g(graph), k(at) {}
    Edge operator*() const { return g->edges_[k]; }
    EdgeIterator& operator++() { return ++k, *this; }
    bool operator==(const EdgeIterator& o) const { return k == o.k; }
  };
  struct IncidentIterator : equality_comparable<IncidentIterator> {
    typename std::map<size_type, Edge>::const_iterator it;
    IncidentIterator(decltype(it) i) : it(i) {}
    Edge operator*() const { return it->second; }
    IncidentIterator& operator++() { return ++it, *this; }
    bool operator==(const IncidentIterator& o) const { return it == o.it; }
  };

  Graph() {}
  ~Graph() { clear(); }
  size_type size() const { return nodes_.size(); }
  size_type num_nodes() const { return nodes_.size(); }
  size_type num_edges() const { return edges_.size(); }
  Node node(size_type i) const { return nodes_[i]; }
  Edge edge(size_type i) const { return edges_[i]; }
  bool has_node(const Node& n) const {
    return n.data_ && n.data_->graph == this;
  }
  bool has_edge(const Node& a, const Node& b) const {
    return a.data_->edges.count(b.data_->key) == 1;
  }
  NodeIterator node_begin() const { return {this, 0}; }
  NodeIterator node_end() const { return {this, size()}; }
  EdgeIterator edge_begin() const { return {this, 0}; }
  EdgeIterator edge_end() const { return {this, num_edges()}; }

  Node add_node(const Point& p, const V& value = V()) {
    Node n;
    n.data_ = std::make_shared<Data>(this, p, value, size(),
                                     decltype(Data::edges){}, keys_++);
    nodes_.push_back(n);
    return n;
  }
  Edge add_edge(const Node& a, const Node& b) {
    if (has_edge(a, b)) return a.data_->edges[b.data_->key];
    Edge& e = a.data_->edges[b.data_->key];
    Edge& back = b.data_->edges[a.data_->key];
    e.a_ = back.b_ = a.data_;
    e.b_ = back.a_ = b.data_;
    e.value_ = back.value_ = std::make_shared<E>();
    edges_.push_back(e);
    return e;
  }
  size_type remove_edge(const Edge& e) {
    return remove_edge(e.node1(), e.node2());
  }
  size_type remove_edge(const Node& a, const Node& b) {
    if (!has_edge(a, b)) return 0;
    std::erase(edges_, a.data_->edges[b.data_->key]);
    a.data_->edges.erase(b.data_->key);
    return b.data_->edges.erase(a.data_->key);
  }
  EdgeIterator remove_edge(EdgeIterator it) { return remove_edge(*it), it; }
  size_type remove_node(const Node& node) {
    const Node n = node;  // it may be in the vector
    if (!has_node(n)) return 0;
    while (n.degree() > 0) remove_edge(*n.edge_begin());
    n.data_->graph = nullptr;
    nodes_.back().data_->index = n.index();
    nodes_[n.index()] = nodes_.back();
    nodes_.pop_back();
    return 1;
  }
  NodeIterator remove_node(NodeIterator it) { return remove_node(*it), it; }
  void clear() {
    for (Node& n : nodes_) n.data_->graph = nullptr, n.data_->edges.clear();
    nodes_.clear(), edges_.clear();
  }

 private:
  std::vector<Node> nodes_;
  std::vector<Edge> edges_;
  size_type keys_ = 0;
};
