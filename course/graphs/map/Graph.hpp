#pragma once
/** @file Graph.hpp
 * Maps: nodes by a number that is never used again, edges by the numbers of
 * their ends. Iterators go through the maps. An index is found by counting. */
#include <map>

#include "CME212/Point.hpp"

template <typename V, typename E = char>
class Graph {
  using Ends = std::pair<unsigned, unsigned>;  // the smaller one first
  struct Data {
    Point position;
    V value;
    std::map<unsigned, Ends> edges;  // by the other end
  };
  using Nodes = std::map<unsigned, Data>;
  using Edges = std::map<Ends, E>;
  Nodes nodes_;
  Edges edges_;
  unsigned next_ = 0;

 public:
  using size_type = unsigned;
  using node_value_type = V;
  using edge_value_type = E;

  template <typename It, typename T>
  class Iterator;
  class Edge;
  class Node : private totally_ordered<Node> {
   public:
    Node() : graph_(nullptr), key_(0) {}
    Point& position() { return data().position; }
    const Point& position() const { return data().position; }
    V& value() { return data().value; }
    const V& value() const { return data().value; }
    size_type index() const {
      return std::distance(graph_->nodes_.begin(), graph_->nodes_.find(key_));
    }
    size_type degree() const { return data().edges.size(); }
    auto edge_begin() const { return walk(data().edges.begin()); }
    auto edge_end() const { return walk(data().edges.end()); }
    bool operator==(const Node& n) const {
      return graph_ == n.graph_ && key_ == n.key_;
    }
    bool operator<(const Node& n) const {
      return std::pair(graph_, key_) < std::pair(n.graph_, n.key_);
    }

   private:
    friend class Graph;
    Graph* graph_;
    unsigned key_;
    Node(const Graph* g, unsigned key)
        : graph_(const_cast<Graph*>(g)), key_(key) {}
    Data& data() const { return graph_->nodes_.at(key_); }
    template <typename It>
    auto walk(It it) const {
      return Iterator<It, Edge>(graph_, it, key_);
    }
  };
  class Edge : private totally_ordered<Edge> {
   public:
    Edge() {}
    Node node1() const { return a_; }
    Node node2() const { return b_; }
    E& value() { return a_.graph_->edges_.at(ends()); }
    const E& value() const { return a_.graph_->edges_.at(ends()); }
    bool operator==(const Edge& e) const {
      return a_.graph_ == e.a_.graph_ && ends() == e.ends();
    }
    bool operator<(const Edge& e) const {
      return std::pair(a_.graph_, ends()) < std::pair(e.a_.graph_, e.ends());
    }

   private:
    friend class Graph;
    Node a_, b_;
    Edge(Node a, Node b) : a_(a), b_(b) {}
    Ends ends() const { return std::minmax(a_.key_, b_.key_); }
  };
  /** Of nodes, of edges, or of the edges at node @a from. */
  template <typename It, typename T>
  class Iterator : private equality_comparable<Iterator<It, T>> {
   public:
    Iterator() {}
    T operator*() const {
      const auto& key = it_->first;
      if constexpr (std::is_same_v<T, Node>)
        return Node(graph_, key);
      else if constexpr (std::is_same_v<decltype(key), const Ends&>)
        return Edge(Node(graph_, key.first), Node(graph_, key.second));
      else
        return Edge(Node(graph_, from_), Node(graph_, key));
    }
    Iterator& operator++() { return ++it_, *this; }
    bool operator==(const Iterator& o) const { return it_ == o.it_; }

   private:
    friend class Graph;
    const Graph* graph_ = nullptr;
    It it_;
    unsigned from_ = 0;
    Iterator(const Graph* g, It it, unsigned from = 0)
        : graph_(g), it_(it), from_(from) {}
  };
  using node_type = Node;
  using edge_type = Edge;
  using node_iterator = Iterator<typename Nodes::const_iterator, Node>;
  using edge_iterator = Iterator<typename Edges::const_iterator, Edge>;
  using incident_iterator =
      Iterator<typename std::map<unsigned, Ends>::iterator, Edge>;

  size_type size() const { return nodes_.size(); }
  size_type num_nodes() const { return nodes_.size(); }
  size_type num_edges() const { return edges_.size(); }
  Node node(size_type i) const {
    return *node_iterator(this, std::next(nodes_.begin(), i));
  }
  Edge edge(size_type i) const {
    return *edge_iterator(this, std::next(edges_.begin(), i));
  }
  bool has_node(const Node& n) const {
    return n.graph_ == this && nodes_.count(n.key_) == 1;
  }
  bool has_edge(const Node& a, const Node& b) const {
    return edges_.count(std::minmax(a.key_, b.key_)) == 1;
  }
  node_iterator node_begin() const { return {this, nodes_.begin()}; }
  node_iterator node_end() const { return {this, nodes_.end()}; }
  edge_iterator edge_begin() const { return {this, edges_.begin()}; }
  edge_iterator edge_end() const { return {this, edges_.end()}; }

  Node add_node(const Point& position, const V& value = V()) {
    nodes_[next_] = {position, value, {}};
    return Node(this, next_++);
  }
  Edge add_edge(const Node& a, const Node& b, const E& value = E()) {
    const Ends ends = std::minmax(a.key_, b.key_);
    edges_.emplace(ends, value);
    a.data().edges[b.key_] = b.data().edges[a.key_] = ends;
    return Edge(a, b);
  }
  size_type remove_edge(const Node& a, const Node& b) {
    if (edges_.erase(std::minmax(a.key_, b.key_)) == 0) return 0;
    a.data().edges.erase(b.key_);
    return b.data().edges.erase(a.key_);
  }
  size_type remove_edge(const Edge& e) { return remove_edge(e.a_, e.b_); }
  edge_iterator remove_edge(edge_iterator it) {
    const Edge e = *it;
    ++it;
    remove_edge(e);
    return it;
  }
  bool remove_node(Node n) {
    if (!has_node(n)) return false;
    while (n.degree() > 0) remove_edge(*n.edge_begin());
    return nodes_.erase(n.key_) == 1;
  }
  node_iterator remove_node(node_iterator it) {
    const Node n = *it;
    ++it;
    remove_node(n);
    return it;
  }
  void clear() { nodes_.clear(), edges_.clear(); }
};
