#pragma once
/** @file Graph.hpp
 * Graph: an undirected graph. Each node has a position in space; each node and
 * each edge carries a value. Node and Edge are proxies: small handles, passed
 * by value, that read and write the graph's arrays.
 *
 * How it is stored, and why: docs/graph.md. */
#include <algorithm>
#include <array>
#include <cassert>
#include <compare>
#include <cstddef>
#include <functional>
#include <iterator>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "CME212/AnyGraph.hpp"
#include "CME212/Point.hpp"
#include "CME212/SlotMap.hpp"
#include "CME212/Util.hpp"

/** An undirected graph in space: no loops, no parallel edges.
 * @tparam V, E Types of the nodes' and the edges' values: std::semiregular
 *
 * Nodes have the indices 0, ..., num_nodes() - 1, edges 0, ...,
 * num_edges() - 1. A removal changes indices, but not what a handle refers to:
 * a Node or Edge refers to the same element until that is removed. Then the
 * handle is dead: has_node() or has_edge() is false, also when new elements are
 * added (up to the bound of SlotMap).
 *
 * Complexity: O(1) unless stated; "degree" is a node's number of edges. The
 * first removal, and that after clear(), also makes lists of all indices: O(1)
 * for each element added before.
 * Memory: 52 + sizeof(V) bytes a node, 28 + sizeof(E) an edge, 8 of each more
 * from the first removal on; and what the vectors hold ready. New elements
 * reuse the slots of removed ones; only the destructor frees memory.
 *
 * If a member throws, std::bad_alloc or what a value throws, then no node, edge
 * or value has changed; what it lists under Invalidates may be invalid.
 * Preconditions are asserted, at no cost with NDEBUG.
 * A copy of a Graph has the same indices and ids, and its own handles. A Graph
 * can't be assigned to: handles of its old content would refer to the new one.
 * No handle may be used after its graph is destroyed.
 * Threads: as std::vector. Reads may run at the same time, a write runs alone;
 * but positions and values of different elements may be written at once. */
template <typename V = graph_detail::NoValue,
          typename E = graph_detail::NoValue>
class Graph {
  static_assert(!std::is_const_v<V> && !std::is_const_v<E>,
                "values of a Graph can change: their types are not const");
  template <typename T>
  using Array = graph_detail::Array<T>;
  template <typename Proxy, bool of_one_node>
  class ProxyIterator;
  using Generation = graph_detail::SlotMap::Generation;
  /** An edge seen from one end: the ids of the other end and of the edge. */
  struct Neighbor {
    unsigned node, edge;
  };
  using Neighbors = std::vector<Neighbor>;
  template <typename G>
  friend class GraphArrays;  // for loops over arrays, without proxies

 public:
  class Node;
  class Edge;
  using graph_type = Graph;
  using size_type = graph_detail::size_type;
  using node_type = Node;
  using edge_type = Edge;
  using node_value_type = V;
  using edge_value_type = E;
  /** Random access, all three. */
  using NodeIterator = ProxyIterator<Node, false>;
  using EdgeIterator = ProxyIterator<Edge, false>;
  using IncidentIterator = ProxyIterator<Edge, true>;
  using node_iterator = NodeIterator;
  using edge_iterator = EdgeIterator;
  using incident_iterator = IncidentIterator;

  /** An empty graph. */
  Graph() {
    static_assert(std::semiregular<V> && std::semiregular<E>,
                  "values of a Graph are copyable and made from nothing");
  }
  Graph(const Graph&) = default;
  Graph& operator=(const Graph&) = delete;

  // ------------------------------------------------------------------- Node

  /** A handle of one node: 16 bytes, passed by value. A default constructed
   * Node belongs to no graph.
   * @pre of all members but comparisons: the node is in its graph. */
  class Node : private totally_ordered<Node> {
   public:
    using graph_type = Graph;
    /** An invalid node. */
    Node() = default;
    /** The graph that it is in. */
    Graph& graph() const {
      assert(graph_ && graph_->has_node(*this) &&
             "a node is used that is in no graph: removed, or *node_end()");
      return *graph_;
    }

