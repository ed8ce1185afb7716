#pragma once
/** @file World.hpp
 * The cloths on which lab/try measures a step, of the course's classes alone.
 */
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <string>
#include <vector>

#include "mass_spring.hpp"

namespace probe {

inline std::FILE* out;
inline bool constrained = true;  // does the step take a constraint?
using Numbers = std::vector<double>;

/** A cloth and the forces on it. */
struct World {
  GraphType g;
  double gravity = 0;           // [m/s^2]
  double gamma = 0, apart = 0;  // drag c/m [1/s]; c that the step may solve
  std::vector<unsigned> walls;  // nodes without force and velocity
  std::function<Point(Node, double)> extra;      // another force [N]
  std::function<void(GraphType&, double)> hold;  // the constraint
  long long calls = 0;                           // of the force

  void add(const Point& x, const Point& v, double mass) {
    NodeData data;
    data.vel = v, data.mass = mass;
    g.add_node(x, data);
  }
  void spring(unsigned i, unsigned j, double K, double L) {
    EdgeData data;
    data.K = K, data.L = L;
    g.add_edge(g.node(i), g.node(j)).value() = data;
  }
  Point force(Node n, double t) const {
    for (unsigned i : walls)
      if (n.index() == i) return Point();
    const double m = n.value().mass;
    Point f = m * (Point(0, 0, -gravity) - gamma * n.value().vel);
    if (extra) f += extra(n, t);
    for (auto e = n.edge_begin(); e != n.edge_end(); ++e) {
      const Point u = (*e).node2().position() - n.position();
      const double l = norm(u);
      if (l > 0) f += (*e).value().K * (l - (*e).value().L) / l * u;
    }
    return f;
  }
  void constrain(double t) {
    if (hold) hold(g, t);
  }
};

/** Positions and velocities, in the order of the nodes. */
inline Numbers state(World& w) {
  Numbers s;
  for (unsigned i = 0; i < w.g.num_nodes(); ++i) {
    const Point x = w.g.node(i).position(), v = w.g.node(i).value().vel;
    s.insert(s.end(), {x.x, x.y, x.z, v.x, v.y, v.z});
  }
  return s;
}
inline Numbers positions(World& w) {
  Numbers x;
  for (unsigned i = 0; i < w.g.num_nodes(); ++i)
    for (unsigned d = 0; d < 3; ++d) x.push_back(w.g.node(i).position()[d]);
  return x;
}
/** Masses, K and L, which no step may change. */
inline Numbers data(World& w) {
  Numbers is;
  for (Node n : nodes(w.g)) is.push_back(n.value().mass);
  for (unsigned i = 0; i < w.g.num_nodes(); ++i)
    for (Edge e : edges(w.g.node(i)))
      is.insert(is.end(), {e.value().K, e.value().L});
  return is;
}
inline void set_state(World& w, const Numbers& s) {
  for (unsigned i = 0; i < w.g.num_nodes(); ++i) {
    const double* p = &s[6 * i];
    w.g.node(i).position() = Point(p[0], p[1], p[2]);
    w.g.node(i).value().vel = Point(p[3], p[4], p[5]);
  }
}
inline double energy(World& w) {
  double sum = 0;
  for (unsigned i = 0; i < w.g.num_nodes(); ++i) {
    Node n = w.g.node(i);
    sum += n.value().mass *
           (normSq(n.value().vel) / 2 + w.gravity * n.position().z);
    for (auto e = n.edge_begin(); e != n.edge_end(); ++e) {
      const Point u = (*e).node2().position() - n.position();
      const double d = norm(u) - (*e).value().L;
      sum += (*e).value().K * d * d / 4;  // half: it is met from both ends
    }
  }
  return sum;
}

inline void put(const std::string& name, const Numbers& numbers) {
  std::fprintf(out, "%s", name.c_str());
  for (double x : numbers) std::fprintf(out, " %.17g", x);
  std::fputc('\n', out);
  std::fflush(out);  // what is known before a crash counts
}

/** The derivatives of what @a make() returns in the state of @a w, by
 * differences of order 4: a row for each number of the state. */
template <typename Make>
void put_jacobian(World& w, Make make) {
  constexpr double apart = 1e-3;
  const Numbers s = state(w);
  for (std::size_t k = 0; k < s.size(); ++k) {
    Numbers column;
    for (const auto& [at, weight] :
         {std::pair{-2., 1.}, {-1., -8.}, {1., 8.}, {2., -1.}}) {
      Numbers from = s;
      from[k] += at * apart;
      set_state(w, from);
      const Numbers made = make();
      column.resize(made.size());
      for (std::size_t i = 0; i < made.size(); ++i)
        column[i] += weight * made[i] / (12 * apart);
    }
    put("jacobian", column);
  }
}

inline void verlet(World& w, double t, double h) {
  auto kick = [&](double at) {
    for (Node n : nodes(w.g))
      n.value().vel += (h / 2 / n.value().mass) * w.force(n, at);
  };
  kick(t);
  for (Node n : nodes(w.g)) n.position() += h * n.value().vel;
  w.constrain(t + h);
  kick(t + h);
}

// ---- Scenes

/** Four masses and six springs. */
inline World tangle() {
  World w;
  const Point at[] = {{.3, .1, 0}, {1.2, .2, .1}, {.9, 1.1, -.2}, {.1, .8, .7}};
  for (unsigned i = 0, k = 0; i < 4; ++i) {
    w.add(at[i], Point(.3 - .2 * i, .1 * i, .4 - .1 * i * i), .5 + .25 * i);
    for (unsigned j = 0; j < i; ++j, ++k) w.spring(i, j, 4 + k, .7 + .1 * k);
  }
  return w;
}
/** The tangle with forces that depend on time and velocity. */
inline World forced() {
  World w = tangle();
  w.extra = [](Node n, double t) {
    return Point(std::cos(5 * t), std::sin(3 * t), t) - .3 * n.value().vel;
  };
  return w;
}
/** Nodes @a pins stay: by the constraint and, if the step has none or they are
 * @a walls, as no force acts on them. */
inline World& pin(World& w, const std::vector<unsigned>& pins, bool walls) {
  if (walls || !constrained) w.walls = pins;
  std::vector<Point> places;
  for (unsigned i : pins) places.push_back(w.g.node(i).position());
  w.hold = [=](GraphType& g, double) {
    for (std::size_t k = 0; k < pins.size(); ++k) {
      g.node(pins[k]).position() = places[k];
      g.node(pins[k]).value().vel = Point();
    }
  };
  return w;
}
/** A mass on a spring of length 0, whose other end is a wall at the origin. */
inline World oscillator(double mass, double omega, double x, double v) {
  World w;
  w.add(Point(), Point(), mass);
  w.add(Point(x, 0, 0), Point(v, 0, 0), mass);
  w.spring(0, 1, mass * omega * omega, 0);
  return pin(w, {0}, true);
}

/** n x n nodes of 1 kg together, with springs along the sides of squares and
 * along diagonals; side by side in the plane of x and y or, if it @a hangs, of
 * x and z. */
inline World cloth(unsigned n, bool hangs, bool diagonals) {
  World w;
  w.gravity = 9.81;
  const double side = 1.0 / (n - 1);
  auto join = [&](unsigned a, unsigned b) {
    const Point u = w.g.node(a).position() - w.g.node(b).position();
    w.spring(a, b, 100, norm(u));
  };
  for (unsigned k = 0; k < n * n; ++k) {
    const unsigned i = k / n, j = k % n;
    const double y = j * side;
    w.add(Point(i * side, hangs ? 0 : y, hangs ? -y : 0), Point(), 1. / n / n);
    if (i > 0) join(k - n, k);
    if (j > 0) join(k - 1, k);
    if (i > 0 && j > 0 && diagonals) join(k - n - 1, k), join(k - n, k - 1);
  }
  return w;
}
inline World grid1() {
  World w = cloth(25, false, true);
  return pin(w, {0, 600}, false);
}

/** Five masses that hang from a pin. */
inline World swinging(bool moves) {
  World w;
  w.gravity = 9.81;
  for (unsigned j = 0; j < 6; ++j) w.add(Point(.4, .3, -.2 * j), Point(), .2);
  for (unsigned j = 0; j < 5; ++j) w.spring(j, j + 1, 40, .15);
  w.hold = [=](GraphType& g, double t) {
    const double x = moves ? .1 * std::sin(3 * t) + .3 * t : 0;
    g.node(0).position() = Point(.4 + x, .3, 0);
    g.node(0).value().vel = Point(moves ? .3 * std::cos(3 * t) + .3 : 0, 0, 0);
  };
  w.hold(w.g, 0);
  return w;
}
/** A cloth falls on a ball. */
inline World falling() {
  World w = cloth(5, false, true);
  pin(w, {0, 20}, false);
  w.hold = [pins = w.hold](GraphType& g, double t) {
    pins(g, t);
    for (Node n : nodes(g)) {
      const Point r = n.position() - Point(.5, .55, -.25);
      if (norm(r) >= .2) continue;
      const Point normal = r / norm(r);
      n.position() = Point(.5, .55, -.25) + .2 * normal;
      n.value().vel -= dot(n.value().vel, normal) * normal;
    }
  };
  return w;
}

}  // namespace probe
