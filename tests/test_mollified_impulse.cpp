// The mollified impulse method: which springs it splits off, that it is Verlet
// where there are none, its order, its limit as theory has it, and what it
// saves on a soft cloth with stiff springs.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "lab/charts/Problem.hpp"
#include "lab/methods/Methods.hpp"
#include "lab/methods/MollifiedImpulse.hpp"
#include "lab/methods/Splitting.hpp"
#include "lab/methods/StiffSplit.hpp"
#include "lab/scenes/Contact.hpp"
#include "lab/stability/Spectrum.hpp"
#include "lab/stepping/Trial.hpp"
#include "tests/Allocations.hpp"
#include "tests/Momentum.hpp"
#include "tests/NetOf.hpp"

using namespace lab;

namespace {

/** The edge in the middle of a cloth. */
Edge middle_edge(const Cloth& g) { return g.edge(g.num_edges() / 2 + 1); }

/** A cloth of @a side x @a side nodes, K = 100 N/m, pinned at its corners, one
 * edge of which is of 1e6 N/m. */
Problem stiff_edge(unsigned side, double t_end) {
  Problem p = grid_problem("stiff-edge", "one stiff edge", t_end, side);
  p.damping = 0;
  const Start s(p);
  const Edge e = middle_edge(s.cloth);
  p.mesh.springs = {{e.node1().index(), e.node2().index(), 1e6}};
  return p;
}

/** The smallest number of steps of Verlet that are stable on @a p. */
long long least_of_verlet(const Problem& p) {
  const Start s(p);
  return std::llround(
      std::ceil(p.t_end * omega_safe(s.cloth, s.force, s.constraint) / 2));
}

TEST(StiffSplit, TakesTheStiffEdgesOfASoftCloth) {
  Start s(stiff_edge(9, 1));
  const Edge stiff = middle_edge(s.cloth);
  const StiffSplit split = split_springs(s.cloth, 1, s.constraint);
  ASSERT_EQ(split.springs.size(), 1u);
  EXPECT_EQ(split.springs[0].edge, stiff.id());
  EXPECT_EQ(split.nodes.size(), 2u);
  for (unsigned i = 0; i < s.cloth.num_nodes(); ++i)
    EXPECT_EQ(split.find(i) < 2,
              i == stiff.node1().id() || i == stiff.node2().id());
  EXPECT_NEAR(split.omega, std::sqrt(1e6 * 2 * 81), 1e-6);
  // Two in a row: |1 -1 0; -1 2 -1; 0 -1 1| has 3, the bound is 3.
  for (Edge e : stiff.node1().edges())
    if (e != stiff) {
      e.value().K = 1e6;
      break;
    }
  const StiffSplit two = split_springs(s.cloth, 1, s.constraint);
  EXPECT_EQ(two.springs.size(), 2u);
  EXPECT_EQ(two.nodes.size(), 3u);
  EXPECT_NEAR(two.omega, std::sqrt(1e6 * 3 * 81), 1e-6);
  EXPECT_NEAR(split_springs(s.cloth, 2, s.constraint).omega,
              std::sqrt(2e6 * 3 * 81), 1e-6);
  EXPECT_TRUE(split_springs(s.cloth, 0, s.constraint).empty());
}

TEST(StiffSplit, TakesNoneWhereSpringsAreAlikeOrMostAreStiff) {
  Start s(grid_problem("", "", 1, 9));
  EXPECT_TRUE(split_springs(s.cloth, 1, s.constraint).empty());
  for (Edge e : s.cloth.edges()) e.value().K *= e.index() % 2 ? 1 : 4;
  EXPECT_TRUE(split_springs(s.cloth, 1, s.constraint).empty());
  for (Edge e : s.cloth.edges()) e.value().K = e.index() % 9 ? 1e6 : 100;
  EXPECT_TRUE(split_springs(s.cloth, 1, s.constraint).empty());
}

TEST(MollifiedImpulse, GetsTheStepOfTheSoftSprings) {
  const Problem stiff = stiff_edge(9, 1), soft = grid_problem("", "", 1, 9);
  const auto step_of = [](const Problem& p, const char* method) {
    const Start start(p);
    Scene scene(Model(), net_of(start.cloth, start.constraint),
                {.rule = StepRule::safe}, *find_method(method));
    EXPECT_TRUE(scene.run_to(0.5)) << text_of(scene.failure());
    return scene.dt();
  };
  const double verlet = step_of(soft, "verlet");
  EXPECT_LT(step_of(stiff, "verlet"), verlet / 30);
  EXPECT_NEAR(step_of(stiff, "mollified-impulse") / verlet, 1, 0.02);
  EXPECT_EQ(step_of(soft, "mollified-impulse"), verlet);
}

TEST(MollifiedImpulse, IsVerletWhereSpringsAreAlike) {
  const Problem p = grid_problem("", "", 1, 9);
  Start a(p), b(p);
  MollifiedImpulse impulse;
  Verlet verlet;
  double t = 0;
  for (int n = 0; n < 50; ++n) {
    impulse.step(a.cloth, t, 0.005, a.force, a.constraint);
    t = verlet.step(b.cloth, t, 0.005, b.force, b.constraint);
  }
  EXPECT_TRUE(impulse.split().empty());
  EXPECT_EQ(end_of(a).positions, end_of(b).positions);
}

// The purpose of the method. Verlet needs its least stable number of steps
// whatever the tolerance is.
TEST(MollifiedImpulse, SavesForceEvaluationsOnASoftClothWithAStiffEdge) {
  const Problem p = stiff_edge(15, 0.3);
  const Reference right = reference(p, 4);
  const long long verlet = least_of_verlet(p);
  std::printf(
      "floor %.1e m; verlet at its limit, %lld evaluations: %.2e m\n",
      right.floor, verlet,
      distance(p, run(p, *table::verlet.make(), verlet).end, right.end));
  const auto error = [&](long long steps) {
    MollifiedImpulse impulse;
    const Outcome out = run(p, impulse, steps);
    EXPECT_TRUE(out.ok()) << out.reason;
    EXPECT_EQ(out.sweeps, steps + 1);
    EXPECT_EQ(impulse.split().springs.size(), 1u);
    const double e = distance(p, out.end, right.end);
    std::printf(
        "mollified-impulse, %lld evaluations, %lld inner steps: %.2e m\n",
        out.sweeps, out.work.inner, e);
    return e;
  };
  const double coarse = error(verlet / 30), fine = error(verlet / 4);
  EXPECT_NEAR(std::log(coarse / fine) / std::log(30 / 4.), 2, 0.4);
  EXPECT_LT(coarse, 2e-4);
  EXPECT_LT(error(verlet / 10), 3e-5);
}

TEST(MollifiedImpulse, CanBeTakenBackAndKeepsMomentum) {
  const Problem p = stiff_edge(9, 1);
  Start s(p);
  const std::vector<Point> start = end_of(s).positions;
  const auto force = make_combined_force(MassSpringForce());
  for (Node n : s.cloth.nodes())
    n.value().vel = Point(n.position().y, 0.3, n.position().x);
  const Point linear = momentum(s.cloth), angular = angular_momentum(s.cloth);
  for (int way = 0; way < 2; ++way) {
    MollifiedImpulse impulse;
    for (int n = 0; n < 100; ++n) impulse(s.cloth, 0.004 * n, 0.004, force);
    EXPECT_GT(impulse.work().inner, 2000);
    if (way == 0) {
      EXPECT_GT(norm(s.cloth.node(7).position() - start[7]), 0.01);
      EXPECT_LT(norm(momentum(s.cloth) - linear), 1e-12);
      // H changes with x, which the filter leaves out.
      EXPECT_LT(norm(angular_momentum(s.cloth) - angular),
                1e-5 * norm(angular));
    }
    for (Node n : s.cloth.nodes()) n.value().vel *= -1;
  }
  for (unsigned i = 0; i < start.size(); ++i)
    EXPECT_LT(norm(s.cloth.node(i).position() - start[i]), 1e-9);
}

/** A mass between two walls, on a stiff and on a soft spring in a line; and a
 * long row of soft springs at rest, which make it worth to split. */
struct StiffOscillator {
  Cloth g;
  Node mass;
  std::optional<PinConstraint> walls;
  double omega_f, omega_s;

