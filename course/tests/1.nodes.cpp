/** @file 1.nodes.cpp
 * Nodes as Homework 0 left them: adding, indices, comparisons, clear(). */
#include "graph.hpp"

TASK("1.nodes", nodes_are_added) {
  DID("an empty graph");
  TestSubject s(nodes(0));
  auto& g = s.g;
  CHECK_EQUAL(g.num_nodes(), 0);
  CHECK_EQUAL(g.size(), 0);
  for (int v = 0; v < 100; ++v) {
    DID("add_node to a graph of ", v, " nodes");
    s.add_node(v);
    CHECK_EQUAL(g.num_nodes(), v + 1);
    CHECK_EQUAL(g.size(), v + 1);
  }
  DID("added 100 nodes, n0 to n99");
  s.hold(by_index);
}

TASK("1.nodes", nodes_are_known_by_their_graph) {
  DID("two graphs of 3 nodes each, g and h");
  TestSubject one(nodes(3)), two(nodes(3));
  auto &g = one.g, &h = two.g;
  for (int v = 0; v < 3; ++v) {
    CHECK(g.has_node(one.node(v)), "g.has_node(g.node(i))");
    CHECK(!g.has_node(two.node(v)), "not g.has_node(h.node(i))");
    CHECK(!h.has_node(one.node(v)), "not h.has_node(g.node(i))");
  }
}

namespace kit {
template <typename S>
static void check_order_of_nodes(S& one, S& two) {
  constexpr bool ordered = must_compile || requires {
    one.node(0) < two.node(0);
  };
  need<ordered>("n < m");
  for (S* a : {&one, &two})
    for (S* b : {&one, &two})
      for (int v = 0; v < 4; ++v)
        for (int w = 0; w < 4; ++w) {
          auto x = a->node(v), y = b->node(w);
          CHECK(same(x, y) == (a == b && v == w),
                "two nodes are equal if they have one graph and one index");
          if constexpr (ordered)
            CHECK(bool(x < y) + bool(y < x) + same(x, y) == 1,
                  "of two nodes exactly one of x < y, y < x and x == y holds");
        }
}
}  // namespace kit

TASK("1.nodes", nodes_are_ordered) {
  DID("two graphs of 4 nodes each, all their nodes compared");
  TestSubject one(nodes(4)), two(nodes(4));
  check_order_of_nodes(one, two);
}

TASK("1.nodes", clear_leaves_an_empty_graph) {
  DID("a ring of 5 nodes; clear()");
  TestSubject s(ring(5));
  auto& g = s.g;
  g.clear();
  s.m = nodes(0);
  s.hold(by_index);
  CHECK_EQUAL(g.num_edges(), 0);
  DID("a ring of 5 nodes; clear(); added n0, n1 and n2");
  for (int v = 0; v < 3; ++v) s.add_node(v);
  s.hold(by_index);
  if (!(s.works & adjacency)) return;  // 1.edges says so
  DID("a ring of 5 nodes; clear(); added n0, n1 and n2 and joined n0 to n2");
  s.add_edge(0, 2);
  s.hold(by_index | adjacency | (s.works & edge_count));
}
