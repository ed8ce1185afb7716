/** @file 3.2.symp_euler_step.cpp
 * One step of symplectic Euler against its two lines, for a force that depends
 * on time and on where the other nodes are. No node is a corner. */
#include "cloth.hpp"

namespace kit {

/** Three bodies with velocities; no two masses are equal, and none is 1. */
static Bodies three_bodies() {
  Bodies b;
  b.add(Point(0.3, 0.1, 0.2), 2.0, Point(1, -2, 0.5));
  b.add(Point(0.7, 0.4, -0.1), 0.5, Point(-3, 0, 1));
  b.add(Point(0.2, 0.9, 0.6), 4.0, Point(0, 2, -1));
  b.vary();
  return b;
}

/** Take a step and hold it to x += dt v; v += dt F(x, t)/m. */
static void step_and_compare(Cloth& g, Bodies& b, double t, double dt) {
  const int n = b.size;
  const Point from = Point(1, 2, 3);
  const double K = 3;
  // Pulls at each body towards where the next one is now.
  const auto law = [&](ClothNode node, double time) {
    const int i = int(node.index());
    return K * (place(g, (i + 1) % n) - from) + Point(0, 5 * time, 0);
  };
  TestForce force(law);
  const double returned = free_step(g, t, dt, force);
  answer("time", returned);
  answer_nodes(g, n);

  for (int i = 0; i < n; ++i) b.x[i] += dt * b.v[i];
  for (int i = 0; i < n; ++i)
    b.v[i] +=
        dt / b.m[i] * (K * (b.x[(i + 1) % n] - from) + Point(0, 5 * t, 0));

  for (int i = 0; i < n; ++i) {
    const Point position = place(g, i);
    CHECK_NEAR(position, b.x[i], 1e-12);
  }
  for (int i = 0; i < n; ++i) {
    const Point vel = velocity(g, i);
    CHECK_NEAR(vel, b.v[i], 1e-12);
  }
  const double t_returned = returned;
  CHECK_NEAR(t_returned, t + dt, 1e-12);
}

}  // namespace kit

TASK("3.2.symp_euler_step", step_moves_then_kicks) {
  Cloth g;
  Bodies b = three_bodies();
  fill(g, b);
  const double t = drawn(0.5, 0, 1), dt = drawn(0.125, 0.01, 0.2);
  DID("three nodes of masses ", b.m[0], ", ", b.m[1], " and ", b.m[2],
      ", one step of dt = ", dt, " from t = ", t,
      " with a force that depends on t and on the next node's position");
  step_and_compare(g, b, t, dt);
}

TASK("3.2.symp_euler_step", step_after_step) {
  Cloth g;
  Bodies b = three_bodies();
  fill(g, b);
  double t = 0;
  const double dt = drawn(0.25, 0.01, 0.2);
  for (int step = 1; step <= 5; ++step, t += dt) {
    DID("three nodes of masses ", b.m[0], ", ", b.m[1], " and ", b.m[2],
        ", step ", step, " of dt = ", dt);
    step_and_compare(g, b, t, dt);
  }
}
