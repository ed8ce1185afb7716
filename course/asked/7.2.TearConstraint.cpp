/** @file 7.2.TearConstraint.cpp
 * Which of some nodes at random are left. */
#include "bodies.hpp"

namespace kit {
template <typename T>
static void ask_what_is_left(const Bodies& b) {
  Cloth g;
  fill(g, b);
  if constexpr (Present<T>) {
    auto tear = made_sphere<T>();
    constrain(tear, g);
  }
  int at[Bodies::most] = {};
  for (int i = 0; i < b.size; ++i) {
    at[i] = index_of(g, b, i);
    answer("left", at[i] >= 0);
    for (int j = 0; j < i; ++j)
      if (at[i] >= 0 && at[j] >= 0)
        answer("joined", g.has_edge(node_of(g, at[i]), node_of(g, at[j])));
  }
  answer("number", double(g.num_nodes()));
}
}  // namespace kit

ASKED("7.2.TearConstraint", tear_asked) {
  Bodies b = drawn_bodies(20, 100);
  for (int i = 0; i < b.size; ++i)
    b.x[i] = Point(0.5, 0.5, -0.5) + drawn_point(0.16);
  ask_what_is_left<Tear>(b);
}
