#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "lab/charts/Problem.hpp"

namespace lab {

using std::numbers::pi;

double Chain::omega(unsigned k) const {
  return 2 * std::sqrt(K * n) * std::sin(k * pi / (n + 1) / 2);
}
std::vector<Point> Chain::exact(double t) const {
  std::vector<Point> x;
  for (unsigned j = 0; j < n + 2; ++j) {
    Point& p = x.emplace_back(j / double(n + 1), 0, 0);
    if (j == 0 || j == n + 1) continue;
    for (const Mode& m : modes)
      p.x += m.amplitude * std::sin(m.k * pi / (n + 1) * j) *
             std::cos(omega(m.k) * t);
  }
  return x;
}

Problem chain_problem(std::string name, std::string about, double t_end,
                      Chain chain) {
  auto build = [chain](Cloth& g) {
    const unsigned n = chain.n;
    for (const Point& p : chain.exact(0)) g.add_node(p, {Point(), 1.0 / n});
    for (unsigned j = 0; j <= n; ++j)
      g.add_edge(g.node(j), g.node(j + 1), {chain.K, chain.rest / (n + 1)});
  };
  auto pins = [n = chain.n](const Cloth& g) {
    const std::array ends = {g.node(0), g.node(n + 1)};
    return make_combined_constraints(PinConstraint(std::span(ends)));
  };
  return {.name = std::move(name),
          .about = std::move(about),
          .t_end = t_end,
          .gravity = 0,
          .build = build,
          .constraint = pins,
          .exact = [chain](double t) { return chain.exact(t); }};
}

namespace {

/** A square cloth of n x n nodes, plain mesh, that hangs from its whole upper
 * row and starts unstretched: each column is a chain. */
struct Curtain {
  unsigned n = 16;
  double K = 100;

