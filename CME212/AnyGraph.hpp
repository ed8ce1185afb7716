#pragma once
/** @file AnyGraph.hpp
 * What programs need of a graph beyond the assignment's interface, made of that
 * interface: so they run with any Graph.hpp of the course. What is faster is
 * used where a graph has it. */
#include <cstddef>
#include <ranges>

#include "CME212/Point.hpp"

namespace CME212 {

/** A first and a last iterator, for range-for. */
template <typename It>
struct Range {
  It first, last;
  It begin() const { return first; }
  It end() const { return last; }
};

/** The nodes of a graph: for (Node n : nodes(g)) ... */
template <typename G>
auto nodes(G&& g) -> Range<decltype(g.node_begin())> {
  return {g.node_begin(), g.node_end()};
}
/** The edges of a graph, or those at a node. */
template <typename X>
auto edges(X&& x) -> Range<decltype(x.edge_begin())> {
  return {x.edge_begin(), x.edge_end()};
}

/** The present distance of an edge's ends. */
template <typename E>
double length(E e) {
  if constexpr (requires { e.length(); })
    return e.length();
  else
    return norm(e.node1().position() - e.node2().position());
}

/** Allocate memory for so many nodes and edges, if @a g can. */
template <typename G>
void reserve(G& g, std::size_t nodes, std::size_t edges) {
  if constexpr (requires { g.reserve(unsigned(nodes), unsigned(edges)); })
    g.reserve(unsigned(nodes), unsigned(edges));
}

}  // namespace CME212

template <typename It>
inline constexpr bool std::ranges::enable_view<CME212::Range<It>> = true;
template <typename It>
inline constexpr bool std::ranges::enable_borrowed_range<CME212::Range<It>> =
    true;
