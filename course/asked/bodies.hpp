/** @file bodies.hpp
 * Cloths at random, for questions about forces, constraints and steps. */
#ifndef KIT_ASKED_BODIES_HPP
#define KIT_ASKED_BODIES_HPP
#include "asked.hpp"

namespace kit {

/** Some bodies, none at a corner, in a ring of springs of this K. */
inline Bodies drawn_bodies(int n, double K) {
  Bodies b;
  for (int i = 0; i < n; ++i) {
    const Point x = Point(0.5, 0.5, 0.5) + drawn_point(), v = drawn_point(4);
    b.add(x, drawn(0.1, 3), v);
  }
  for (int i = 0; i < n; ++i) b.join(i, (i + 1) % n, K, drawn(0.1, 2));
  return b;
}
/** Where the nodes are, and how fast. */
inline void answer_nodes(Cloth& g, int n) {
  for (int i = 0; i < n; ++i) {
    answer("position", place(g, i));
    answer("velocity", velocity(g, i));
  }
}

}  // namespace kit
#endif
