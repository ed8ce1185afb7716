/** @file 7.1.remove_edge_iterator.cpp
 * Loops that remove edges chosen at random. */
#include "asked.hpp"

namespace kit {
template <typename S>
static void ask_after_a_loop_over_edges(S& s) {
  std::vector<Ends> wanted;
  for (Ends e : s.m.edges)
    if (drawn_below(2) == 0) wanted.push_back(e);
  S one_by_one(s.m);
  for (Ends e : wanted) s.works &= one_by_one.try_to_remove_edge(e.a, e.b);
  auto it = s.g.edge_begin();
  if constexpr (requires { it = s.g.remove_edge(it); })
    for (int steps = 0; steps < 1000 && !same(it, s.g.edge_end()); ++steps)
      if (std::find(wanted.begin(), wanted.end(), ends_of(*it)) != wanted.end())
        it = s.g.remove_edge(it);
      else
        ++it;
  tell(s.view, s.works);
}
}  // namespace kit

ASKED("7.1.remove_edge_iterator", remove_edge_iterator_asked) {
  for (int loop = 0; loop < 4; ++loop) {
    TestSubject s(wheel(8));
    ask_after_a_loop_over_edges(s);
  }
}
