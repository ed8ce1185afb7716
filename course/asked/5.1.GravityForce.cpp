/** @file 5.1.GravityForce.cpp
 * The weights of bodies at random. */
#include "bodies.hpp"

ASKED("5.1.GravityForce", gravity_asked) {
  const Bodies b = drawn_bodies(6, 100);
  Cloth g;
  fill(g, b);
  with<KIT_FORCE(GravityForce)>("GravityForce", [&]<typename F>() {
    const Owned<F> gravity(made_force<F>("GravityForce", g, 9.81));
    for (int i = 0; i < b.size; ++i) answer("force", force_on(*gravity, g, i));
  });
}