    /** The node's position; assign to it to move the node. */
    Point& position() {
      // BEGIN SOLUTION 3.1.position
      return graph().position_[id_];
      // STUB // A copy, one of some that an expression may need together: what
      // STUB // is written to it does not reach the graph.
      // STUB thread_local Point copies[8];
      // STUB thread_local unsigned count = 0;
      // STUB return copies[count++ % 8] = graph().position_[id_];
      // END SOLUTION
    }
    const Point& position() const { return graph().position_[id_]; }
    /** The value of the node. */
    node_value_type& value() { return graph().node_value_[id_]; }
    const node_value_type& value() const { return graph().node_value_[id_]; }

    /** A number in [0, num_nodes()); removals of others may change it. */
    size_type index() const { return graph().nodes_.index_of(id_); }
    /** A number that stays the same until the node is removed. */
    size_type id() const { return graph(), id_; }

    /** Number of edges at this node. */
    size_type degree() const { return size_type(list().size()); }
    /** The edges at this node: each has it as node1().
     * Order: as added, until an edge at this node is removed. */
    incident_iterator edge_begin() const { return {&graph(), 0, id_}; }
    incident_iterator edge_end() const { return {graph_, degree(), id_}; }
    CME212::Range<incident_iterator> edges() const {
      return {edge_begin(), edge_end()};
    }

    /** Same node of the same graph. */
    bool operator==(const Node& n) const {
      return graph_ == n.graph_ && id_ == n.id_ && generation_ == n.generation_;
    }
    /** A strict total order of all nodes of all graphs; within a graph it is
     * that of the ids. It never changes, so a Node can be the key of a map. */
    bool operator<(const Node& n) const {
      if (graph_ != n.graph_)
        return std::less<const Graph*>()(graph_, n.graph_);
      return id_ != n.id_ ? id_ < n.id_ : generation_ < n.generation_;
    }

   private:
    friend class Graph;
    Graph* graph_ = nullptr;
    size_type id_ = 0;
    Generation generation_ = 0;

    Node(const Graph* g, size_type id)
        : graph_(const_cast<Graph*>(g)),
          id_(id),
          generation_(g->nodes_.generation(id)) {}
    const Neighbors& list() const { return graph().neighbors_of_[id_]; }
  };

  // ------------------------------------------------------------------- Edge

  /** A handle of one edge, seen from one of its ends: 24 bytes, passed by
   * value. A default constructed Edge belongs to no graph.
   * @pre of all members but comparisons: the edge is in its graph. */
  class Edge : private totally_ordered<Edge> {
   public:
    using graph_type = Graph;
    /** An invalid edge. */
    Edge() = default;

    /** The end from which the edge is seen, and the other end. node1() is n for
     * an edge of n.edges(), and a for the result of add_edge(a, b). For edge(i)
     * it is the first argument of the add_edge() that made the edge. */
    Node node1() const { return Node(&graph(), near_); }
    Node node2() const { return Node(&graph(), far_); }

    /** The value of the edge: the same from both ends. */
    // BEGIN SOLUTION 4.1.edge_value
    edge_value_type& value() { return graph().edge_value_[id_]; }
    const edge_value_type& value() const { return graph().edge_value_[id_]; }
    // STUB edge_value_type& value() { return no_edges_; }
    // STUB const edge_value_type& value() const { return no_edges_; }
    // STUB static inline edge_value_type no_edges_{};  // belongs to no edge
    // END SOLUTION

    /** Present distance of the two ends. */
    double length() const {
      return norm(node1().position() - node2().position());
    }
    /** A number in [0, num_edges()); removals of others may change it. */
    size_type index() const { return graph().edges_.index_of(id_); }
    /** A number that stays the same until the edge is removed. */
    size_type id() const { return id_; }

    /** Same edge of the same graph, seen from either end. */
    bool operator==(const Edge& e) const {
      return graph_ == e.graph_ && id_ == e.id_ && generation_ == e.generation_;
    }
    /** A strict total order of all edges of all graphs; it never changes. */
    bool operator<(const Edge& e) const {
      if (graph_ != e.graph_)
        return std::less<const Graph*>()(graph_, e.graph_);
      return id_ != e.id_ ? id_ < e.id_ : generation_ < e.generation_;
    }

   private:
    friend class Graph;
    Graph* graph_ = nullptr;
    size_type id_ = 0, near_ = 0, far_ = 0;  // the ends' ids: node1(), node2()
    Generation generation_ = 0;

