#pragma once
/** @file GraphArrays.hpp
 * The arrays of a graph without proxies, for loops over the whole graph; and
 * its order in memory. */
#include <array>
#include <cassert>
#include <cstdint>
#include <span>
#include <type_traits>
#include <vector>

#include "Graph.hpp"

/** A view of a graph's arrays. The index into them is Node::id() or Edge::id().
 * A slot whose element was removed holds Point(), V(), E() (unless these throw)
 * and the ends {0, 0}; node_in_use() and edge_in_use() tell it apart.
 *
 * Spans are invalid after add_node(), add_edge() and reserve(); a removal keeps
 * them. O(1) unless stated.
 * @tparam G a Graph, const for a view that only reads */
template <typename G>
class GraphArrays {
  template <typename T>
  using Span = std::span<std::conditional_t<std::is_const_v<G>, const T, T>>;

 public:
  using size_type = typename G::size_type;
  using Node = typename G::node_type;
  using Edge = typename G::edge_type;
  using Ids = std::span<const size_type>;
  /** Has `node` and `edge`: the ids of an edge's other end and of the edge. */
  using Neighbor = typename G::Neighbor;

  explicit GraphArrays(G& g) : g_(g) {}

  /** All ids lie below this.  >= num_nodes() */
  size_type node_slots() const { return g_.nodes_.slots(); }
  size_type edge_slots() const { return g_.edges_.slots(); }
  /** True if the slot holds a node.  @pre id < node_slots() */
  bool node_in_use(size_type id) const { return g_.nodes_.in_use(id); }
  bool edge_in_use(size_type id) const { return g_.edges_.in_use(id); }
  /** The node in a slot.  @pre node_in_use(id) */
  Node node_with_id(size_type id) const {
    assert(id < node_slots() && node_in_use(id));
    return g_.node(g_.nodes_.index_of(id));
  }
  Edge edge_with_id(size_type id) const {
    assert(id < edge_slots() && edge_in_use(id));
    return g_.edge(g_.edges_.index_of(id));
  }

  Span<Point> positions() const { return {g_.position_.data(), node_slots()}; }
  Span<typename G::node_value_type> node_values() const {
    return {g_.node_value_.data(), node_slots()};
  }
  /** The ids of both ends of each edge. */
  std::span<const std::array<size_type, 2>> edge_ends() const {
    return {g_.ends_.data(), edge_slots()};
  }
  Span<typename G::edge_value_type> edge_values() const {
    return {g_.edge_value_.data(), edge_slots()};
  }
  /** The edges at a node, in the order of Node::edges(); none at a slot that
   * is not in use. */
  std::span<const Neighbor> neighbors(size_type id) const {
    return g_.neighbors_of_[id];
  }

  /** A number that changes whenever a node or an edge is added or removed, or
   * an index changes. No two graphs of a program ever have the same. */
  std::uint64_t version() const { return g_.version_.number; }

  // ------------------------------------------------------------------- Order

  /** Number nodes and edges in the order in which they lie in memory. After
   * many removals this makes iteration nearly as fast as before them.
   * Invalidates: all iterators.
   * Keeps: every Node and Edge (with another index), references and spans.
   * Complexity: O(node_slots() + edge_slots()) */
  void reindex() const {
    const auto nodes = ids_in_use(g_.nodes_), edges = ids_in_use(g_.edges_);
    g_.nodes_.make_lists(), g_.edges_.make_lists();  // all that may throw
    reindex_nodes(nodes), reindex_edges(edges);
  }
  /** Give the node of id @a ids[i] the index i. So nodes can be numbered in one
   * order, and lie in memory in another that makes loops faster.
   * @pre @a ids holds the id of each node once
   * Invalidates and keeps: as reindex(), of the nodes.  O(num_nodes()) */
  void reindex_nodes(Ids ids) const { g_.nodes_.reindex(ids), ++g_.version_; }
  /** The same for the edges. */
  void reindex_edges(Ids ids) const { g_.edges_.reindex(ids), ++g_.version_; }
  /** Put the edges at @a n in the order of @a ids.
   * @pre @a ids holds the id of each edge at @a n once
   * Invalidates: incident iterators of @a n.   Keeps: all else.
   * Complexity: O(degree squared) */
  void reorder_edges(const Node& n, Ids ids) const {
    auto& list = g_.neighbors_of_[n.id()];
    assert(ids.size() == list.size());
    for (std::size_t k = 0; k < list.size(); ++k) {
      std::size_t at = k;
      while (list[at].edge != ids[k]) ++at;
      std::swap(list[k], list[at]);
    }
    ++g_.version_;
  }

 private:
  G& g_;

  template <typename Slots>
  static std::vector<size_type> ids_in_use(const Slots& slots) {
    std::vector<size_type> ids;
    ids.reserve(slots.size());
    for (size_type id = 0; id < slots.slots(); ++id)
      if (slots.in_use(id)) ids.push_back(id);
    return ids;
  }
};

/** The arrays of @a g: arrays(g).positions()[n.id()] */
template <typename V, typename E>
GraphArrays<Graph<V, E>> arrays(Graph<V, E>& g) {
  return GraphArrays<Graph<V, E>>(g);
}
template <typename V, typename E>
GraphArrays<const Graph<V, E>> arrays(const Graph<V, E>& g) {
  return GraphArrays<const Graph<V, E>>(g);
}
