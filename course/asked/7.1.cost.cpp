/** @file 7.1.cost.cpp
 * That the calls whose cost is counted remove anything. */
#include "asked.hpp"

namespace kit {
template <typename G>
static void ask_for_what_is_left(G& nodes_go, G& edges_go) {
  build(nodes_go, 100, false);
  build(edges_go, 100, false);
  const double edges = double(edges_go.num_edges());
  for (int left = 20 + drawn_below(60); left > 0; --left) {
    auto n = node_at(nodes_go, 0);
    take_out_node(nodes_go, n);
    auto a = node_at(edges_go, std::size_t(left));
    auto at = a.edge_begin(), end = a.edge_end();
    if (same(at, end)) continue;  // both of its edges are gone
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
