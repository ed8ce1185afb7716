/** @file 7.1.remove_edge.cpp
 * A history of edges at random. */
#include "asked.hpp"

ASKED("7.1.remove_edge", remove_edge_asked) {
  TestSubject s(wheel(7));
  for (int step = 0; step < 40; ++step) {
    if (s.m.edges.empty() || drawn_below(2) == 0) {
      const int v = drawn_below(7), w = drawn_below(7);
      if (v != w && !s.m.has(Ends(v, w))) s.add_edge(v, w);
    } else {
      const int k = drawn_below(int(s.m.edges.size()));
      const Ends e = s.m.edges[std::size_t(k)];
      if (step % 2)
        s.remove_edge(e.b, e.a);
      else
        s.remove_edge(s.edge(e.a, e.b));
    }
    tell(s.view, s.works | by_index);
  }
}
