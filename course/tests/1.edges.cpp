/** @file 1.edges.cpp
 * Edges as Homework 0 left them: adding, has_edge(), edge(i), comparisons. */
#include "graph.hpp"

TASK("1.edges", edges_are_added) {
  DID("2 nodes without an edge");
  TestSubject none(nodes(2));
  none.hold(edge_count | edge_indices | adjacency);
  for (const Model& shape : {ring(3), ring(20), wheel(6), complete(7)}) {
    DID("added ", shape.edges.size(), " edges, ", name(shape.edges[0]),
        " the first, to ", shape.nodes.size(), " nodes");
    TestSubject s(shape);
    s.hold(edge_count | edge_indices | adjacency);
  }
}

TASK("1.edges", the_edge_that_is_added_has_the_two_ends) {
  DID("a ring of 6 nodes; add_edge(n4, n1)");
  TestSubject s(ring(6));
  auto e = add_edge(s.g, s.node(4), s.node(1));
  s.m.add(Ends(1, 4));
  CHECK(ends_of(e) == Ends(1, 4), "the ends of the result are n4 and n1");
  s.hold(edge_count | edge_indices | adjacency);
}

TASK("1.edges", an_edge_is_added_once) {
  TestSubject s(ring(6));
  for (auto [a, b] : {std::pair(2, 3), std::pair(3, 2), std::pair(0, 5)}) {
    DID("a ring of 6 nodes; add_edge(", name(a), ", ", name(b),
        "), which is there");
    auto e = add_edge(s.g, s.node(a), s.node(b));
    CHECK(ends_of(e) == Ends(a, b), "the result is the edge that is there");
    s.hold(edge_count | edge_indices | adjacency);
  }
}

namespace kit {
template <typename E>
static void check_order_of_edges(E x, E y, bool are_same) {
  CHECK(same(x, y) == are_same, "edge(i) == edge(j) if i == j");
  constexpr bool ordered = must_compile || requires { x < y; };
  need<ordered>("e < f");
  if constexpr (ordered)
    CHECK(bool(x < y) + bool(y < x) + same(x, y) == 1,
          "of two edges exactly one of x < y, y < x and x == y holds");
}
}  // namespace kit

TASK("1.edges", edges_are_equal_from_either_end) {
  DID("a wheel of 5 nodes; compared edge(i) and edge(j)");
  TestSubject s(wheel(5));
  for (int i = 0; i < int(s.m.edges.size()); ++i)
    for (int j = 0; j < int(s.m.edges.size()); ++j)
      check_order_of_edges(edge_at(s.g, i), edge_at(s.g, j), i == j);
  DID("a wheel of 5 nodes; added each edge again, its ends exchanged");
  for (Ends e : s.m.edges) {
    auto there = add_edge(s.g, s.node(e.a), s.node(e.b));
    auto back = add_edge(s.g, s.node(e.b), s.node(e.a));
    CHECK(same(there, back), "add_edge(a, b) == add_edge(b, a)");
  }
}
