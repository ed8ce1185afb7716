/** @file 5.2.skip_corners.cpp
 * Steps without a constraint, from rest, by a force that pulls at every node.
 * A program of a later section may have no such step: then its pin holds the
 * corners or, without a pin, the step with a constraint that does nothing. */
#include "cloth.hpp"

namespace kit {

/** Take five steps, and look at the cloth after each. */
template <typename G, typename F, typename Look>
static void step_with_corners(G& g, F& force, Look look) {
  const double dt = 0.125;
  if constexpr (steps_freely<G>() || !Complete<KIT_CONSTRAINT(PinConstraint)>) {
    for (int step = 1; step <= 5; ++step) {
      free_step(g, step * dt, dt, force);
      look(step);
    }
  } else {
    with<KIT_CONSTRAINT(PinConstraint)>("PinConstraint", [&]<typename Pin>() {
      Pins<Pin> pins(g);
      const auto law = [&](Cloth& cloth, double time) { pins(cloth, time); };
      TestConstraint pin(law);
      for (int step = 1; step <= 5; ++step) {
        ::symp_euler_step(g, step * dt, dt, force, pin);
        look(step);
      }
    });
  }
}

}  // namespace kit

TASK("5.2.skip_corners", step_skips_corners) {
  Bodies b;
  const Point f = drawn_near(Point(1, -2, -4), 0.5);
  b.add(Point(0, 1, 0), 0.5);
  b.add(Point(0, 0, 0), 0.5);
  b.add(Point(1, 0, 0), 2);
  b.add(Point(1, 1, 0), 2);
  b.add(Point(0.5, 0, 0), 1);
  b.add(Point(0.04, 0, 0), 1);  // a neighbor of the corner
  b.join(0, 1, given_K, 1);
  b.join(2, 3, given_K, 1);
  b.join(1, 4, given_K, 0.5);
  Cloth g;
  fill(g, b);
  const auto law = [&f](ClothNode, double) { return f; };
  TestForce force(law);
  step_with_corners(g, force, [&](int steps) {
    DID("six nodes at rest, two of them corners, a force of ", f, " N on ",
        "each, steps: ", steps);
    const Point first(0, 0, 0), second(1, 0, 0);
    const Point first_corner = place(g, b.at(first));
    const Point second_corner = place(g, b.at(second));
    CHECK_NEAR(first_corner, first, 0);
    CHECK_NEAR(second_corner, second, 0);
  });
  for (int i = 0; i < b.size; ++i) {
    const Point moved = place(g, i) - b.x[i];
    const bool held = Bodies::is_corner(b.x[i]);
    answer("direction", held ? moved : 1 / norm(moved) * moved, 1e-6);
    CHECK(held || norm(moved) > 0.01,
          words("the node that starts at ", b.x[i], " to move"));
  }
}
