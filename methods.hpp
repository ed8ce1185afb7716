#pragma once
/** @file methods.hpp
 * Methods as plain steps, to read after section 7 and to copy from. Each has
 * the form of symp_euler_step() in mass_spring.hpp, which is one of them, and
 * advances a cloth from time t to t + dt. Any graph of the assignment will do.
 *
 *   force       Point(Node, double): the force F [N] on a node at a time. It
 *               may depend on all positions and on the velocity of that node.
 *   constraint  void(G&, double): called with the time that the nodes have
 *               reached, each time they have moved. So a pin that moves is at
 *               its place at every stage of a step.
 *   returns     t + dt, to round-off
 *
 * Order p: half the step divides the error by 2^p. A method with the limit L is
 * stable while dt omega < L for each frequency omega [1/s] of the cloth,
 * without drag. Tests measure these numbers, and the forces a step: how often a
 * step computes the forces on all nodes. x, v and m are a node's position,
 * velocity and mass. */
#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <utility>
#include <vector>

#include "CME212/AnyGraph.hpp"
#include "CME212/Point.hpp"

using CME212::edges, CME212::nodes;

// ---------------------------------------------------------------- Splittings

/** A force with linear drag, F - c v. Drag depends on the velocity that a kick
 * changes, so as an ordinary force it lowers every splitting to order 1. Given
 * by this class, it is left to the drift, which solves it exactly, and each
 * method keeps its order. */
template <typename F>
struct WithDrag {
  mutable F others;  ///< F, all forces but the drag
  double drag;       ///< c [kg/s], >= 0
  WithDrag(F f, double c) : others(std::move(f)), drag(c) {}
  /** The whole force, for methods that are no splittings. */
  template <typename N>
  Point operator()(N n, double t) const {
    return others(n, t) - drag * n.value().vel;
  }
};

/** WithDrag, or another class with these members. */
template <typename F>
concept DragApart = requires(F& force) {
  force.others;
  force.drag;
};

/** c of a force with its drag apart; 0 of any other. */
template <typename F>
double drag_of(const F& force) {
  if constexpr (DragApart<F>)
    return force.drag;
  else
    return 0;
}

/** F of a force with its drag apart; any other force itself. */
template <typename F>
auto& without_drag(F& force) {
  if constexpr (DragApart<F>)
    return force.others;
  else
    return force;
}

/** Kick, over the time h: v += h F(x, t)/m. */
template <typename G, typename F>
void kick(G& g, double t, double h, F& force) {
  auto& others = without_drag(force);
  for (auto n : nodes(g)) n.value().vel += (h / n.value().mass) * others(n, t);
}

/** Drift, from t to t + h: x += h v; constrain. With drag, where r = c/m:
 * x += v (1 - e^(-r h))/r;  v *= e^(-r h).
 * @return t + h */
template <typename G, typename F, typename C>
double drift(G& g, double t, double h, F& force, C& constraint) {
  for (auto n : nodes(g)) {
    Point &x = n.position(), &v = n.value().vel;
    const double r = drag_of(force) / n.value().mass;
    x += (r > 0 ? -std::expm1(-r * h) / r : h) * v;
    if (r > 0) v *= std::exp(-r * h);
  }
  constraint(g, t + h);
  return t + h;
}

/** Half a kick, a drift, half a kick:
 * v += dt/2 F(x, t)/m;  x += dt v;  v += dt/2 F(x, t + dt)/m.
 * Order 2, limit 2. The last kick and the first one of the next step need the
 * same force: a program that keeps it has 1 force a step.
 * Source: L. Verlet, Phys. Rev. 159 (1967) 98. */
template <typename G, typename F, typename C>
double verlet_step(G& g, double t, double dt, F&& force, C&& constraint) {
  kick(g, t, dt / 2, force);
  t = drift(g, t, dt, force, constraint);
  kick(g, t, dt / 2, force);
  return t;
}

