/** @file 5.1.DampingForce.cpp
 * The drag on bodies at random, divided by its coefficient. */
#include "bodies.hpp"

namespace kit {
template <typename F>
static void ask_for_drag() {
  Bodies b = drawn_bodies(6, 100);
  b.v[0] = Point(1, 0, 0);
  Cloth g;
  fill(g, b);
  double c = 0;
  const Owned<F> damping(damping_from<F>(g, 0.75, c));
  if (c == 0) c = -force_on(*damping, g, 0).x;
  for (int i = 0; i < b.size; ++i)
    answer("force", 1 / c * force_on(*damping, g, i));
}
}  // namespace kit

ASKED("5.1.DampingForce", damping_asked) {
  with<KIT_FORCE(DampingForce)>("DampingForce",
                                []<typename F>() { ask_for_drag<F>(); });
}
