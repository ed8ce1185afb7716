/** @file 7.1.remove_edge.cpp
 * remove_edge(a, b) and remove_edge(e): one edge goes, all else stays. */
#include "graph.hpp"

namespace kit {
/** Remove each edge of a wheel, each from a wheel of its own, by @a remove. */
template <typename S, typename F>
static void check_remove_edge(const char* call, F remove) {
  for (Ends e : wheel(5).edges) {
    S s(wheel(5));
    const auto did = words("a wheel of 5 nodes; ", call, " of ", name(e));
    DID(did);
    check_result(remove(s, e), 1);
    s.hold();
    DID(did, "; then remove_edge(", name(e.b), ", ", name(e.a),
        "), which is not there any more");
    check_result(s.remove_edge(e.b, e.a), 0);
    s.hold();
    DID(did, "; then added it again");
    s.add_edge(e.b, e.a);
    s.hold();
  }
}
}  // namespace kit

TASK("7.1.remove_edge", an_edge_is_removed_by_its_ends) {
  check_remove_edge<TestSubject>("remove_edge(a, b)", [](auto& s, Ends e) {
    return s.remove_edge(e.a, e.b);
  });
  check_remove_edge<TestSubject>("remove_edge(b, a)", [](auto& s, Ends e) {
    return s.remove_edge(e.b, e.a);
  });
}

TASK("7.1.remove_edge", an_edge_is_removed_by_its_handle) {
  check_remove_edge<TestSubject>("remove_edge(edge(i))", [](auto& s, Ends e) {
    return s.remove_edge(s.edge(e.a, e.b));
  });
  check_remove_edge<TestSubject>(
      "remove_edge(e), e seen from the first end,", [](auto& s, Ends e) {
        return s.remove_edge(s.edge_seen_from(e.a, e.b));
      });
  check_remove_edge<TestSubject>(
      "remove_edge(e), e seen from the second end,", [](auto& s, Ends e) {
        return s.remove_edge(s.edge_seen_from(e.b, e.a));
      });
}

TASK("7.1.remove_edge", an_edge_that_is_not_there_is_not_removed) {
  TestSubject s(ring(6));
  DID("a ring of 6 nodes; remove_edge(n0, n3), which is not there");
  check_result(s.remove_edge(0, 3), 0);
  s.hold();
}

namespace kit {
template <typename S>
static void check_dead_edge(S& s) {
  auto e = s.edge(0, 1);
  s.remove_edge(e);
  // Another graph may assert that the edge is alive, and is as right.
  if (!probes(dead_edges)) return;
  DID("two nodes, the edge e between them; remove_edge(e) twice");
  check_result(kit::remove_edge(s.g, e), 0);
  probes(0);
  s.hold();
}
}  // namespace kit

TASK("7.1.remove_edge", a_removed_edge_is_not_removed_again) {
  Model pair = nodes(2);
  pair.add(Ends(0, 1));
  TestSubject s(pair);
  check_dead_edge(s);
}

TASK("7.1.remove_edge", all_edges_are_removed) {
  TestSubject s(complete(6));
  Dice dice{71};
  while (!s.m.edges.empty()) {
    Ends e = s.m.edges[dice(s.m.edges.size())];
    DID("6 nodes, all joined; removed edges down to ", s.m.edges.size() - 1,
        ", the last by remove_edge(", name(e.a), ", ", name(e.b), ")");
    check_result(s.remove_edge(e.a, e.b), 1);
    s.hold();
  }
}

TASK("7.1.remove_edge", edges_come_and_go) {
  TestSubject s(ring(8));
  s.tells = true;
  Dice dice = drawn_dice(7);
  for (int step = 0; step < 200; ++step) {
    const auto after = words("step ", step, " of a random history: ");
    if (s.m.edges.empty() || dice(2) == 0) {
      int v = dice(8), w = dice(8);
      if (v == w || s.m.has(Ends(v, w))) continue;
      DID(after, "add_edge(", name(v), ", ", name(w), ")");
      s.add_edge(v, w);
    } else {
      Ends e = s.m.edges[dice(s.m.edges.size())];
      DID(after, "removed ", name(e));
      check_result(
          step % 2 ? s.remove_edge(e.b, e.a) : s.remove_edge(s.edge(e.a, e.b)),
          1);
    }
    s.hold();
  }
}
