/** @file 3.1.position.cpp
 * Nodes that are moved at random. */
#include "asked.hpp"

namespace kit {
template <typename S>
static void ask_for_positions(S& s) {
  Point places[6];
  for (Point& p : places) p = drawn_point();
  for (int v : {3, 0, 5, 1, 4, 2}) {
    auto n = node_at(s.g, std::size_t(v)), copy = n;
    if constexpr (requires { n.position() += Point(); }) {
      n.position() = places[v];
      n.position() += places[5 - v];
      answer("by a copy", position_of(copy));
    }
  }
  for (int v = 0; v < 6; ++v)
    answer("by node(i)", position_of(node_at(s.g, std::size_t(v))));
}
}  // namespace kit

ASKED("3.1.position", position_asked) {
  TestSubject s(ring(6));
  ask_for_positions(s);
}
