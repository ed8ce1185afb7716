/** @file 6.1.PinConstraint.cpp
 * A cloth in any order that moved at random. */
#include "bodies.hpp"

namespace kit {
template <typename Pin>
static void ask_for_pins() {
  Bodies b = cloth_with_corners();
  double rank[Bodies::most];
  for (double& r : rank) r = drawn(0, 1);
  b.reorder(rank);
  Cloth g;
  fill(g, b);
  Pins<Pin> pin(g);
  constrain(pin, g);
  for (int i = 0; i < b.size; ++i) {
    node_of(g, i).position() = drawn_point();
    velocity(g, i) = drawn_point();
  }
  constrain(pin, g, 1);
  for (int i = 0; i < b.size; ++i) {
    answer("position", place(g, i));
    if (!Bodies::is_corner(b.x[i])) answer("velocity", velocity(g, i));
  }
}
}  // namespace kit

ASKED("6.1.PinConstraint", pins_asked) {
  with<KIT_CONSTRAINT(PinConstraint)>(
      "PinConstraint", []<typename Pin>() { ask_for_pins<Pin>(); });
}
