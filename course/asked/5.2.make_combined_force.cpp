/** @file 5.2.make_combined_force.cpp
 * Sums of forces on bodies at random. */
#include "bodies.hpp"

namespace kit {
template <typename Sum>
static void ask_for_sum(Sum sum, const Bodies& b, const char* what) {
  if constexpr (!std::is_same_v<Sum, Missing>) {
    Cloth g;
    fill(g, b);
    for (int i = 0; i < b.size; ++i) answer(what, force_on(sum, g, i, b.m[0]));
  }
}
template <typename P>
static void ask_for_sums(const Bodies& b, const char* what) {
  ask_for_sum(sum_of(P::first(), P::second()), b, what);
  ask_for_sum(sum_of(P::first(), P::second(), P::third()), b, what);
}
/** With the same parts as its test; the solution answers for both. */
template <typename Gravity, typename Springs>
static void ask_for_sums_like() {
  const Bodies b = drawn_bodies(4, 100);
  constexpr bool own =
      base_is_unknown<Gravity, FreeForce>() && Complete<Springs>;
  if constexpr (!own) ask_for_sums<Parts>(b, "sum of the test's?");
  if constexpr (own || answers_all)
    ask_for_sums<OwnParts<Gravity, Springs>>(b, "sum of its own?");
}
}  // namespace kit

ASKED("5.2.make_combined_force", sums_asked) {
  ask_for_sums_like<KIT_FORCE(GravityForce), KIT_FORCE(MassSpringForce)>();
}
