/** @file 4.2.Problem1Force.cpp
 * Problem1Force with springs that differ: what changes when one edge gets
 * another K or L. (The differences know nothing of weight.) */
#include "cloth.hpp"

namespace kit {

template <typename P>
static P* own_springs_force(Cloth& g) {
  if constexpr (std::is_default_constructible_v<P>)
    return new P();
  else if constexpr (std::is_constructible_v<P, Cloth&>)
    return new P(g);
  else if constexpr (std::is_constructible_v<P, double, double>)
    return new P(100., 0.5);
  else
    fail("Problem1Force to be made from nothing", "another constructor");
}

/** A node with three springs of its own K and L each. */
static Bodies three_springs() {
  Bodies b;
  b.add(Point(0.25, 0.5, 0.125), 0.5);
  b.join(0, b.add(Point(1.25, 0.5, 0.5)), 100, 0.5);
  b.join(b.add(Point(0.25, 1.5, -0.5)), 0, 100, 1.5);
  b.join(0, b.add(Point(-0.5, 0, 1)), 100, 0.75);
  return b;
}

/** Give spring @a s another K and L, and look at the force on all nodes. */
template <typename P>
static void change_spring(int s, double K, double L) {
  Bodies b = three_springs();
  Cloth g;
  fill(g, b);
  const Owned<P> force(own_springs_force<P>(g));
  Point before[Bodies::most], pull_before[Bodies::most];
  for (int i = 0; i < b.size; ++i) {
    before[i] = force_on(*force, g, i);
    pull_before[i] = b.pull(i);
  }
  b.springs[s].K = K;
  b.springs[s].L = L;
  set_springs(g, b);
  for (int i = 0; i < b.size; ++i) {
    const Point change_of_force = force_on(*force, g, i) - before[i];
    CHECK_NEAR(change_of_force, b.pull(i) - pull_before[i], 1e-9);
  }
}

}  // namespace kit

TASK("4.2.Problem1Force", problem1_own_springs) {
  CHECK(has_L, "an edge's value to hold the spring's L");
  with<KIT_FORCE(Problem1Force)>("Problem1Force", []<typename P>() {
    for (int s : {0, 1, 2}) {
      DID("a node with three springs; L of spring ", s,
          " set to 2 m by its edge's value()");
      change_spring<P>(s, 100, 2);
      if (!has_K) continue;  // K = 100 N/m for all, as the assignment has it
      DID("a node with three springs; K of spring ", s,
          " set to 40 N/m by its edge's value()");
      change_spring<P>(s, 40, three_springs().springs[s].L);
    }
  });
}
