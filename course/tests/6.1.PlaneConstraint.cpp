/** @file 6.1.PlaneConstraint.cpp
 * Nodes above and below the plane z = -0.75 m. */
#include "cloth.hpp"

TASK("6.1.PlaneConstraint", plane_is_solid) {
  Bodies b;
  for (double z : std::initializer_list<double>{
           -0.5, -0.875, 0., -0.7499, -0.7501, -3., 2., -0.75, -0.875})
    b.add(Point(0.25 * b.size, 0.5, z), 0.5, Point(1, -2, z < -2 ? 4 : -4));
  b.vary();
  for (int i = 1; i < b.size; ++i) b.join(i - 1, i, given_K, 0.5);
  Cloth g;
  fill(g, b);
  with<KIT_CONSTRAINT(PlaneConstraint)>("PlaneConstraint", [&]<typename C>() {
    auto plane = made_plane<C>();
    constrain(plane, g);
    if constexpr (requires { C(2).z; }) {  // as in the guided starter
      DID("PlaneConstraint(2) and a node at z = 1");
      Bodies low;
      low.add(Point(0, 0, 1));
      Cloth other;
      fill(other, low);
      C higher(2);
      constrain(higher, other);
      const Point position = place(other, 0);
      CHECK_NEAR(position, Point(0, 0, 2), 1e-12);
    }
  });
  answer_nodes(g, b.size);
  for (int i = 0; i < b.size; ++i) {
    const bool below = b.x[i].z < -0.75;
    DID("a node at ", b.x[i], " with velocity ", b.v[i]);
    const Point position = place(g, i), vel = velocity(g, i);
    CHECK_NEAR(position,
               Point(b.x[i].x, b.x[i].y, below ? -0.75 : double(b.x[i].z)),
               1e-12);
    CHECK_NEAR(vel, Point(b.v[i].x, b.v[i].y, below ? 0 : double(b.v[i].z)),
               1e-12);
  }
}
