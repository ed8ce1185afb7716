#pragma once
/** @file Graph.hpp
 * Pointers: a Node is the address of its data, on the heap, and so is an Edge.
 * A handle of what was removed dangles. */
#include <vector>

#include "CME212/Point.hpp"

template <typename V, typename E = int>
class Graph {
  struct EdgeData;
  struct NodeData {
    Point p;
    V value;
    unsigned index;
    std::vector<EdgeData*> edges;
  };
  struct EdgeData {
    NodeData *a, *b;
    E value;
    unsigned index;
  };
  std::vector<NodeData*> nodes_;
  std::vector<EdgeData*> edges_;

 public:
  using size_type = unsigned;
  using node_value_type = V;
  using edge_value_type = E;

  template <typename T>
  class Iterator;
  class Edge;
  using node_edge_iterator = Iterator<EdgeData*>;
  class Node : private totally_ordered<Node> {
   public:
    Node(NodeData* data = nullptr) : d(data) {}
    Point& position() { return d->p; }
    const Point& position() const { return d->p; }
    V& value() { return d->value; }
    const V& value() const { return d->value; }
    size_type index() const { return d->index; }
    size_type degree() const { return d->edges.size(); }
    auto edge_begin() const { return node_edge_iterator(&d->edges, 0, d); }
    auto edge_end() const { return node_edge_iterator(&d->edges, degree(), d); }
    bool operator==(const Node& n) const { return d == n.d; }
    bool operator<(const Node& n) const {
      return std::less<NodeData*>()(d, n.d);
    }

   private:
    friend class Graph;
    NodeData* d;
  };
  class Edge : private totally_ordered<Edge> {
   public:
    Edge(EdgeData* data = nullptr, NodeData* from = nullptr)
        : d(data), from_(from) {}
    Node node1() const { return from_; }
    Node node2() const { return from_ == d->a ? d->b : d->a; }
    E& value() { return d->value; }
    const E& value() const { return d->value; }
    bool operator==(const Edge& e) const { return d == e.d; }
    bool operator<(const Edge& e) const {
      return std::less<EdgeData*>()(d, e.d);
    }

   private:
    friend class Graph;
    EdgeData* d;
    NodeData* from_;
  };
  /** Through a vector of NodeData* or EdgeData*. */
  template <typename T>
  class Iterator : private equality_comparable<Iterator<T>> {
   public:
    Iterator(const std::vector<T>* list = nullptr, size_type k = 0,
             NodeData* from = nullptr)
        : list_(list), k_(k), from_(from) {}
    auto operator*() const {
      T data = (*list_)[k_];
      if constexpr (std::is_same_v<T, NodeData*>)
        return Node(data);
      else
        return Edge(data, from_ ? from_ : data->a);
    }
    Iterator& operator++() { return ++k_, *this; }
    bool operator==(const Iterator& o) const { return k_ == o.k_; }

   private:
    const std::vector<T>* list_;
    size_type k_;
    NodeData* from_;
  };
  using node_type = Node;
  using edge_type = Edge;
  using node_iterator = Iterator<NodeData*>;
  using edge_iterator = Iterator<EdgeData*>;
  using incident_iterator = Iterator<EdgeData*>;

  Graph() {}
  Graph(const Graph&) = delete;
  Graph& operator=(const Graph&) = delete;
  ~Graph() { clear(); }

  size_type size() const { return nodes_.size(); }
  size_type num_nodes() const { return nodes_.size(); }
  size_type num_edges() const { return edges_.size(); }
  Node node(size_type i) const { return nodes_[i]; }
  Edge edge(size_type i) const { return Edge(edges_[i], edges_[i]->a); }
  bool has_node(const Node& n) const {
    return n.d && n.d->index < size() && nodes_[n.d->index] == n.d;
  }
  bool has_edge(const Node& a, const Node& b) const { return find(a, b); }
  node_iterator node_begin() const { return {&nodes_, 0}; }
  node_iterator node_end() const { return {&nodes_, size()}; }
  edge_iterator edge_begin() const { return {&edges_, 0}; }
  edge_iterator edge_end() const { return {&edges_, num_edges()}; }

  Node add_node(const Point& p, const V& value = V()) {
    nodes_.push_back(new NodeData{p, value, size(), {}});
    return nodes_.back();
  }
  Edge add_edge(const Node& a, const Node& b, const E& value = E()) {
    if (EdgeData* old = find(a, b)) return Edge(old, a.d);
    edges_.push_back(new EdgeData{a.d, b.d, value, num_edges()});
    a.d->edges.push_back(edges_.back()), b.d->edges.push_back(edges_.back());
    return Edge(edges_.back(), a.d);
  }
  size_type remove_edge(const Node& a, const Node& b) {
    EdgeData* e = find(a, b);
    if (!e) return 0;
    std::erase(e->a->edges, e), std::erase(e->b->edges, e);
    drop(edges_, e);
    return 1;
  }
  size_type remove_edge(const Edge& e) {
    return remove_edge(e.node1(), e.node2());
  }
  edge_iterator remove_edge(edge_iterator it) { return remove_edge(*it), it; }
  size_type remove_node(const Node& n) {
    if (!has_node(n)) return 0;
    while (n.degree() > 0) remove_edge(*n.edge_begin());
    drop(nodes_, n.d);
    return 1;
  }
  /** Returns the first node: the loop starts anew. */
  node_iterator remove_node(node_iterator it) {
    remove_node(*it);
    return node_begin();
  }
  void clear() {
    for (NodeData* n : nodes_) delete n;
    for (EdgeData* e : edges_) delete e;
    nodes_.clear(), edges_.clear();
  }

 private:
  EdgeData* find(const Node& a, const Node& b) const {
    for (EdgeData* e : a.d->edges)
      if (e->a == b.d || e->b == b.d) return e;
    return nullptr;
  }
  template <typename T>
  void drop(std::vector<T*>& list, T* data) {
    list[data->index] = list.back();
    list[data->index]->index = data->index;
    list.pop_back();
    delete data;
  }
};
