/** @file 6.2.make_combined_constraints.cpp
 * Constraints combined, on nodes at random. */
#include "bodies.hpp"

namespace kit {
template <typename All>
static void ask_for_all(All all, const Bodies& b, const char* what) {
  if constexpr (Present<All>) {
    Cloth g;
    fill(g, b);
    constrain(all, g, b.m[0]);
    for (int i = 0; i < b.size; ++i) answer(what, place(g, i));
  }
}
/** With the same parts as its test; the solution answers for both. */
template <typename Plane, typename Sphere>
static void ask_for_constraints() {
  const Bodies b = drawn_bodies(4, 100);
  Bodies low = b;
  for (int i = 0; i < low.size; ++i) low.x[i].z -= 1;
  low.x[1] = Point(0.5, 0.5, -0.5) + drawn_point(0.08);
  constexpr bool own =
      base_is_unknown<Plane, FreeConstraint>() && Complete<Sphere>;
  if constexpr (!own) {
    using C = TestConstraint;
    ask_for_all(constraints_of(part<C, 1>(), part<C, 2>()), b,
                "all of the test's?");
    ask_for_all(constraints_of(part<C, 3>(), part<C, 2>(), part<C, 1>()), b,
                "all of the test's?");
  }
  if constexpr (own || answers_all)
    ask_for_all(constraints_of(made_plane<Plane>(), made_sphere<Sphere>()), low,
                "all of its own?");
}
}  // namespace kit

ASKED("6.2.make_combined_constraints", constraints_asked) {
  ask_for_constraints<KIT_CONSTRAINT(PlaneConstraint),
                      KIT_CONSTRAINT(SphereConstraint)>();
}
