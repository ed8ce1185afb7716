/** @file functor.cpp
 * Calls a force or a constraint that somebody has written, and writes numbers;
 * forces.py and constraints.py say what they mean. It is compiled, as
 * probe.cpp, with
 *   -DTRY_FILE='"mine.hpp"' -DTRY_NAME=Mine -DTRY_MADE='Mine(3)'
 * (without TRY_MADE: Mine(), or Mine(g)).
 *   functor PART DESCRIPTOR    PART: functor */
#include <unistd.h>

#include <concepts>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "lab/try/World.hpp"
// The force or constraint, after all that it may use.
#include TRY_FILE

namespace probe {

template <typename T>
auto make([[maybe_unused]] GraphType& g) {
#ifdef TRY_MADE
  return TRY_MADE;
#else
  if constexpr (std::default_initializable<T>)
    return T();
  else
    return T(g);
#endif
}
template <typename T>
concept Force = requires(T& f, Node n) {
  { f(n, 1.) } -> std::convertible_to<Point>;
};
template <typename T>
concept Constraint = !Force<T> && requires(T & c, GraphType& g) {
  c(g, 1.);
};

// ---- A force, on the four masses of tangle() that something changes

template <typename F>
Numbers forces(World& w, F& force, double t) {
  Numbers f;
  for (Node n : nodes(w.g)) {
    const Point p = force(n, t);
    f.insert(f.end(), {p.x, p.y, p.z});
  }
  return f;
}
/** Scale the velocities, K and masses, move all. */
World changed(double v, double K, double m, const Point& by = {}) {
  World w = tangle();
  for (Node n : nodes(w.g)) {
    n.value().vel *= v, n.value().mass *= m, n.position() += by;
    for (Edge e : edges(n))  // which is met from both ends
      if (n < e.node2()) e.value().K *= K;
  }
  return w;
}

template <Force F>
void measure() {
  auto tell = [](const char* name, World w, double t = .7) {
    auto force = make<F>(w.g);
    put(name, forces(w, force, t));
  };
  World w = changed(1, 1, 1);
  auto force = make<F>(w.g);
  put("before", state(w)), put("data", data(w));
  put("base", forces(w, force, .7)), put("base", forces(w, force, .7));
  put("after", state(w)), put("data", data(w));
  tell("later", changed(1, 1, 1), 13), tell("base", changed(1, 1, 1));
  for (const double v : {0., 1., 2., -1.})
    for (const double m : {1., 2.})
      put("scales", {v, m}), tell("moving", changed(v, 1, m)),
          tell("soft", changed(v, 0, m)),
          tell("moved", changed(v, 1, m, Point(1, 2, 3)));
  for (int k = 0; k < 6; ++k) {  // two masses that come together
    World near = changed(0, 1, 1);
    near.g.node(1).position() =
        near.g.node(0).position() + Point(k * .25 * .7, 0, 0);
    tell("length", near);
  }
  put_jacobian(w, [&] { return forces(w, force, .7); });
}

// ---- A constraint, on cloths of 9 x 9 nodes

void rows(const char* name, World& w, double variant) {
  for (Node n : nodes(w.g)) {
    const Point x = n.position(), v = n.value().vel;
    put(name, {variant, std::round((n.value().mass - .04) * 1e6), x.x, x.y, x.z,
               v.x, v.y, v.z});
  }
}

template <Constraint C>
void measure() {
  // Depths [m]; 5: all in the assignment's ball, one at its center.
  const double depths[] = {0, .3, .5, .65, 1, .5, .5, .5};
  for (int variant = 0; variant < 8; ++variant) {
    World w = cloth(9, false, true);
    auto constraint = make<C>(w.g);
    int i = 0;
    for (Node n : nodes(w.g)) n.value().mass = .04 + 1e-6 * i++;
    if (variant > 0) constraint(w.g, 0);  // pins are where they were first
    for (Node n : nodes(w.g)) {
      i = int(std::round((n.value().mass - .04) * 1e6));
      const double wave = variant == 5 ? 0 : .02 * std::sin(5. * i);
      if (variant == 5)
        n.position() = .9 * Point(.5, .5, 0) + .1 * n.position();
      if (variant > 0) {
        n.position() += Point(wave, -wave, 3 * wave - depths[variant]);
        n.value().vel = Point(.3, .01 * i, -.4 - .02 * i);
      }
      if (variant == 6 && i == 40) n.position() += Point(.01, .02, -.03);
    }
    rows("before", w, variant);
    for (const char* name : {"once", "twice"}) {
      constraint(w.g, variant == 7 ? .5 : 0);
      rows(name, w, variant);
    }
    put("data", data(w));
  }
  for (int steps = 32; steps <= 4096; steps *= 2) {  // Verlet's order
    World w = cloth(9, false, true);
    auto constraint = make<C>(w.g);
    pin(w, {0, 72}, false);
    w.hold = [&, pins = w.hold](auto& g, double t) {
      if (g.num_nodes() == 81) pins(g, t);
      constraint(g, t);
    };
    w.constrain(0);
    for (int k = 0; k < steps; ++k) verlet(w, k * .6 / steps, .6 / steps);
    Numbers row = positions(w);
    row.insert(row.begin(), {double(steps), double(steps)});
    put("verlet", row);
  }
}

}  // namespace probe

int main(int count, char** words) {
  if (count < 3 || std::string(words[1]) != "functor") return 2;
  probe::out = fdopen(std::atoi(words[2]), "w");
  probe::put("begun", {});
  probe::put("kind", {double(probe::Force<TRY_NAME>)});
  static_assert(probe::Force<TRY_NAME> || probe::Constraint<TRY_NAME>,
                "expected a call Point operator()(Node, double) of a force or "
                "void operator()(GraphType&, double) of a constraint");
  probe::measure<TRY_NAME>();
  probe::put("done", {});
}
