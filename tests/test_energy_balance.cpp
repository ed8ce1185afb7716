// EnergyBalance.hpp, Guard.hpp and the end of a run: the work of what moves
// against exact energies; what the guard stops and what it lets pass, by whole
// scenes; and runs that end on time.
#include <gtest/gtest.h>

#include <cmath>

#include "lab/charts/Problem.hpp"
#include "lab/fast/Energy.hpp"
#include "lab/methods/Methods.hpp"
#include "lab/methods/Splitting.hpp"
#include "lab/stepping/Scene.hpp"
#include "tests/Says.hpp"

using namespace lab;

namespace {

/** A sheet of side x side nodes over the unit square, without gravity. */
Model sheet(unsigned side, std::string_view method, double dt) {
  Model m;
  m.sheets = {{.nodes = {side, side}}};
  m.gravity = 0;
  m.method = find_method(method);
  m.step = {.dt = dt};
  return m;
}
Pin pin_at_x(double x, Motion motion = {}) { return {x, {}, {}, {}, motion}; }
/** Energy that did not come from its start nor from what moves it [J]. */
double gain(const Scene& s) {
  return energies(s.cloth(), s.model().gravity).total() - s.flow().work +
         s.flow().removed;
}

// ----------------------------------------------------------------------- Work

// Nodes inside an obstacle at t = 0 are moved out: that is its work, the same
// for every step, and no divergence.
TEST(Work, OfAnObstacleOnNodesThatStartInIt) {
  for (const char* method : {"symplectic-euler", "verlet", "rk4"})
    for (double dt : {1e-5, 1e-3}) {
      Model m = sheet(9, method, dt);
      m.gravity = grav;
      m.pins = {pin_at_x(0)};
      m.spheres = {Solid{Ball{Point(0.5, 0.5, 0.05), 0.3}, 0, {}}};
      Scene s(m);
      EXPECT_NEAR(s.flow().work, 34.402, 1e-3);
      EXPECT_NEAR(gain(s), 0, 1e-9);
      EXPECT_TRUE(s.run_to(0.1)) << text_of(s.failure());
    }
}

// Drag brings a loose sheet to the velocity of the air; what the air gives and
// takes is counted.
TEST(Work, OfTheWind) {
  for (const char* method : {"verlet", "rk4", "implicit-euler"}) {
    Model m = sheet(5, method, 0.001);
    m.damping = 2 / 25.;  // gamma = 2/s
    m.wind = Wind{Point(3, 0, 1)};
    Scene s(m);
    s.stepper().follow_drag();
    ASSERT_TRUE(s.run_to(1));
    const Point v = -std::expm1(-2.) * m.wind->velocity;
    EXPECT_LT(norm(s.cloth().node(7).value().vel - v), 0.01) << method;
    EXPECT_NEAR(s.energy().total(), 0.5 * normSq(v), 0.03);
    EXPECT_NEAR(s.flow().drag, -s.energy().total(), 0.005);
  }
}

// It hits all nodes at once, and they stay on it: 1 kg gets a speed of V, and
// the work is m V^2, twice the energy, as the impact is inelastic.
TEST(Work, OfAWallThatHitsASheetIsTwiceItsEnergy) {
  Model m = sheet(6, "verlet", 0.001);
  m.sheets[0].at = Point(0, 0, 0.01);
  m.planes = {{.at = Point(), .motion = {Point(0, 0, 10)}}};
  Scene s(m);
  ASSERT_TRUE(s.run_to(0.1));
  EXPECT_NEAR(s.flow().work, 100, 1e-9);
  EXPECT_NEAR(kinetic_energy(s.cloth()), 50, 1e-9);
  EXPECT_NEAR(center_of_mass(s.cloth()).z, 1, 1e-12);
}

// It lifts 1 kg: m g V t, and m V^2 at first.
TEST(Work, OfAFloorThatLiftsASheet) {
  for (double V : {0.5, -0.5}) {
    Model m = sheet(5, "verlet", 0.001);
    m.gravity = grav;
    m.planes = {{.at = Point(), .motion = {Point(0, 0, V)}}};
    Scene s(m);
    ASSERT_TRUE(s.run_to(1));
    EXPECT_NEAR(center_of_mass(s.cloth()).z, V, 2e-3);
    const double reached = V > 0 ? 0 : -V / grav;  // it falls behind at first
    EXPECT_NEAR(s.flow().work, grav * V * (1 - reached) + (V > 0 ? V * V : 0),
                0.2)
        << V;
  }
}

// Pins put held nodes back, so that no energy goes into them, whatever the
// step. The floor hits the 12 other nodes once: that takes half of its work.
TEST(Work, OfAnObstacleOnHeldNodesIsNone) {
  for (double dt : {1e-3, 1e-4}) {
    Model m = sheet(5, "verlet", dt);
    m.pins = {{{}, 0, {}, {}, {}}, pin_at_x(0), pin_at_x(1)};
    m.planes = {{.at = Point(0, 0, -0.1), .motion = {Point(0, 0, 1)}}};
    Scene s(m);
    ASSERT_TRUE(s.run_to(0.2));
    EXPECT_NEAR(gain(s), -12 / 50., 1e-3) << dt;
  }
}

// What hangs below 0 takes negative energy with it when it is torn away.
TEST(Flow, CountsTheEnergyOfNodesThatAreRemoved) {
  for (bool by_call : {false, true}) {
    Cloth g;
    build_cloth(g, grid_points(5), grid_quads(5), MeshSprings::diagonals);
    for (Node n : g.nodes()) n.position().z = -2;
    const TearConstraint tear(Ball{Point(0.5, 0.5, -2), 0.3});
    auto call = [&](Cloth& cloth, double t) { tear(cloth, t); };
    const ConstraintPlan plan =
        by_call ? ConstraintPlan(make_combined_constraints(call))
                : ConstraintPlan(tear);
    EnergyBalance balance(g, 0, make_combined_force(GravityForce()), plan, 10);
    const double before = gravitational_energy(g, 10);
    plan(g, 0);
    balance.follow(g, 0, plan);
    EXPECT_EQ(g.num_nodes(), 20u);
    EXPECT_NEAR(balance.flow().removed, -2 * 10 * 5 / 25., 1e-12);
    EXPECT_NEAR(gravitational_energy(g, 10) + balance.flow().removed, before,
                1e-12);
    plan(g, 0);
    balance.follow(g, 0, plan);
    EXPECT_NEAR(balance.flow().removed, -2 * 10 * 5 / 25., 1e-12);
    balance.resume(g, 0, plan, {});
    balance.follow(g, 0, plan);
    EXPECT_EQ(balance.flow().removed, 0);
  }
}

// ---------------------------------------------------------------------- Guard

/** Why @a m failed before its end; empty if it did not. */
std::string failure_of(const Model& m) {
  Scene s(m);
  s.run_to(m.t_end);
  return text_of(s.failure());
}

TEST(Guard, LetsPassStrongGravityAndSmallSheets) {
  Model strong = sheet(8, "verlet", 1e-6);
  strong.pins = {pin_at_x(0)};
  strong.gravity = 1e8;
  strong.t_end = 1e-3;
  EXPECT_EQ(failure_of(strong), "");
  for (const MethodEntry& method : methods) {
    Model small = sheet(4, method.info.name, 1e-3);
    small.sheets[0].u = Point(1e-8, 0, 0), small.sheets[0].v = {0, 1e-8, 0};
    small.gravity = grav;
    small.t_end = 0.2;
    EXPECT_EQ(failure_of(small), "") << method.info.name;
  }
}

// An oscillation near the limit: its energy goes up to 1/(1 - y^2) times that
// of its start, which is not divergence; beyond the limit it is.
TEST(Guard, TellsAnOscillationFromDivergence) {
  Cloth g;
  Node wall = g.add_node(Point());
  Node mass = g.add_node(Point(1, 0, 0), {Point(), 1});
  g.add_edge(wall, mass, {1, 1});
  const std::array held = {wall};
  const PinConstraint pin(held);
  auto looks = [&](double y) {
    mass.position() = Point(1, 0, 0), mass.value().vel = Point(0.1, 0, 0);
    DivergenceGuard guard(g, 0, 2 * y);
    Verlet verlet;
    int n = 0;
    for (; n < 1000; ++n) {
      verlet(g, 0, 2 * y, MassSpringForce(), pin);
      if (!guard.accept(g)) break;
    }
    return n;
  };
  EXPECT_EQ(looks(0.5), 1000);
  EXPECT_EQ(looks(0.85), 1000);
  EXPECT_LT(looks(1.02), 50);
}

TEST(Guard, StopsWhatHasAnEnergyThatIsNotFinite) {
  Model m = sheet(5, "verlet", 0.001);
  m.gravity = 1e300;
  EXPECT_NE(failure_of(m), "");
  m.t_end = 0;
  m.sheets[0].at = Point(0, 0, 1e10);
  EXPECT_TRUE(begins(failure_of(m), "the energy at the start is not finite"));
}

// ------------------------------------------------------------------------ End

TEST(End, IsReachedToRoundOffWhateverTheStep) {
  struct {
    double t_end, dt;
    long long steps;
  } const runs[] = {
      {5, 0.001, 5000},      {0.07, 0.01, 7},     {0.0333, 0.01, 4},
      {0.25, 0.003, 84},     {0.001, 0.01, 1},    {1e-13, 0.01, 1},
      {0.3, 0.1, 3},         {0.31, 0.1, 4},      {1, 1. / 3, 3},
      {0.1 + 1e-12, 0.1, 1}, {0.1 + 1e-8, 0.1, 2}};
  for (const auto& [t_end, dt, steps] : runs) {
    Scene s(sheet(2, "verlet", dt));
    EXPECT_TRUE(s.run_to(t_end));
    EXPECT_EQ(s.time(), t_end);
    EXPECT_EQ(s.steps(), steps) << t_end << ' ' << dt;
    EXPECT_TRUE(s.run_to(t_end + 1.5 * dt));  // and goes on from there
    EXPECT_EQ(s.steps(), steps + 2);
  }
}

// The order that a method declares, through last steps that are shorter.
TEST(End, KeepsTheOrderThroughShorterSteps) {
  const Problem p = chain_problem("", "", 1);
  for (const MethodEntry& method : methods) {
    if (method.info.order > 4 || method.info.adaptive) continue;
    if (method.info.limit == 0 || method.info.name == "xpbd") continue;
    const double n = method.info.order == 1          ? 2000
                     : method.info.limit == no_limit ? 300
                                                     : 160;
    for (double rest : {0.3, 0.9}) {
      double error[2];
      for (int k : {0, 1}) {
        Scene s(p, p.mesh, {.dt = 1 / ((1 + k) * n + rest)}, method);
        ASSERT_TRUE(s.run_to(1));
        const auto right = p.exact(1);
        error[k] = 0;
        for (unsigned i = 0; i < right.size(); ++i)
          error[k] = std::max<double>(
              error[k], norm(s.cloth().node(i).position() - right[i]));
      }
      EXPECT_NEAR(std::log2(error[0] / error[1]), method.info.order, 0.35)
          << method.info.name << ' ' << rest << ' ' << error[0];
    }
  }
}

}  // namespace
