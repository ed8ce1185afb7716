/** @file 7.1.remove_node_iterator.cpp
 * remove_node(it) in a loop: the loop ends, reaches each node, and leaves none
 * that it should remove; it may reach one twice. What is wrong after
 * remove_node(n), too, is the fault of that task and not looked at here. */
#include "graph.hpp"

namespace kit {
template <typename S>
static void remove_nodes_in_a_loop(S& s, bool (*wanted)(int)) {
  const unsigned worked = s.works;
  S one_by_one(s.m);
  std::size_t left = s.m.nodes.size();
  for (std::size_t i = 0; i < left && s.works == worked;) {  // as the loop goes
    const int v = name_of(node_at(one_by_one.g, i));
    if (!wanted(v)) {
      ++i;
    } else {
      s.works &= one_by_one.try_to_remove_node(v);
      --left;
    }
  }
  if (s.works != worked && !s.m.edges.empty()) return;
  const std::size_t size = s.m.nodes.size(), limit = size * size + size + 1;
  std::vector<bool> met(size);
  auto& g = s.g;
  auto it = g.node_begin();
  constexpr bool there = must_compile || requires { it = g.remove_node(it); };
  need<there>("it = g.remove_node(it)");
  if constexpr (there) {
    for (std::size_t steps = 0; !same(it, g.node_end()); ++steps) {
      CHECK(steps < limit, "the loop ends");
      const int v = name_of(*it);
      if (v >= 0) met[std::size_t(v)] = true;
      if (!wanted(v)) {
        ++it;
        continue;
      }
      CHECK(s.m.has(v), "*it is a node of the graph");
      it = g.remove_node(it);
      s.m.remove(v);
      if (s.works & by_index) CHECK_EQUAL(g.num_nodes(), s.m.nodes.size());
    }
    for (int v : s.m.nodes)
      CHECK(met[std::size_t(v)], words("the loop reaches ", name(v)));
    s.hold(s.works);
  }
}
}  // namespace kit

static bool chosen_nodes[20];

TASK("7.1.remove_node_iterator", the_loop_leaves_no_node) {
  const auto loop = [](const Model& shape, const char* which,
                       bool (*wanted)(int)) {
    TestSubject s(shape);
    DID(description(shape), "; a loop that removes ", which);
    remove_nodes_in_a_loop(s, wanted);
  };
  const Model shapes[] = {nodes(20), nodes(5), nodes(1),   ring(20),
                          ring(5),   grid(5),  complete(6)};
  for (const Model& shape : shapes) {
    loop(shape, "n0 and n19", [](int v) { return v == 0 || v == 19; });
    loop(shape, "every third", [](int v) { return v % 3 == 0; });
    loop(shape, "every second", [](int v) { return v % 2 == 0; });
    loop(shape, "two of three", [](int v) { return v % 3 != 1; });
    loop(shape, "n4", [](int v) { return v == 4; });
    loop(shape, "n3 and those behind it", [](int v) { return v >= 3; });
    loop(shape, "none", [](int) { return false; });
    loop(shape, "all", [](int) { return true; });
  }
}

TASK("7.1.remove_node_iterator", no_chosen_node_is_left) {
  Dice dice = drawn_dice(71);
  for (bool& one : chosen_nodes) one = dice(2) == 0;
  TestSubject s(nodes(20));
  s.works &= by_index | node_values | node_loop;
  s.tells = true;
  DID("20 nodes; a loop that removes some, by dice");
  remove_nodes_in_a_loop(s, [](int v) { return v >= 0 && chosen_nodes[v]; });
}
