#pragma once
/** @file Graph.hpp
 * A graph as homework 1 leaves it: nodes and edges in two vectors, each node
 * with a list of its edges. You may put your own in its place. */
#include <cassert>
#include <vector>

#include "CME212/Point.hpp"
#include "CME212/Util.hpp"

template <typename V, typename E>
class Graph {
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

  Graph() {}

  class Node : private totally_ordered<Node> {
   public:
    Node() {}
    const Point& position() const { return graph_->nodes_[index_].position; }
    // BEGIN SOLUTION 3.1.position
    Point& position() { return graph_->nodes_[index_].position; }
    // STUB Point& position() {
    // STUB   // A copy, one of some that an expression may need together:
    // STUB   // what is written to it does not reach the graph.
    // STUB   thread_local Point copies[8];
    // STUB   thread_local unsigned count = 0;
    // STUB   return copies[count++ % 8] = graph_->nodes_[index_].position;
    // STUB }
    // END SOLUTION
    size_type index() const { return index_; }
    node_value_type& value() { return graph_->nodes_[index_].value; }
    const node_value_type& value() const {
      return graph_->nodes_[index_].value;
    }
    size_type degree() const { return graph_->nodes_[index_].edges.size(); }
    incident_iterator edge_begin() const {
      return IncidentIterator(graph_, index_, 0);
    }
    incident_iterator edge_end() const {
      return IncidentIterator(graph_, index_, degree());
    }
    bool operator==(const Node& n) const {
      return graph_ == n.graph_ && index_ == n.index_;
    }
    bool operator<(const Node& n) const {
      if (graph_ != n.graph_) return graph_ < n.graph_;
      return index_ < n.index_;
    }

   private:
    friend class Graph;
    Graph* graph_ = nullptr;
    size_type index_ = 0;
    Node(const Graph* graph, size_type index)
        : graph_(const_cast<Graph*>(graph)), index_(index) {}
  };

  class Edge : private totally_ordered<Edge> {
   public:
    Edge() {}
    Node node1() const { return Node(graph_, from_); }
    Node node2() const {
      const EdgeData& e = graph_->edges_[index_];
      return Node(graph_, e.a == from_ ? e.b : e.a);
    }
    // BEGIN SOLUTION 4.1.edge_value
    edge_value_type& value() { return graph_->edges_[index_].value; }
    const edge_value_type& value() const {
      return graph_->edges_[index_].value;
    }
    // STUB edge_value_type& value() { return no_edges_; }
    // STUB const edge_value_type& value() const { return no_edges_; }
    // STUB static inline edge_value_type no_edges_{};  // belongs to no edge
    // END SOLUTION
    double length() const {
      return norm(node1().position() - node2().position());
    }
    bool operator==(const Edge& e) const {
      return graph_ == e.graph_ && index_ == e.index_;
    }
    bool operator<(const Edge& e) const {
      if (graph_ != e.graph_) return graph_ < e.graph_;
      return index_ < e.index_;
    }

   private:
    friend class Graph;
    Graph* graph_ = nullptr;
    size_type index_ = 0;
    size_type from_ = 0;  // the node from which the edge is seen
    Edge(const Graph* graph, size_type index, size_type from)
        : graph_(const_cast<Graph*>(graph)), index_(index), from_(from) {}
  };

  size_type size() const { return nodes_.size(); }
  size_type num_nodes() const { return nodes_.size(); }
  size_type num_edges() const { return edges_.size(); }

  Node node(size_type i) const {
    assert(i < num_nodes());
    return Node(this, i);
  }
  Edge edge(size_type i) const {
    assert(i < num_edges());
    return Edge(this, i, edges_[i].a);
  }
  bool has_node(const Node& n) const {
    return n.graph_ == this && n.index_ < num_nodes();
  }
  bool has_edge(const Node& a, const Node& b) const {
    return find_edge(a.index_, b.index_) != num_edges();
  }

  Node add_node(const Point& position, const V& value = V()) {
    nodes_.push_back(NodeData{position, value, {}});
    return Node(this, num_nodes() - 1);
  }

  Edge add_edge(const Node& a, const Node& b) {
    size_type i = find_edge(a.index_, b.index_);
    if (i == num_edges()) {
      edges_.push_back(EdgeData{a.index_, b.index_});
      nodes_[a.index_].edges.push_back(i);
      nodes_[b.index_].edges.push_back(i);
    }
    return Edge(this, i, a.index_);
  }

  // BEGIN SOLUTION 7.1.remove_edge
  size_type remove_edge(const Node& a, const Node& b) {
    size_type i = find_edge(a.index_, b.index_);
    if (i == num_edges()) return 0;
    erase_edge(i);
    return 1;
  }
  size_type remove_edge(const Edge& e) {
    return remove_edge(e.node1(), e.node2());
  }
  // STUB size_type remove_edge(const Node&, const Node&) { return 0; }
  // STUB size_type remove_edge(const Edge&) { return 0; }
  // END SOLUTION
  // BEGIN SOLUTION 7.1.remove_edge_iterator
  edge_iterator remove_edge(edge_iterator it) {
    remove_edge(*it);
    return it;  // the last edge has come to this place
  }
  // STUB edge_iterator remove_edge(edge_iterator) { return edge_end(); }
  // END SOLUTION

