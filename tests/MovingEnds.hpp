#pragma once
/** @file MovingEnds.hpp
 * Problems whose held nodes move: a chain with a known answer, and a cloth. */
#include <cmath>
#include <numbers>
#include <vector>

#include "lab/charts/Problem.hpp"

namespace lab {

/** How far the masses of a chain are carried along [m] by its right wall,
 * which moves at 1 m/s since a time @a t: springs that stay straight are
 * linear, so the masses follow in proportion, which takes no force, but for the
 * modes that it takes to start from rest. */
inline double carried(const Chain& chain, unsigned j, double t) {
  if (t <= 0) return 0;
  const unsigned n = chain.n;
  const double angle = std::numbers::pi / (n + 1);
  double way = t * j / (n + 1);
  for (unsigned k = 1; k <= n; ++k) {
    double speed = 0;  // of mode k at the start
    for (unsigned i = 1; i <= n; ++i)
      speed -= 2. / (n + 1) * i / (n + 1) * std::sin(k * angle * i);
    way += speed * std::sin(k * angle * j) * std::sin(chain.omega(k) * t) /
           chain.omega(k);
  }
  return way;
}

/** The chain, of which the right wall moves away from t = 0 on, and stops. */
inline Problem pulled_chain(double t_end, double until = HUGE_VAL) {
  const Chain chain{.n = 8};
  const Point velocity(0.5, 0, 0);
  Problem p =
      chain_problem("pulled", "chain with a wall that moves", t_end, chain);
  p.mesh.held = {0};
  p.pins = {{.node = chain.n + 1, .motion = {velocity, until}}};
  p.exact = [=](double t) {
    std::vector<Point> x = chain.exact(t);
    for (unsigned j = 0; j < x.size(); ++j)
      x[j] += (carried(chain, j, t) - carried(chain, j, t - until)) * velocity;
    return x;
  };
  return p;
}

/** The 5 x 5 cloth with drag, one edge held, the other one moved. */
inline Problem moving_edge(double t_end) {
  Problem p = grid_problem("edge", "5 x 5 cloth, one edge moves", t_end, 5);
  p.pins = {{.x = 0}, {.x = 1, .motion = {Point(0.1, 0.15, 0.25)}}};
  return p;
}

}  // namespace lab
