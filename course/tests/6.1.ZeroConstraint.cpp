/** @file 6.1.ZeroConstraint.cpp
 * The parent class of the constraints: it changes nothing by itself;
 * PinConstraint, PlaneConstraint and SphereConstraint are its children, and so
 * can one of the test's own be. */
#include "cloth.hpp"

namespace kit {

static void check_same(Cloth& g, Cloth& other, int n) {
  for (int i = 0; i < n; ++i) {
    const Point position = place(g, i), vel = velocity(g, i);
    CHECK_NEAR(position, place(other, i), 1e-12);
    CHECK_NEAR(vel, velocity(other, i), 1e-12);
  }
}

/** A call of C as a Parent is the call of C.  @return how far node 0 moved */
template <typename Parent, typename C>
static double called_as(const char* name, C& constraint, const Bodies& b) {
  DID(name, " called through a reference to its parent class");
  Cloth g, other;
  fill(g, b);
  fill(other, b);
  Parent& parent = constraint;
  constrain(parent, g);
  constrain(constraint, other);
  check_same(g, other, b.size);
  return norm(place(g, 0) - b.x[0]);
}

template <typename Parent>
static void hold_parent_of_constraints() {
  using Plane = KIT_CONSTRAINT(PlaneConstraint);
  using Sphere = KIT_CONSTRAINT(SphereConstraint);
  Bodies b;
  b.add(Point(0.25, 0.5, -0.875), 0.5, Point(1, -2, -4));
  b.add(Point(0, 0, 0), 0.5, Point(1, 2, 3));
  b.add(Point(0.5, 0.5, -0.45), 0.5, Point(0, 0, -1));
  b.join(0, 1, given_K, 0.5);
  Cloth g, untouched;
  fill(g, b);
  fill(untouched, b);
  DID("the parent class, called for nodes below the floor, at a corner and in "
      "the ball");
  Parent zero;
  constrain(zero, g);
  check_same(g, untouched, b.size);

  static Point drawn_place;
  drawn_place = drawn_near(Point(1, -2, 4), 0.5);
  static constexpr auto law = [](Cloth& cloth, double) {
    node_of(cloth, 0).position() = drawn_place;
  };
  Child<Parent, FreeConstraint, CallOf<Parent>> mine{law};
  called_as<Parent>("a child of the test's own", mine, b);
  constrain(static_cast<Parent&>(mine), g);
  const Point moved = answer("place by a child?", place(g, 0));
  CHECK_NEAR(moved, drawn_place, 1e-12);

  check_inherits<KIT_CONSTRAINT(PinConstraint), Parent>("PinConstraint",
                                                        "ZeroConstraint");
  check_inherits<Plane, Parent>("PlaneConstraint", "ZeroConstraint");
  check_inherits<Sphere, Parent>("SphereConstraint", "ZeroConstraint");
  double far = 0;
  if constexpr (inherits_from<Plane, Parent>()) {
    auto plane = made_plane<Plane>();
    far += called_as<Parent>("PlaneConstraint", plane, b);
  }
  if constexpr (inherits_from<Sphere, Parent>()) {
    auto sphere = made_sphere<Sphere>();
    std::swap(b.x[0], b.x[2]);
    far += called_as<Parent>("SphereConstraint", sphere, b);
  }
  CHECK(far > 0, "PlaneConstraint or SphereConstraint to move a node");
}

/** A question to a constraint whose parent no test can name. */
template <typename Plane>
static void answer_own_place(const Bodies& b) {
  Cloth g;
  fill(g, b);
  auto plane = made_plane<Plane>();
  constrain(plane, g);
  const Point position = answer("place by its own?", place(g, 0));
  CHECK(norm(position - b.x[0]) > 0, "PlaneConstraint to move a node");
}

}  // namespace kit

TASK("6.1.ZeroConstraint", constraints_have_a_parent) {
  using Plane = KIT_CONSTRAINT(PlaneConstraint);
  constexpr bool hidden = parent_is_hidden<ConstraintParent, Plane>();
  Bodies b;
  b.add(Point(0.25, 0.5, -3), 0.5, Point(1, -2, -4));
  b.vary();
  if constexpr (hidden || answers_all) answer_own_place<Plane>(b);
  if constexpr (!hidden)
    with_parent<ConstraintParent, FreeConstraint>(
        "ZeroConstraint",
        []<typename Parent>() { hold_parent_of_constraints<Parent>(); });
}
