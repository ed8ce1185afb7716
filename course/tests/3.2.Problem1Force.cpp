/** @file 3.2.Problem1Force.cpp
 * Problem1Force where all springs have the same K and L, against weight and
 * Hooke's law: made from K and L, or reading them from the edges. */
#include "cloth.hpp"

namespace kit {

/** A way to make the force such that all springs have this K and L. */
struct Uniform {
  double K, L;
  std::function<ForceLaw(Cloth&)> make;
};

// A global K or L, if there is one that can be set.
[[maybe_unused]] static bool set(double& variable, double a) {
  return variable = a, true;
}
[[maybe_unused]] static bool set(float& variable, double a) {
  return variable = float(a), true;
}
template <typename T>
[[maybe_unused]] static bool set(const T&, double) {
  return false;
}

/** The force made from @a args, with its K and L set if it shows them. */
template <typename P, typename... Args>
static Uniform way(double K, double L, const Args&... args) {
  return {K, L, [=](Cloth& g) {
            set(::K, K), set(::L, L);
            std::shared_ptr<P> p;
            if constexpr (sizeof...(args) == 0 &&
                          !std::is_default_constructible_v<P>)
              p.reset(new P(g));
            else
              p.reset(new P(args...));
            if constexpr (is_there<decltype(named_K(*p))>) *named_K(*p) = K;
            if constexpr (is_there<decltype(named_L(*p))>) *named_L(*p) = L;
            return ForceLaw([p](ClothNode n, double t) { return (*p)(n, t); });
          }};
}

/** All ways that compile; what the assignment has first comes first. */
template <typename P>
static std::vector<Uniform> ways_of_uniform() {
  const double K = 80, L = 0.5;
  std::vector<Uniform> ways;
  if constexpr (std::is_constructible_v<P, double, double>) {
    ways.push_back(way<P>(K, L, K, L));
    ways.push_back(way<P>(K, L, L, K));
  }
  if constexpr (std::is_constructible_v<P, double>) {
    ways.push_back(way<P>(100, L, L));
    ways.push_back(way<P>(K, L, K));
  }
  if constexpr (std::is_default_constructible_v<P> ||
                std::is_constructible_v<P, Cloth&>) {
    ways.push_back(way<P>(100, L));
    ways.push_back(way<P>(K, L));
  }
  return ways;
}

static const double m1 = 0.25;  // [kg]

/** Two nodes and a spring between them, turned and stretched to @a length. */
static Bodies pair_at(double length, double K, double L) {
  Bodies b;
  b.add(Point(0.2, 0.3, 0.4), m1);
  b.add(b.x[0] + length * Point(2. / 3, -1. / 3, 2. / 3), m1);
  b.springs.push_back({0, 1, K, L});
  return b;
}

/** Hold the force on body @a i to what the assignment says. */
static void compare_problem1(const Bodies& b, int i, const Uniform& all) {
  Cloth g;
  fill(g, b);
  const Point force = all.make(g)(node_of(g, i), 0);
  const Point weight(0, 0, -b.m[i] * 9.81);
  CHECK_NEAR(force, weight + b.pull(i), 1e-9);
}

/** The way to make the force; if no one gives what is expected, the first. */
static Uniform uniform_force() {
  const auto ways = ways_of_uniform<KIT_FORCE(Problem1Force)>();
  CHECK(!ways.empty(),
        "Problem1Force to be made from K and L, or from nothing");
  for (const Uniform& all : ways) {
    const Bodies b = pair_at(2, all.K, all.L);
    Cloth g;
    fill(g, b);
    const Point weight(0, 0, -b.m[0] * 9.81);
    if (near(all.make(g)(node_of(g, 0), 0), weight + b.pull(0), 1e-9))
      return all;
  }
  return ways.front();
}

}  // namespace kit

TASK("3.2.Problem1Force", problem1_weight) {
  const Uniform all = uniform_force();
  for (double m : {1.0, 0.25, 3.0}) {
    DID("a node of mass ", m, " kg without edges");
    Bodies b;
    b.add(Point(0.5, 0.25, 0.125), m, Point(1, 2, 3));
    compare_problem1(b, 0, all);
  }
}

TASK("3.2.Problem1Force", problem1_one_spring) {
  const Uniform all = uniform_force();
  for (double length : {2.0, 1.0, 0.25}) {
    const Bodies b = pair_at(length * all.L, all.K, all.L);
    for (int end : {0, 1}) {
      DID("two nodes of mass 0.25 kg, a spring of K = ", all.K, ", L = ", all.L,
          " between them, ", length * all.L, " long; the force on its ",
          end == 0 ? "first" : "second", " end");
      compare_problem1(b, end, all);
    }
  }
}

TASK("3.2.Problem1Force", problem1_several_springs) {
  const Uniform all = uniform_force();
  Bodies b;
  b.add(Point(0.5, 0.5, 0), 0.5);
  for (const Point& p : {Point(1.5, 0.5, 0.25), Point(0.25, 0.75, 0.5),
                         Point(0.5, 0.5, -2), Point(0, 1, 0)})
    b.springs.push_back({b.add(p), 0, all.K, all.L});
  DID("a node of mass 0.5 kg with four springs of K = ", all.K,
      ", L = ", all.L);
  compare_problem1(b, 0, all);
}

TASK("3.2.Problem1Force", problem1_corners) {
  const Uniform all = uniform_force();
  Bodies b;
  for (const Point& p : {Point(0, 0, 0), Point(1, 0, 0), Point(0, 1, 0),
                         Point(1, 1, 0), Point(0, 0, 1)})
    b.add(p);
  for (int i = 1; i < b.size(); ++i) b.springs.push_back({0, i, all.K, all.L});
  b.springs.push_back({1, 3, all.K, all.L});
  Cloth g;
  fill(g, b);
  auto force_of = all.make(g);
  for (int corner : {0, 1}) {
    DID("the node at ", b.x[corner], ", with stretched springs");
    const Point force = force_of(node_of(g, corner), 0);
    CHECK_NEAR(force, Point(0, 0, 0), 0);
  }
  for (int other : {2, 3, 4}) {
    DID("the node at ", b.x[other], ", with stretched springs");
    const Point force = force_of(node_of(g, other), 0);
    CHECK(norm(force) > 1, "a force on a node that is no corner");
  }
}
