#pragma once
/** @file Graph.hpp
 * Graph: an undirected graph. Each node has a position in space; each node and
 * each edge carries a value. Node and Edge are proxies: small handles, passed
 * by value, that read and write the graph's arrays.
 *
 * How it is stored, and why: docs/graph.md. */
#include <array>
#include <bit>
#include <cassert>
#include <compare>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <iterator>
#include <span>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>

#include "CME212/AnyGraph.hpp"
#include "CME212/NeighborPool.hpp"
#include "CME212/Point.hpp"
#include "CME212/SlotMap.hpp"
#include "CME212/Util.hpp"

/** An undirected graph in space: no loops, no parallel edges.
 * @tparam V Type of the nodes' values: default constructible, copyable
 * @tparam E Type of the edges' values: likewise
 *
 * Nodes have the indices 0, ..., num_nodes() - 1, edges 0, ...,
 * num_edges() - 1. A removal changes indices, but not what a handle refers to:
 * a Node or Edge refers to the same element until that is removed. Then the
 * handle is dead for ever: has_node() or has_edge() is false, even when new
 * elements are added.
 *
 * Complexity: O(1) unless stated; "degree" is a node's number of edges. The
 * first removal makes lists of indices: O(num_nodes() + num_edges()), which
 * is O(1) for each element added before. The first removal after clear() or
 * reindex() may do so, too.
 * Memory: 36 + sizeof(V) bytes a node and 24 + sizeof(E) an edge of a grid; up
 * to an eighth more, as arrays grow ahead; 12 a node and an edge from the first
 * removal on; 8 an edge after many removals at nodes of large degree. New
 * elements reuse the slots of removed ones; only the destructor frees slots.
 *
 * If a member throws, std::bad_alloc or what a value throws, then no node, edge
 * or value has changed; what it lists under Invalidates may be invalid.
 * Preconditions are asserted, at no cost with NDEBUG.
 * A copy of a Graph has the same indices and ids, and its own handles. A Graph
 * can't be assigned to: handles of its old content would refer to the new one.
 * No handle may be used after its graph is destroyed.
 * Threads: as std::vector. Reads may run at the same time, a write runs alone;
 * but positions and values of different elements may be written at the same
 * time. */
template <typename V = graph_detail::NoValue,
          typename E = graph_detail::NoValue>
class Graph {
  template <typename T>
  using Array = graph_detail::Array<T>;
  template <typename Proxy, bool of_one_node>
  class ProxyIterator;
  using Generation = std::uint32_t;

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
  Graph() = default;
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
      // BEGIN SOLUTION 3.1.position 4pt
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
    /** The node's element in Graph::positions() and Graph::node_values(). It
     * stays the same until the node is removed. */
    size_type id() const { return graph(), id_; }

    /** Number of edges at this node. */
    size_type degree() const { return list().size; }
    /** The edges at this node: each has it as node1().
     * Order: as added, until an edge at this node is removed. */
    incident_iterator edge_begin() const { return {graph_, list().begin, id_}; }
    incident_iterator edge_end() const {
      return {graph_, std::size_t(list().begin) + list().size, id_};
    }
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
    /** For std::hash: equal nodes have equal numbers, which never change. */
    std::size_t hash() const { return std::size_t(generation_) << 32 | id_; }

   private:
    friend class Graph;
    Graph* graph_ = nullptr;
    size_type id_ = 0;
    Generation generation_ = 0;