/** Three steps of Verlet, the middle one back in time: their errors of order 2
 * cancel, and as the step is symmetric it has none of order 3. Order 4,
 * limit 1.573; 3 forces a step if those at equal positions are kept.
 * Sources: H. Yoshida, Phys. Lett. A 150 (1990) 262; E. Forest, R. D. Ruth,
 * Physica D 43 (1990) 105. */
template <typename G, typename F, typename C>
double yoshida4_step(G& g, double t, double dt, F&& force, C&& constraint) {
  const double forth = 1 / (2 - std::cbrt(2.0)), back = 1 - 2 * forth;
  t = verlet_step(g, t, forth * dt, force, constraint);
  t = verlet_step(g, t, back * dt, force, constraint);
  return verlet_step(g, t, forth * dt, force, constraint);
}

/** Drifts and kicks in turn over @a parts of dt, the first one a kick if
 * @a kicks.
 * @return t + dt if the parts of the drifts add up to 1 */
template <typename G, typename F, typename C, std::size_t n>
double alternate(G& g, double t, double dt, const std::array<double, n>& parts,
                 bool kicks, F& force, C& constraint) {
  for (const double part : parts) {
    if (kicks)
      kick(g, t, part * dt, force);
    else
      t = drift(g, t, part * dt, force, constraint);
    kicks = !kicks;
  }
  return t;
}

/** Drifts and kicks in a symmetric order: one kick more than order 4 needs, so
 * that xi, lambda and chi could be chosen for the least error. Order 4,
 * limit 2.989, 4 forces a step.
 * Source: I. P. Omelyan, I. M. Mryglod, R. Folk, Comput. Phys. Commun. 146
 * (2002) 188. */
inline constexpr std::array pefrl_parts = [] {
  const double xi = 0.1786178958448091, lambda = -0.2123418310626054,
               chi = -0.06626458266981849;
  return std::array{xi,  0.5 - lambda, chi, lambda, 1 - 2 * (chi + xi), lambda,
                    chi, 0.5 - lambda, xi};
}();

template <typename G, typename F, typename C>
double pefrl_step(G& g, double t, double dt, F&& force, C&& constraint) {
  return alternate(g, t, dt, pefrl_parts, false, force, constraint);
}

/** A Runge-Kutta-Nystroem method: 12 kicks and 11 drifts in a symmetric order,
 * which meet the conditions for forces that depend on positions alone; those
 * for all forces are more. Order 6, limit 9.074, but an oscillation of dt omega
 * near pi or 2 pi grows slowly; 11 forces a step if the last one is kept.
 * Source: S. Blanes, P. C. Moan, J. Comput. Appl. Math. 142 (2002) 313. */
inline constexpr std::array srkn11b_parts = [] {
  const double b1 = .0414649985182624, b2 = .198128671918067,
               b3 = -.0400061921041533, b4 = .0752539843015807,
               b5 = -.0115113874206879, b6 = 0.5 - (b1 + b2 + b3 + b4 + b5);
  const double a1 = .123229775946271, a2 = .290553797799558,
               a3 = -.127049212625417, a4 = -.246331761062075,
               a5 = .357208872795928, a6 = 1 - 2 * (a1 + a2 + a3 + a4 + a5);
  return std::array{b1, a1, b2, a2, b3, a3, b4, a4, b5, a5, b6, a6,
                    b6, a5, b5, a4, b4, a3, b3, a2, b2, a1, b1};
}();

template <typename G, typename F, typename C>
double srkn11b_step(G& g, double t, double dt, F&& force, C&& constraint) {
  return alternate(g, t, dt, srkn11b_parts, true, force, constraint);
}

// -------------------------------------------------------------- Runge-Kutta

/** Position and velocity of a node, or their derivatives by time. */
struct NodeState {
  Point x, v;
};

