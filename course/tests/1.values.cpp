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
  auto n = node_at(g, 3), copy = n;
  constexpr bool there = must_compile || requires { n.value().kg = 7; };
  need<there>("n.value().kg = 7");
  if constexpr (there) {
    for (int v = 0; v < 10; ++v) {
      auto m = node_at(g, v);
      CHECK_EQUAL(m.value().kg, v + 0.5);
      CHECK_EQUAL(m.value().velocity, Point(v, 0, 1));
    }
    DID("n.value().kg = 7 for n = g.node(3)");
    n.value().kg = 7;
    CHECK_EQUAL(n.value().kg, 7);
    CHECK_EQUAL(copy.value().kg, 7);
    CHECK_EQUAL(g.node(n.index()).value().kg, 7);
    for (int v = 0; v < 10; ++v)
      if (v != 3) CHECK_EQUAL(node_at(g, v).value().kg, v + 0.5);
    DID("n.value() = Mass{8, (1, 2, 3)} for n = g.node(3)");
    n.value() = Mass{8, Point(1, 2, 3)};
    CHECK_EQUAL(copy.value().velocity, Point(1, 2, 3));
  }
}

template <typename S>
static void check_values_by_iterators(S& s) {
  if (!(s.works & node_loop)) return;  // the fault of another task
  DID("(*it).value() += 5 for all nodes of a ring of 6");
  auto it = s.g.node_begin(), end = s.g.node_end();
  constexpr bool there = must_compile || requires { (*it).value() += 5; };
  need<there>("(*it).value() += 5");
  if constexpr (there) {
    for (; !same(it, end); ++it) (*it).value() += 5;
    for (int v = 0; v < 6; ++v)
      check_equal(s.node(v).value(), value_of_node(v) + 5,
                  words("the value of ", name(v)));
  }
}
}  // namespace kit

TASK("1.values", all_handles_see_the_same_value) {
  StructGraph g;
  check_values_of_nodes(g);
}

TASK("1.values", iterators_lead_to_the_value_in_the_graph) {
  TestSubject s(ring(6));
  check_values_by_iterators(s);
}