    Edge(const Graph* g, size_type id, size_type near, size_type far)
        : graph_(const_cast<Graph*>(g)),
          id_(id),
          near_(near),
          far_(far),
          generation_(g->edges_.generation(id)) {}
    Edge(const Graph* g, size_type id)
        : Edge(g, id, g->ends_[id][0], g->ends_[id][1]) {}

    Graph& graph() const {
      assert(graph_ != nullptr && graph_->has_edge(*this));
      return *graph_;
    }
  };

  // ------------------------------------------------------------------ Nodes

  /** Number of nodes. */
  size_type size() const { return nodes_.size(); }
  size_type num_nodes() const { return nodes_.size(); }

  /** Add a node at @a position.
   * @return the new node; its index is old num_nodes().
   * Invalidates: references to positions and node values.
   * Keeps: every Node, Edge and iterator; an old node_end() is now at the new
   *       node.
   * Complexity: O(1) amortized.
   * Throws std::length_error beyond 2^31 nodes. */
  Node add_node(const Point& position, const V& value = V()) {
    V copy = value;  // first: it may refer into the array that grows
    const Point p = position;
    const size_type id = nodes_.next_id();
    graph_detail::grow_to_hold(position_, id);
    graph_detail::grow_to_hold(node_value_, id);
    graph_detail::grow_to_hold(neighbors_of_, id);
    node_value_[id] = std::move(copy);
    nodes_.acquire();  // the last line that may throw
    position_[id] = p;
    ++version_;
    return Node(this, id);
  }

  /** True if @a n is a node of this graph and was not removed. */
  bool has_node(const Node& n) const {
    return n.graph_ == this && nodes_.alive(n.id_, n.generation_);
  }

  /** The node of index @a i.  @pre i < num_nodes()
   * @post result.index() == i */
  Node node(size_type i) const {
    assert(i < num_nodes());
    return Node(this, nodes_.id_at(i));
  }

  /** Remove node @a n and every edge at it.
   * @return 1 if removed; 0 if !has_node(@a n), then nothing has changed.
   * @post !has_node(@a n), and num_nodes() fell by the result.
   * @post If removed: num_edges() fell by old @a n.degree(); the node of
   *       highest index took @a n's index; all others kept their own.
   * Invalidates: @a n, its copies and its edges; all edge and incident
   *       iterators; node iterators at @a n and at the highest index.
   * Keeps: every other Node and Edge; references.
   * Complexity: O(sum of degree() over @a n's neighbors), whatever num_nodes()
   */
  size_type remove_node(const Node& n) {
    // BEGIN SOLUTION 7.1.remove_node
    if (!has_node(n)) return 0;
    const size_type id = n.id_;  // a copy: n may refer into what changes below
    nodes_.make_lists(), edges_.make_lists();  // all that may throw
    for (Neighbor b : neighbors_of_[id]) {
      erase(neighbors_of_[b.node], b.edge);
      drop_edge(b.edge);
    }
    neighbors_of_[id].clear();
    position_[id] = Point();
    graph_detail::reset(node_value_[id]);
    nodes_.release(id);
    ++version_;
    return 1;
    // STUB (void)n;
    // STUB return 0;
    // END SOLUTION
  }
  /** Remove the node at @a it, as remove_node(*it).
   * @return an iterator from which a loop reaches each node that it has not
   *         visited, if it says `it = g.remove_node(it)` instead of ++it where
   *         it removes. Here at the node that took the index, or node_end().
   * @pre @a it != node_end() */
  node_iterator remove_node(node_iterator it) {
    // BEGIN SOLUTION 7.1.remove_node_iterator
    assert(it.at_ < num_nodes());
    remove_node(*it);
    return it;
    // STUB (void)it;
    // STUB return node_end();
    // END SOLUTION
  }

  // ------------------------------------------------------------------ Edges

  /** Number of edges. */
  size_type num_edges() const { return edges_.size(); }

