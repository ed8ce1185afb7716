// The multirate method: which springs it splits off, that it is Verlet where
// there are none, its order, its resonances as theory has them, and what it
// saves on a soft cloth with a stiff edge.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

#include "lab/charts/Problem.hpp"
#include "lab/methods/Methods.hpp"
#include "lab/scenes/Obstacle.hpp"
#include "lab/scenes/Scene.hpp"
#include "lab/stability/Spectrum.hpp"
#include "tests/Allocations.hpp"

using namespace lab;

namespace {

/** The edge in the middle of a cloth. */
Edge middle_edge(const Cloth& g) { return g.edge(g.num_edges() / 2 + 1); }

/** A cloth of @a side x @a side nodes, K = 100 N/m, pinned at its corners, one
 * edge of which is of 1e6 N/m. */
Problem stiff_edge(unsigned side, double t_end) {
  Problem p = grid_problem("stiff-edge", "one stiff edge", t_end, side);
  p.gamma = 0;
  p.build = [build = p.build](Cloth& g) {
    build(g);
    middle_edge(g).value().K = 1e6;
  };
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

TEST(StiffSplit, LeavesWhatBoundsTheStep) {
  const Start s(stiff_edge(9, 1)), soft(grid_problem("", "", 1, 9));
  const double without = omega_safe(soft.cloth, soft.force, soft.constraint);
  EXPECT_GT(omega_safe(s.cloth, s.force, s.constraint), 30 * without);
  const ForcePlan left = soft_stiffness(s.cloth, s.force, s.constraint);
  EXPECT_NEAR(omega_safe(s.cloth, left, s.constraint) / without, 1, 0.01);
}

TEST(Respa, GetsTheStepOfTheSoftSprings) {
  const Problem stiff = stiff_edge(9, 1), soft = grid_problem("", "", 1, 9);
  const auto step_of = [](const Problem& p, const char* method) {
    Recipe recipe;
    recipe.gravity = p.gravity;
    recipe.build = p.build;
    recipe.force = [](const Cloth&) {
      return make_combined_force(GravityForce(), MassSpringForce());
    };
    recipe.constraint = p.constraint;
    Scene scene(recipe, {.rule = StepRule::safe}, *find_method(method));
    EXPECT_TRUE(scene.run_to(0.5)) << scene.failure();
    return scene.dt();
  };
  const double verlet = step_of(soft, "verlet");
  EXPECT_LT(step_of(stiff, "verlet"), verlet / 30);
  EXPECT_NEAR(step_of(stiff, "respa"), verlet, 0.02 * verlet);
  EXPECT_EQ(step_of(soft, "respa"), verlet);
}

TEST(Respa, IsVerletWhereSpringsAreAlike) {
  const Problem p = grid_problem("", "", 1, 9);
  Start a(p), b(p);
  Respa respa;
  Verlet verlet;
  double t = 0;
  for (int n = 0; n < 50; ++n) {
    respa.step(a.cloth, t, 0.005, a.force, a.constraint);
    t = verlet.step(b.cloth, t, 0.005, b.force, b.constraint);
  }
  EXPECT_TRUE(respa.split().empty());
  EXPECT_EQ(end_of(a).positions, end_of(b).positions);
}

// Below Verlet's step the inner step is the outer one.
TEST(Respa, IsVerletToRoundOffForShortSteps) {
  const Problem p = stiff_edge(5, 0.01);
  Respa respa;
  Verlet verlet;
  const long long steps = 5 * least_of_verlet(p);
  const Outcome a = run(p, respa, steps), b = run(p, verlet, steps);
  EXPECT_EQ(respa.inner_steps(), 1);
  EXPECT_EQ(respa.split().springs.size(), 1u);
  EXPECT_LT(distance(p, a.end, b.end), 1e-12);
}

// What the method is for. Verlet needs its least stable number of steps
// whatever the tolerance is.
TEST(Respa, SavesForceEvaluationsOnASoftClothWithAStiffEdge) {
  const Problem p = stiff_edge(15, 0.3);
  const Reference right = reference(p, 4);
  const long long verlet = least_of_verlet(p);
  std::printf("floor %.1e m; verlet at its limit, %lld evaluations: %.2e m\n",
              right.floor, verlet,
              distance(p, run(p, *find_method("verlet")->make(), verlet).end,
                       right.end));
  const auto error = [&](long long steps) {
    Respa respa;
    const Outcome out = run(p, respa, steps);
    EXPECT_TRUE(out.ok()) << out.reason;
    EXPECT_EQ(out.sweeps, steps + 1);
    EXPECT_EQ(respa.split().springs.size(), 1u);
    const double e = distance(p, out.end, right.end);
    std::printf("respa, %lld evaluations, %d inner steps: %.2e m\n", out.sweeps,
                respa.inner_steps(), e);
    return e;
  };
  // The phase of the stiff spring at the kicks makes the errors uneven.
  const double coarse = error(verlet / 30), fine = error(verlet / 4);
  EXPECT_NEAR(std::log(coarse / fine) / std::log(30 / 4.), 2, 0.4);
  EXPECT_LT(coarse, 2e-4);
  EXPECT_LT(error(verlet / 10), 3e-5);
}

TEST(Respa, CanBeTakenBackAndKeepsMomentum) {
  const Problem p = stiff_edge(5, 1);
  Start s(p);
  const std::vector<Point> start = end_of(s).positions;
  const auto force = make_combined_force(MassSpringForce());
  for (Node n : s.cloth.nodes())
    n.value().vel = Point(n.position().y, 0.3, n.position().x);
  const auto momenta = [&s] {
    Point linear, angular;
    for (Node n : s.cloth.nodes()) {
      linear += n.value().mass * n.value().vel;
      angular += cross(n.position(), n.value().mass * n.value().vel);
    }
    return std::pair(linear, angular);
  };
  const auto [linear, angular] = momenta();
  for (int way = 0; way < 2; ++way) {
    Respa respa;
    for (int n = 0; n < 100; ++n) respa(s.cloth, 0.004 * n, 0.004, force);
    EXPECT_GT(respa.inner_steps(), 20);
    if (way == 0) {
      EXPECT_GT(norm(s.cloth.node(7).position() - start[7]), 0.01);
      EXPECT_LT(norm(momenta().first - linear), 1e-12);
      EXPECT_LT(norm(momenta().second - angular), 1e-12);
    }
    for (Node n : s.cloth.nodes()) n.value().vel *= -1;
  }
  for (unsigned i = 0; i < start.size(); ++i)
    EXPECT_LT(norm(s.cloth.node(i).position() - start[i]), 1e-9);
}

/** A mass between two walls, on a stiff and on a soft spring in a line. */
struct StiffOscillator {
  Cloth g;
  Node mass;
  std::optional<PinConstraint> walls;
  double omega_f, omega_s;

  StiffOscillator(double f, double s) : omega_f(f), omega_s(s) {
    const std::vector<Node> ends = {g.add_node(Point(-1, 0, 0)),
                                    g.add_node(Point(1, 0, 0))};
    mass = g.add_node(Point());
    g.add_edge(ends[0], mass, {Real(f * f), 1});
    g.add_edge(ends[1], mass, {Real(s * s), 1});
    walls.emplace(ends);
  }
  /** The growth of its motion in each step of @a h: from the trace of a step.
   */
  double growth(double h) {
    double trace = 0;
    for (int column : {0, 1}) {
      const double size = 1e-4;
      mass.position() = Point(column == 0 ? size : 0, 0, 0);
      mass.value().vel = Point(column == 1 ? size : 0, 0, 0);
      Respa respa;
      respa(g, 0, h, MassSpringForce(), *walls);
      EXPECT_EQ(respa.split().springs.size(), 1u);
      trace += (column == 0 ? mass.position().x : mass.value().vel.x) / size;
    }
    const double half = std::abs(trace) / 2;
    return half <= 1 ? 1 : half + std::sqrt(half * half - 1);
  }
};

// Half the trace of a step is cos(a) - (h omega_s^2/(2 omega_f)) sin(a), a = h
// omega_f: below each a = k pi there is a gap, its width and growth as
// Respa.hpp says. Inner steps make omega_f that of Verlet, and the other
// factor 1/(omega_f cos), of the same.
TEST(Respa, HasTheResonancesOfTheory) {
  StiffOscillator o(100, 4);
  double worst = 1, worst_h = 0, between = 1;
  for (double h = 0.02; h < 2 / 4.; h += 2e-4) {
    const double growth = o.growth(h);
    if (growth > worst) worst = growth, worst_h = h;
    const double turns = h * 100 / std::numbers::pi;
    if (std::abs(turns - std::round(turns)) > 0.35)
      between = std::max(between, growth);
  }
  EXPECT_GT(worst, 1 + 1e-3);
  EXPECT_LT(worst, 1 + 1.1 * std::pow(4 * worst_h, 2) / (2 * 100 * worst_h));
  EXPECT_LT(between, 1 + 1e-9);
  // At the soft limit, where no spring is left that Verlet could not take.
  EXPECT_LT(o.growth(0.45), 1.05);
}

TEST(Respa, TakesForcesByCallAsSoftOnes) {
  const Problem p = stiff_edge(5, 1);
  Start a(p), b(p);
  const auto weight = [](Node n, double) {
    return n.value().mass * Point(0, 0, -grav);
  };
  const auto called = make_combined_force(weight, MassSpringForce());
  const auto known = make_combined_force(GravityForce(), MassSpringForce());
  Respa one, other;
  for (int n = 0; n < 50; ++n) {
    one(a.cloth, 0.005 * n, 0.005, called, a.constraint);
    other(b.cloth, 0.005 * n, 0.005, known, b.constraint);
  }
  EXPECT_EQ(one.split().springs.size(), 1u);
  EXPECT_GT(one.inner_steps(), 10);
  EXPECT_LT(distance(p, end_of(a), end_of(b)), 1e-10);
}

// A stiff spring at a wall that moves: its node is right at all inner times.
TEST(Respa, KeepsItsOrderAtAMovingPin) {
  Problem p = stiff_edge(5, 0.2);
  p.driven = true;
  p.constraint = [](const Cloth& g) {
    const Node n = middle_edge(g).node1();
    return make_combined_constraints(
        PinConstraint(g), MovingPinConstraint(PinConstraint(std::vector{n}),
                                              {Point(0, 0, 0.05)}));
  };
  const Reference right = reference(p, 4);
  const auto error = [&](long long steps) {
    Respa respa;
    const Outcome out = run(p, respa, steps);
    EXPECT_EQ(respa.split().springs.size(), 1u);
    EXPECT_GT(respa.inner_steps(), 1);
    return distance(p, out.end, right.end);
  };
  const double coarse = error(640), fine = error(1280);
  EXPECT_LT(right.floor, fine / 20);
  EXPECT_NEAR(std::log2(coarse / fine), 2, 0.4);
}

TEST(Respa, GoesOnWhenTheStiffEdgeIsTornAndAllocatesNothing) {
  const Problem p = stiff_edge(9, 1);
  Start s(p);
  Respa respa;
  double t = 0;
  const auto steps = [&](int count) {
    for (int n = 0; n < count; ++n)
      t = respa.step(s.cloth, t, 0.003, s.force, s.constraint);
  };
  steps(3);
  const long before = allocations;
  steps(20);
  EXPECT_EQ(allocations, before);
  EXPECT_EQ(respa.split().springs.size(), 1u);
  s.cloth.remove_edge(middle_edge(s.cloth));
  steps(2);
  EXPECT_TRUE(respa.split().empty());
  s.cloth.remove_node(s.cloth.node(40));
  steps(20);
  EXPECT_LT(s.energy(), 1);
}

TEST(Respa, RefusesAStepOfMillionsOfInnerOnes) {
  Start s(stiff_edge(5, 1));
  Respa respa;
  EXPECT_THROW(respa.step(s.cloth, 0, 1e3, s.force, s.constraint), StepError);
}

}  // namespace
