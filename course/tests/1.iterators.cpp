/** @file 1.iterators.cpp
 * The iterators of Homework 1: over nodes, edges and the edges at a node. */
#include "graph.hpp"

TASK("1.iterators", every_element_is_visited_once) {
  Model with_gaps = nodes(9);  // n0, n4 and n8 have no edge
  for (int v : {1, 2, 5, 6}) with_gaps.add(Ends(v, v + 1));
  for (const Model& shape : {nodes(1), nodes(3), ring(3), ring(20), wheel(6),
                             complete(6), with_gaps}) {
    DID(description(shape));
    TestSubject s(shape);
    s.hold(node_loop | edge_loop | incident_loop | seen_from | degrees);
  }
}

TASK("1.iterators", an_empty_range_has_no_steps) {
  DID("an empty graph");
  TestSubject empty(nodes(0));
  CHECK(same(empty.g.node_begin(), empty.g.node_end()),
        "node_begin() == node_end()");
  CHECK(same(empty.g.edge_begin(), empty.g.edge_end()),
        "edge_begin() == edge_end()");
  DID("a graph of one node");
  TestSubject one(nodes(1));
  auto n = one.node(0);
  CHECK(same(n.edge_begin(), n.edge_end()),
        "edge_begin() == edge_end() of a node without edges");
}

namespace kit {
template <typename It>
static void check_steps(It first, It second, It end) {
  CHECK(same(first, second), "two iterators at begin are equal");
  ++first;
  CHECK(!same(first, second), "++ moves an iterator to another place");
  ++second;
  CHECK(same(first, second), "++ moves two equal iterators alike");
  CHECK(!same(first, end), "begin is not one step before end");
}
}  // namespace kit

TASK("1.iterators", a_step_moves_to_another_place) {
  TestSubject s(complete(4));
  auto& g = s.g;
  DID("4 nodes, all joined; one step from node_begin()");
  check_steps(g.node_begin(), g.node_begin(), g.node_end());
  DID("4 nodes, all joined; one step from edge_begin()");
  check_steps(g.edge_begin(), g.edge_begin(), g.edge_end());
  DID("4 nodes, all joined; one step from n2.edge_begin()");
  auto n = s.node(2);
  check_steps(n.edge_begin(), n.edge_begin(), n.edge_end());
}