  /** Add the edge between @a a and @a b, unless it is there already.
   * @return the edge, new or not, with node1() == a and node2() == b.
   * @pre has_node(a) && has_node(b) && a != b
   * @post has_edge(a, b). If the edge is new, num_edges() grew by one and the
   *       edge's index is old num_edges(); else its value is unchanged.
   * Invalidates: incident iterators of @a a and @a b; references to edge
   * values. Keeps: every Node, Edge and other iterator. Complexity:
   * O(min(a.degree(), b.degree())), amortized. Throws std::length_error beyond
   * 2^31 edges. */
  Edge add_edge(const Node& a, const Node& b, const E& value = E()) {
    assert(has_node(a) && has_node(b) && !(a == b));
    const size_type i = a.id_, j = b.id_;
    if (size_type id = find(a, b); id != none) return Edge(this, id, i, j);
    E copy = value;
    const size_type id = edges_.next_id();
    graph_detail::grow_to_hold(ends_, id);
    graph_detail::grow_to_hold(edge_value_, id);
    make_room(neighbors_of_[i]), make_room(neighbors_of_[j]);
    // BEGIN SOLUTION 4.1.edge_value
    edge_value_[id] = std::move(copy);
    // STUB (void)copy;
    // END SOLUTION
    edges_.acquire();  // the last line that may throw
    ends_[id] = {i, j};
    neighbors_of_[i].push_back({j, id});
    neighbors_of_[j].push_back({i, id});
    ++version_;
    return Edge(this, id);
  }

  /** True if @a a and @a b are nodes of this graph with an edge between them.
   * Complexity: O(min(a.degree(), b.degree())) */
  bool has_edge(const Node& a, const Node& b) const {
    return find(a, b) != none;
  }
  /** True if @a e is an edge of this graph and was not removed. */
  bool has_edge(const Edge& e) const {
    return e.graph_ == this && edges_.alive(e.id_, e.generation_);
  }

  /** The edge of index @a i.  @pre i < num_edges() */
  Edge edge(size_type i) const {
    assert(i < num_edges());
    return Edge(this, edges_.id_at(i));
  }

  /** Remove the edge between @a a and @a b.
   * @return 1 if removed; 0 if !has_edge(a, b), then nothing has changed.
   * @post !has_edge(a, b), and num_edges() fell by the result.
   * @post If removed: the edge of highest index took its index; all others
   *       kept their own.
   * Invalidates: the edge and its copies; edge iterators at it and at the
   *       highest index; incident iterators of @a a and @a b.
   * Keeps: every Node and every other Edge; references.
   * Complexity: O(a.degree() + b.degree()) */
  size_type remove_edge(const Node& a, const Node& b) {
    // BEGIN SOLUTION 7.1.remove_edge
    size_type id = find(a, b);
    return id == none ? 0 : remove_edge(Edge(this, id));
    // STUB (void)a, (void)b;
    // STUB return 0;
    // END SOLUTION
  }
  /** Remove @a e, as above. Returns 0 if !has_edge(e). */
  size_type remove_edge(const Edge& e) {
    // BEGIN SOLUTION 7.1.remove_edge
    if (!has_edge(e)) return 0;
    edges_.make_lists();  // all that may throw
    const size_type id = e.id_;
    for (size_type end : ends_[id]) erase(neighbors_of_[end], id);
    drop_edge(id);
    ++version_;
    return 1;
    // STUB (void)e;
    // STUB return 0;
    // END SOLUTION
  }
  /** Remove the edge at @a it, as above.
   * @return as for a node. Here at the edge that took the index, or edge_end().
   * @pre @a it != edge_end() */
  edge_iterator remove_edge(edge_iterator it) {
    // BEGIN SOLUTION 7.1.remove_edge_iterator
    remove_edge(*it);
    return it;
    // STUB (void)it;
    // STUB return edge_end();
    // END SOLUTION
  }

  // ------------------------------------------------------------------ Whole

  /** Remove all nodes and edges.
   * Invalidates: every Node, Edge, iterator and reference.
   * Complexity: O(num_nodes() + num_edges()), even if there were many more
   *       before. Frees no memory. */
  void clear() {
    for (Edge e : edges())
      ends_[e.id()] = {}, graph_detail::reset(edge_value_[e.id()]);
    for (Node n : nodes()) {
      position_[n.id_] = Point();
      graph_detail::reset(node_value_[n.id_]);
      neighbors_of_[n.id_].clear();
    }
    nodes_.clear();
    edges_.clear();
    ++version_;
  }

