/** @file 7.1.cost.cpp
 * That the calls whose cost is counted remove anything: nodes without edges,
 * and edges that share no node, the last one first. No list that a wrong
 * removal leaves behind is read here, as that is of other tasks. */
#include "asked.hpp"

namespace kit {
template <typename G>
static void ask_for_what_is_left(G& nodes_go, G& edges_go) {
  const std::size_t pairs = 100;
  for (std::size_t i = 0; i < 2 * pairs; ++i) {
    add_node(nodes_go, place(int(i)), int(i));
    add_node(edges_go, place(int(i)), int(i));
  }
  for (std::size_t i = 0; i < pairs; ++i)
    add_edge(edges_go, node_at(edges_go, 2 * i), node_at(edges_go, 2 * i + 1));
  const double edges = double(edges_go.num_edges());
  const std::size_t go = std::size_t(20 + drawn_below(60));
  for (std::size_t i = 1; i <= go; ++i) {
    auto n = node_at(nodes_go, 2 * pairs - i);
    take_out_node(nodes_go, n);
    auto a = node_at(edges_go, 2 * (pairs - i));
    auto at = a.edge_begin(), end = a.edge_end();
    if (same(at, end)) continue;  // an earlier removal took it, too
    auto e = *at;
    take_out_edge(edges_go, e);
  }
  answer("nodes", double(nodes_go.num_nodes()));
  // How many there are is of other tasks.
  answer("edges gone", edges - double(edges_go.num_edges()));
}
}  // namespace kit

ASKED("7.1.cost", cost_asked) {
  TestGraph nodes_go, edges_go;
  ask_for_what_is_left(nodes_go, edges_go);
}