  std::vector<Point> exact(double t) const {
    const double m = 1.0 / (n * n), width = 1.0 / (n - 1);
    std::vector<double> hangs(n);  // displacement at rest, downwards [m]
    for (unsigned j = 1; j < n; ++j)
      hangs[j] = hangs[j - 1] + (n - j) * m * grav / K;
    std::vector<double> z(n);
    for (unsigned j = 0; j < n; ++j) z[j] = -(j * width) - hangs[j];
    for (unsigned k = 1; k < n; ++k) {
      double angle = (2 * k - 1) * pi / (2 * n - 1), amplitude = 0;
      for (unsigned j = 1; j < n; ++j)
        amplitude += 4.0 / (2 * n - 1) * hangs[j] * std::sin(angle * j);
      double omega = 2 * std::sqrt(K / m) * std::sin(angle / 2);
      for (unsigned j = 1; j < n; ++j)
        z[j] += amplitude * std::sin(angle * j) * std::cos(omega * t);
    }
    std::vector<Point> x;
    for (unsigned i = 0; i < n; ++i)
      for (unsigned j = 0; j < n; ++j) x.emplace_back(i * width, 0, z[j]);
    return x;
  }
  void build(Cloth& g) const {
    auto points = grid_points(n);
    for (Point& p : points) p = Point(p.x, 0, -p.y);
    build_cloth(g, points, grid_quads(n), MeshSprings::plain, K);
  }
  CombinedConstraints pins(const Cloth& g) const {
    std::vector<Node> row;
    for (unsigned i = 0; i < n; ++i) row.push_back(g.node(i * n));
    return make_combined_constraints(PinConstraint(row));
  }
};

CombinedConstraints pinned(const Cloth& g) {
  return make_combined_constraints(PinConstraint(g));
}
PinConstraint side_of(const Cloth& g) {
  std::vector<Node> side;
  for (unsigned i = 0; i < g.num_nodes(); ++i)
    if (g.node(i).position().y == 0) side.push_back(g.node(i));
  return PinConstraint(side);
}
CombinedConstraints held_at_a_side(const Cloth& g) {
  return make_combined_constraints(side_of(g));
}
CombinedConstraints torn_by_a_ball(const Cloth& g) {
  return make_combined_constraints(PinConstraint(g), PlaneConstraint(),
                                   TearConstraint());
}

}  // namespace

Problem curtain_problem(std::string name, std::string about, double t_end,
                        unsigned side) {
  const Curtain curtain{.n = side};
  return {.name = std::move(name),
          .about = std::move(about),
          .t_end = t_end,
          .build = [=](Cloth& g) { curtain.build(g); },
          .constraint = [=](const Cloth& g) { return curtain.pins(g); },
          .exact = [=](double t) { return curtain.exact(t); }};
}

CombinedConstraints on_a_ball(const Cloth& g) {
  return make_combined_constraints(PinConstraint(g), PlaneConstraint(),
                                   SphereConstraint());
}

Problem cloth_problem(std::string name, std::string about, double t_end,
                      std::vector<Point> points, std::vector<Quad> quads,
                      double K) {
  return {
      .name = std::move(name),
      .about = std::move(about),
      .t_end = t_end,
      .gamma = 1,
      .build =
          [points = std::move(points), quads = std::move(quads), K](Cloth& g) {
            build_cloth(g, points, quads, MeshSprings::diagonals, K);
          },
      .constraint = pinned};
}

Problem grid_problem(std::string name, std::string about, double t_end,
                     unsigned side, double K) {
  return cloth_problem(std::move(name), std::move(about), t_end,
                       grid_points(side), grid_quads(side), K);
}

Problem mixed_problem() {
  Problem p = grid_problem(
      "mixed", "25 x 25 cloth, a band of K = 1e6 N/m, held at a side, to 0.1 s",
      0.1, 25);
  p.constraint = held_at_a_side;
  p.build = [build = p.build](Cloth& g) {
    build(g);
    for (Edge e : g.edges())
      if (std::max(e.node1().position().x, e.node2().position().x) < 0.09)
        e.value().K *= 1e4;
  };
  return p;
}

namespace {

/** Columns that become narrower from right to left, down to a sixteenth; masses
 * by area, K of a spring by 1/length. */
Problem graded_problem() {
  constexpr unsigned side = 25;
  std::vector<Point> points = grid_points(side);
  const double ratio = std::pow(16, 1. / (side - 2));
  const auto place = [=](double u) {  // of 0, 1/24 ... 1
    return (std::pow(ratio, u * (side - 1)) - 1) /
           (std::pow(ratio, side - 1) - 1);
  };
  for (Point& p : points) p.x = place(p.x);
  Problem p = cloth_problem(
      "graded", "25 x 25 cloth, columns of width 1 to 1/16, to 0.25 s", 0.25,
      points, grid_quads(side));
  p.gamma = 0;
  p.build = [=, build = p.build](Cloth& g) {
    build(g);
    for (Node n : g.nodes()) n.value().mass = 0;
    for (const Quad& q : grid_quads(side)) {
      const double area =
          norm(points[q[0]] - points[q[1]]) * norm(points[q[1]] - points[q[2]]);
      for (unsigned i : q) g.node(i).value().mass += area / 4;
    }
    for (Edge e : g.edges()) e.value().K = 100. / 24 / e.value().L;
  };
  return p;
}

/** A floor with Coulomb's friction: the tangential velocity loses a half of
 * what the normal one loses. */
void rub(Cloth& g, double) {
  for (Node n : g.nodes()) {
    Point &x = n.position(), &v = n.value().vel;
    if (!(x.z < 0)) continue;
    const Point along(v.x, v.y, 0);
    const double speed = norm(along), loss = std::max(0., -double(v.z)) / 2;
    x.z = 0;
    v = speed > loss ? (1 - loss / speed) * along : Point();
  }
}

}  // namespace

std::vector<Problem> make_problems() {
  std::vector<Problem> all;
  all.push_back(chain_problem(
      "chain", "20 masses between two walls, to 0.8 s; exact", 0.8));
  all.push_back(
      curtain_problem("curtain", "16 x 16 curtain let go, to 1 s; exact", 1));
  all.push_back(grid_problem("grid0", "5 x 5 cloth with drag, to 5 s", 5, 5));
  all.push_back(
      grid_problem("grid1", "25 x 25 cloth with drag, to 0.5 s", 0.5, 25));
  all.push_back(grid_problem("grid1-short",
                             "25 x 25 cloth with drag, to 0.25 s", 0.25, 25));
  all.push_back(grid_problem("stiff", "25 x 25 cloth, K = 10000 N/m, to 0.25 s",
                             0.25, 25, 1e4));
  all.push_back(mixed_problem());
  all.push_back(graded_problem());
  all.push_back(grid_problem(
      "settles", "25 x 25 cloth, K = 1e5 N/m, drag of 4/s, at rest after 5 s",
      5, 25, 1e5));
  all.back().gamma = 4;
  all.back().norm = Norm::functionals;
  all.back().rests = true;
  all.push_back(grid_problem(
      "large", "100 x 100 cloth, a side of which is lifted, to 0.1 s", 0.1,
      100));
  all.back().driven = true;
  all.back().constraint = [](const Cloth& g) {
    return make_combined_constraints(PinnedNodes(side_of(g), {Point(0, 0, 1)}));
  };
  all.push_back(grid_problem(
      "drape", "25 x 25 cloth falling on a ball, to 0.4 s", 0.4, 25));
  all.back().constraint = on_a_ball;
  all.back().norm = Norm::functionals;
  all.push_back(grid_problem(
      "slide", "25 x 25 cloth thrown on a floor, rubs and stops, to 0.5 s", 0.5,
      25));
  all.back().gamma = 0;
  all.back().constraint = [](const Cloth&) {
    return make_combined_constraints(rub);
  };
  all.back().build = [build = all.back().build](Cloth& g) {
    build(g);
    for (Node n : g.nodes()) {
      n.position().z = 0.05;
      n.value().vel = Point(1, 0, 0);
    }
  };
  all.back().norm = Norm::functionals;
  all.push_back(grid_problem(
      "tear", "25 x 25, drag, pins, floor and tearing ball (7.2), to 0.4 s",
      0.4, 25));
  all.back().constraint = torn_by_a_ball;
  all.back().norm = Norm::functionals;
  return all;
}

}  // namespace lab
