/** @file 5.1.DampingForce.cpp
 * The drag on nodes of different velocities and masses. It may be made from c,
 * from the number of nodes N (then c = 1/N), from a graph, or from nothing. */
#include "cloth.hpp"

namespace kit {

/** Four nodes: where c comes from N, it is 1/4. */
static Bodies four_bodies() {
  Bodies b;
  b.add(Point(0.5, 0.5, 0), 0.125, Point(1, 0, 0));
  b.add(Point(0.25, 0.5, -1), 2, Point(-2, 3, 5));
  b.add(Point(0.75, 1, 1), 0.5, Point(0, 0, 0));
  b.add(Point(2, 1, 3), 1, Point(0.5, -8, 0.25));
  return b;
}

struct Damping {
  ForceLaw force;
  double c;          ///< [kg/s]; 0: not known
  std::string from;  // what it was made from
};

template <typename F>
static ForceLaw law_of(F* f) {
  std::shared_ptr<F> kept(f);
  return [kept](ClothNode n, double t) { return (*kept)(n, t); };
}

/** @a d tells a coefficient, or a number of nodes, from an integer type. */
template <typename F>
constexpr bool takes_real = requires(double d) {
  F{d};
};
template <typename F>
constexpr bool takes_whole = requires(unsigned d) {
  F(d);
};

template <typename F>
static Damping damping_from(Cloth& g, double number) {
  if constexpr (takes_real<F>) {
    auto force = law_of(new F{number});
    // From N, or from c? The first node has the velocity (1, 0, 0).
    const bool from_N = near(force(node_of(g, 0), 0).x, -1 / number, 1e-12);
    return {force, from_N ? 1 / number : number, words(number)};
  } else if constexpr (takes_whole<F>) {
    const unsigned N = unsigned(g.num_nodes());
    return {law_of(new F(N)), 1. / N, words(N)};
  } else if constexpr (std::is_constructible_v<F, Cloth&>) {
    return {law_of(new F(g)), 1. / double(g.num_nodes()), "the graph"};
  } else {
    auto* f = new F();
    auto law = law_of(f);
    if constexpr (requires { f->c = number; })
      return f->c = number, Damping{law, number, "nothing, c set"};
    else
      return {law, 0, "nothing"};
  }
}

}  // namespace kit

TASK("5.1.DampingForce", damping_slows) {
  const Bodies b = four_bodies();
  for (double number : {4., 0.375}) {
    Cloth g;
    fill(g, b);
    Damping damping = damping_from<KIT_FORCE(DampingForce)>(g, number);
    if (damping.c == 0) {  // whatever it is, it is one number
      DID("DampingForce() on a node of velocity (1, 0, 0)");
      damping.c = -damping.force(node_of(g, 0), 0).x;
      CHECK(damping.c > 0, "a force against the velocity");
    }
    for (int i = 0; i < b.size(); ++i) {
      DID("DampingForce made from ", damping.from, ", c = ", damping.c,
          " kg/s; a node of mass ", b.m[i], " kg and velocity ", b.v[i]);
      const Point force = damping.force(node_of(g, i), 0);
      CHECK_NEAR(force, -damping.c * b.v[i], 1e-9);
    }
  }
}
