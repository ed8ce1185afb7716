/** @file 3.2.Problem1Force.cpp
 * The forces on bodies at random, without their weight, per K. */
#include "bodies.hpp"

namespace kit {
template <typename P>
static void ask_for_force() {
  const int way = way_to_make<P>();
  const double K = K_of_way(way);
  Bodies b = drawn_bodies(6, K);
  const double L = rest_length();
  for (int k = 0; k < b.num_springs; ++k) b.springs[k].L = L;
  b.join(b.add(Point(0, 0, 0)), 2, K, L);
  for (int i = 0; i < b.size; ++i) {
    const Point force = problem1<P>(b, i, way);
    const Point f = i == 6 ? force : force - weight(b, i);
    answer("force", 1 / K * f);
  }
}
}  // namespace kit

ASKED("3.2.Problem1Force", problem1_asked) {
  with<KIT_FORCE(Problem1Force)>("Problem1Force",
                                 []<typename P>() { ask_for_force<P>(); });
}
