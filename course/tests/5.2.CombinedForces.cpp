/** @file 5.2.CombinedForces.cpp
 * Sums of a vector of forces, of one to five, of the test's own and of the
 * submission's classes. The vector holds whatever pointers to the parent class
 * CombinedForces takes: raw, shared or unique. */
#include "cloth.hpp"

namespace kit {

/** Force number @a k of the test's own. */
template <int k>
static TestForce numbered_force() {
  static constexpr auto law = [](ClothNode n, double t) {
    return k * n.position() + Point(1 << k, 3 * t, k * t);
  };
  return TestForce(law);
}

/** CombinedForces of these, or Missing. */
template <typename... Fs>
static auto combined(Fs&... forces) {
  return made_of_list<ForceParent>(
      []<typename List>(
          List&& list) -> decltype(::CombinedForces(std::forward<List>(list))) {
        return ::CombinedForces(std::forward<List>(list));
      },
      forces...);
}

/** A parent that no test can name has no vector of it. */
template <typename F, typename...>
constexpr bool hidden = parent_is_hidden<ForceParent, F>();
/** CombinedForces of these is their sum. */
template <typename... Fs>
static void compare_combined(const char* answered, Cloth& g, Fs&... forces) {
  DID("CombinedForces of a std::vector of length ", int(sizeof...(forces)));
  auto all = combined(forces...);
  if constexpr (!Present<decltype(all)> && !hidden<Fs...>)
    fail(
        "a class CombinedForces that is made from a std::vector of pointers to "
        "the parent class of the forces",
        "none, or one that is made from something else");
  else
    for (int i = 0; i < int(g.num_nodes()); ++i)
      for (double t : {0., 2.}) {
        const Point sum = (force_on(forces, g, i, t) + ...);
        Point force = sum;
        if constexpr (!hidden<Fs...>) force = force_on(all, g, i, t);
        if (answered) answer(answered, force);
        CHECK_NEAR(force, sum, 1e-9);
      }
}

template <typename Gravity, typename Springs>
static void compare_sums() {
  Bodies b;
  b.add(Point(0.5, 0.25, 0), 0.25, Point(1, 2, 3));
  b.add(Point(0.25, 1.5, 1), 2, Point(-3, 0, 4));
  b.join(0, 1, given_K, 0.25);
  b.vary();
  Cloth g;
  fill(g, b);
  constexpr bool own = inherits_from<Gravity, ForceParent>() &&
                       inherits_from<Springs, ForceParent>();
  // Some parents have no child of a test's.
  constexpr bool tests_own =
      !hidden<Gravity> &&
      (!own || std::is_convertible_v<TestForce*, ForceParent*>);
  if constexpr (tests_own) {
    auto f1 = numbered_force<1>(), f2 = numbered_force<2>(),
         f3 = numbered_force<3>();
    compare_combined("sum of the test's?", g, f1);
    compare_combined("sum of the test's?", g, f3, f1);
    compare_combined("sum of the test's?", g, f1, f2, f3, f2, f1);
  }
  if constexpr (own) {
    const Owned<Gravity> gravity(made_force<Gravity>("GravityForce", g, 10));
    const Owned<Springs> springs(
        made_force<Springs>("MassSpringForce", g, given_K));
    compare_combined(tests_own && !answers_all ? nullptr : "sum of its own?", g,
                     *gravity, *springs, *gravity);
  }
}

}  // namespace kit

TASK("5.2.CombinedForces", forces_of_a_vector) {
  compare_sums<KIT_FORCE(GravityForce), KIT_FORCE(MassSpringForce)>();
}
