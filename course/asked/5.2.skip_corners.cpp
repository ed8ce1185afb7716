/** @file 5.2.skip_corners.cpp
 * Where a force at random pulls the nodes that are no corners. */
#include "bodies.hpp"

ASKED("5.2.skip_corners", corners_asked) {
  Bodies b;
  for (const Point& p : {Point(0, 1, 0), Point(0, 0, 0), Point(1, 0, 0),
                         Point(1, 1, 0), Point(0.5, 0, 0)})
    b.add(p, drawn(0.5, 2));
  b.join(0, 1, 100, 1);
  b.join(2, 3, 100, 1);
  Cloth g;
  fill(g, b);
  static Point pull;
  pull = drawn_point(4);
  const auto law = [](ClothNode, double) { return pull; };
  TestForce force(law);
  step_with_corners(g, force, [](int) {});
  for (int i = 0; i < b.size; ++i) {
    const Point moved = place(g, i) - b.x[i];
    answer("direction", i == 1 || i == 2 ? moved : 1 / norm(moved) * moved,
           1e-6);
  }
}
