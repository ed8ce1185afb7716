/** @file 6.1.SphereConstraint.cpp
 * Nodes inside and outside the ball of center (0.5, 0.5, -0.5) m and radius
 * 0.15 m. */
#include "cloth.hpp"

TASK("6.1.SphereConstraint", sphere_is_solid) {
  const Point c(0.5, 0.5, -0.5);
  const double r = 0.15;
  // From the center in units of r: direction (of length 1), and how far.
  struct Place {
    Point direction;
    double how_far;
  };
  Bodies b;
  Place places[Bodies::most];
  for (const Point& d :
       {Point(0, 0, 1), Point(1. / 3, -2. / 3, 2. / 3), Point(0, -0.6, -0.8)})
    for (double usual : {0.5, 1.0001, 0.9999, 3., 0.125}) {
      const double radii = drawn(usual, 0.1, 2);
      places[b.size] = {d, radii};
      b.add(c + radii * r * d, 0.5, drawn_near(Point(1, -2, -4)));
    }
  for (int i = 1; i < b.size; ++i) b.join(i - 1, i, given_K, 0.1);
  Cloth g;
  fill(g, b);
  with<KIT_CONSTRAINT(SphereConstraint)>("SphereConstraint", [&]<typename C>() {
    auto sphere = made_sphere<C>();
    constrain(sphere, g);
    with_ball<C>([](auto& ball, Cloth& other) {
      constrain(ball, other);
      const Point outside = place(other, 0), inside = place(other, 1);
      CHECK_NEAR(outside, Point(0.5, 0.5, -0.5), 0);
      CHECK_NEAR(inside, Point(3, 2, 2), 1e-12);
    });
  });
  answer_nodes(g, b.size);
  for (int i = 0; i < b.size; ++i) {
    DID("a node at ", places[i].how_far, " radii from the center, in the ",
        "direction ", places[i].direction, ", with velocity ", b.v[i]);
    const Point position = place(g, i), vel = velocity(g, i);
    if (places[i].how_far > 1) {
      CHECK_NEAR(position, b.x[i], 1e-12);
      CHECK_NEAR(vel, b.v[i], 1e-12);
      continue;
    }
    const Point R = places[i].direction;
    CHECK_NEAR(position, c + r * R, 1e-9);
    const double v_R = b.v[i].x * R.x + b.v[i].y * R.y + b.v[i].z * R.z;
    CHECK_NEAR(vel, b.v[i] - v_R * R, 1e-9);
  }
}
