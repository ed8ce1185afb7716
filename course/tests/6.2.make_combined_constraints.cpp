/** @file 6.2.make_combined_constraints.cpp
 * Two and three constraints in their order, made from temporaries, or from a
 * vector of pointers to the parent class. */
#include "cloth.hpp"

namespace kit {

/** A copy that lives on: a list may hold its address. */
template <typename C>
static C& kept(const C& c) {
  static std::list<C> all;
  return all.emplace_back(c);
}
/** The submission's combination of these, by any of its names, from the parts
 * or from a vector of pointers to them; or Missing. */
template <typename... Cs>
static auto constraints_of(Cs&&... cs) {
  if constexpr (must_compile || requires {
                  {
                    ::make_combined_constraints(std::forward<Cs>(cs)...)
                    } -> Present;
                })
    return ::make_combined_constraints(std::forward<Cs>(cs)...);
  else if constexpr (requires {
                       {
                         ::make_combined_constraint(std::forward<Cs>(cs)...)
                         } -> Present;
                     })
    return ::make_combined_constraint(std::forward<Cs>(cs)...);
  else if constexpr (requires {
                       ::CombinedConstraints(std::forward<Cs>(cs)...);
                     })
    return ::CombinedConstraints(std::forward<Cs>(cs)...);
  else
    return made_of_list<ConstraintParent>(
        []<typename List>(List&& list) -> decltype(::CombinedConstraints(
                                           std::forward<List>(list))) {
          return ::CombinedConstraints(std::forward<List>(list));
        },
        kept(cs)...);
}
template <typename All>
static void apply(All& all, Cloth& g, double t, int how_many) {
  if constexpr (Present<All>)
    constrain(all, g, t);
  else
    fail(words("make_combined_constraints of ", how_many,
               " constraints to compile"),
         "an error");
}

/** What one of the test's constraints makes of a coordinate: the order of two
 * of them matters. */
static double changed(int which, double x, double t) {
  return which == 1 ? 2 * x + t : which == 2 ? 3 * x - 5 * t : 7 * x + 11 * t;
}
template <typename C, int which>
static C part() {
  static constexpr auto law = [](Cloth& g, double t) {
    for (int i = 0; i < int(g.num_nodes()); ++i) {
      auto n = node_of(g, i);
      Point& p = n.position();
      p = Point(changed(which, p.x, t), changed(which, p.y, t),
                changed(which, p.z, t));
    }
  };
  return C(law);
}

/** Apply @a all, and compare with the first @a how_many parts. */
template <typename All>
static void compare_combined(All& all, const Bodies& b, int how_many) {
  const double t = 2;
  Cloth g;
  fill(g, b);
  // Uses the place on the stack where temporaries were.
  [[maybe_unused]] volatile double other_numbers[256] = {};
  apply(all, g, t, how_many);
  for (int i = 0; i < b.size; ++i) {
    answer("all of the test's?", place(g, i));
    Point expected = b.x[i];
    for (int which = 1; which <= how_many; ++which)
      for (int k = 0; k < 3; ++k) expected[k] = changed(which, expected[k], t);
    const Point position = place(g, i);
    CHECK_NEAR(position, expected, 1e-9);
  }
}

template <typename C>
static void combine_constraints(const Bodies& b) {
  {
    DID("x -> 2x + t, then x -> 3x - 5t, both temporaries");
    auto all = constraints_of(part<C, 1>(), part<C, 2>());
    compare_combined(all, b, 2);
  }
  {
    DID("x -> 2x + t, then x -> 3x - 5t, both variables");
    auto c1 = part<C, 1>();
    auto c2 = part<C, 2>();
    auto all = constraints_of(c1, c2);
    compare_combined(all, b, 2);
  }
  {
    DID("x -> 2x + t, then x -> 3x - 5t, then x -> 7x + 11t, all temporaries; "
        "others were combined after them");
    auto all = constraints_of(part<C, 1>(), part<C, 2>(), part<C, 3>());
    auto others = constraints_of(part<C, 3>(), part<C, 1>());
    compare_combined(all, b, 3);
  }
}

/** If the submission's constraints have a base class that is not known here,
 * they are combined themselves. Their order matters at the plane's height. */
template <typename Plane, typename Sphere>
static void combine_own(const Bodies& b) {
  for (int how_many : {2, 3}) {
    DID(how_many, " constraints, all temporaries: planes and a sphere");
    Cloth one, other;
    fill(one, b);
    fill(other, b);
    auto plane = made_plane<Plane>();
    auto sphere = made_sphere<Sphere>();
    constrain(plane, one);
    constrain(sphere, one);
    if (how_many == 2) {
      auto all = constraints_of(made_plane<Plane>(), made_sphere<Sphere>());
      apply(all, other, 0, 2);
    } else {
      auto all = constraints_of(made_plane<Plane>(), made_sphere<Sphere>(),
                                made_plane<Plane>());
      apply(all, other, 0, 3);
    }
    for (int i = 0; i < b.size; ++i) {
      const Point position = answer("all of its own?", place(other, i));
      CHECK_NEAR(position, place(one, i), 1e-12);
      CHECK(norm(place(one, i) - b.x[i]) > 0, "the parts to do anything");
    }
  }
}

template <typename Plane, typename Sphere>
static void combine_constraints_like() {
  Bodies b, inside;
  b.add(Point(0.5, 0.25, -1), 1, Point(1, 2, 3));
  b.add(Point(4, 0.5, 2), 1, Point(1, 2, 3));
  inside.add(Point(0.5, 0.5, -0.4), 1, Point(1, 2, 3));
  inside.add(Point(0.5, 0.25, -2), 1, Point(1, 2, 3));
  b.vary();
  inside.vary(0.03);
  constexpr bool own =
      base_is_unknown<Plane, FreeConstraint>() && Complete<Sphere>;
  if constexpr (own || answers_all) combine_own<Plane, Sphere>(inside);
  if constexpr (!own) combine_constraints<TestConstraint>(b);
}

}  // namespace kit

TASK("6.2.make_combined_constraints", constraints_combined) {
  combine_constraints_like<KIT_CONSTRAINT(PlaneConstraint),
                           KIT_CONSTRAINT(SphereConstraint)>();
}
