/** @file 6.2.symp_euler_step.cpp
 * A step with a constraint, at random. */
#include "bodies.hpp"

ASKED("6.2.symp_euler_step", constrained_step_asked) {
  const Bodies b = drawn_bodies(5, 100);
  Cloth g;
  fill(g, b);
  const Point lift = drawn_point();
  const auto change = [&](Cloth& cloth, double) {
    for (int i = 0; i < b.size; ++i) {
      auto n = node_of(cloth, i);
      answer("seen", n.position());
      n.position() += lift;
      velocity(n) = 2 * velocity(n);
    }
  };
  TestConstraint constraint(change);
  const auto pull = [&](ClothNode n, double time) {
    return 3 * place(g, (int(n.index()) + 1) % b.size) + time * lift;
  };
  TestForce force(pull);
  step_with(g, drawn(0, 1), drawn(0.01, 0.3), force, constraint);
  answer_nodes(g, b.size);
}
