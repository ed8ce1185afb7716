/** @file 7.1.remove_node.cpp
 * remove_node(n): the node goes and its edges with it; all else stays. */
#include "graph.hpp"

TASK("7.1.remove_node", a_node_without_edges_is_removed) {
  for (int v = 0; v < 5; ++v) {
    TestSubject s(nodes(5));
    DID("added n0 to n4; remove_node(", name(v), ")");
    s.remove_node(v);
    s.hold();
    DID("added n0 to n4; remove_node(", name(v), "); added n5");
    s.add_node(5);
    s.hold();
  }
}

TASK("7.1.remove_node", the_edges_go_with_the_node) {
  for (const Model& shape : {ring(5), wheel(6), complete(5)})
    for (int v : shape.nodes) {
      const auto graph =
          words("a graph of ", shape.nodes.size(), " nodes and ",
                shape.edges.size(), " edges; remove_node(", name(v), ")");
      TestSubject s(shape);
      DID(graph);
      s.remove_node(v);
      s.hold();
      DID(graph, "; added a node and joined it to all others");
      const auto others = s.m.nodes;
      s.add_node(9);
      for (int w : others) s.add_edge(9, w);
      s.hold();
    }
}

TASK("7.1.remove_node", a_grid_is_emptied_and_built_again) {
  TestSubject s(grid(4));
  s.tells = true;
  Dice dice = drawn_dice(71);
  int count = 0;
  while (!s.m.nodes.empty()) {
    int v = s.m.nodes[dice(s.m.nodes.size())];
    DID("a grid of 4 by 4 nodes; removed ", count++, " nodes, then ", name(v));
    s.remove_node(v);
    s.hold();
  }
  DID("a grid of 4 by 4 nodes; removed all; added 10 nodes and joined all");
  for (int v = 20; v < 30; ++v) s.add_node(v);
  for (int v = 20; v < 30; ++v)
    for (int w = 20; w < v; ++w) s.add_edge(v, w);
  s.hold();
}

TASK("7.1.remove_node", half_of_a_large_grid_is_removed) {
  TestSubject s(grid(20));
  Dice dice = drawn_dice(72);
  DID("a grid of 20 by 20 nodes; removed 200 nodes");
  for (int k = 0; k < 200; ++k)
    s.remove_node(s.m.nodes[dice(s.m.nodes.size())]);
  s.hold();
}

TASK("7.1.remove_node", a_node_of_lowest_and_of_highest_index_is_removed) {
  for (bool last : {false, true}) {
    TestSubject s(grid(4));
    while (s.m.nodes.size() > 1) {
      auto n = node_at(s.g, last ? s.m.nodes.size() - 1 : 0);
      int v = name_of(n);
      DID("a grid of 4 by 4 nodes; remove_node(node(", last ? "last" : "0",
          ")) down to ", s.m.nodes.size() - 1, " nodes");
      s.remove_node(v);
      s.hold();
    }
  }
}

namespace kit {
/** A long history of additions and removals. */
template <typename S>
static void check_history(S& s, bool removes_edges, std::uint32_t seed) {
  Dice dice{seed};
  for (int step = 0; step < 250; ++step) {
    auto any_node = [&] { return s.m.nodes[dice(s.m.nodes.size())]; };
    const int what = dice(10);
    const auto after = words("step ", step, " of a random history: ");
    if (s.m.nodes.size() < 3 || (what < 3 && s.m.nodes.size() < 12)) {
      DID(after, "added ", name(100 + step));
      s.add_node(100 + step);
    } else if (what < 5) {
      int v = any_node();
      DID(after, "remove_node(", name(v), ")");
      s.remove_node(v);
    } else if (what < 8 || !removes_edges || s.m.edges.empty()) {
      int v = any_node(), w = any_node();
      if (v == w || s.m.has(Ends(v, w))) continue;
      DID(after, "add_edge(", name(v), ", ", name(w), ")");
      s.add_edge(v, w);
    } else {
      Ends e = s.m.edges[dice(s.m.edges.size())];
      DID(after, "remove_edge(", name(e.a), ", ", name(e.b), ")");
      s.remove_edge(e.a, e.b);
    }
    s.hold();
  }
}

/** Does remove_edge(a, b) do its own task? If not, no other test calls it. */
template <typename S>
static bool removes_edges(S& s) {
  auto a = node_at(s.g, 0), b = node_at(s.g, 1);
  if constexpr (requires { bool(s.g.remove_edge(a, b)); }) {
    for (Ends e : {Ends(0, 1), Ends(4, 1), Ends(0, 4)})
      if (s.try_to_remove_edge(e.b, e.a) != s.works) return false;
    return true;
  }
  return false;
}
}  // namespace kit

TASK("7.1.remove_node", nodes_and_edges_come_and_go) {
  TestSubject s(ring(6)), tried(wheel(5));
  check_history(s, removes_edges(tried), 7);
}
