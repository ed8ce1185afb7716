// Equilibrium.hpp, against closed forms and against motion with drag.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <numbers>

#include "lab/fast/Sweep.hpp"
#include "lab/methods/Methods.hpp"
#include "lab/scenes/Measure.hpp"
#include "lab/stepping/RestReport.hpp"
#include "lab/stepping/Trial.hpp"
#include "tests/Says.hpp"

using namespace lab;

namespace {

/** The scene of a net and @a m, at rest. */
std::unique_ptr<Scene> at_rest(const Net& net, Model m = {}) {
  m.from_rest = true;
  return std::make_unique<Scene>(m, net);
}
std::unique_ptr<Scene> at_rest(Model m) {
  m.from_rest = true;
  return std::make_unique<Scene>(m);
}

std::vector<Mode> modes_of(Scene& s, unsigned count) {
  return Equilibrium(s.model(), s.cloth(), s.force(), s.watched()).modes(count);
}

/** Springs in a row between two held ends, all in y = 0. */
Net chain(unsigned springs, double span, double K, double L, double m,
          double sag = 0) {
  Net net;
  for (unsigned k = 0; k <= springs; ++k) {
    const double s = double(k) / springs;
    net.points.emplace_back(span * s, 0, -4 * sag * s * (1 - s));
    net.masses.push_back(m);
    if (k > 0) net.springs.push_back({k - 1, k, K, L});
  }
  net.held = {0, springs};
  return net;
}

/** The discrete elastic catenary of chain(): forces of all springs add up, and
 * the horizontal one H [N] makes their span. */
struct Catenary {
  std::vector<Point> points;
  double H, V;  // at the ends [N]
  Catenary(unsigned n, double span, double K, double L, double m) {
    V = m * grav * (n - 1) / 2;
    const auto hang = [&] {
      Point p;
      points = {p};
      for (unsigned k = 0; k < n; ++k) {
        const double v = V - k * m * grav, T = std::hypot(H, v);
        p += (L / T + 1 / K) * Point(H, 0, -v);
        points.push_back(p);
      }
      return p.x;
    };
    double low = 0, high = K * span;
    for (int k = 0; k < 200; ++k)
      (hang() < span ? low : high) = H = (low + high) / 2;
    hang();
  }
};

TEST(Rest, ChainsHangAsCatenaries) {
  for (unsigned n : {10u, 100u, 1000u}) {
    const double K = 10. * n, L = 1. / n, m = 0.1 / n;
    const auto s = at_rest(chain(n, 0.8, K, L, m));
    const Catenary c(n, 0.8, K, L, m);
    for (unsigned k = 0; k <= n; ++k)
      ASSERT_LT(norm(s->cloth().node(k).position() - c.points[k]), 1e-8) << n;
    if (n > 10) continue;
    EXPECT_NEAR(c.H, .293952909693, 1e-12);
    EXPECT_NEAR(s->cloth().node(5).position().z, -.296746705662, 1e-10);
  }
}

TEST(Rest, SteelCable) {
  const double K = 157079633, L = 0.1, m = 0.0616537558;
  const auto s = at_rest(chain(20, 1.6, K, L, m, 0.6));
  const Catenary c(20, 1.6, K, L, m);
  Measure at_left = Measure::pin_force;
  at_left.pin.x = 0;
  const double force = answer(*s, at_left)[0];
  EXPECT_NEAR(force, 7.553, 5e-4);
  EXPECT_NEAR(force, std::hypot(c.H, c.V + m * grav), 1e-6);
}

TEST(Rest, ALoadedStringHasItsFrequencies) {
  // T = 10 N; across and along, w_k = 2 sqrt(K/m) sin(k pi/(2 n)).
  const unsigned n = 20;
  Model m;
  m.gravity = 0;
  const double l = 0.05, L = 0.04, T = 10, K = T / (l - L), mass = 0.01;
  const auto s = at_rest(chain(n, n * l, K, L, mass), m);
  EXPECT_EQ(s->rest()->factors, 0);
  std::vector<double> expected;
  for (unsigned k = 1; k < n; ++k)
    for (double stiffness : {T / l, T / l, K})
      expected.push_back(4 * stiffness / mass *
                         std::pow(std::sin(k * std::numbers::pi / (2 * n)), 2));
  std::ranges::sort(expected);
  const auto modes = modes_of(*s, 10);
  ASSERT_EQ(modes.size(), 10u);
  for (unsigned k = 0; k < 10; ++k)
    EXPECT_NEAR(modes[k].square, expected[k], 1e-8 * expected[k]) << k;
  EXPECT_NEAR(2 * std::numbers::pi / std::sqrt(modes[0].square), .28313, 1e-5);
}

/** Two bars to an apex at height @a h, which carries 20 N. */
Net truss(double h) {
  Net net;
  net.points = {Point(-1, 0, 0), Point(1, 0, 0), Point(0, 0, h)};
  net.masses = {1, 1, 20 / grav};
  const double L = std::sqrt(1.25);
  net.springs = {{0, 2, 1000, L}, {1, 2, 1000, L}};
  net.held = {0, 1};
  return net;
}

TEST(Rest, ATrussSnapsThrough) {
  const double L = std::sqrt(1.25);
  const auto load = [L](double h) {
    const double l = std::hypot(1, h);
    return 2000 * (L - l) * h / l;
  };
  // The modes are one along each axis. Sideways, only tension holds the apex.
  const auto along_z = [](Scene& s) {
    for (const Mode& mode : modes_of(s, 3))
      if (std::abs(mode.shape[2].z) > 0.1) return mode.square;
    return 0.;
  };
  for (const auto& [start, end] : {std::pair(0.5, 0.4419190),
                                   {0.3, 0.4419190},
                                   {0.05, -0.5451193},
                                   {-0.8, -0.5451193}}) {
    const auto s = at_rest(truss(start));
    const double h = s->cloth().node(2).position().z;
    EXPECT_NEAR(h, end, 1e-7) << start;
    EXPECT_NEAR(load(h), 20, 1e-7);
    const double slope = (load(h + 1e-5) - load(h - 1e-5)) / 2e-5;
    EXPECT_NEAR(along_z(*s), -slope * grav / 20, 1e-4);
    EXPECT_GT(along_z(*s), 0);
  }
  double low = 0, high = 0.27;
  for (int k = 0; k < 100; ++k)
    (load((low + high) / 2) < 20 ? low : high) = (low + high) / 2;
  EXPECT_NEAR(low, .0879217, 1e-7);
  const auto s = at_rest(truss(low));
  EXPECT_EQ(s->rest()->factors, 0);
  EXPECT_LT(along_z(*s), 0);
}

Model sheet(unsigned n, std::vector<Pin> pins) {
  Model m;
  m.sheets = {{.nodes = {n, n}}};
  m.pins = std::move(pins);
  return m;
}
const std::vector<Pin> corners = {
    {.x = 0, .y = 0}, {.x = 1, .y = 0}, {.x = 0, .y = 1}, {.x = 1, .y = 1}};

TEST(Rest, PinsCarryTheWeight) {
  const auto s = at_rest(sheet(9, {corners[0], corners[1]}));
  Point sum;
  for (const HeldNodes& h : s->held())
    for (const auto& held : h.nodes)
      sum += s->force()(arrays(s->cloth()).node_with_id(held.id), 0);
  EXPECT_LT(norm(sum - Point(0, 0, -grav)), 1e-9 * grav);
  EXPECT_GT(modes_of(*s, 1)[0].square, 0);
}

TEST(Rest, ForcesBalanceOnABallAndAFloor) {
  Model m = sheet(11, corners);
  m.spheres.push_back({.ball = {Point(0.5, 0.45, -0.3), 0.35}, .motion = {}});
  m.planes.push_back({.at = Point(0, 0, -0.07), .motion = {}});
  m.stiffness = 30;
  const auto s = at_rest(m);
  EXPECT_TRUE(s->rest()->found());
  unsigned on_ball = 0, on_floor = 0;
  double left = 0;
  for (Node n : s->cloth().nodes()) {
    if (s->is_pinned(n.id())) continue;
    const Point arm = n.position() - m.spheres[0].ball.center;
    const double height = norm(arm) - 0.35, z = n.position().z + 0.07;
    EXPECT_GT(height, -1e-12);
    EXPECT_GT(z, -1e-12);
    Point f = s->force()(n, 0);
    const Point out = height < 1e-9 ? arm / norm(arm) : Point(0, 0, 1);
    if (height >= 1e-9 && z >= 1e-9) {
      left += normSq(f);
      continue;
    }
    ++(height < 1e-9 ? on_ball : on_floor);
    EXPECT_FALSE(height < 1e-9 && z < 1e-9) << "both, which is not tested here";
    EXPECT_LT(dot(f, out), 1e-9) << "it is pushed, not held";
    left += normSq(f - dot(f, out) * out);
  }
  EXPECT_GT(on_ball, 3u);
  EXPECT_GT(on_floor, 3u);
  EXPECT_LT(std::sqrt(left), 1e-10 * grav);
  const auto lowest = modes_of(*s, 3);
  for (const Mode& mode : lowest)
    for (Node n : s->cloth().nodes()) {
      const Point arm = n.position() - m.spheres[0].ball.center;
      if (norm(arm) > 0.35 + 1e-9) continue;
      EXPECT_NEAR(dot(mode.shape[n.id()], arm), 0, 1e-9);
    }
}

TEST(Rest, AWeightOnTopOfABallIsUnstable) {
  Net net;
  net.points = {Point(0, 0, 0.5)};
  net.masses = {2};
  Model m;
  m.spheres.push_back({.ball = {Point(), 0.5}, .motion = {}});
  const auto s = at_rest(net, m);
  const auto modes = modes_of(*s, 3);
  ASSERT_EQ(modes.size(), 2u) << "the surface takes a direction";
  for (const Mode& mode : modes) EXPECT_NEAR(mode.square, -grav / 0.5, 1e-8);
  m.spheres[0].friction = 0.5;
  net.points[0] = Point(0.1, 0, 1);
  EXPECT_TRUE(has(error_of([&] { at_rest(net, m); }), "node 0, which falls"));
}

TEST(Rest, ALooseClothOnAFloorMovesFreely) {
  Model m = sheet(4, {});
  m.planes.push_back({.at = Point(0, 0, -0.5), .motion = {}});
  const auto s = at_rest(m);
  Equilibrium here(s->model(), s->cloth(), s->force(), s->watched());
  const auto modes = here.modes(5);
  for (unsigned k = 0; k < 5; ++k)
    EXPECT_EQ(std::abs(modes[k].square) < here.zero(), k < 3) << k;
  EXPECT_NEAR(answer(*s, Measure::contact_force)[0], grav, 1e-9);
  EXPECT_TRUE(has(error_of([] { at_rest(sheet(3, {})); }), "falls without"));
}

TEST(Rest, IsWhereDragEnds) {
  for (const bool floor : {false, true}) {
    Model m = sheet(5, {corners[0], corners[1]});
    if (floor) m.planes.push_back({.at = Point(0, 0, -0.4), .motion = {}});
    m.from_rest = true;
    Scene still(m);
    const double slow = std::sqrt(modes_of(still, 1)[0].square);
    ASSERT_GT(slow, 0.1);
    m.from_rest = false, m.method = &table::verlet, m.step.dt = 0.005;
    m.damping = 2 * slow / 25;
    Scene moves(m);
    ASSERT_TRUE(moves.run_to(60 / slow));
    for (unsigned k = 0; k < 25; ++k)
      EXPECT_LT(norm(moves.cloth().node(k).position() -
                     still.cloth().node(k).position()),
                1e-7)
          << k << ' ' << floor;
  }
}

Measure tension(unsigned i, unsigned j) {
  Measure m = Measure::tension;
  m.between = {i, j};
  return m;
}

TEST(Net, CablesHangAsSpringsDo) {
  Net net = chain(10, 0.8, 100, 0.1, 0.01);
  for (Spring& s : net.springs) s.acts = Acts::pulls;
  const auto s = at_rest(net);
  const Catenary c(10, 0.8, 100, 0.1, 0.01);
  for (unsigned k = 0; k < 10; ++k) {
    EXPECT_LT(norm(s->cloth().node(k).position() - c.points[k]), 1e-8);
    EXPECT_NEAR(answer(*s, tension(k + 1, k))[0],
                std::hypot(c.H, c.V - k * 0.01 * grav), 1e-7);
  }
  EXPECT_NEAR(answer(*s, Measure::max_tension)[0], std::hypot(c.H, c.V), 1e-7);
  EXPECT_TRUE(has(error_of([&] { answer(*s, tension(0, 2)); }), "no spring"));
}

TEST(Net, ASlackSpringCarriesNothing) {
  for (const Acts acts : {Acts::pulls, Acts::pushes}) {
    const bool pulls = acts == Acts::pulls;
    Net net;  // a weight between two held nodes, pushed to one of them
    net.points = {Point(-1, 0, 0), Point(1, 0, 0), Point()};
    net.springs = {{0, 2, 100, 1, acts}, {2, 1, 100, 1, acts}};
    net.held = {0, 1};
    net.loads = {{2, Point(4, 0, 0)}, {2, Point(6, 0, 0)}, {0, Point(0, 0, 5)}};
    Model m;
    m.gravity = 0, m.from_rest = true;
    Scene s(m, net), moves(m, net, {.dt = 0.001}, table::xpbd);
    ASSERT_TRUE(moves.run_to(0.1));
    for (const auto& [scene, error] : {std::pair(&s, 1e-8), {&moves, 0.01}}) {
      EXPECT_NEAR(scene->cloth().node(2).position().x, 0.1, error) << "F/K";
      EXPECT_NEAR(answer(*scene, tension(0, 2))[0], pulls ? 10 : 0, error);
      EXPECT_NEAR(answer(*scene, tension(1, 2))[0], pulls ? 0 : -10, error);
      EXPECT_NEAR(answer(*scene, Measure::pin_force)[0], std::hypot(10, 5),
                  error);
    }
    EXPECT_NEAR(s.energy().elastic, 0.5, 1e-9) << "F^2/2K";
    EXPECT_NEAR(s.energy().gravitational, -1, 1e-9) << "-F x";
    const RestReport report(s);
    EXPECT_EQ(report.stable(), pulls) << "a strut buckles";
    EXPECT_TRUE(has(report.text(), pulls ? "slack: that of nodes 2 and 1\n"
                                         : "slack: that of nodes 0 and 2\n"));
    EXPECT_EQ(net_left(s.cloth(), s.mesh(), s.held()).springs[0].acts, acts);
  }
}

TEST(Net, AWeightFallsUntilItsCableIsTaut) {
  Net net;
  net.points = {Point(), Point(0, 0, -0.5)};
  net.masses = {1, 1};
  net.springs = {{0, 1, 1000, 1, Acts::pulls}};
  net.held = {0};
  net.loads = {{1, Point(3, 0, 0)}};
  for (const MethodEntry& method : methods) {
    Scene s({}, net, {.dt = 0.001}, method);
    ASSERT_TRUE(s.run_to(0.25)) << method.info.name;
    const double t2 = 0.25 * 0.25 / 2;
    EXPECT_LT(
        norm(s.cloth().node(1).position() - Point(3 * t2, 0, -0.5 - grav * t2)),
        method.info.order > 1 ? 1e-9 : 2e-3)
        << method.info.name;
    EXPECT_EQ(s.energy().elastic, 0) << method.info.name;
    if (const double safe = s.safe_limit(); safe < no_limit) {
      EXPECT_NEAR(s.stepper().sharp_limit(), safe, 1e-3 * safe) << "if taut";
    }
    if (method.info.limit == 0) continue;
    ASSERT_TRUE(s.run_to(1)) << method.info.name;
    EXPECT_GT(norm(s.cloth().node(1).position()), 0.5) << method.info.name;
  }
  Scene fine({}, net, {.dt = 1e-5}, table::verlet);
  const double start = fine.energy().total();
  ASSERT_TRUE(fine.run_to(2));
  EXPECT_NEAR(fine.energy().total(), start, 1e-3);
  Model tears;
  tears.tears = {{Point(), 1}};
  EXPECT_TRUE(has(error_of([&] { Scene(tears, net); }), "--tear removes"));
}

TEST(Net, HasTheSameBitsForEveryNumberOfThreads) {
  Net net;
  net.points = grid_points(40);
  for (const Quad& q : grid_quads(40))
    for (const unsigned k : {1u, 2u, 3u})
      net.springs.push_back(
          {q[0], q[k], 100, -1, k == 3 ? Acts::pushes : Acts::pulls});
  net.held = {0, 39};
  std::vector<std::vector<Point>> ends;
  for (const int threads : {1, 3, 0}) {
    Sweep::set_threads(threads);
    Scene s({}, net, {.dt = 5e-4}, table::verlet);
    ASSERT_TRUE(s.run_to(0.05));
    const auto x = arrays(s.cloth()).positions();
    ends.emplace_back(x.begin(), x.end());
  }
  EXPECT_EQ(ends[0], ends[1]);
}

TEST(Rest, ARunBeginsThere) {
  Model m = sheet(5, {corners[0], corners[1]});
  m.from_rest = true, m.method = &table::verlet, m.step.dt = 0.002;
  m.sheets[0].velocity = Point(0, 0, 4);
  Scene s(m);
  const Point before = s.cloth().node(12).position();
  EXPECT_LT(before.z, -0.2);
  ASSERT_TRUE(s.run_to(1));
  EXPECT_LT(norm(s.cloth().node(12).position() - before), 1e-8);
  s.restart();
  EXPECT_EQ(s.cloth().node(12).position(), before);
  EXPECT_EQ(s.finer()->cloth().node(12).position(), before);
}

}  // namespace
