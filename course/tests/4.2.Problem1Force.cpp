/** @file 4.2.Problem1Force.cpp
 * Problem1Force with springs that differ: what changes when one edge gets
 * another K or L, beside others and alone. */
#include "cloth.hpp"

namespace kit {

/** A node with three springs of its own K and L each. */
static Bodies three_springs() {
  Bodies b;
  b.add(Point(0.25, 0.5, 0.125), 0.5);
  b.join(0, b.add(Point(1.25, 0.5, 0.5)), given_K, 0.5);
  b.join(b.add(Point(0.25, 1.5, -0.5)), 0, given_K, 1.5);
  b.join(0, b.add(Point(-0.5, 0, 1)), given_K, 0.75);
  b.vary(0.05);
  return b;
}

/** How the force on body @a i changes when spring @a s gets this K and L. */
template <typename P>
static Point change_of_force(const Bodies& b, int i, int s, double K,
                             double L) {
  Cloth g;
  fill(g, b);
  const Owned<P> force(made_force<P>("Problem1Force", g, given_K, 0.5));
  const Point before = force_on(*force, g, i);
  Bodies changed = b;
  changed.springs[s].K = K;
  changed.springs[s].L = L;
  set_springs(g, changed);
  return force_on(*force, g, i) - before;
}

/** The change is that of a cloth with this spring alone. (Whether it is the
 * right one for a single spring, another task asks.) */
template <typename P>
static void check_change(const Bodies& all, int s, double K, double L) {
  Bodies alone = all;
  alone.springs[0] = all.springs[s];
  alone.num_springs = 1;
  for (int end : {all.springs[s].a, all.springs[s].b}) {
    const Point change_without_other_springs =
        change_of_force<P>(alone, end, 0, K, L);
    CHECK(norm(change_without_other_springs) > 0.1,
          "the force on its ends to change");
    const Point change = change_of_force<P>(all, end, s, K, L);
    CHECK_NEAR(change, change_without_other_springs, 1e-9);
  }
}

/** How the change grows with L, and its direction: for any law of a spring. */
template <typename P>
static void answer_changes(const Bodies& all, int s) {
  const int end = all.springs[s].a;
  const double L = all.springs[s].L;
  const Point some =
      change_of_force<P>(all, end, s, given_K, L + drawn(0.75, 0.5, 1));
  const Point large =
      change_of_force<P>(all, end, s, given_K, L + drawn(2, 1.5, 3));
  answer("growth", norm(large) / norm(some));
  const Point along = 1 / norm(large) * large;
  answer("direction",
         Point(std::abs(along.x), std::abs(along.y), std::abs(along.z)));
}

}  // namespace kit

TASK("4.2.Problem1Force", problem1_own_springs) {
  CHECK(has_L && has_K, "an edge's value to hold the spring's K and L");
  with<KIT_FORCE(Problem1Force)>("Problem1Force", []<typename P>() {
    const double K = 40, L = 2;
    const Bodies all = three_springs();
    for (int s : {0, 1, 2}) {
      DID("a node with three springs; L of spring ", s, " set to ", L,
          " m by its edge's value()");
      check_change<P>(all, s, given_K, L);
      DID("a node with three springs; K of spring ", s, " set to ", K,
          " N/m by its edge's value()");
      check_change<P>(all, s, K, all.springs[s].L);
      answer_changes<P>(all, s);
    }
  });
}
