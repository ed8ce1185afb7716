/** @file 5.2.skip_corners.cpp
 * Steps without a constraint, from rest, by a force that pulls at every node.
 * A program of a later section may have no such step: then its pin holds the
 * corners. */
#include "cloth.hpp"

namespace kit {

template <typename G, typename F>
static void step_with_corners(G& g, double t, double dt, F& force) {
  if constexpr (steps_freely<G>()) {
    ::symp_euler_step(g, t, dt, force);
  } else {
    Pins<KIT_CONSTRAINT(PinConstraint)> pins(g);
    TestConstraint pin(
        [&pins](Cloth& cloth, double time) { pins(cloth, time); });
    ::symp_euler_step(g, t, dt, force, pin);
  }
}

}  // namespace kit

TASK("5.2.skip_corners", step_skips_corners) {
  Bodies b;
  b.add(Point(0, 1, 0), 0.5);
  b.add(Point(0, 0, 0), 0.5);
  b.add(Point(1, 0, 0), 2);
  b.add(Point(1, 1, 0), 2);
  b.add(Point(0.5, 0, 0), 1);
  b.join(0, 1, 100, 1);
  b.join(2, 3, 100, 1);
  b.join(1, 4, 100, 0.5);
  Cloth g;
  fill(g, b);
  const auto law = [](ClothNode, double) { return Point(1, -2, -4); };
  TestForce force(law);
  for (int step = 0; step < 5; ++step) {
    DID("five nodes at rest, two of them corners, a force of (1, -2, -4) N on "
        "each, step ",
        step + 1);
    step_with_corners(g, step * 0.125, 0.125, force);
    const Point first_corner = place(g, 1), second_corner = place(g, 2);
    CHECK_NEAR(first_corner, b.x[1], 0);
    CHECK_NEAR(second_corner, b.x[2], 0);
  }
  for (int i : {0, 3, 4})
    CHECK(norm(place(g, i) - b.x[i]) > 0.01,
          words("the node that starts at ", b.x[i], " to move"));
}
