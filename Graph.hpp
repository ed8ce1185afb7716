#pragma once
/** @file Graph.hpp
 * Graph: an undirected graph whose nodes have a position in space and whose
 * nodes and edges carry a value each. Node and Edge are proxies: small
 * handles, passed by value, that read and write the graph's own arrays.
 *
 * How it is stored, and why so: docs/graph.md. */
#include <array>
#include <bit>
#include <cassert>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <iterator>
#include <span>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>

#include "CME212/NeighborPool.hpp"
#include "CME212/Point.hpp"
#include "CME212/SlotMap.hpp"
#include "CME212/Util.hpp"

/** An undirected graph in space: no loops, no parallel edges.
 * @tparam V Type of the nodes' values: default constructible, copyable
 * @tparam E Type of the edges' values: likewise
 *
 * The nodes have the indices 0, ..., num_nodes() - 1, the edges 0, ...,
 * num_edges() - 1. A removal moves indices; it never moves what a Node or an
 * Edge means: every handle keeps meaning the same element for as long as that
 * lives. A handle of a removed element is dead and stays so for ever, also
 * when new elements come (has_node() and has_edge() say false).
 *
 * Complexity: O(1) where nothing is said; "degree" is a node's number of
 * edges. The first removal makes the lists of indices: it takes
 * O(num_nodes() + num_edges()), which is O(1) for each element added before.
 * So may the first one after clear() or reindex(). Memory, N nodes and M edges:
 * 40 + sizeof(V) bytes a node and 28 + sizeof(E) an edge on a grid, up to a
 * quarter of that to grow into, 8 more each after the first removal, and 8 an
 * edge once hubs lost many edges; slots of removed elements are used again by
 * new ones, and given back when the graph is destroyed.
 *
 * A member that throws, std::bad_alloc or what a value throws, has changed no
 * node, edge or value; but what it says it invalidates may be invalid.
 * Preconditions are asserted; with NDEBUG they cost nothing. A Graph may be
 * copied (the copy has the same indices and ids, and handles of its own), but
 * not assigned: the handles of the old content would come to mean another. No
 * handle may be used when its graph is destroyed.
 * Threads: as a std::vector. Reads may run together, a write runs alone;
 * writes to positions and values of different elements may run together. */
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

  /** A handle of one node: 16 bytes, to be passed by value. A default
   * constructed Node belongs to no graph.
   * @pre of all members but comparisons: the node is in its graph. */
  class Node : private totally_ordered<Node> {
   public:
    /** An invalid node. */
    Node() = default;

    /** The place of the node in space, to read or to move. */
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
    /** Where Graph::positions() and Graph::node_values() hold this node. It
     * stays the same for as long as the node lives. */
    size_type id() const { return graph(), id_; }

    /** Number of edges at this node. */
    size_type degree() const { return list().size; }
    /** The edges at this node: each has it as node1().
     * Order: as added, until an edge at this node is removed. */
    incident_iterator edge_begin() const { return {graph_, list().begin, id_}; }
    incident_iterator edge_end() const {
      return {graph_, std::size_t(list().begin) + list().size, id_};
    }
    graph_detail::Range<incident_iterator> edges() const {
      return {edge_begin(), edge_end()};
    }

    /** Same node of the same graph. */
    bool operator==(const Node& n) const {
      return graph_ == n.graph_ && id_ == n.id_ && generation_ == n.generation_;
    }
    /** A strict total order of all nodes of all graphs: in one graph that of
     * their ids. It never changes, so a Node can be a key. */
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

    Graph& graph() const {
      assert(graph_ != nullptr && graph_->has_node(*this));
      return *graph_;
    }
    const auto& list() const { return graph().neighbors_of_[id_]; }
  };

  // ------------------------------------------------------------------- Edge

  /** A handle of one edge, seen from one of its ends: 24 bytes, to be passed
   * by value. A default constructed Edge belongs to no graph.
   * @pre of all members but comparisons: the edge is in its graph. */
  class Edge : private totally_ordered<Edge> {
   public:
    /** An invalid edge. */
    Edge() = default;

    /** The end from which the edge is seen, and the other one. Which is which
     * depends on where this handle comes from: Node::edges() gives the node
     * itself as node1(), add_edge(a, b) gives a, edge(i) the first one of the
     * call that added the edge. */
    Node node1() const { return Node(&graph(), near_); }
    Node node2() const { return Node(&graph(), far_); }

    /** The value of the edge: one, whichever end it is seen from. */
    // BEGIN SOLUTION 4.1.edge_value 6pt
    edge_value_type& value() { return graph().edge_value_[id_]; }
    const edge_value_type& value() const { return graph().edge_value_[id_]; }
    // STUB edge_value_type& value() { return no_edges_; }
    // STUB const edge_value_type& value() const { return no_edges_; }
    // STUB static inline edge_value_type no_edges_{};  // belongs to no edge
    // END SOLUTION

    /** Distance of the two ends, now. */
    double length() const {
      return norm(node1().position() - node2().position());
    }
    /** A number in [0, num_edges()); removals of others may change it. */
    size_type index() const { return graph().edges_.index_of(id_); }
    /** Where Graph::edge_ends() and Graph::edge_values() hold this edge. It
     * stays the same for as long as the edge lives. */
    size_type id() const { return id_; }

    /** Same edge of the same graph, whichever end it is seen from. */
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
   * Invalidates: references and spans to positions and node values.
   * Keeps: every Node, Edge and iterator (but an end stays where it was).
   * Complexity: O(1) amortized.
   * Throws std::length_error beyond 2^31 nodes. */
  Node add_node(const Point& position, const V& value = V()) {
    V copy = value;  // the caller's may lie in the array that grows
    Point p = position;
    size_type id = nodes_.reserve_one();
    graph_detail::grow_to_hold(position_, id + 1);  // one more: positions()
    graph_detail::grow_to_hold(node_value_, id);
    graph_detail::grow_to_hold(neighbors_of_, id);
    node_value_[id] = std::move(copy);  // the last that may throw
    nodes_.acquire();
    position_[id] = p;
    ++version_;
    return Node(this, id);
  }

  /** True if @a n is a node of this graph now. */
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
   * @return 1 if removed; 0 if !has_node(@a n), and then nothing changed.
   * @post !has_node(@a n), and num_nodes() fell by the result.
   * @post If removed: num_edges() fell by old @a n.degree(); the node of
   *       highest index took @a n's index; all others kept their own.
   * Invalidates: @a n, its copies and its edges; all edge and incident
   *       iterators; node iterators at @a n and at the highest index.
   * Keeps: every other Node and Edge; references and spans.
   * Complexity: O(degree()) amortized, whatever the neighbors' degrees, but for
   *       the first removal: see Graph. */
  size_type remove_node(const Node& n) {
    // BEGIN SOLUTION 7.1.remove_node 8pt
    if (!has_node(n)) return 0;
    size_type id = n.id_;  // n may be a reference into what changes below
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
   * @return an iterator at the node that now has the index, or node_end(): so
   *         `it = g.remove_node(it)` in place of ++it visits every node once.
   * @pre @a it != node_end() */
  node_iterator remove_node(node_iterator it) {
    // BEGIN SOLUTION 7.1.remove_node_iterator 3pt
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
   * @return the edge, new or old, with node1() == a and node2() == b.
   * @pre has_node(a) && has_node(b) && a != b
   * @post has_edge(a, b); num_edges() grew by one if the edge is new, and then
   *       its index is old num_edges(). The value of an old edge is kept.
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
    edge_value_[id] = std::move(copy);  // the last that may throw
    // STUB (void)copy;
    // END SOLUTION
    edges_.acquire();
    ends_[id] = {i, j};
    pool_.add(neighbors_of_[i], i, {j, id});
    pool_.add(neighbors_of_[j], j, {i, id});
    ++version_;
    return Edge(this, id);
  }

  /** True if there is an edge between @a a and @a b, nodes of this graph now.
   * Complexity: O(min(a.degree(), b.degree())) */
  bool has_edge(const Node& a, const Node& b) const {
    return find(a, b) != none;
  }
  /** True if @a e is an edge of this graph now. */
  bool has_edge(const Edge& e) const {
    return e.graph_ == this && edges_.alive(e.id_, e.generation_);
  }

  /** The edge of index @a i.  @pre i < num_edges() */
  Edge edge(size_type i) const {
    assert(i < num_edges());
    return Edge(this, edges_.id_at(i));
  }

  /** Remove the edge between @a a and @a b.
   * @return 1 if removed; 0 if !has_edge(a, b), and then nothing changed.
   * @post !has_edge(a, b), and num_edges() fell by the result.
   * @post If removed: the edge of highest index took its index; all others
   *       kept their own.
   * Invalidates: the edge and its copies; edge iterators at it and at the
   *       highest index; incident iterators of @a a and @a b.
   * Keeps: every Node and every other Edge; references and spans.
   * Complexity: O(min(degrees)) amortized, but for the first removal. */
  size_type remove_edge(const Node& a, const Node& b) {
    // BEGIN SOLUTION 7.1.remove_edge 6pt
    size_type id = find(a, b);
    return id == none ? 0 : remove_edge(Edge(this, id));
    // STUB (void)a, (void)b;
    // STUB return 0;
    // END SOLUTION
  }
  /** Remove @a e: as above, in O(1) amortized; 0 if !has_edge(e). */
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
  /** Remove the edge at @a it: as above.
   * @return an iterator at the edge that now has the index, or edge_end().
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
   * Complexity: O(num_nodes() + num_edges()), whatever was removed before.
   *       Memory is kept for new elements, so dead handles stay dead. */
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

  /** Give the indices anew, in the order in which the elements lie in memory,
   * and close gaps between lists of neighbors: after many removals this makes
   * iteration nearly as fast as at first.
   * Invalidates: all iterators; spans of neighbors().
   * Keeps: every Node and Edge (with another index); references, other spans.
   * Complexity: O(node_slots() + edge_slots()) */
  void reindex() {
    pool_.compact(neighbors_of_);
    nodes_.reindex();
    edges_.reindex();
    ++version_;
  }
  /** Give the node of id @a ids[i] the index i: so nodes can lie in memory in
   * the order that sweeps like best, and be counted in another.
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
  /** Give the edges at @a n the order of @a ids, which are theirs, each once.
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

  /** Make room for so many nodes and edges in all: up to there, adding moves
   * nothing; but lists of neighbors may, if most are far from full.
   * Invalidates: references and spans.   Keeps: all else. */
  void reserve(size_type nodes, size_type edges) {
    nodes_.reserve(nodes);
    position_.reserve(nodes + 1);
    node_value_.reserve(nodes);
    neighbors_of_.reserve(nodes);
    edges_.reserve(edges);
    ends_.reserve(edges);
    edge_value_.reserve(edges);
    pool_.reserve(nodes, 2 * std::size_t(edges));
  }

  node_iterator node_begin() const { return {self(), 0}; }
  node_iterator node_end() const { return {self(), num_nodes()}; }
  edge_iterator edge_begin() const { return {self(), 0}; }
  edge_iterator edge_end() const { return {self(), num_edges()}; }
  /** For range-for: for (auto n : g.nodes()) ... */
  graph_detail::Range<node_iterator> nodes() const {
    return {node_begin(), node_end()};
  }
  graph_detail::Range<edge_iterator> edges() const {
    return {edge_begin(), edge_end()};
  }

  // ---------------------------------------------------------- Arrays, by id
  // The same storage without proxies, for sweeps over the whole graph: plain
  // arrays, addressed by Node::id() and Edge::id(). A slot whose element was
  // removed holds Point(), V(), E() (unless these throw) and the ends {0, 0};
  // skip it by node_in_use() and edge_in_use(). The loop is one over memory.

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

  /** One more Point lies behind the last: who reads four numbers at a time may
   * read its x. */
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

  /** An edge as one of its ends sees it: the ids of the other end and of the
   * edge. */
  struct Neighbor {
    size_type node, edge;
  };
  /** The edges at a node, in the order of Node::edges(); none at a slot that
   * is not in use. */
  std::span<const Neighbor> neighbors(size_type id) const {
    return pool_.items(neighbors_of_[id]);
  }

  /** Changes whenever a node or an edge came or went, or indices changed. No
   * two graphs of a program ever have the same. */
  std::uint64_t version() const { return version_.number; }

  /** Throw std::logic_error with what is wrong unless the whole representation
   * is consistent. For tests.
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
    // Not a branch on what is found: in lists this short, one that the
    // processor guesses wrong costs more than to read on to the end.
    for (Neighbor n : pool_.items(neighbors_of_[from.id_]))
      found &= n.edge | (0u - size_type(n.node != to));
    return found;
  }

  /** All that may throw when edges are removed. */
  void prepare_drop() {
    edges_.make_lists();
    pool_.reserve_removal({neighbors_of_.data(), node_slots()}, num_edges(),
                          edge_slots());
  }
  /** Release edge @a e, whose ends' lists are not looked at. */
  void drop_edge(size_type e) {
    // BEGIN SOLUTION 7.1.remove_edge
    ends_[e] = {};
    graph_detail::reset(edge_value_[e]);
    edges_.release(e);
    // STUB (void)e;
    // END SOLUTION
  }

  /** Iterates over proxies, made when asked for. Random access over all nodes
   * or edges by index; over the edges of one node by place in the pool. */
  template <typename Proxy, bool of_one_node>
  class ProxyIterator {
   public:
    using value_type = Proxy;
    using reference = Proxy;
    using difference_type = std::ptrdiff_t;
    using iterator_category = std::random_access_iterator_tag;
    /** Holds the proxy while its member is called. */
    struct pointer {
      Proxy proxy;
      Proxy* operator->() { return &proxy; }
    };

    /** An iterator of no graph: only to be assigned to. */
    ProxyIterator() = default;

    /** @pre it belongs to a graph and is not at the end of its range */
    Proxy operator*() const {
      assert(graph_ && "an iterator of no graph is dereferenced");
      if constexpr (of_one_node) {
        [[maybe_unused]] const auto& list = graph_->neighbors_of_[node_];
        assert(at_ - list.begin < list.size &&
               "Node::edge_end() is dereferenced, or an iterator gone stale");
        const Neighbor& to = graph_->pool_[at_];
        return Proxy(graph_, to.edge, node_, to.node);
      } else if constexpr (std::is_same_v<Proxy, Node>) {
        assert(at_ < graph_->num_nodes() && "node_end() is dereferenced");
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
    // Index, or place in the pool: as long as an address, for short loops.
    std::size_t at_ = 0;
    size_type node_ = 0;  // of_one_node: its id
    ProxyIterator(Graph* g, std::size_t at, size_type node = 0)
        : graph_(g), at_(at), node_(node) {}
  };

  static_assert(sizeof(Node) <= 16 && sizeof(Edge) <= 24);
};
