#include <algorithm>
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
  Model m;
  m.name = std::move(name), m.t_end = t_end, m.gravity = 0;
  const unsigned n = chain.n;
  Net net{.points = chain.exact(0)};
  for (unsigned j = 0; j <= n; ++j)
    net.springs.push_back({j, j + 1, chain.K, chain.rest / (n + 1)});
  net.masses.assign(n + 2, 1.0 / n);
  net.held = {0, n + 1};
  Problem p(m, std::move(about), net);
  p.exact = [chain](double t) { return chain.exact(t); };
  return p;
}

Problem curtain_problem(std::string name, std::string about, double t_end,
                        unsigned n) {
  Model model;
  model.name = std::move(name), model.t_end = t_end;
  model.sheets = {{.v = Point(0, 0, -1), .nodes = {n, n}}};
  model.edges.diagonals = false;
  model.pins = {{.z = 0}};
  Problem p(model, std::move(about));
  p.exact = [=, K = model.stiffness](double t) {
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
  };
  return p;
}

namespace {

/** grid_problem() as a scene. */
Model grid(std::string name, double t_end, unsigned side = 25, double K = 100) {
  Model m;
  m.name = std::move(name), m.t_end = t_end, m.stiffness = K;
  m.sheets = {{.nodes = {side, side}}};
  m.pins = {{.x = 0, .y = 0}, {.x = 1, .y = 0}};
  m.damping = 1.0 / (side * side);
  return m;
}

}  // namespace

Problem grid_problem(std::string name, std::string about, double t_end,
                     unsigned side, double K) {
  return {grid(std::move(name), t_end, side, K), std::move(about)};
}

Problem mixed_problem() {
  Model m = grid("mixed", 0.1);
  m.pins = {{.y = 0}};
  m.regions = {{.box = {Point(0, 0, 0), Point(0.09, 1, 0)}, .stiffness = 1e4}};
  return {m, "25 x 25 cloth, a band of K = 1e6 N/m, held at a side, to 0.1 s"};
}

namespace {

/** Columns that become narrower from right to left, down to a sixteenth; masses
 * by area, K of a spring by 1/length. */
Problem graded_problem() {
  Model m = grid("graded", 0.25);
  m.damping = 0;
  Problem p(m, "25 x 25 cloth, columns of width 1 to 1/16, to 0.25 s");
  constexpr unsigned side = 25;
  const double ratio = std::pow(16, 1. / (side - 2));
  auto& x = p.mesh.points;
  for (Point& q : x)  // q.x: 0, 1/24 ... 1
    q.x = (std::pow(ratio, q.x * (side - 1)) - 1) /
          (std::pow(ratio, side - 1) - 1);
  p.mesh.masses.resize(x.size());
  for (const Quad& q : p.mesh.quads) {
    const double area = norm(x[q[0]] - x[q[1]]) * norm(x[q[1]] - x[q[2]]);
    for (unsigned i : q) p.mesh.masses[i] += area / 4;
  }
  Cloth g;
  p.build(g);
  for (Edge e : g.edges())
    p.mesh.springs.push_back(
        {e.node1().index(), e.node2().index(), 100. / 24 / e.value().L});
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
  std::vector<Problem> all = {
      chain_problem("chain", "20 masses between two walls, to 0.8 s; exact",
                    0.8),
      curtain_problem("curtain", "16 x 16 curtain let go, to 1 s; exact", 1),
      grid_problem("grid0", "5 x 5 cloth with drag, to 5 s", 5, 5),
      {grid("grid1", 0.5), "25 x 25 cloth with drag, to 0.5 s"},
      {grid("grid1-short", 0.25), "25 x 25 cloth with drag, to 0.25 s"},
      {grid("stiff", 0.25, 25, 1e4), "25 x 25 cloth, K = 10000 N/m, to 0.25 s"},
      mixed_problem(),
      graded_problem()};
  Model m = grid("settles", 5, 25, 1e5);
  m.damping *= 4;
  all.emplace_back(
      m, "25 x 25 cloth, K = 1e5 N/m, drag of 4/s, at rest after 5 s");
  all.back().norm = Norm::functionals, all.back().rests = true;
  m = grid("large", 0.1, 100);
  m.pins = {{.y = 0, .motion = {Point(0, 0, 1)}}};
  all.emplace_back(m, "100 x 100 cloth, a side of which is lifted, to 0.1 s");
  all.emplace_back(grid("drape", 0.4),
                   "25 x 25 cloth falling on a ball, to 0.4 s");
  all.back().constraint = [](const Cloth& g) {
    return make_combined_constraints(PinConstraint(g), PlaneConstraint(),
                                     SphereConstraint());
  };
  all.back().norm = Norm::functionals;
  m = grid("slide", 0.5);
  m.damping = 0, m.pins = {};
  m.sheets[0].at.z = 0.05, m.sheets[0].velocity.x = 1;
  all.emplace_back(m,
                   "25 x 25 cloth thrown on a floor, rubs and stops, to 0.5 s");
  all.back().norm = Norm::functionals;
  all.back().constraint = [](const Cloth&) {
    return make_combined_constraints(rub);
  };
  m = grid("tear", 0.4);
  m.planes = {{}}, m.tears = {{}};
  all.emplace_back(
      m, "25 x 25, drag, pins, floor and tearing ball (7.2), to 0.4 s");
  all.back().norm = Norm::functionals;
  return all;
}

}  // namespace lab