    Node(const Graph* g, size_type id)
        : graph_(const_cast<Graph*>(g)),
          id_(id),
          generation_(g->nodes_.generation(id)) {}
    const auto& list() const { return graph().neighbors_of_[id_]; }
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
    // BEGIN SOLUTION 4.1.edge_value 6pt
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
    /** The edge's element in Graph::edge_ends() and Graph::edge_values(). It
     * stays the same until the edge is removed. */
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
    /** As of a Node. */
    std::size_t hash() const { return std::size_t(generation_) << 32 | id_; }

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
   * Invalidates: references and spans to positions and node values.
   * Keeps: every Node, Edge and iterator; an old node_end() is now at the new
   *       node.
   * Complexity: O(1) amortized.
   * Throws std::length_error beyond 2^31 nodes. */
  Node add_node(const Point& position, const V& value = V()) {
    V copy = value;  // first: it may refer into the array that grows
    Point p = position;
    size_type id = nodes_.reserve_one();
    graph_detail::grow_to_hold(position_, id + 1);  // one more: positions()
    graph_detail::grow_to_hold(node_value_, id);
    graph_detail::grow_to_hold(neighbors_of_, id);
    node_value_[id] = std::move(copy);  // the last line that may throw
    nodes_.acquire();
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
   * Keeps: every other Node and Edge; references and spans.
   * Complexity: O(n.degree()) amortized, also if a neighbor's degree is large.
   *       The first removal takes longer: see Graph. */
  size_type remove_node(const Node& n) {
    // BEGIN SOLUTION 7.1.remove_node 8pt
    if (!has_node(n)) return 0;
    size_type id = n.id_;  // a copy: n may refer into what changes below
    nodes_.make_lists();
    if (n.degree() > 0) prepare_drop();
    for (Neighbor b : pool_.items(neighbors_of_[id])) {
      pool_.remove(neighbors_of_[b.node], b.node, {id, b.edge});
      drop_edge(b.edge);
    }
    pool_.free(neighbors_of_[id]);
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
   * @return an iterator at the node that took the index, or node_end(). So a
   *         loop visits each node once if it says `it = g.remove_node(it)`
   *         instead of ++it where it removes.
   * @pre @a it != node_end() */
  node_iterator remove_node(node_iterator it) {
    // BEGIN SOLUTION 7.1.remove_node_iterator 3pt
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
   * Invalidates: incident iterators of @a a and @a b; references and spans to
   *       edge values and ends.
   * Keeps: every Node, Edge and other iterator.
   * Complexity: O(min(a.degree(), b.degree())), amortized.
   * Throws std::length_error beyond 2^31 edges. */
  Edge add_edge(const Node& a, const Node& b, const E& value = E()) {
    assert(has_node(a) && has_node(b) && !(a == b));
    size_type i = a.id_, j = b.id_;
    if (size_type id = find(a, b); id != none) return Edge(this, id, i, j);
    E copy = value;
    size_type id = edges_.reserve_one();
    graph_detail::grow_to_hold(ends_, id);
    graph_detail::grow_to_hold(edge_value_, id);
    pool_.reserve_edge(neighbors_of_[i], neighbors_of_[j], id);
    // BEGIN SOLUTION 4.1.edge_value
    edge_value_[id] = std::move(copy);  // the last line that may throw
    // STUB (void)copy;
    // END SOLUTION
    edges_.acquire();
    ends_[id] = {i, j};
    pool_.add(neighbors_of_[i], i, {j, id});
    pool_.add(neighbors_of_[j], j, {i, id});
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
   * Keeps: every Node and every other Edge; references and spans.
   * Complexity: O(min(a.degree(), b.degree())) amortized; the first removal
   *       takes longer. */
  size_type remove_edge(const Node& a, const Node& b) {
    // BEGIN SOLUTION 7.1.remove_edge 6pt
    size_type id = find(a, b);
    return id == none ? 0 : remove_edge(Edge(this, id));
    // STUB (void)a, (void)b;
    // STUB return 0;
    // END SOLUTION
  }
  /** Remove @a e, as above. Returns 0 if !has_edge(e). O(1) amortized. */
  size_type remove_edge(const Edge& e) {
    // BEGIN SOLUTION 7.1.remove_edge
    if (!has_edge(e)) return 0;
    size_type id = e.id_;
    prepare_drop();
    const auto [i, j] = ends_[id];
    pool_.remove(neighbors_of_[i], i, {j, id});
    pool_.remove(neighbors_of_[j], j, {i, id});
    drop_edge(id);
    ++version_;
    return 1;
    // STUB (void)e;
    // STUB return 0;
    // END SOLUTION
  }
  /** Remove the edge at @a it, as above.
   * @return an iterator at the edge that took the index, or edge_end().
   * @pre @a it != edge_end() */
  edge_iterator remove_edge(edge_iterator it) {
    // BEGIN SOLUTION 7.1.remove_edge_iterator 3pt
    remove_edge(*it);
    return it;
    // STUB (void)it;
    // STUB return edge_end();
    // END SOLUTION
  }

  // ------------------------------------------------------------------ Whole

  /** Remove all nodes and edges.
   * Invalidates: every Node, Edge, iterator, reference and span.
   * Complexity: O(num_nodes() + num_edges()), even if there were many more
   *       before. Frees no memory. */
  void clear() {
    for (Edge e : edges())
      ends_[e.id()] = {}, graph_detail::reset(edge_value_[e.id()]);
    for (Node n : nodes()) {
      position_[n.id_] = Point();
      graph_detail::reset(node_value_[n.id_]);
      neighbors_of_[n.id_] = {};
    }
    nodes_.clear();
    edges_.clear();
    pool_.clear();
    ++version_;
  }

  /** Number nodes and edges in the order in which they lie in memory, and close
   * the gaps between lists of neighbors. After many removals this makes
   * iteration nearly as fast as before them.
   * Invalidates: all iterators; spans of neighbors().
   * Keeps: every Node and Edge (with another index); references, other spans.
   * Complexity: O(node_slots() + edge_slots()) */
  void reindex() {
    pool_.compact(neighbors_of_);
    nodes_.reindex();
    edges_.reindex();
    ++version_;
  }
  /** Give the node of id @a ids[i] the index i. So nodes can be numbered in one
   * order, and lie in memory in another that makes loops faster.
   * @pre @a ids holds the id of each node once
   * Invalidates and keeps: as reindex(), of the nodes.
   * Complexity: O(node_slots()); memory as after a removal. */
  void reindex_nodes(std::span<const size_type> ids) {
    nodes_.reindex(ids);
    ++version_;
  }
  /** The same for the edges. */
  void reindex_edges(std::span<const size_type> ids) {
    edges_.reindex(ids);
    ++version_;
  }
  /** Put the edges at @a n in the order of @a ids.
   * @pre @a ids holds the id of each edge at @a n once
   * Invalidates: incident iterators of @a n.   Keeps: all else.
   * Complexity: O(degree squared) */
  void reorder_edges(const Node& n, std::span<const size_type> ids) {
    const auto list = neighbors_of_[n.id()];
    assert(ids.size() == list.size);
    for (size_type k = list.begin; k < list.begin + list.size; ++k) {
      size_type at = k;
      while (pool_[at].edge != ids[k - list.begin]) ++at;
      std::swap(pool_[k], pool_[at]);
    }
    pool_.note_places(list, n.id_);
    ++version_;
  }

  /** Allocate memory for a total of @a nodes and @a edges, so that adding them
   * moves no data. (Lists of neighbors may move if degrees differ a lot.)
   * Invalidates: references and spans.   Keeps: all else. */
  void reserve(size_type nodes, size_type edges) {
    position_.reserve(nodes + 1);
    node_value_.reserve(nodes);
    neighbors_of_.reserve(nodes);
    ends_.reserve(edges);
    edge_value_.reserve(edges);
    pool_.reserve(nodes, 2 * std::size_t(edges));
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

  // ---------------------------------------------------------- Arrays, by id
  // The graph's arrays without proxies, for loops over the whole graph. The
  // index into them is Node::id() or Edge::id(). A slot whose element was
  // removed holds Point(), V(), E() (unless these throw) and the ends {0, 0};
  // node_in_use() and edge_in_use() tell it apart.

  /** All ids lie below this.  >= num_nodes() */
  size_type node_slots() const { return nodes_.slots(); }
  size_type edge_slots() const { return edges_.slots(); }
  /** True if the slot holds a node.  @pre id < node_slots() */
  bool node_in_use(size_type id) const { return nodes_.in_use(id); }
  bool edge_in_use(size_type id) const { return edges_.in_use(id); }
  /** The node in a slot.  @pre node_in_use(id) */
  Node node_with_id(size_type id) const {
    assert(id < node_slots() && node_in_use(id));
    return Node(this, id);
  }
  Edge edge_with_id(size_type id) const {
    assert(id < edge_slots() && edge_in_use(id));
    return Edge(this, id);
  }

  /** One padding Point follows the last, so a 4-wide load stays inside. */
  std::span<Point> positions() { return {position_.data(), node_slots()}; }
  std::span<const Point> positions() const {
    return {position_.data(), node_slots()};
  }
  std::span<V> node_values() { return {node_value_.data(), node_slots()}; }
  std::span<const V> node_values() const {
    return {node_value_.data(), node_slots()};
  }
  /** The ids of both ends of each edge. */
  std::span<const std::array<size_type, 2>> edge_ends() const {
    return {ends_.data(), edge_slots()};
  }
  std::span<E> edge_values() { return {edge_value_.data(), edge_slots()}; }
  std::span<const E> edge_values() const {
    return {edge_value_.data(), edge_slots()};
  }

  /** An edge seen from one end: the ids of the other end and of the edge. */
  struct Neighbor {
    size_type node, edge;
  };
  /** The edges at a node, in the order of Node::edges(); none at a slot that
   * is not in use. */
  std::span<const Neighbor> neighbors(size_type id) const {
    return pool_.items(neighbors_of_[id]);
  }

  /** A number that changes whenever a node or an edge is added or removed, or
   * an index changes. No two graphs of a program ever have the same. */
  std::uint64_t version() const { return version_.number; }

  /** For tests.  Throws std::logic_error, with what is wrong, unless the
   * representation invariant holds: see the arrays, below.
   * Complexity: O(N log N + sum of squared degrees) */
  void check_invariants() const {
    auto require = [](bool ok, const char* what) {
      if (!ok) throw std::logic_error(std::string("Graph: ") + what);
    };
    nodes_.check_invariants(), edges_.check_invariants();
    require(position_.size() >= node_slots() + (node_slots() > 0) &&
                node_value_.size() >= node_slots() &&
                neighbors_of_.size() >= node_slots() &&
                ends_.size() >= edge_slots() &&
                edge_value_.size() >= edge_slots(),
            "an array is shorter than its slots");
    for (const auto& list : neighbors_of_)
      require(list.size <= list.capacity &&
                  (list.capacity == 0 || std::has_single_bit(list.capacity)),
              "a neighbor list exceeds its block");
    require(pool_.is_filled_by(neighbors_of_),
            "a block of the pool is lost or used twice");
    std::size_t neighbors = 0;
    for (size_type i = 0; i < node_slots(); ++i) {
      const auto& list = neighbors_of_[i];
      neighbors += list.size;
      require(node_in_use(i) || list.capacity == 0,
              "a removed node has neighbors");
      for (auto [j, e] : pool_.items(list)) {
        require(e < edge_slots() && edge_in_use(e),
                "a neighbor list holds a removed edge");
        require(j != i, "a loop");
        require(ends_[e] == std::array{i, j} || ends_[e] == std::array{j, i},
                "a neighbor list and the ends of an edge disagree");
        size_type seen = 0;
        for (Neighbor other : pool_.items(list)) seen += other.node == j;
        require(seen == 1, "parallel edges");
      }
      require(pool_.has_right_places(list, i),
              "an edge has another place in a list than is noted");
    }
    require(neighbors == 2 * std::size_t(num_edges()),
            "an edge is not in the lists of both its ends");
    for (size_type e = 0; e < edge_slots(); ++e)
      require(edge_in_use(e) || ends_[e] == std::array<size_type, 2>{},
              "a removed edge has ends");
  }

 private:
  static constexpr size_type none = graph_detail::none;
  // Representation. A slot is a place in the arrays; the id of an element is
  // the number of its slot.
  //
  // Invariant:
  // - nodes_ and edges_ know which slots are in use: those of odd generation,
  //   whose indices are 0, ..., size() - 1, each once. Every other slot is
  //   free or worn out.
  // - Every array reaches to the last slot; position_ has one Point more.
  // - neighbors_of_[i] is a list in pool_, inside its block. Each block of the
  //   pool belongs to one list or is free.
  // - For each edge e in use, with ends_[e] = {i, j}: i != j, both in use; the
  //   list of i has the entry {j, e}, that of j the entry {i, e}. There are no
  //   other entries, and no list names a node twice. If the pool notes places
  //   of entries, they are right.
  // - Slots not in use: a node has no list, an edge has the ends {0, 0}.
  // check_invariants() checks all of it; docs/graph.md explains it.
  graph_detail::SlotMap<Generation> nodes_, edges_;
  graph_detail::NeighborPool<Neighbor> pool_;
  graph_detail::Version version_;
  // By node id:
  Array<Point> position_;
  Array<V> node_value_;
  Array<typename graph_detail::NeighborPool<Neighbor>::List> neighbors_of_;
  // By edge id:
  Array<std::array<size_type, 2>> ends_;  // in the order of add_edge()
  Array<E> edge_value_;
  Graph* self() const { return const_cast<Graph*>(this); }

  /** The id of the edge between @a a and @a b, or none. */
  size_type find(const Node& a, const Node& b) const {
    if (!has_node(a) || !has_node(b)) return none;
    bool from_a = a.degree() <= b.degree();
    const Node& from = from_a ? a : b;
    size_type to = from_a ? b.id_ : a.id_;
    size_type found = none;
    // No branch on what is found: lists are short, so a branch that is
    // predicted wrong costs more than reading on to the end.
    for (Neighbor n : pool_.items(neighbors_of_[from.id_]))
      found &= n.edge | (0u - size_type(n.node != to));
    return found;
  }

  /** Do all that may throw when edges are removed. */
  void prepare_drop() {
    edges_.make_lists();
    pool_.reserve_removal({neighbors_of_.data(), node_slots()}, num_edges(),
                          edge_slots());
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
   * edges by index, and over the edges of one node by place in the pool. */
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
        [[maybe_unused]] const auto& list = graph_->neighbors_of_[node_];
        assert(at_ - list.begin < list.size &&
               "Node::edge_end() is dereferenced, or an iterator gone stale");
        const Neighbor& to = graph_->pool_[at_];
        return Proxy(graph_, to.edge, node_, to.node);
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
    // Index, or place in the pool; of 64 bits, which makes loops faster.
    std::size_t at_ = 0;
    size_type node_ = 0;  // of_one_node: its id
    ProxyIterator(Graph* g, std::size_t at, size_type node = 0)
        : graph_(g), at_(at), node_(node) {}
  };

  static_assert(sizeof(Node) <= 16 && sizeof(Edge) <= 24);
};

/** Nodes and edges can be the keys of a std::unordered_map. */
template <typename T>
requires std::same_as<T, typename T::graph_type::node_type> ||
    std::same_as<T, typename T::graph_type::edge_type>
struct std::hash<T> {
  std::size_t operator()(const T& handle) const { return handle.hash(); }
};
