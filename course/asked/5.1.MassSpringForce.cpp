/** @file 5.1.MassSpringForce.cpp
 * The springs of bodies at random: with one K, by which forces are divided, and
 * each with its own. */
#include "bodies.hpp"

namespace kit {
static void ask_for_springs(const Bodies& b, double K, const char* what) {
  Cloth g;
  fill(g, b);
  with<KIT_FORCE(MassSpringForce)>("MassSpringForce", [&]<typename F>() {
    const Owned<F> springs(made_force<F>("MassSpringForce", g, 100.));
    for (int i = 0; i < b.size; ++i)
      answer(what, 1 / K * force_on(*springs, g, i));
  });
}
}  // namespace kit

ASKED("5.1.MassSpringForce", springs_asked) {
  const double K = spring_constant(60);
  Bodies b = drawn_bodies(6, K);
  ask_for_springs(b, K, "force");
  for (int k = 0; k < b.num_springs; ++k) b.springs[k].K = drawn(20, 200);
  if (has_K) ask_for_springs(b, 1, "force of each K~");
}
