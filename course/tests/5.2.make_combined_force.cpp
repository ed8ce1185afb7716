/** @file 5.2.make_combined_force.cpp
 * Sums of two, of three and of sums, made from temporaries, against the sum of
 * the parts. */
#include "cloth.hpp"

namespace kit {

/** Three forces that depend on time, place and velocity. */
struct Parts {
  static constexpr char answer[] = "sum of the test's?",
                        again[] = "sum of a sum of the test's~";
  static TestForce first() {
    static constexpr auto law = [](ClothNode, double t) {
      return Point(1, 2, 4 + t);
    };
    return TestForce(law);
  }
  static TestForce second() {
    static constexpr auto law = [](ClothNode n, double t) {
      return n.position() + Point(8, 16 - 3 * t, 32);
    };
    return TestForce(law);
  }
  static TestForce third() {
    static constexpr auto law = [](ClothNode n, double t) {
      return velocity(n) + Point(64 + 5 * t, -128, 256);
    };
    return TestForce(law);
  }
};

/** The same from the submission's own classes. */
template <typename Gravity, typename Springs>
struct OwnParts {
  static constexpr char answer[] = "sum of its own?",
                        again[] = "sum of a sum of its own~";
  static Gravity first() { return {}; }
  static Springs second() { return {}; }
  static Gravity third() { return {}; }
};

static Bodies two_bodies() {
  Bodies b;
  b.add(Point(0.5, 0.25, 0), 0.25, Point(1, 2, 3));
  b.add(Point(0.25, 1.5, 1), 2, Point(-3, 0, 4));
  b.join(0, 1, given_K, 0.25);
  b.vary();
  return b;
}

/** Hold @a sum to the first @a how_many of the parts. */
template <typename P, typename Sum>
static void compare_sum(Sum& sum, const Bodies& b, int how_many,
                        const char* answered) {
  Cloth g;
  fill(g, b);
  // Uses the place on the stack where temporaries were.
  [[maybe_unused]] volatile double other_numbers[256] = {};
  auto p1 = P::first();
  auto p2 = P::second();
  auto p3 = P::third();
  for (int i = 0; i < b.size; ++i)
    for (double t : {0., 2.}) {
      auto n = node_of(g, i);
      const Point force = answer(answered, force_on(sum, n, t));
      Point expected = p1(n, t) + p2(n, t);
      if (how_many == 3) expected += p3(n, t);
      CHECK(norm(expected) > 0, "forces to sum that are not zero");
      CHECK_NEAR(force, expected, 1e-9);
    }
}

/** The submission's sum of these forces; or a failure. */
template <typename... Fs>
static auto sum_of(Fs&&... fs) {
  if constexpr (must_compile ||
                requires { ::make_combined_force(std::forward<Fs>(fs)...); })
    return ::make_combined_force(std::forward<Fs>(fs)...);
  else
    return Missing();
}
template <typename Ptr>
concept MakesForces = requires(std::vector<Ptr> list) {
  ::CombinedForces(std::move(list));
};
/** Some sums hold unique pointers, so they can't be copied. */
constexpr bool can_copy_sum = MakesForces<std::shared_ptr<ForceParent>> ||
                              !MakesForces<std::unique_ptr<ForceParent>>;
template <typename P, typename Sum>
static void hold(Sum& sum, const Bodies& b, int how_many,
                 const char* answered = P::answer) {
  if constexpr (std::is_same_v<Sum, Missing>)
    fail(words("make_combined_force of ", how_many, " forces to compile"),
         "an error");
  else
    compare_sum<P>(sum, b, how_many, answered);
}

template <typename P>
static void combine_forces(const Bodies& b) {
  {
    DID("make_combined_force(f1, f2) of two temporaries");
    auto sum = sum_of(P::first(), P::second());
    hold<P>(sum, b, 2);
  }
  {
    DID("make_combined_force(f1, f2) of two variables");
    auto p1 = P::first();
    auto p2 = P::second();
    auto sum = sum_of(p1, p2);
    hold<P>(sum, b, 2);
  }
  {
    DID("make_combined_force(f1, f2, f3) of three temporaries");
    auto sum = sum_of(P::first(), P::second(), P::third());
    hold<P>(sum, b, 3);
  }
  if constexpr (can_copy_sum) {
    DID("make_combined_force(make_combined_force(f1, f2), f3)");
    auto sum = sum_of(sum_of(P::first(), P::second()), P::third());
    hold<P>(sum, b, 3, P::again);
  }
}

/** Forces of the test's own can't be combined if the submission's have a base
 * class that is not known here. */
template <typename Gravity, typename Springs>
static void combine_forces_like() {
  const Bodies b = two_bodies();
  constexpr bool own =
      base_is_unknown<Gravity, FreeForce>() && Complete<Springs>;
  if constexpr (own || answers_all)
    combine_forces<OwnParts<Gravity, Springs>>(b);
  if constexpr (!own) combine_forces<Parts>(b);
}

}  // namespace kit

TASK("5.2.make_combined_force", forces_combined) {
  combine_forces_like<KIT_FORCE(GravityForce), KIT_FORCE(MassSpringForce)>();
}
