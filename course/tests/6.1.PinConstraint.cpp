/** @file 6.1.PinConstraint.cpp
 * Corners that a step has moved, and other nodes, also ones that come to where
 * a corner was. Which velocity a pin leaves to the nodes it holds is open: it
 * puts them back after each move. */
#include "cloth.hpp"

namespace kit {

static Bodies cloth_with_corners() {
  Bodies b;
  b.add(Point(0.5, 0.25, 0));
  b.add(Point(1, 0, 0), 0.5);
  b.add(Point(0, 1, 0), 0.25);
  b.add(Point(0, 0, 0), 2);
  b.add(Point(1, 1, 0), 4);
  b.add(Point(0.5, 0, 0));
  b.add(Point(0.04, 0, 0));  // neighbors of the corners
  b.add(Point(1, 0.04, 0));
  b.join(0, 1, given_K, 0.5);
  b.join(3, 2, given_K, 1);
  b.join(0, 4, given_K, 1);
  return b;
}

template <typename Pin>
static void check_pins(const char* which, Bodies b) {
  const Point v = drawn_near(Point(1, 2, -4));
  Cloth g;
  fill(g, b);
  Pins<Pin> pin(g);
  constrain(pin, g);  // nothing to do; some look for the corners now
  for (int time = 1; time <= 3; ++time) {
    const double far = time == 2 ? 1. / 1024 : 1;  // as in a step, or farther
    const Point moved = far * drawn_near(Point(0.125, 0.25, -0.5), 0.1);
    DID(which, " whose nodes have all moved by ", moved, ", time ", time);
    for (int i = 0; i < b.size; ++i) {
      auto n = node_of(g, i);
      n.position() = b.x[i] + moved;
      velocity(n) = v;
    }
    constrain(pin, g, time);
    for (int i = 0; i < b.size; ++i) {
      answer("position", place(g, i));
      if (!Bodies::is_corner(b.x[i])) answer("velocity", velocity(g, i));
    }
    const Point corner_0 = place(g, b.at(Point(0, 0, 0)));
    const Point corner_1 = place(g, b.at(Point(1, 0, 0)));
    CHECK_NEAR(corner_0, Point(0, 0, 0), 1e-12);
    CHECK_NEAR(corner_1, Point(1, 0, 0), 1e-12);
    for (int i = 0; i < b.size; ++i) {
      if (Bodies::is_corner(b.x[i])) continue;
      const Point other_node = place(g, i), other_velocity = velocity(g, i);
      CHECK_NEAR(other_node, b.x[i] + moved, 0);
      CHECK_NEAR(other_velocity, v, 0);
    }
  }
}

}  // namespace kit

TASK("6.1.PinConstraint", pin_puts_corners_back) {
  with<KIT_CONSTRAINT(PinConstraint)>("PinConstraint", []<typename Pin>() {
    Bodies b = cloth_with_corners();
    check_pins<Pin>("a cloth", b);
    double rank[Bodies::most];
    for (int i = 0; i < b.size; ++i) rank[i] = drawn(-i, 0, 1);
    b.reorder(rank);
    check_pins<Pin>("a second cloth, with a pin of its own,", b);
  });
}
