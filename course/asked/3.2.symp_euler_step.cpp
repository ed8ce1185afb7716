/** @file 3.2.symp_euler_step.cpp
 * Steps of bodies at random, by a force that pulls each to the next one. */
#include "bodies.hpp"

ASKED("3.2.symp_euler_step", step_asked) {
  const Bodies b = drawn_bodies(5, 100);
  Cloth g;
  fill(g, b);
  const Point wind = drawn_point(3);
  const auto law = [&](ClothNode n, double time) {
    return 3 * place(g, (int(n.index()) + 1) % b.size) + time * wind;
  };
  TestForce force(law);
  double t = drawn(0, 1);
  for (int step = 0; step < 3; ++step) {
    t = free_step(g, t, drawn(0.01, 0.2), force);
    answer("time", t);
    answer_nodes(g, b.size);
  }
}