  /** Allocate memory for a total of @a nodes and @a edges, so that adding them
   * moves no data.   Invalidates: references.   Keeps: all else. */
  void reserve(size_type nodes, size_type edges) {
    nodes_.reserve(nodes), edges_.reserve(edges);
    reserve_in(position_, nodes), reserve_in(node_value_, nodes);
    reserve_in(neighbors_of_, nodes);
    reserve_in(ends_, edges), reserve_in(edge_value_, edges);
  }

  node_iterator node_begin() const { return {self(), 0}; }
  node_iterator node_end() const { return {self(), num_nodes()}; }
  edge_iterator edge_begin() const { return {self(), 0}; }
  edge_iterator edge_end() const { return {self(), num_edges()}; }
  /** For range-for: for (auto n : g.nodes()) ... */
  CME212::Range<node_iterator> nodes() const {
    return {node_begin(), node_end()};
  }
  CME212::Range<edge_iterator> edges() const {
    return {edge_begin(), edge_end()};
  }

  /** For tests.  Throws std::logic_error, with what is wrong, unless the
   * representation invariant holds: see the arrays, below.
   * Complexity: O(N + sum of squared degrees) */
  void check_invariants() const {
    auto require = [](bool ok, const char* what) {
      if (!ok) throw std::logic_error(std::string("Graph: ") + what);
    };
    nodes_.check_invariants(), edges_.check_invariants();
    const size_type nodes = nodes_.slots(), edges = edges_.slots();
    require(position_.size() >= nodes && node_value_.size() >= nodes &&
                neighbors_of_.size() >= nodes && ends_.size() >= edges &&
                edge_value_.size() >= edges,
            "an array is shorter than its slots");
    std::size_t neighbors = 0;
    for (size_type i = 0; i < neighbors_of_.size(); ++i) {
      const Neighbors& list = neighbors_of_[i];
      neighbors += list.size();
      require(list.empty() || (i < nodes && nodes_.in_use(i)),
              "a removed node has neighbors");
      for (auto [j, e] : list) {
        require(e < edges && edges_.in_use(e),
                "a neighbor list holds a removed edge");
        require(j != i, "a loop");
        require(ends_[e] == std::array{i, j} || ends_[e] == std::array{j, i},
                "a neighbor list and the ends of an edge disagree");
        size_type seen = 0;
        for (Neighbor other : list) seen += other.node == j;
        require(seen == 1, "parallel edges");
      }
    }
    require(neighbors == 2 * std::size_t(num_edges()),
            "an edge is not in the lists of both its ends");
    for (size_type e = 0; e < edges; ++e)
      require(edges_.in_use(e) || ends_[e] == std::array<size_type, 2>{},
              "a removed edge has ends");
  }

 private:
  static constexpr size_type none = graph_detail::none;

  // Representation. A slot is a place in the arrays; the id of an element is
  // the number of its slot.
  //
  // Invariant:
  // - nodes_ and edges_ know which slots are in use, and their indices.
  // - Every array reaches to the last slot.
  // - For each edge e in use, with ends_[e] = {i, j}: i != j, both in use; the
  //   list of i has the entry {j, e}, that of j the entry {i, e}. There are no
  //   other entries, and no list names a node twice.
  // - Slots not in use: a node has no entries, an edge has the ends {0, 0}.
  // check_invariants() checks all of it; docs/graph.md explains it.
  graph_detail::SlotMap nodes_, edges_;
  graph_detail::Version version_;
  // By node id:
  Array<Point> position_;
  Array<V> node_value_;
  Array<Neighbors> neighbors_of_;
  // By edge id:
  Array<std::array<size_type, 2>> ends_;  // in the order of add_edge()
  Array<E> edge_value_;

  Graph* self() const { return const_cast<Graph*>(this); }
  template <typename A>
  static void reserve_in(A& array, std::size_t n) {
    if constexpr (requires { array.reserve(n); }) array.reserve(n);
  }