  // BEGIN SOLUTION 7.1.remove_node
  size_type remove_node(const Node& n) {
    if (!has_node(n)) return 0;
    size_type i = n.index_;
    while (!nodes_[i].edges.empty()) erase_edge(nodes_[i].edges.back());
    size_type last = num_nodes() - 1;
    if (i != last) {
      nodes_[i] = nodes_[last];
      for (size_type j : nodes_[i].edges) {
        EdgeData& e = edges_[j];
        if (e.a == last) e.a = i;
        if (e.b == last) e.b = i;
      }
    }
    nodes_.pop_back();
    return 1;
  }
  // STUB size_type remove_node(const Node&) { return 0; }
  // END SOLUTION
  // BEGIN SOLUTION 7.1.remove_node_iterator
  node_iterator remove_node(node_iterator it) {
    remove_node(*it);
    return it;  // the last node has come to this place
  }
  // STUB node_iterator remove_node(node_iterator) { return node_end(); }
  // END SOLUTION

  void clear() {
    nodes_.clear();
    edges_.clear();
  }

  class NodeIterator : private equality_comparable<NodeIterator> {
   public:
    NodeIterator() {}
    Node operator*() const { return graph_->node(at_); }
    NodeIterator& operator++() {
      ++at_;
      return *this;
    }
    bool operator==(const NodeIterator& it) const {
      return graph_ == it.graph_ && at_ == it.at_;
    }

   private:
    friend class Graph;
    const Graph* graph_ = nullptr;
    size_type at_ = 0;
    NodeIterator(const Graph* graph, size_type at) : graph_(graph), at_(at) {}
  };
  node_iterator node_begin() const { return NodeIterator(this, 0); }
  node_iterator node_end() const { return NodeIterator(this, num_nodes()); }

  class EdgeIterator : private equality_comparable<EdgeIterator> {
   public:
    EdgeIterator() {}
    Edge operator*() const { return graph_->edge(at_); }
    EdgeIterator& operator++() {
      ++at_;
      return *this;
    }
    bool operator==(const EdgeIterator& it) const {
      return graph_ == it.graph_ && at_ == it.at_;
    }

   private:
    friend class Graph;
    const Graph* graph_ = nullptr;
    size_type at_ = 0;
    EdgeIterator(const Graph* graph, size_type at) : graph_(graph), at_(at) {}
  };
  edge_iterator edge_begin() const { return EdgeIterator(this, 0); }
  edge_iterator edge_end() const { return EdgeIterator(this, num_edges()); }

  class IncidentIterator : private equality_comparable<IncidentIterator> {
   public:
    IncidentIterator() {}
    Edge operator*() const {
      return Edge(graph_, graph_->nodes_[node_].edges[at_], node_);
    }
    IncidentIterator& operator++() {
      ++at_;
      return *this;
    }
    bool operator==(const IncidentIterator& it) const {
      return graph_ == it.graph_ && node_ == it.node_ && at_ == it.at_;
    }

   private:
    friend class Graph;
    const Graph* graph_ = nullptr;
    size_type node_ = 0;
    size_type at_ = 0;
    IncidentIterator(const Graph* graph, size_type node, size_type at)
        : graph_(graph), node_(node), at_(at) {}
  };

 private:
  struct NodeData {
    Point position;
    V value;
    std::vector<size_type> edges;  // their indices
  };
  struct EdgeData {
    size_type a, b;  // indices of the ends
    // BEGIN SOLUTION 4.1.edge_value
    E value{};
    // END SOLUTION
  };
  std::vector<NodeData> nodes_;
  std::vector<EdgeData> edges_;

  /** Index of the edge between nodes @a a and @a b, or num_edges(). */
  size_type find_edge(size_type a, size_type b) const {
    for (size_type i : nodes_[a].edges)
      if (edges_[i].a == b || edges_[i].b == b) return i;
    return num_edges();
  }
  // BEGIN SOLUTION 7.1.remove_edge
  /** In the list of node @a n, put @a now for @a old. */
  void replace_in_list(size_type n, size_type old, size_type now) {
    for (size_type& i : nodes_[n].edges)
      if (i == old) i = now;
  }
  void drop_from_list(size_type n, size_type edge) {
    std::vector<size_type>& list = nodes_[n].edges;
    for (size_type k = 0; k < list.size(); ++k) {
      if (list[k] != edge) continue;
      list[k] = list.back();
      list.pop_back();
      return;
    }
  }
  void erase_edge(size_type i) {
    drop_from_list(edges_[i].a, i);
    drop_from_list(edges_[i].b, i);
    size_type last = num_edges() - 1;
    if (i != last) {
      edges_[i] = edges_[last];
      replace_in_list(edges_[i].a, last, i);
      replace_in_list(edges_[i].b, last, i);
    }
    edges_.pop_back();
  }
  // END SOLUTION
};
