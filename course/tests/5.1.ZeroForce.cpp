/** @file 5.1.ZeroForce.cpp
 * The parent class of the forces: no force by itself; GravityForce,
 * MassSpringForce and DampingForce are its children, and so can one of the
 * test's own be. */
#include "cloth.hpp"

namespace kit {

static Bodies moving_bodies() {
  Bodies b;
  b.add(Point(0.5, 0.25, 0), 0.25, Point(1, 2, 3));
  b.add(Point(0.25, 1.5, 1), 2, Point(-3, 0, 4));
  b.join(0, 1, given_K, 0.25);
  b.vary();
  return b;
}

/** A call of F as a Parent is the call of F.  @return the force on node 0 */
template <typename Parent, typename F>
static Point called_as(const char* name, F& force, Cloth& g) {
  DID(name, " called through a reference to its parent class");
  Parent& parent = force;
  const Point through_parent = force_on(parent, g, 0);
  CHECK_NEAR(through_parent, force_on(force, g, 0), 1e-12);
  return through_parent;
}
template <typename Parent, typename F>
static double own_force(const char* name, Cloth& g, double number) {
  if constexpr (inherits_from<F, Parent>()) {
    const Owned<F> own(made_force<F>(name, g, number));
    return norm(called_as<Parent>(name, *own, g));
  }
  return 0;
}

template <typename Parent>
static void hold_parent_of_forces(const Bodies& b) {
  using Gravity = KIT_FORCE(GravityForce);
  using Springs = KIT_FORCE(MassSpringForce);
  Cloth g;
  fill(g, b);
  DID("the parent class, called for a node of mass ", b.m[0],
      " kg, with a velocity and a stretched spring");
  Parent zero;
  const Point force = force_on(zero, g, 0);
  CHECK_NEAR(force, Point(0, 0, 0), 0);

  static Point drawn_force;
  drawn_force = drawn_near(Point(1, -2, 4), 0.5);
  static constexpr auto law = [](ClothNode, double) { return drawn_force; };
  Child<Parent, FreeForce, CallOf<Parent>> mine{law};
  const Point of_mine = called_as<Parent>("a child of the test's own", mine, g);
  CHECK_NEAR(answer("force of a child?", of_mine), drawn_force, 1e-12);

  check_inherits<Gravity, Parent>("GravityForce", "ZeroForce");
  check_inherits<Springs, Parent>("MassSpringForce", "ZeroForce");
  check_inherits<KIT_FORCE(DampingForce), Parent>("DampingForce", "ZeroForce");
  const double sum = own_force<Parent, Gravity>("GravityForce", g, 10) +
                     own_force<Parent, Springs>("MassSpringForce", g, given_K);
  CHECK(sum > 0, "GravityForce or MassSpringForce to be a force");
}

/** A question to a force whose parent no test can name. */
template <typename Gravity>
static void answer_own_force(const Bodies& b) {
  Cloth g;
  fill(g, b);
  const Owned<Gravity> own(made_force<Gravity>("GravityForce", g, 10));
  const Point force = answer("force of its own?", force_on(*own, g, 0));
  CHECK(norm(force) > 0, "GravityForce to be a force");
}

}  // namespace kit

TASK("5.1.ZeroForce", forces_have_a_parent) {
  using Gravity = KIT_FORCE(GravityForce);
  constexpr bool hidden = parent_is_hidden<ForceParent, Gravity>();
  const Bodies b = moving_bodies();
  if constexpr (hidden || answers_all) answer_own_force<Gravity>(b);
  if constexpr (!hidden)
    with_parent<ForceParent, FreeForce>("ZeroForce", [&]<typename Parent>() {
      hold_parent_of_forces<Parent>(b);
    });
}