/** The states of all nodes, by index. */
template <typename G>
std::vector<NodeState> states(G& g) {
  std::vector<NodeState> y(g.num_nodes());
  for (auto n : nodes(g)) y[n.index()] = {n.position(), n.value().vel};
  return y;
}

/** Their derivatives: x' = v, v' = F(x, v, t)/m. */
template <typename G, typename F>
std::vector<NodeState> slopes(G& g, double t, F& force) {
  std::vector<NodeState> k(g.num_nodes());
  for (auto n : nodes(g))
    k[n.index()] = {n.value().vel, force(n, t) / n.value().mass};
  return k;
}

/** Throws if the constraint has removed any of @a count nodes: then what is
 * stored by index belongs to others. Only the last call in a step may. */
template <typename G>
void expect_all(G& g, std::size_t count) {
  if (g.num_nodes() != count)
    throw std::logic_error("the constraint removed a node within a step");
}

/** Put all nodes to y + h k, and constrain them at time t. */
template <typename G, typename C>
void put(G& g, const std::vector<NodeState>& y, double h,
         const std::vector<NodeState>& k, double t, C& constraint) {
  for (auto n : nodes(g)) {
    const auto i = n.index();
    n.position() = y[i].x + h * k[i].x;
    n.value().vel = y[i].v + h * k[i].v;
  }
  constraint(g, t);
}

/** Along the slope at the start: x += dt v;  v += dt F/m, both with the old x
 * and v. Order 1, 1 force a step. Without drag no step is stable.
 * Source: L. Euler, Institutionum calculi integralis I (1768). */
template <typename G, typename F, typename C>
double forward_euler_step(G& g, double t, double dt, F&& force,
                          C&& constraint) {
  put(g, states(g), dt, slopes(g, t, force), t + dt, constraint);
  return t + dt;
}

/** Along the mean of four slopes, y' = f(y, t) of y = (x, v): y += dt k where
 * k = (k1 + 2 k2 + 2 k3 + k4)/6,  k1 = f(y, t),  k2 = f(y + dt/2 k1, t + dt/2),
 * k3 = f(y + dt/2 k2, t + dt/2),  k4 = f(y + dt k3, t + dt).
 * Order 4, limit 2.828, 4 forces a step; each step loses (dt omega)^6/72 of the
 * energy of an oscillation.
 * Source: W. Kutta, Z. Math. Phys. 46 (1901) 435. */
template <typename G, typename F, typename C>
double rk4_step(G& g, double t, double dt, F&& force, C&& constraint) {
  const auto y = states(g);
  const auto slope_after = [&](double h, const auto& k) {
    put(g, y, h, k, t + h, constraint);
    expect_all(g, y.size());
    return slopes(g, t + h, force);
  };
  auto k1 = slopes(g, t, force);
  const auto k2 = slope_after(dt / 2, k1), k3 = slope_after(dt / 2, k2),
             k4 = slope_after(dt, k3);
  for (std::size_t i = 0; i < y.size(); ++i) {
    k1[i].x = (k1[i].x + 2 * k2[i].x + 2 * k3[i].x + k4[i].x) / 6;
    k1[i].v = (k1[i].v + 2 * k2[i].v + 2 * k3[i].v + k4[i].v) / 6;
  }
  put(g, y, dt, k1, t + dt, constraint);
  return t + dt;
}

// ------------------- Implicit Euler and XPBD, which take edges to be springs

/** The nodes that a constraint holds, by index: those that get the same
 * velocity from it whatever they had, for which it is called twice. They are
 * put to their places at time t; all others keep position and velocity. */
template <typename G, typename C>
std::vector<char> held_nodes(G& g, double t, C& constraint) {
  const auto before = states(g);
  std::vector<std::vector<NodeState>> after;
  for (const double sign : {-1, 1}) {
    for (auto n : nodes(g)) n.value().vel = sign * Point(1, 2, 3);
    constraint(g, t);
    expect_all(g, before.size());
    after.push_back(states(g));
  }
  std::vector<char> held(before.size());
  for (auto n : nodes(g)) {
    const auto i = n.index();
    held[i] = after[0][i].v == after[1][i].v;
    if (held[i]) continue;
    n.position() = before[i].x;
    n.value().vel = before[i].v;
  }
  return held;
}