  /** The id of the edge between @a a and @a b, or none. */
  size_type find(const Node& a, const Node& b) const {
    if (!has_node(a) || !has_node(b)) return none;
    const bool from_a = a.degree() <= b.degree();
    for (Neighbor n : neighbors_of_[from_a ? a.id_ : b.id_])
      if (n.node == (from_a ? b.id_ : a.id_)) return n.edge;
    return none;
  }
  /** Make room for one more entry: then push_back() does not throw. */
  static void make_room(Neighbors& list) {
    if (list.size() == list.capacity())
      list.reserve(std::max<std::size_t>(4, 2 * list.size()));
  }
  /** Remove the entry of edge @a e from @a list; the last one takes its place.
   */
  static void erase(Neighbors& list, size_type e) {
    const auto at = std::find_if(list.begin(), list.end(),
                                 [e](Neighbor n) { return n.edge == e; });
    *at = list.back();
    list.pop_back();
  }
  /** Release the slot of edge @a e; its entries in the lists stay. */
  void drop_edge(size_type e) {
    // BEGIN SOLUTION 7.1.remove_edge
    ends_[e] = {};
    graph_detail::reset(edge_value_[e]);
    edges_.release(e);
    // STUB (void)e;
    // END SOLUTION
  }

  /** Makes a proxy when it is dereferenced. Iterates over all nodes or all
   * edges by index, and over the edges of one node by place in its list. */
  template <typename Proxy, bool of_one_node>
  class ProxyIterator {
   public:
    using value_type = Proxy;
    using reference = Proxy;
    using difference_type = std::ptrdiff_t;
    using iterator_category = std::random_access_iterator_tag;
    /** Holds the proxy while a member of it is called. */
    struct pointer {
      Proxy proxy;
      Proxy* operator->() { return &proxy; }
    };

    /** An iterator of no graph. It can only be assigned to. */
    ProxyIterator() = default;

    /** At node_end() an invalid node, which may only be passed on.
     * @pre it belongs to a graph, and is not at the end of a range of edges */
    Proxy operator*() const {
      assert(graph_ && "an iterator of no graph is dereferenced");
      if constexpr (of_one_node) {
        const Neighbors& list = graph_->neighbors_of_[node_];
        assert(at_ < list.size() &&
               "Node::edge_end() is dereferenced, or an iterator gone stale");
        return Proxy(graph_, list[at_].edge, node_, list[at_].node);
      } else if constexpr (std::is_same_v<Proxy, Node>) {
        assert(at_ <= graph_->num_nodes() && "beyond node_end()");
        if (at_ == graph_->num_nodes()) return Node();
        return graph_->node(size_type(at_));
      } else {
        assert(at_ < graph_->num_edges() && "edge_end() is dereferenced");
        return graph_->edge(size_type(at_));
      }
    }
    pointer operator->() const { return {**this}; }
    Proxy operator[](difference_type n) const { return *(*this + n); }

    ProxyIterator& operator+=(difference_type n) {
      return at_ += std::size_t(n), *this;
    }
    ProxyIterator& operator-=(difference_type n) { return *this += -n; }
    ProxyIterator& operator++() { return ++at_, *this; }
    ProxyIterator& operator--() { return --at_, *this; }
    ProxyIterator operator++(int) { return std::exchange(*this, *this + 1); }
    ProxyIterator operator--(int) { return std::exchange(*this, *this - 1); }
    friend ProxyIterator operator+(ProxyIterator it, difference_type n) {
      return it += n;
    }
    friend ProxyIterator operator+(difference_type n, ProxyIterator it) {
      return it += n;
    }
    friend ProxyIterator operator-(ProxyIterator it, difference_type n) {
      return it -= n;
    }
    /** @pre both of the same range, here and in the comparisons */
    friend difference_type operator-(ProxyIterator a, ProxyIterator b) {
      return difference_type(a.at_) - difference_type(b.at_);
    }
    bool operator==(const ProxyIterator& o) const {
      return graph_ == o.graph_ && at_ == o.at_;
    }
    auto operator<=>(const ProxyIterator& o) const { return at_ <=> o.at_; }

   private:
    friend class Graph;
    Graph* graph_ = nullptr;
    // Index, or place in the list; of 64 bits, which makes loops faster.
    std::size_t at_ = 0;
    size_type node_ = 0;  // of_one_node: its id
    ProxyIterator(Graph* g, std::size_t at, size_type node = 0)
        : graph_(g), at_(at), node_(node) {}
  };

  static_assert(sizeof(Node) <= 16 && sizeof(Edge) <= 24);
};
