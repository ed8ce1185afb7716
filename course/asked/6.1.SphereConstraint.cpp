/** @file 6.1.SphereConstraint.cpp
 * Nodes at random, inside and outside the ball. */
#include "bodies.hpp"

ASKED("6.1.SphereConstraint", sphere_asked) {
  Bodies b = drawn_bodies(20, 100);
  for (int i = 0; i < b.size; ++i)  // half of them surely inside
    b.x[i] = Point(0.5, 0.5, -0.5) + drawn_point(i % 2 ? 0.08 : 0.2);
  Cloth g;
  fill(g, b);
  with<KIT_CONSTRAINT(SphereConstraint)>("SphereConstraint", [&]<typename C>() {
    auto sphere = made_sphere<C>();
    constrain(sphere, g);
  });
  answer_nodes(g, b.size);
}
