/** @file 3.2.Problem1Force.cpp
 * Problem1Force where all springs have the same K and L, against weight and
 * Hooke's law: made from K and L, or reading them from the edges. */
#include "cloth.hpp"

namespace kit {

// A global K or L, if there is one that can be set.
[[maybe_unused]] static void set(double& variable, double a) { variable = a; }
[[maybe_unused]] static void set(float& variable, double a) {
  variable = float(a);
}
template <typename T>
static void set(const T&, double) {}

static double rest_length() { return 0.5; }  // [m]
/** K [N/m] in each way to make the force: some leave no choice. */
static double K_of_way(int way) { return way == 2 || way == 4 ? given_K : 80; }
/** The force made by this way such that all springs have the same K and L; or
 * nullptr if it is made otherwise. */
template <typename P>
static P* made(Cloth& g, int way) {
  const double K = K_of_way(way), L = rest_length();
  P* p = nullptr;
  if constexpr (std::is_constructible_v<P, double, double>) {
    if (way == 0) p = new P(K, L);
    if (way == 1) p = new P(L, K);
  } else {
    if constexpr (std::is_constructible_v<P, double>) {
      if (way == 2) p = new P(L);
      if (way == 3) p = new P(K);
    }
    if constexpr (std::is_default_constructible_v<P>) {
      if (way >= 4) p = new P();
    } else if constexpr (std::is_constructible_v<P, Cloth&>) {
      if (way >= 4) p = new P(g);
    }
  }
  if (!p) return p;
  set(::K, K), set(::L, L);
  if constexpr (is_there<decltype(named_K(*p))>) *named_K(*p) = K;
  if constexpr (is_there<decltype(named_L(*p))>) *named_L(*p) = L;
  return p;
}
/** Two nodes and a spring between them, turned and stretched to @a length. */
static Bodies pair_at(double length, double K) {
  Bodies b;
  b.add(Point(0.2, 0.3, 0.4), 0.25);
  b.add(b.x[0] + length * Point(0.48, 0.6, -0.64), b.m[0]);
  b.join(0, 1, K, rest_length());
  return b;
}
static Point weight(const Bodies& b, int i) {
  return Point(0, 0, -b.m[i] * 9.81);
}

/** The force on body @a i. */
template <typename P>
static Point problem1(const Bodies& b, int i, int way) {
  Cloth g;
  fill(g, b);
  const Owned<P> p(made<P>(g, way));
  return force_on(*p, g, i);
}

/** The way to make the force; if none gives what is expected, the first. */
template <typename P>
static int way_to_make() {
  int first = -1;
  for (int way = 0; way < 6; ++way) {
    Cloth g;
    if (!Owned<P>(made<P>(g, way)).made) continue;
    if (first < 0) first = way;
    const Bodies b = pair_at(2, K_of_way(way));
    if (near(problem1<P>(b, 0, way), weight(b, 0) + b.pull(0), 1e-9))
      return way;
  }
  CHECK(first >= 0, "Problem1Force to be made from K and L, or from nothing");
  return first;
}

template <typename P>
static void check_weight() {
  const int way = way_to_make<P>();
  for (double m : {1.0, 0.25, 3.0}) {
    Bodies b;
    b.add(Point(0.5, 0.25, 0.125), m, Point(1, 2, 3));
    DID("a node of mass ", b.m[0], " kg without edges");
    const Point force = problem1<P>(b, 0, way);
    CHECK_NEAR(force, weight(b, 0), 1e-9);
  }
}

template <typename P>
static void check_one_spring() {
  const int way = way_to_make<P>();
  const double K = K_of_way(way), L = rest_length();
  for (double length : {2 * L, L, L / 4}) {
    const Bodies b = pair_at(length, K);
    for (int end : {0, 1}) {
      DID("two nodes of mass ", b.m[0], " kg, a spring of K = ", K, ", L = ", L,
          " between them, ", length, " m long; the force on its ",
          end == 0 ? "first" : "second", " end");
      const Point force = problem1<P>(b, end, way);
      CHECK_NEAR(force, weight(b, end) + b.pull(end), 1e-9);
    }
  }
}

template <typename P>
static void check_several_springs() {
  const int way = way_to_make<P>();
  const double K = K_of_way(way), L = rest_length();
  Bodies b;
  b.add(Point(0.5, 0.5, 0), 0.5);
  for (const Point& p : {Point(1.5, 0.5, 0.25), Point(0.25, 0.75, 0.5),
                         Point(0.5, 0.5, -2), Point(0, 1, 0)})
    b.join(b.add(p), 0, K, L);
  b.vary();
  DID("a node of mass ", b.m[0], " kg with four springs of K = ", K,
      ", L = ", L);
  const Point force = problem1<P>(b, 0, way);
  answer("force", 1 / K * (force - weight(b, 0)));
  CHECK_NEAR(force, weight(b, 0) + b.pull(0), 1e-9);
}

template <typename P>
static void check_corners() {
  const int way = way_to_make<P>();
  const double K = K_of_way(way), L = rest_length();
  Bodies b;
  for (const Point& p : {Point(0, 0, 0), Point(1, 0, 0), Point(0, 1, 0),
                         Point(1, 1, 0), Point(0, 0, 1), Point(0.04, 0, 0)})
    b.add(p);
  for (int i = 1; i < b.size; ++i) b.join(0, i, K, L);
  b.join(1, 3, K, L);
  for (int i = 0; i < b.size; ++i) {
    DID("the node at ", b.x[i], ", with stretched springs");
    const Point force = problem1<P>(b, i, way);
    if (Bodies::is_corner(b.x[i]))
      CHECK_NEAR(answer("at a corner", force), Point(0, 0, 0), 0);
    else
      CHECK(norm(force) > 1, "a force on a node that is no corner");
  }
}

}  // namespace kit

TASK("3.2.Problem1Force", problem1_uniform) {
  with<KIT_FORCE(Problem1Force)>("Problem1Force", []<typename P>() {
    check_weight<P>();
    check_one_spring<P>();
    check_several_springs<P>();
    check_corners<P>();
  });
}
