/** @file 7.1.remove_node_iterator.cpp
 * Loops that remove nodes chosen at random. */
#include "asked.hpp"

namespace kit {
template <typename S>
static void ask_after_a_loop(S& s) {
  std::vector<bool> wanted;
  for (std::size_t v = 0; v < s.m.nodes.size(); ++v)
    wanted.push_back(drawn_below(2) == 0);
  S one_by_one(s.m);
  for (int v : s.m.nodes)
    if (wanted[std::size_t(v)]) s.works &= one_by_one.try_to_remove_node(v);
  auto it = s.g.node_begin();
  if constexpr (requires { it = s.g.remove_node(it); })
    for (int steps = 0; steps < 1000 && !same(it, s.g.node_end()); ++steps) {
      const auto v = std::size_t(name_of(*it));
      if (v < wanted.size() && wanted[v])
        it = s.g.remove_node(it);
      else
        ++it;
    }
  tell(s.view, s.works & (by_index | node_values | node_loop));
}
}  // namespace kit

ASKED("7.1.remove_node_iterator", remove_node_iterator_asked) {
  for (int loop = 0; loop < 4; ++loop) {
    TestSubject s(nodes(20));
    ask_after_a_loop(s);
  }
}
