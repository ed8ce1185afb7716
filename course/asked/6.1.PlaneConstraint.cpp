/** @file 6.1.PlaneConstraint.cpp
 * Nodes at random, above and below the plane. */
#include "bodies.hpp"

ASKED("6.1.PlaneConstraint", plane_asked) {
  Bodies b = drawn_bodies(20, 100);
  for (int i = 0; i < b.size; ++i) b.x[i].z = drawn(-2, 0.5);
  Cloth g;
  fill(g, b);
  with<KIT_CONSTRAINT(PlaneConstraint)>("PlaneConstraint", [&]<typename C>() {
    auto plane = made_plane<C>();
    constrain(plane, g);
  });
  answer_nodes(g, b.size);
}