/** The length l [m] of a spring, and its direction n from node1() to node2();
 * 0 if l = 0. */
template <typename E>
std::pair<double, Point> span_of(const E& e) {
  const Point u = e.node2().position() - e.node1().position();
  const double l = norm(u);
  return {l, l > 0 ? u / l : Point()};
}

/** H d, by node index: by how much the pull of the springs on each node falls
 * if all nodes move by d [m]. Along a spring the stiffness is K, across it
 * K (1 - L/l), but 0 if it is compressed, so that H is positive. If l = 0 it is
 * K in all directions. */
template <typename G>
std::vector<Point> stiffness_times(G& g, const std::vector<Point>& d) {
  std::vector<Point> f(d.size());
  for (auto e : edges(g)) {
    const auto i = e.node1().index(), j = e.node2().index();
    const auto [l, n] = span_of(e);
    const double K = e.value().K, L = e.value().L;
    const double across = l > 0 ? std::max(0., K * (1 - L / l)) : K;
    const Point by = d[i] - d[j];
    const Point pull = across * by + (K - across) * dot(n, by) * n;
    f[i] += pull, f[j] -= pull;
  }
  return f;
}

/** Sum of the products of all nodes. */
inline double product(const std::vector<Point>& a,
                      const std::vector<Point>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += dot(a[i], b[i]);
  return sum;
}

/** The solution x of A x = b up to |A x - b| <= tolerance |b|, by conjugate
 * gradients: A, symmetric and positive, is only needed as the function A(x).
 * Source: M. Hestenes, E. Stiefel, J. Res. Natl. Bur. Stand. 49 (1952) 409. */
template <typename Product>
std::vector<Point> solve(const Product& A, const std::vector<Point>& b,
                         double tolerance) {
  std::vector<Point> x(b.size()), r = b, p = b;
  double rr = product(r, r);
  const double enough = tolerance * tolerance * rr;
  for (auto left = 10 * b.size() + 100; rr > enough; --left) {
    if (left == 0) throw std::runtime_error("conjugate gradients: no solution");
    const auto Ap = A(p);
    const double a = rr / product(p, Ap), before = rr;
    for (std::size_t i = 0; i < b.size(); ++i)
      x[i] += a * p[i], r[i] -= a * Ap[i];
    rr = product(r, r);
    for (std::size_t i = 0; i < b.size(); ++i) p[i] = r[i] + rr / before * p[i];
  }
  return x;
}

/** (M + dt c + dt^2 H) d, by node index: by what an implicit step multiplies
 * changes of velocity. 0 at @a held nodes. */
template <typename G>
std::vector<Point> matrix_times(G& g, const std::vector<char>& held, double dt,
                                double c, const std::vector<Point>& d) {
  auto Ad = stiffness_times(g, d);
  for (auto n : nodes(g)) {
    const auto i = n.index();
    const double inertia = n.value().mass + dt * c;
    Ad[i] = held[i] ? Point() : inertia * d[i] + dt * dt * Ad[i];
  }
  return Ad;
}

/** v += dt F/m with the force at the end of the step, then x += dt v. That
 * force is found by one step of Newton's method, with the springs' stiffness H:
 *   (M + dt c + dt^2 H) dv = dt (F - dt H v - c v).
 * Order 1, no limit, 1 force and about dt omega products with H a step. Drag
 * is implicit if it is given by WithDrag.
 * @param tolerance of the linear equations, as a share of their right side
 * Source: D. Baraff, A. Witkin, SIGGRAPH 1998, doi:10.1145/280814.280821. */