  StiffOscillator(double f, double s) : omega_f(f), omega_s(s) {
    const std::vector<Node> ends = {g.add_node(Point(-1, 0, 0)),
                                    g.add_node(Point(1, 0, 0))};
    mass = g.add_node(Point());
    g.add_edge(ends[0], mass, {f * f, 1});
    g.add_edge(ends[1], mass, {s * s, 1});
    walls.emplace(ends);
    Node last = g.add_node(Point(0, 1, 0));
    for (int k = 1; k < 300; ++k) {
      const Node next = g.add_node(Point(k, 1, 0));
      g.add_edge(last, next, {s * s / 2, 1});
      last = next;
    }
  }
  /** Half the trace of a step of @a h. */
  double half_trace(double h) {
    double trace = 0;
    for (int column : {0, 1}) {
      const double size = 1e-4;
      mass.position() = Point(column == 0 ? size : 0, 0, 0);
      mass.value().vel = Point(column == 1 ? size : 0, 0, 0);
      MollifiedImpulse impulse;
      impulse(g, 0, h, MassSpringForce(), *walls);
      EXPECT_EQ(impulse.split().springs.size(), 1u);
      trace += (column == 0 ? mass.position().x : mass.value().vel.x) / size;
    }
    return trace / 2;
  }
};

// cos(a) - h (q omega_s)^2/(2 omega') sin(a), where a and omega' are those of n
// Verlet steps of h/n, and q = 1/(1 + (h omega_f/2)^2) is that of the filter
// and of the averaged position. Just below half periods of the stiff spring its
// absolute value exceeds 1, but little.
TEST(MollifiedImpulse, HasTheTraceOfTheory) {
  StiffOscillator o(100, 4);
  double most = 0;  // growth of a step
  for (double h = 1e-3; h < 0.48; h += 1e-3) {
    const double n = std::ceil(h * o.omega_f), y = h * o.omega_f / (2 * n),
                 a = 2 * n * std::asin(y),
                 omega = o.omega_f * std::sqrt(1 - y * y),
                 q = 1 / (1 + std::pow(h * o.omega_f / 2, 2)),
                 soft = std::pow(q * o.omega_s, 2);
    const double trace = std::cos(a) - h * soft / (2 * omega) * std::sin(a);
    EXPECT_NEAR(o.half_trace(h), trace, 1e-9) << h;
    most = std::max(most, std::sqrt(std::max(0., trace * trace - 1)));
  }
  EXPECT_LT(most, 1e-3);
}

/** A cloth of 81 to 169 nodes, pinned at two corners, without drag, drawn at
 * random: masses, velocities, and which springs are of 1e5 to 1e6 N/m. */
Problem drawn(const std::string& kind, unsigned seed) {
  std::mt19937 random(seed);
  const auto draw = [&random] { return double(random()) / 4294967296.; };
  Problem p = grid_problem(kind, kind, 1, 9 + random() % 5);
  p.damping = 0;
  Cloth g;
  p.build(g);
  const double K = std::pow(10, 5 + draw());
  const double spread = draw() / 2, speed = draw();
  for (Node n : g.nodes()) {
    n.value().mass *= 1 + spread * (2 * draw() - 1);
    for (int k : {0, 1, 2}) n.value().vel[k] = speed * (draw() - 0.5);
  }
  if (kind == "a band")
    for (Edge e : g.edges())
      if (e.node1().position().x + e.node2().position().x < 0.01)
        e.value().K = K;
  Edge any = g.edge(random() % g.num_edges());
  if (kind != "a band") any.value().K = K;
  for (Edge e : any.node1().edges())
    if (kind == "a triangle" && g.has_edge(e.node2(), any.node2())) {
      e.value().K = K;
      for (Edge f : any.node2().edges())
        if (f.node2() == e.node2()) f.value().K = K;
      break;
    }
  for (int k = 0; k < 2 && kind == "three edges"; ++k)
    g.edge(random() % g.num_edges()).value().K = K;
  p.mesh = net_of(g);
  // As pins of the scene, these nodes would start at rest.
  p.pins.clear();
  p.constraint = [](const Cloth& g) {
    return make_combined_constraints(PinConstraint(g));
  };
  return p;
}

// The table of README.md: SCENES=12 STEPS=5000 build/test_mollified_impulse
// --gtest_filter='*Drawn*' draws that many of each kind.
TEST(MollifiedImpulse, KeepsTheEnergyOfDrawnCloths) {
  const auto number = [](const char* name, int other) {
    const char* text = std::getenv(name);
    return text ? std::atoi(text) : other;
  };
  const int scenes = number("SCENES", 1), steps = number("STEPS", 500);
  for (const char* kind : {"an edge", "three edges", "a triangle", "a band"}) {
    std::printf("| %s |", kind);
    for (double share : {0.3, 0.45, 0.6, 0.75, 0.9}) {
      std::vector<double> off;
      int diverged = 0;
      for (int seed = 1; seed <= scenes; ++seed) {
        Problem p = drawn(kind, unsigned(seed));
        const Start s(p);
        const double dt =
            share * 2 /
            omega_safe(s.cloth, soft_stiffness(s.cloth, s.force, s.constraint),
                       s.constraint);
        p.t_end = steps * dt;
        MollifiedImpulse impulse;
        const Outcome out = run(p, impulse, steps);
        if (impulse.split().empty()) continue;
        diverged += !out.ok();
        if (out.ok()) off.push_back(std::abs(out.end.energy - s.energy()));
      }
      std::ranges::sort(off);
      ASSERT_FALSE(off.empty()) << kind;
      std::printf(" %.2g (%.2g)%s |", off[off.size() / 2], off.back(),
                  diverged
                      ? (", " + std::to_string(diverged) + " diverged").c_str()
                      : "");
      if (share > 0.5) continue;
      EXPECT_EQ(diverged, 0) << kind << ' ' << share;
      EXPECT_LT(off.back(), 0.3) << kind << ' ' << share;
    }
    std::printf("\n");
  }
}

TEST(MollifiedImpulse, TakesForcesByCallAsSoftOnes) {
  const Problem p = stiff_edge(9, 1);
  Start a(p), b(p);
  const auto weight = [](Node n, double) {
    return n.value().mass * Point(0, 0, -grav);
  };
  const auto called = make_combined_force(weight, MassSpringForce());
  const auto known = make_combined_force(GravityForce(), MassSpringForce());
  MollifiedImpulse one, other;
  for (int n = 0; n < 50; ++n) {
    one(a.cloth, 0.005 * n, 0.005, called, a.constraint);
    other(b.cloth, 0.005 * n, 0.005, known, b.constraint);
  }
  EXPECT_EQ(one.split().springs.size(), 1u);
  EXPECT_GT(one.work().inner, 500);
  EXPECT_LT(distance(p, end_of(a), end_of(b)), 1e-10);
}

// A stiff spring at a wall that moves: its node is right at all inner times.
TEST(MollifiedImpulse, KeepsItsOrderAtAMovingPin) {
  Problem p = stiff_edge(9, 0.2);
  p.pins.push_back(
      {.node = p.mesh.springs[0].i, .motion = {Point(0, 0, 0.005)}});
  const Reference right = reference(p, 4);
  const auto error = [&](long long steps) {
    MollifiedImpulse impulse;
    const Outcome out = run(p, impulse, steps);
    EXPECT_EQ(impulse.split().springs.size(), 1u);
    return distance(p, out.end, right.end);
  };
  const double coarse = error(40), fine = error(80);
  EXPECT_LT(right.floor, fine / 20);
  EXPECT_NEAR(std::log2(coarse / fine), 2, 0.4);
}

TEST(MollifiedImpulse, GivesTheSameBitsInBatchesAndAfterLoading) {
  const Problem p = stiff_edge(9, 1);
  Start a(p), b(p);
  MollifiedImpulse one, other, loaded;
  for (int n = 0; n < 6; ++n)
    one.step(a.cloth, 0.003 * n, 0.003, a.force, a.constraint);
  other.steps(b.cloth, {0, 0.003}, 3, b.force, b.constraint);
  Archive out;
  other.archive(out, b.cloth);
  Archive in(out.bytes());
  loaded.archive(in, b.cloth);
  loaded.steps(b.cloth, {0, 0.003, 3}, 3, b.force, b.constraint);
  EXPECT_EQ(loaded.split().springs.size(), 1u);
  EXPECT_EQ(end_of(a).positions, end_of(b).positions);
  // Once an edge is removed, the saved state belongs to another cloth.
  Archive again(out.bytes());
  MollifiedImpulse torn;
  torn.archive(again, b.cloth);
  b.cloth.remove_edge(b.cloth.edge(0));
  const long long before = b.force.evaluations();
  torn.step(b.cloth, 0.009, 0.003, b.force, b.constraint);
  EXPECT_EQ(b.force.evaluations(), before + 2);  // at the start, too
}

TEST(MollifiedImpulse, RefusesAStepOfMillionsOfInnerOnes) {
  Start s(stiff_edge(9, 1));
  MollifiedImpulse impulse;
  EXPECT_THROW(impulse.step(s.cloth, 0, 1e3, s.force, s.constraint), StepError);
}

TEST(MollifiedImpulse, GoesOnWhenTheStiffEdgeIsTornAndAllocatesNothing) {
  const Problem p = stiff_edge(9, 1);
  Start s(p);
  MollifiedImpulse impulse;
  double t = 0;
  const auto steps = [&](int count) {
    for (int n = 0; n < count; ++n)
      t = impulse.step(s.cloth, t, 0.003, s.force, s.constraint);
  };
  steps(3);
  const long before = allocations;
  steps(20);
  EXPECT_EQ(allocations, before);
  EXPECT_EQ(impulse.split().springs.size(), 1u);
  s.cloth.remove_edge(middle_edge(s.cloth));
  steps(2);
  EXPECT_TRUE(impulse.split().empty());
  s.cloth.remove_node(s.cloth.node(40));
  steps(20);
  EXPECT_LT(s.energy(), 1);
}

}  // namespace
