/** @file 5.1.DampingForce.cpp
 * The drag on nodes of different velocities and masses. It may be made from c,
 * from the number of nodes N (then c = 1/N), from a graph, or from nothing. */
#include "cloth.hpp"

namespace kit {

/** Four nodes: where c comes from N, it is 1/4. */
static Bodies four_bodies() {
  Bodies b;
  b.add(Point(0.5, 0.5, 0), 0.125, Point(1, 0, 0));
  b.add(Point(1, 0, 0), 2, Point(-2, 3, 5));  // no exception for corners
  b.add(Point(0.75, 1, 1), 0.5, Point(0, 0, 0));
  b.add(Point(2, 1, 3), 1, Point(0.5, -8, 0.25));
  return b;
}

template <typename F>
constexpr bool takes_real = requires(double d) {
  F{d};
};
template <typename F>
constexpr bool takes_whole = requires(unsigned N) {
  F(N);
};

template <typename T>
static bool set_if_it_is_there(T& global, double number) {
  if constexpr (std::is_assignable_v<T&, double>) {
    global = number;
    return true;
  }
  return false;
}

/** The force from a number, which may be c or N, from N, or from a graph.
 * @param c  what its coefficient should be; 0 if nobody can know */
template <typename F>
static F* damping_from(Cloth& g, double number, double& c) {
  const unsigned N = unsigned(g.num_nodes());
  if constexpr (takes_real<F>) {
    auto* force = new F{number};
    // The first node has the velocity (1, 0, 0).
    const bool was_N = near(force_on(*force, g, 0).x, -1 / number, 1e-12);
    c = was_N ? 1 / number : number;
    return force;
  } else if constexpr (takes_whole<F>) {
    c = 1. / N;
    return new F(N);
  } else if constexpr (std::is_constructible_v<F, Cloth&>) {
    c = 1. / N;
    return new F(g);
  } else {
    auto* force = new F();
    c = 0;
    if constexpr (requires { force->c = number; }) force->c = c = number;
    // A global one, which main() would set.
    else if (!set_if_it_is_there(::C, number) &&
             !set_if_it_is_there(::c, number))
      return force;
    c = number;
    return force;
  }
}

template <typename Damping>
static void compare_damping(Bodies b, double number) {
  b.vary();
  b.v[0] = Point(1, 0, 0);
  Cloth g;
  fill(g, b);
  double c = 0;
  const Owned<Damping> damping(damping_from<Damping>(g, number, c));
  if (c == 0) {  // whatever it is, it is one number
    DID("DampingForce() on a node of velocity (1, 0, 0)");
    c = -force_on(*damping, g, 0).x;
    CHECK(c > 0, "a force against the velocity");
  }
  for (int i = 0; i < b.size; ++i) {
    DID("DampingForce made such that c = ", c, " kg/s, on a node of mass ",
        b.m[i], " kg and velocity ", b.v[i]);
    const Point force = force_on(*damping, g, i);
    answer("force", 1 / c * force);
    CHECK_NEAR(force, Point(0, 0, 0) - c * b.v[i], 1e-9);
  }
}

/** Each force keeps its own c, whatever is made after it. */
template <typename F>
static void compare_two_dampings(const Bodies& b) {
  if constexpr (takes_real<F>) {
    Cloth g;
    fill(g, b);
    const double c = 0.5, other = 0.25;
    DID("two forces, DampingForce(", c, ") and then DampingForce(", other,
        "), the first one on a node of velocity (1, 0, 0)");
    F first{c}, second{other};
    const double force = -force_on(first, g, 0).x;
    CHECK(near(force, c, 1e-9) || near(force, 1 / c, 1e-9),  // c, or N
          words("a force of ", c, " N"));
  }
}

/** A force that is made from a graph, too, has its c = 1/N. */
template <typename F>
static void compare_damping_of_a_graph(const Bodies& b) {
  Cloth g;
  fill(g, b);
  if constexpr (std::is_constructible_v<F, Cloth&>) {
    DID("DampingForce(g), g being a graph of ", b.size,
        " nodes, on a node of velocity ", b.v[1]);
    F damping(g);
    const Point force = force_on(damping, g, 1);
    CHECK_NEAR(force, -1. / b.size * b.v[1], 1e-9);
  }
}

}  // namespace kit

TASK("5.1.DampingForce", damping_slows) {
  const Bodies b = four_bodies();
  with<KIT_FORCE(DampingForce)>("DampingForce", [&]<typename F>() {
    for (double number : {4., 0.375}) compare_damping<F>(b, number);
    compare_two_dampings<F>(b);
    compare_damping_of_a_graph<F>(b);
  });
}
