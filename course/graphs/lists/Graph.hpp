#pragma once
/** @file Graph.hpp
 * Linked lists: a Node is an iterator of the list of nodes, an Edge one of the
 * list of edges, and node(i) walks. Handles of others outlive a removal. */
#include <list>

#include "CME212/Point.hpp"

template <typename V, typename E = double>
class Graph {
  struct NodeData;
  struct EdgeData;
  using NodePlace = typename std::list<NodeData>::iterator;
  using EdgePlace = typename std::list<EdgeData>::iterator;
  struct NodeData {
    Point position;
    V value;
    std::list<EdgePlace> edges;
    Graph* graph;
  };
  struct EdgeData {
    NodePlace a, b;
    E value;
  };
  std::list<NodeData> nodes_;
  std::list<EdgeData> edges_;

 public:
  using size_type = std::size_t;
  using node_value_type = V;
  using edge_value_type = E;

  struct IncidentIterator;
  struct Node : totally_ordered<Node> {
    NodePlace at;
    Graph* graph_of = nullptr;
    Node() {}
    Node(NodePlace place, const Graph* g)
        : at(place), graph_of(const_cast<Graph*>(g)) {}
    Point& position() { return at->position; }
    const Point& position() const { return at->position; }
    V& value() { return at->value; }
    const V& value() const { return at->value; }
    size_type index() const {
      return std::distance(graph_of->nodes_.begin(), at);
    }
    size_type degree() const { return at->edges.size(); }
    IncidentIterator edge_begin() const { return {at->edges.begin(), *this}; }
    IncidentIterator edge_end() const { return {at->edges.end(), *this}; }
    bool operator==(const Node& n) const {
      return graph_of == n.graph_of && at == n.at;
    }
    bool operator<(const Node& n) const { return &*at < &*n.at; }
  };
  struct Edge : totally_ordered<Edge> {
    EdgePlace at;
    Node from;
    Edge() {}
    Edge(EdgePlace place, Node n) : at(place), from(n) {}
    Node node1() const { return from; }
    Node node2() const {
      return Node(at->a == from.at ? at->b : at->a, from.graph_of);
    }
    E& value() { return at->value; }
    const E& value() const { return at->value; }
    bool operator==(const Edge& e) const { return &*at == &*e.at; }
    bool operator<(const Edge& e) const { return &*at < &*e.at; }
  };
  struct NodeIterator : equality_comparable<NodeIterator> {
    NodePlace it;
    const Graph* g;
    NodeIterator(NodePlace at, const Graph* graph) : it(at), g(graph) {}
    Node operator*() const { return Node(it, g); }
    NodeIterator& operator++() { return ++it, *this; }
    bool operator==(const NodeIterator& o) const { return it == o.it; }
  };
  struct EdgeIterator : equality_comparable<EdgeIterator> {
    EdgePlace it;
    const Graph* g;
    EdgeIterator(EdgePlace at, const Graph* graph) : it(at), g(graph) {}
    Edge operator*() const { return Edge(it, Node(it->a, g)); }
    EdgeIterator& operator++() { return ++it, *this; }
    bool operator==(const EdgeIterator& o) const { return it == o.it; }
  };
  struct IncidentIterator : equality_comparable<IncidentIterator> {
    typename std::list<EdgePlace>::iterator it;
    Node from;
    IncidentIterator(decltype(it) at, Node n) : it(at), from(n) {}
    Edge operator*() const { return Edge(*it, from); }
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
  NodeIterator node_begin() const { return {self()->nodes_.begin(), this}; }
  NodeIterator node_end() const { return {self()->nodes_.end(), this}; }
  EdgeIterator edge_begin() const { return {self()->edges_.begin(), this}; }
  EdgeIterator edge_end() const { return {self()->edges_.end(), this}; }
  Node node(size_type i) const {
    auto it = node_begin();
    while (i-- > 0) ++it;
    return *it;
  }
  Edge edge(size_type i) const {
    auto it = edge_begin();
    while (i-- > 0) ++it;
    return *it;
  }
  bool has_node(const Node& n) const {
    for (auto it = node_begin(); it != node_end(); ++it)
      if (*it == n) return true;
    return false;
  }
  bool has_edge(const Node& a, const Node& b) const {
    return find(a, b) != edge_end();
  }

  Node add_node(const Point& p, const V& value = V()) {
    nodes_.push_back({p, value, {}, this});
    return Node(std::prev(nodes_.end()), this);
  }
  Edge add_edge(const Node& a, const Node& b, const E& value = E()) {
    if (auto it = find(a, b); it != edge_end()) return Edge(it.it, a);
    edges_.push_back({a.at, b.at, value});
    const EdgePlace e = std::prev(edges_.end());
    a.at->edges.push_back(e), b.at->edges.push_back(e);
    return Edge(e, a);
  }
  size_type remove_edge(const Node& a, const Node& b) {
    auto it = find(a, b);
    return it == edge_end() ? 0 : (remove_edge(it), 1);
  }
  size_type remove_edge(const Edge& e) {
    return remove_edge(e.node1(), e.node2());
  }
  EdgeIterator remove_edge(EdgeIterator it) {
    it.it->a->edges.remove(it.it), it.it->b->edges.remove(it.it);
    return {edges_.erase(it.it), this};
  }
  size_type remove_node(const Node& n) {
    return has_node(n) ? (remove_node(NodeIterator(n.at, this)), 1) : 0;
  }
  NodeIterator remove_node(NodeIterator it) {
    while (!it.it->edges.empty()) remove_edge(Edge(it.it->edges.front(), *it));
    return {nodes_.erase(it.it), this};
  }
  void clear() { nodes_.clear(), edges_.clear(); }

 private:
  Graph* self() const { return const_cast<Graph*>(this); }
  EdgeIterator find(const Node& a, const Node& b) const {
    for (EdgePlace e : a.at->edges)
      if (e->a == b.at || e->b == b.at) return {e, this};
    return edge_end();
  }
};
