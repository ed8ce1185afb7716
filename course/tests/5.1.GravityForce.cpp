/** @file 5.1.GravityForce.cpp
 * The weight of nodes of different masses, which move and have springs. */
#include "cloth.hpp"

TASK("5.1.GravityForce", gravity_is_the_weight) {
  Bodies b;
  b.add(Point(0.5, 0.25, 0.5), 1);
  b.add(Point(1, 0, 0), 0.125, Point(3, 2, 1));  // no exception for corners
  b.add(Point(-1, 0.5, 8), 6, Point(0, 0, -5));
  b.join(0, 1, given_K, 0.5);
  b.join(1, 2, given_K, 0.5);
  b.vary();
  Cloth g;
  fill(g, b);
  with<KIT_FORCE(GravityForce)>("GravityForce", [&]<typename F>() {
    const Owned<F> gravity(made_force<F>("GravityForce", g, 9.81));
    for (int i = 0; i < b.size; ++i) {
      DID("a node of mass ", b.m[i], " kg at ", b.x[i], " with velocity ",
          b.v[i]);
      const Point force = answer("force", force_on(*gravity, g, i));
      CHECK_NEAR(force, Point(0, 0, -b.m[i] * 9.81), 1e-9);
    }
    if constexpr (requires { F(1.5).gravity; }) {  // as in the guided starter
      DID("GravityForce(1.5) on a node of mass ", b.m[0], " kg");
      F other(1.5);
      const Point force = force_on(other, g, 0);
      CHECK_NEAR(force, Point(0, 0, -b.m[0] * 1.5), 1e-9);
    }
  });
}
