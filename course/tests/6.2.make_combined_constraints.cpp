/** @file 6.2.make_combined_constraints.cpp
 * Two and three constraints in their order, made from temporaries. */
#include "cloth.hpp"

namespace kit {

/** By either name. */
template <typename... Cs>
static auto combined(Cs&&... cs) {
  using First = decltype(::make_combined_constraints(std::forward<Cs>(cs)...));
  if constexpr (!std::is_same_v<First, Missing>) {
    return ::make_combined_constraints(std::forward<Cs>(cs)...);
  } else {
    static_assert(
        !std::is_same_v<decltype(::make_combined_constraint(
                            std::forward<Cs>(cs)...)),
                        Missing>,
        "there is make_combined_constraints or make_combined_constraint");
    return ::make_combined_constraint(std::forward<Cs>(cs)...);
  }
}

/** x becomes a x + b t at all nodes: the order of two of them matters. */
static TestConstraint scaled(double a, double b) {
  return TestConstraint([=](Cloth& g, double t) {
    for (int i = 0; i < int(g.num_nodes()); ++i) {
      auto n = node_of(g, i);
      n.position() = a * n.position() + Point(b * t, b * t, b * t);
    }
  });
}
static double after(double x, double a, double b, double t) {
  return a * x + b * t;
}

/** Apply what make() combines, at t = 2, and compare with @a expected(x). */
template <typename Make, typename Expected>
static void compare_combined(Make make, Expected expected) {
  Bodies b;
  b.add(Point(0.5, 0.25, -1), 1, Point(1, 2, 3));
  b.add(Point(4, 0.5, 2), 1, Point(1, 2, 3));
  Cloth g;
  fill(g, b);
  auto all = make();
  // Uses the place on the stack where temporaries were.
  [[maybe_unused]] volatile double other_numbers[256] = {};
  constrain(all, g, 2);
  for (int i = 0; i < b.size(); ++i) {
    const Point p = b.x[i], position = place(g, i);
    CHECK_NEAR(position, Point(expected(p.x), expected(p.y), expected(p.z)),
               1e-9);
  }
}

static void combine_constraints() {
  DID("x -> 2x + t, then x -> 3x - 5t, both temporaries");
  compare_combined([] { return combined(scaled(2, 1), scaled(3, -5)); },
                   [](double x) { return after(after(x, 2, 1, 2), 3, -5, 2); });

  DID("x -> 2x + t, then x -> 3x - 5t, both variables");
  auto c1 = scaled(2, 1), c2 = scaled(3, -5);
  compare_combined([&] { return combined(c1, c2); },
                   [](double x) { return after(after(x, 2, 1, 2), 3, -5, 2); });

  DID("x -> 2x + t, then x -> 3x - 5t, then x -> 7x + 11t, all temporaries");
  compare_combined(
      [] { return combined(scaled(2, 1), scaled(3, -5), scaled(7, 11)); },
      [](double x) {
        return after(after(after(x, 2, 1, 2), 3, -5, 2), 7, 11, 2);
      });
}

/** If the submission's constraints have a base class that is not known here,
 * they are combined themselves. Their order matters at the plane's height. */
template <typename Plane, typename Sphere>
static void combine_own() {
  Bodies b;
  b.add(Point(0.5, 0.5, -0.4), 1, Point(1, 2, 3));
  b.add(Point(0.5, 0.25, -2), 1, Point(1, 2, 3));
  for (int how_many : {2, 3}) {
    DID(how_many, " constraints, all temporaries: planes and a sphere");
    Cloth one, other;
    fill(one, b);
    fill(other, b);
    Plane plane;
    Sphere sphere;
    plane(one, 0.), sphere(one, 0.);
    if (how_many == 2) {
      auto all = combined(Plane(), Sphere());
      all(other, 0.);
    } else {
      auto all = combined(Plane(), Sphere(), Plane());
      all(other, 0.);
    }
    for (int i = 0; i < b.size(); ++i) {
      const Point position = place(other, i);
      CHECK_NEAR(position, place(one, i), 1e-12);
      CHECK(norm(place(one, i) - b.x[i]) > 0, "the parts to do anything");
    }
  }
}

template <typename Plane, typename Sphere>
static void combine_constraints_like() {
  if constexpr (std::is_polymorphic_v<Plane> &&
                std::is_same_v<TestConstraint, FreeConstraint>)
    combine_own<Plane, Sphere>();
  else
    combine_constraints();
}

}  // namespace kit

TASK("6.2.make_combined_constraints", constraints_combined) {
  combine_constraints_like<KIT_CONSTRAINT(PlaneConstraint),
                           KIT_CONSTRAINT(SphereConstraint)>();
}