template <typename G, typename F, typename C>
double implicit_euler_step(G& g, double t, double dt, F&& force, C&& constraint,
                           double tolerance = 1e-8) {
  const auto held = held_nodes(g, t + dt, constraint);
  const double c = drag_of(force);
  std::vector<Point> v(held.size()), b(held.size());
  for (auto n : nodes(g))
    if (!held[n.index()]) v[n.index()] = n.value().vel;
  const auto Hv = stiffness_times(g, v);
  for (auto n : nodes(g))
    if (const auto i = n.index(); !held[i])
      b[i] = dt * (without_drag(force)(n, t + dt) - dt * Hv[i] - c * v[i]);
  const auto A = [&](auto& d) { return matrix_times(g, held, dt, c, d); };
  const auto dv = solve(A, b, tolerance);
  for (auto n : nodes(g)) {
    n.value().vel = v[n.index()] + dv[n.index()];
    n.position() += dt * n.value().vel;
  }
  constraint(g, t + dt);
  return t + dt;
}

/** Accelerations (F - F of the springs)/m, by node index.
 * @param w 1/m of each node, or 0 if it is held */
template <typename G, typename F>
std::vector<Point> without_springs(G& g, double t, F& force,
                                   const std::vector<double>& w) {
  std::vector<Point> a(w.size());
  for (auto n : nodes(g)) {
    const auto i = n.index();
    a[i] = w[i] * without_drag(force)(n, t);
    for (auto e : edges(n)) {
      const auto [l, direction] = span_of(e);
      a[i] -= w[i] * e.value().K * (l - e.value().L) * direction;
    }
  }
  return a;
}

/** Moves the ends of each spring in turn towards its rest length:
 *   x_i += w_i d n,  x_j -= w_j d n,  d = (l - L)/(w_i + w_j + 1/(K h^2)).
 * The velocities follow: v += (what a node has moved)/h.
 * @param w 1/m of each node, or 0 if it is held   @param h step [s] */
template <typename G>
void relax_springs(G& g, const std::vector<double>& w, double h) {
  const auto before = states(g);
  for (auto e : edges(g)) {
    const auto i = e.node1().index(), j = e.node2().index();
    const auto [l, n] = span_of(e);
    const double K = e.value().K, L = e.value().L;
    const double d = (l - L) / (w[i] + w[j] + 1 / (K * h * h));
    e.node1().position() += w[i] * d * n;
    e.node2().position() -= w[j] * d * n;
  }
  for (auto n : nodes(g))
    n.value().vel += (n.position() - before[n.index()].x) / h;
}

/** Extended position-based dynamics, in substeps: all forces but the springs
 * move the nodes, then relax_springs() corrects them. Order 1, no limit,
 * 1 force a step.
 * @param force with that of the springs, as in all steps here
 * Sources: M. Macklin, M. Mueller, N. Chentanez, MIG 2016,
 * doi:10.1145/2994258.2994272; M. Macklin et al., SCA 2019,
 * doi:10.1145/3309486.3340247. */
template <typename G, typename F, typename C>
double xpbd_step(G& g, double t, double dt, F&& force, C&& constraint) {
  constexpr int substeps = 10;
  const double h = dt / substeps;
  const auto held = held_nodes(g, t, constraint);
  std::vector<double> w(held.size());
  for (auto n : nodes(g))
    w[n.index()] = held[n.index()] ? 0 : 1 / n.value().mass;
  const auto a = without_springs(g, t, force, w);
  for (int k = 1; k <= substeps; ++k) {
    for (auto n : nodes(g)) {
      const auto i = n.index();
      Point& v = n.value().vel;
      v = std::exp(-drag_of(force) * w[i] * h) * (v + h * a[i]);
      n.position() += h * v;
    }
    constraint(g, t + k * h);
    expect_all(g, held.size());
    relax_springs(g, w, h);
  }
  constraint(g, t + dt);
  return t + dt;
}
