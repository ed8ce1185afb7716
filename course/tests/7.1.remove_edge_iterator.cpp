/** @file 7.1.remove_edge_iterator.cpp
 * remove_edge(it) in a loop: the loop ends and leaves none that it should
 * remove, whether it visits an edge once or more often. */
#include "graph.hpp"

namespace kit {
template <typename S>
static void remove_edges_in_a_loop(S& s, bool (*wanted)(Ends)) {
  const std::size_t size = s.m.edges.size(), limit = 2 * size * size + size + 1;
  auto it = s.g.edge_begin();
  constexpr bool there = requires { it = s.g.remove_edge(it); };
  need<there>("it = g.remove_edge(it)");
  if constexpr (there) {
    for (std::size_t steps = 0; !same(it, s.g.edge_end()); ++steps) {
      CHECK(steps < limit, "the loop ends");
      const Ends e = ends_of(*it);
      if (!wanted(e)) {
        ++it;
        continue;
      }
      CHECK(s.m.has(e), "*it is an edge of the graph");
      it = s.g.remove_edge(it);
      s.m.remove(e);
      if (s.works & edge_count) CHECK_EQUAL(s.g.num_edges(), s.m.edges.size());
    }
    for (Ends e : s.m.edges)
      CHECK(!wanted(e), words("the loop removes ", name(e)));
    s.hold();
  }
}
}  // namespace kit

TASK("7.1.remove_edge_iterator", the_loop_leaves_no_edge) {
  const auto loop = [](const Model& shape, const char* which,
                       bool (*wanted)(Ends)) {
    TestSubject s(shape);
    DID(description(shape), "; a loop that removes ", which);
    remove_edges_in_a_loop(s, wanted);
  };
  Model one = nodes(2);
  one.add(Ends(0, 1));
  for (const Model& shape : {one, ring(5), wheel(6), grid(4), complete(6)}) {
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
