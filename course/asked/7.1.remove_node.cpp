/** @file 7.1.remove_node.cpp
 * A history at random. */
#include "asked.hpp"

ASKED("7.1.remove_node", remove_node_asked) {
  TestSubject s(grid(4));
  for (int step = 0; step < 40; ++step) {
    const auto any_node = [&s] {
      return s.m.nodes[std::size_t(drawn_below(int(s.m.nodes.size())))];
    };
    if (s.m.nodes.size() < 6 || drawn_below(3) == 0) {
      s.add_node(100 + step);
      for (int edge = 0; edge < 3; ++edge)
        if (const int w = any_node();
            w != 100 + step && !s.m.has(Ends(100 + step, w)))
          s.add_edge(100 + step, w);
    } else {
      s.remove_node(any_node());
    }
    tell(s.view, s.works | by_index);
  }
}
