#pragma once
/** @file Graph.hpp
 * Sets: the edges are a std::set ordered by their ends, and each node has the
 * set of its neighbors. The value of an edge is mutable in its set. */
#include <set>
#include <vector>

#include "CME212/Point.hpp"

template <typename V, typename E = char>
class Graph {
  struct Record {
    unsigned a, b;  // a < b
    mutable E value;
    bool operator<(const Record& r) const {
      return std::tie(a, b) < std::tie(r.a, r.b);
    }
  };
  struct Data {
    Point p;
    V value;
    std::set<unsigned> neighbors;
  };
  std::vector<Data> nodes_;
  std::set<Record> edges_;

 public:
  using size_type = unsigned;
  using node_value_type = V;
  using edge_value_type = E;

  struct IncidentIterator;
  struct Node : totally_ordered<Node> {
    Graph* g = nullptr;
    unsigned i = 0;
    Node() {}
    Node(const Graph* graph, unsigned n) : g(const_cast<Graph*>(graph)), i(n) {}
    Point& position() { return g->nodes_.at(i).p; }
    const Point& position() const { return g->nodes_.at(i).p; }
    V& value() { return g->nodes_.at(i).value; }
    const V& value() const { return g->nodes_.at(i).value; }
    size_type index() const { return i; }
    size_type degree() const { return g->nodes_.at(i).neighbors.size(); }
    IncidentIterator edge_begin() const {
      return {*this, g->nodes_.at(i).neighbors.begin()};
    }
    IncidentIterator edge_end() const {
      return {*this, g->nodes_.at(i).neighbors.end()};
    }
    bool operator==(const Node& n) const { return g == n.g && i == n.i; }
    bool operator<(const Node& n) const {
      return std::tie(g, i) < std::tie(n.g, n.i);
    }
  };
  struct Edge : totally_ordered<Edge> {
    Node a, b;
    Node node1() const { return a; }
    Node node2() const { return b; }
    E& value() { return a.g->find(a.i, b.i)->value; }
    const E& value() const { return a.g->find(a.i, b.i)->value; }
    bool operator==(const Edge& e) const {
      return std::minmax(a, b) == std::minmax(e.a, e.b);
    }
    bool operator<(const Edge& e) const {
      return std::minmax(a, b) < std::minmax(e.a, e.b);
    }
    Edge() {}
    Edge(const Graph* g, unsigned i, unsigned j) : a(g, i), b(g, j) {}
  };
  struct NodeIterator : equality_comparable<NodeIterator> {
    Node n;
    NodeIterator(Node node) : n(node) {}
    Node operator*() const { return n; }
    NodeIterator& operator++() { return ++n.i, *this; }
    bool operator==(const NodeIterator& o) const { return n == o.n; }
  };
  struct EdgeIterator : equality_comparable<EdgeIterator> {
    const Graph* g;
    typename std::set<Record>::iterator it;
    EdgeIterator(const Graph* graph, decltype(it) at) : g(graph), it(at) {}
    Edge operator*() const { return Edge(g, it->a, it->b); }
    EdgeIterator& operator++() { return ++it, *this; }
    bool operator==(const EdgeIterator& o) const { return it == o.it; }
  };
  struct IncidentIterator : equality_comparable<IncidentIterator> {
    Node n;
    std::set<unsigned>::iterator it;
    IncidentIterator(Node node, decltype(it) at) : n(node), it(at) {}
    Edge operator*() const { return Edge(n.g, n.i, *it); }
    IncidentIterator& operator++() { return ++it, *this; }
    bool operator==(const IncidentIterator& o) const { return it == o.it; }
  };
  using node_type = Node;
  using edge_type = Edge;
  using node_iterator = NodeIterator;
  using edge_iterator = EdgeIterator;
  using incident_iterator = IncidentIterator;

  size_type size() const { return nodes_.size(); }
  size_type num_nodes() const { return nodes_.size(); }
  size_type num_edges() const { return edges_.size(); }
  Node node(size_type i) const { return Node(this, i); }
  Edge edge(size_type i) const {
    return *EdgeIterator(this, std::next(edges_.begin(), i));
  }
  bool has_node(const Node& n) const { return n.g == this && n.i < size(); }
  bool has_edge(const Node& a, const Node& b) const {
    return nodes_[a.i].neighbors.count(b.i) == 1;
  }
  NodeIterator node_begin() const { return node(0); }
  NodeIterator node_end() const { return node(size()); }
  EdgeIterator edge_begin() const { return {this, edges_.begin()}; }
  EdgeIterator edge_end() const { return {this, edges_.end()}; }

  Node add_node(const Point& p, const V& value = V()) {
    nodes_.push_back({p, value, {}});
    return node(size() - 1);
  }
  Edge add_edge(const Node& a, const Node& b, const E& value = E()) {
    edges_.insert({std::min(a.i, b.i), std::max(a.i, b.i), value});
    nodes_[a.i].neighbors.insert(b.i);
    nodes_[b.i].neighbors.insert(a.i);
    return Edge(this, a.i, b.i);
  }
  size_type remove_edge(const Node& a, const Node& b) {
    if (!has_edge(a, b)) return 0;
    edges_.erase(find(a.i, b.i));
    nodes_[a.i].neighbors.erase(b.i);
    return nodes_[b.i].neighbors.erase(a.i);
  }
  size_type remove_edge(const Edge& e) { return remove_edge(e.a, e.b); }
  EdgeIterator remove_edge(EdgeIterator it) {
    const Edge e = *it;
    ++it;
    remove_edge(e);
    return it;
  }
  size_type remove_node(const Node& n) {
    if (!has_node(n)) return 0;
    while (n.degree() > 0) remove_edge(*n.edge_begin());
    const Node last = node(size() - 1);
    if (n != last) {  // it takes the place of n, with its edges
      nodes_[n.i].p = last.position(), nodes_[n.i].value = last.value();
      while (last.degree() > 0) {
        Edge e = *last.edge_begin();
        add_edge(n, e.node2(), e.value());
        remove_edge(e);
      }
    }
    nodes_.pop_back();
    return 1;
  }
  NodeIterator remove_node(NodeIterator it) { return remove_node(*it), it; }
  void clear() { nodes_.clear(), edges_.clear(); }

 private:
  auto find(unsigned i, unsigned j) const {
    return edges_.find({std::min(i, j), std::max(i, j), E()});
  }
};
