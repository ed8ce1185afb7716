/** @file 7.2.grid1.cpp
 * A few nodes that start at random speeds, in each stage. */
#include "asked.hpp"

namespace kit {
template <int stage>
static void ask_for_stage(const char* name) {
  Sheet s;
  s.add(9, 9, -0.3, 6, 6, stage > net);
  for (Point& v : s.v) v = drawn_point(2);
  for (int corner : {0, 24}) s.add(corner, 0, 0, 1, 1, false);
  Point sum;
  if (difference<stage>(s, 60, &sum).empty())
    answer(words("stage ", name, "?"), sum, 1e-6);
}
}  // namespace kit

ASKED("7.2.grid1", stages_asked) {
  ask_for_stage<net>("problem1");
  ask_for_stage<diagonal>("diagonals");
  ask_for_stage<summed>("forces");
  ask_for_stage<constrained>("constraints");
  ask_for_stage<torn>("tear");
}
