/** @file 1.values.cpp
 * The values of nodes, as Homework 1 left them. */
#include "graph.hpp"

TASK("1.values", every_node_has_its_own_value) {
  DID("added 100 nodes, each with a value of its own");
  TestSubject s(nodes(100));
  s.hold(by_index | node_values);
  DID("a ring of 20 nodes, each with a value of its own");
  TestSubject r(ring(20));
  r.hold(by_index | node_values);
}

namespace kit {
template <typename G>
static void check_values_of_nodes(G& g) {
  DID("added 10 nodes with values of struct Mass");
  for (int v = 0; v < 10; ++v)
    add_node(g, place(v), Mass{v + 0.5, Point(v, 0, 1)});
  for (int v = 0; v < 10; ++v) {
    auto n = node_at(g, v);
    CHECK_EQUAL(n.value().kg, v + 0.5);
    CHECK_EQUAL(n.value().velocity, Point(v, 0, 1));
  }
  DID("n.value().kg = 7 for the fourth of 10 nodes");
  auto n = node_at(g, 3), copy = n;
  n.value().kg = 7;
  CHECK_EQUAL(n.value().kg, 7);
  CHECK_EQUAL(copy.value().kg, 7);
  CHECK_EQUAL(node_at(g, 3).value().kg, 7);
  for (int v = 0; v < 10; ++v)
    if (v != 3) CHECK_EQUAL(node_at(g, v).value().kg, v + 0.5);
  DID("n.value() = Mass{8, (1, 2, 3)} for the fourth of 10 nodes");
  n.value() = Mass{8, Point(1, 2, 3)};
  CHECK_EQUAL(copy.value().velocity, Point(1, 2, 3));
}
}  // namespace kit

TASK("1.values", all_handles_see_the_same_value) {
  StructGraph g;
  check_values_of_nodes(g);
}

TASK("1.values", iterators_lead_to_the_value_in_the_graph) {
  DID("(*it).value() += 5 for all nodes of a ring of 6");
  TestSubject s(ring(6));
  for (auto it = s.g.node_begin(), end = s.g.node_end(); !same(it, end); ++it)
    (*it).value() += 5;
  for (int v = 0; v < 6; ++v)
    CHECK_EQUAL(s.node(v).value(), value_of_node(v) + 5);
}
