/** @file 4.2.Problem1Force.cpp
 * How forces change with L, at random: along the spring, and by how much more
 * for another L. (Whether the force is right, another task asks.) */
#include "bodies.hpp"

namespace kit {
template <typename P>
static void ask_for_changes() {
  const Bodies b = drawn_bodies(5, 100);
  for (int s = 0; s < b.num_springs; ++s) {
    const int end = b.springs[s].a;
    const double L = b.springs[s].L;
    const double more = drawn(0.5, 1), much_more = drawn(1.5, 3);
    const Point some = change_of_force<P>(b, end, s, 100, L + more);
    const Point large = change_of_force<P>(b, end, s, 100, L + much_more);
    answer("growth", norm(large) / norm(some));
    const Point along = 1 / norm(large) * large;
    answer("direction",
           Point(std::abs(along.x), std::abs(along.y), std::abs(along.z)));
  }
}
}  // namespace kit

ASKED("4.2.Problem1Force", own_springs_asked) {
  with<KIT_FORCE(Problem1Force)>("Problem1Force",
                                 []<typename P>() { ask_for_changes<P>(); });
}
