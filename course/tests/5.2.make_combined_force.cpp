/** @file 5.2.make_combined_force.cpp
 * Sums of two, of three and of sums, made from temporaries, against the sum of
 * the parts. */
#include "cloth.hpp"

namespace kit {

static const Point f1(1, 2, 4), f2(8, 16, 32), f3(64, -128, 256);

/** Forces of the test's own can't be combined if the submission's have a base
 * class that is not known here. */
template <typename F>
static constexpr bool base_is_unknown() {
  return std::is_polymorphic_v<F> && std::is_same_v<TestForce, FreeForce>;
}

/** Three forces, one for each part of a node; they depend on time as well. */
struct Parts {
  static TestForce first() { return constant_force(f1, Point(0, 0, 1)); }
  static TestForce second() {
    return TestForce(
        [](ClothNode n, double) { return f2 + Point(n.position()); });
  }
  static TestForce third() {
    return TestForce([](ClothNode n, double) { return f3 + velocity(n); });
  }
};

/** The same from the submission's own classes. */
template <typename F>
struct OwnParts {
  static F first() { return F(); }
  static KIT_FORCE(MassSpringForce) second() { return {}; }
  static F third() { return F(); }
};

static Bodies two_bodies() {
  Bodies b;
  b.add(Point(0.5, 0.25, 0), 0.25, Point(1, 2, 3));
  b.add(Point(0.25, 1.5, 1), 2, Point(-3, 0, 4));
  b.springs.push_back({0, 1, 100, 0.25});
  return b;
}

/** Hold what make(P) combines to sum(P), the sum of its parts. */
template <typename P, typename Make>
static void compare_sum(Make make, int from_first, int from_second,
                        int from_third) {
  const Bodies b = two_bodies();
  Cloth g;
  fill(g, b);
  auto sum = make();
  // Uses the place on the stack where temporaries were.
  [[maybe_unused]] volatile double other_numbers[256] = {};
  auto p1 = P::first();
  auto p2 = P::second();
  auto p3 = P::third();
  for (int i = 0; i < b.size(); ++i)
    for (double t : {0., 2.}) {
      auto n = node_of(g, i);
      const Point expected = from_first * Point(p1(n, t)) +
                             from_second * Point(p2(n, t)) +
                             from_third * Point(p3(n, t));
      const Point force = sum(n, t);
      CHECK_NEAR(force, expected, 1e-9);
      CHECK(norm(expected) > 0, "forces to sum that are not zero");
    }
}

template <typename P>
static void combine_forces() {
  DID("make_combined_force(f1, f2) of two temporaries");
  compare_sum<P>([] { return ::make_combined_force(P::first(), P::second()); },
                 1, 1, 0);

  DID("make_combined_force(f1, f2) of two variables");
  auto p1 = P::first();
  auto p2 = P::second();
  compare_sum<P>([&] { return ::make_combined_force(p1, p2); }, 1, 1, 0);

  DID("make_combined_force(f1, f2, f3) of three temporaries");
  compare_sum<P>(
      [] { return ::make_combined_force(P::first(), P::second(), P::third()); },
      1, 1, 1);

  DID("make_combined_force(make_combined_force(f1, f2), f3)");
  compare_sum<P>(
      [] {
        return ::make_combined_force(
            ::make_combined_force(P::first(), P::second()), P::third());
      },
      1, 1, 1);
}

template <typename F>
static void combine_forces_like() {
  if constexpr (base_is_unknown<F>())
    combine_forces<OwnParts<F>>();
  else
    combine_forces<Parts>();
}

}  // namespace kit

TASK("5.2.make_combined_force", forces_combined) {
  combine_forces_like<KIT_FORCE(GravityForce)>();
}
