/** @file 6.2.symp_euler_step.cpp
 * One step with a constraint that moves nodes and changes velocities: what it
 * is given, how often, and what the force sees after it. The step may still
 * skip the corners, as that of 5.2 does: the assignment does not say. */
#include "cloth.hpp"

namespace kit {

template <typename G, typename F, typename C>
static double step_with(G& g, double t, double dt, F& force, C& constraint) {
  if constexpr (must_compile ||
                requires { ::symp_euler_step(g, t, dt, force, constraint); })
    return ::symp_euler_step(g, t, dt, force, constraint);
  else
    fail("symp_euler_step(g, t, dt, force, constraint) to compile", "an error");
}

}  // namespace kit

TASK("6.2.symp_euler_step", constrained_step) {
  Bodies b;
  b.add(Point(0, 0, 0), 2, Point(1, -2, 0.5));
  b.add(Point(0.5, 0.5, 0.25), 0.5, Point(-3, 0, 1));
  b.add(Point(1, 0, 0), 4, Point(0, 2, -1));
  b.add(Point(0, 0, -4), 1, Point(4, 0, 0));  // is put at (1, 0, 0)
  b.vary();                                   // then none is at a corner
  const double t = 0.5, dt = drawn(0.25, 0.01, 0.3), K = 3;
  const int size = b.size;
  Cloth g;
  fill(g, b);

  int calls = 0;
  Point x_seen[4], v_seen[4];
  const auto change = [&](Cloth& cloth, double) {
    ++calls;
    for (int i = 0; i < size; ++i) {
      auto n = node_of(cloth, i);
      x_seen[i] = n.position();
      v_seen[i] = velocity(n);
      n.position() += Point(0, 0, i + 1);
      velocity(n) = 2 * velocity(n);
    }
  };
  TestConstraint constraint(change);
  // Pulls at each body towards where the next one is now, and more with time.
  const auto pull = [&](ClothNode n, double time) {
    return K * place(g, (int(n.index()) + 1) % size) + Point(0, 5 * time, 0);
  };
  TestForce force(pull);
  DID("four nodes, two of them corners, all moving; a constraint that adds to ",
      "z, so one more comes to a corner, and doubles velocities; one step of ",
      "dt = ", dt, " from t = ", t);
  const double t_returned = step_with(g, t, dt, force, constraint);
  answer("time", t_returned);

  for (const Point& x : x_seen) answer("seen", x);
  answer_nodes(g, size);
  const int calls_of_the_constraint = calls;
  CHECK_EQUAL(calls_of_the_constraint, 1);
  // Is it a node at a corner that stayed there?
  const auto is_skipped = [&](int i, const Point& x) {
    return (i == 0 || i == 2) && near(x, b.x[i], 1e-12);
  };
  Point moved[4];
  for (int i = 0; i < size; ++i) {
    const Point position_when_constrained = x_seen[i];
    const Point velocity_when_constrained = v_seen[i];
    moved[i] = is_skipped(i, x_seen[i]) ? b.x[i] : b.x[i] + dt * b.v[i];
    CHECK_NEAR(position_when_constrained, moved[i], 1e-12);
    CHECK_NEAR(velocity_when_constrained, b.v[i], 1e-12);
  }
  for (int i = 0; i < size; ++i) {
    b.x[i] = moved[i] + Point(0, 0, i + 1);
    b.v[i] = 2 * b.v[i];
  }
  for (int i = 0; i < size; ++i) {
    const bool is_corner = b.x[i] == Point(0, 0, 0) || b.x[i] == Point(1, 0, 0);
    if (!is_corner || !near(velocity(g, i), b.v[i], 1e-12))
      b.v[i] += dt / b.m[i] * (K * b.x[(i + 1) % size] + Point(0, 5 * t, 0));
    const Point position_at_last = place(g, i);
    CHECK_NEAR(position_at_last, b.x[i], 1e-12);
  }
  for (int i = 0; i < size; ++i) {
    const Point velocity_at_last = velocity(g, i);
    CHECK_NEAR(velocity_at_last, b.v[i], 1e-12);
  }
  CHECK_NEAR(t_returned, t + dt, 1e-12);
}
