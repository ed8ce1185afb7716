/** @file 5.1.MassSpringForce.cpp
 * The springs at a node against Hooke's law. */
#include "cloth.hpp"

namespace kit {

/** @param K  of all springs, or 0 */
static void compare_springs(const Bodies& b, double K) {
  Cloth g;
  fill(g, b);
  with<KIT_FORCE(MassSpringForce)>("MassSpringForce", [&]<typename F>() {
    const Owned<F> springs(made_force<F>("MassSpringForce", g, given_K));
    for (int i = 0; i < b.size; ++i) {
      const Point force = force_on(*springs, g, i);
      answer(K > 0 ? "force" : "force of each K~", 1 / (K > 0 ? K : 1) * force);
      CHECK_NEAR(force, b.pull(i), 1e-9);
    }
  });
}

}  // namespace kit

TASK("5.1.MassSpringForce", springs_one) {
  const double K = spring_constant(drawn(60, 20, 200)), L = 1.5;
  for (double length : {2 * L, L, L / 2}) {
    DID("a spring of K = ", K, " N/m and L = ", L, " m, ", length, " m long");
    Bodies b;
    b.add(Point(0.25, 0.5, 0.75), 0.125, Point(1, 2, 3));
    const Point u = Point(2. / 3, 1. / 3, -2. / 3);
    b.add(b.x[0] + length * u, 8);
    b.join(1, 0, K, L);
    compare_springs(b, K);
  }
}

TASK("5.1.MassSpringForce", springs_without_length) {
  DID("a spring of length 0 and one of length 1");
  Bodies b;
  for (double x : {0.5, 0.5, 1.5}) b.add(Point(x, 0.25, 0.125));
  b.join(0, 1, given_K, 0.5);
  b.join(0, 2, given_K, 0.5);
  compare_springs(b, given_K);
}

TASK("5.1.MassSpringForce", springs_several) {
  for (bool own : {false, true}) {
    if (own && !has_K) return;
    DID("four springs, each of its own length and L", own ? " and K" : "",
        ", and a node with none");
    Bodies b;
    b.add(Point(0, 0, 0));  // no exception for corners
    b.add(Point(1.5, 0.5, 0.25), 0.5);
    b.add(Point(0.25, 0.75, 0.5), 2);
    b.add(Point(0.5, 0.5, -2), 0.25);
    b.add(Point(7, 7, 7), 3);
    b.join(0, 1, 50, 0.5);
    b.join(2, 0, given_K, 0.25);
    b.join(0, 3, 150, 2.5);
    b.join(3, 1, 20, 1);
    b.vary();
    for (Spring& s : b.springs) s.K = own ? drawn(s.K, 20, 200) : given_K;
    compare_springs(b, own ? 0 : given_K);
  }
}
