/** @file 7.1.remove_edge_iterator.cpp
 * remove_edge(it) in a loop: the loop ends, reaches each edge, and leaves none
 * that it should remove; it may reach one twice. What is wrong after
 * remove_edge(a, b), too, is the fault of that task and not looked at here. */
#include "graph.hpp"

namespace kit {
template <typename S>
static void remove_edges_in_a_loop(S& s, bool (*wanted)(Ends)) {
  const unsigned worked = s.works;
  S one_by_one(s.m);
  for (Ends e : s.m.edges)
    if (wanted(e) && s.works == worked)
      s.works &= one_by_one.try_to_remove_edge(e.a, e.b);
  const std::size_t size = s.m.edges.size(), limit = 2 * size * size + size + 1;
  Model met;
  auto& g = s.g;
  auto it = g.edge_begin();
  constexpr bool there = must_compile || requires { it = g.remove_edge(it); };
  need<there>("it = g.remove_edge(it)");
  if constexpr (there) {
    for (std::size_t steps = 0; !same(it, g.edge_end()); ++steps) {
      CHECK(steps < limit, "the loop ends");
      const Ends e = ends_of(*it);
      met.add(e);
      if (!wanted(e)) {
        ++it;
        continue;
      }
      CHECK(s.m.has(e), "*it is an edge of the graph");
      it = g.remove_edge(it);
      s.m.remove(e);
      if (s.works & edge_count) CHECK_EQUAL(g.num_edges(), s.m.edges.size());
    }
    for (Ends e : s.m.edges)
      CHECK(met.has(e), words("the loop reaches ", name(e)));
    s.hold(s.works);
  }
}
}  // namespace kit

static bool chosen_edges[64];  // by the ends: 8 a + b

TASK("7.1.remove_edge_iterator", the_loop_leaves_no_edge) {
  const auto loop = [](const Model& shape, const char* which,
                       bool (*wanted)(Ends)) {
    TestSubject s(shape);
    DID(description(shape), "; a loop that removes ", which);
    remove_edges_in_a_loop(s, wanted);
  };
  Model one = nodes(2);
  one.add(Ends(0, 1));
  for (const Model& shape : {wheel(6), one, ring(5), grid(4), complete(6)}) {
    loop(shape, "n0-n1 and n4-n5",
         [](Ends e) { return e == Ends(0, 1) || e == Ends(4, 5); });
    loop(shape, "those with an even sum of their nodes' numbers",
         [](Ends e) { return (e.a + e.b) % 2 == 0; });
    loop(shape, "those with an odd sum of their nodes' numbers",
         [](Ends e) { return (e.a + e.b) % 2 == 1; });
    loop(shape, "those at n0", [](Ends e) { return e.has(0); });
    loop(shape, "those not at n0", [](Ends e) { return !e.has(0); });
    loop(shape, "those at n4", [](Ends e) { return e.has(4); });
    loop(shape, "none", [](Ends) { return false; });
    loop(shape, "all", [](Ends) { return true; });
  }
}

TASK("7.1.remove_edge_iterator", no_chosen_edge_is_left) {
  Dice dice = drawn_dice(71);
  for (bool& one : chosen_edges) one = dice(2) == 0;
  TestSubject s(wheel(8));
  s.tells = true;
  DID("a wheel of 8 nodes; a loop that removes some, by dice");
  remove_edges_in_a_loop(
      s, [](Ends e) { return e.a >= 0 && chosen_edges[8 * e.a + e.b]; });
}
