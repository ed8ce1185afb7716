// The multirate method: which springs it splits off, that it is Verlet where
// there are none, its order, its resonances as theory has them, and what it
// saves on a soft cloth with a stiff edge.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <numbers>
#include <optional>
#include <random>
#include <set>
#include <string>
#include <vector>

#include "lab/charts/Problem.hpp"
#include "lab/methods/Methods.hpp"
#include "lab/methods/Resonance.hpp"
#include "lab/scenes/Contact.hpp"
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

/** The scene of @a p: weight and springs. */
Recipe recipe_of(const Problem& p) {
  Recipe recipe;
  recipe.gravity = p.gravity;
  recipe.build = p.build;
  recipe.force = [](const Cloth&) {
    return make_combined_force(GravityForce(), MassSpringForce());
  };
  recipe.constraint = p.constraint;
  return recipe;
}

TEST(Respa, GetsTheStepOfTheSoftSprings) {
  const Problem stiff = stiff_edge(9, 1), soft = grid_problem("", "", 1, 9);
  const auto step_of = [](const Problem& p, const char* method) {
    Scene scene(recipe_of(p), {.rule = StepRule::safe}, *find_method(method));
    EXPECT_TRUE(scene.run_to(0.5)) << scene.failure();
    return scene.dt();
  };
  const double verlet = step_of(soft, "verlet");
  EXPECT_LT(step_of(stiff, "verlet"), verlet / 30);
  // In the nearest gap between resonances: they are pi/omega apart.
  EXPECT_LE(step_of(stiff, "respa"), 1.02 * verlet);
  EXPECT_GT(step_of(stiff, "respa"),
            verlet - 2 * std::numbers::pi / std::sqrt(1e6 * 2 * 81));
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
  /** Half the trace of a step of @a h. */
  double half_trace(double h) {
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
    return trace / 2;
  }
};

// Also that of Verlet, of as many inner steps.
TEST(Respa, HasTheTraceOfTheory) {
  StiffOscillator o(100, 4);
  const StiffSplit split = split_springs(o.g, 1, *o.walls);
  EXPECT_EQ(split.alone, std::vector{100.});
  EXPECT_EQ(split.connected, 0);
  std::set<int> inner;
  for (double h = 1e-3; h < 2 / 4.; h += 1e-3) {
    const int n = split.inner_steps(h);
    inner.insert(n);
    EXPECT_NEAR(o.half_trace(h), HalfTrace(100, 4, h, n).value, 1e-9) << h;
  }
  EXPECT_EQ(*inner.begin(), 1);
  EXPECT_GT(inner.size(), 90u);
}

/** Two masses in a line, a stiff spring between them, soft ones to the walls:
 * while they move against each other the centers of the three springs rest. */
struct StiffPair {
  Cloth g;
  std::vector<Node> mass;
  std::optional<PinConstraint> walls;
  static constexpr double omega = 100, soft = 6;

  StiffPair() {
    std::vector<Node> ends;
    for (double x : {-2., 2.}) ends.push_back(g.add_node(Point(x, 0, 0)));
    for (double x : {-1., 1.}) mass.push_back(g.add_node(Point(x, 0, 0)));
    g.add_edge(mass[0], mass[1], {Real(omega * omega / 2), 2});
    for (int k : {0, 1}) g.add_edge(ends[k], mass[k], {Real(soft * soft), 1});
    walls.emplace(ends);
  }
  /** The largest motion of 20000 steps of @a h, in units of the first. */
  double growth(double h) {
    constexpr double size = 1e-9;
    double most = 0;
    for (int k : {0, 1}) {
      const double side = k == 0 ? -1 : 1;
      mass[k].position() = Point(side * (1 + size), 0, 0);
      mass[k].value().vel = Point(side * size * omega, 0, 0);
    }
    Respa respa;
    for (int n = 0; n < 20000 && most < 1e6; ++n) {
      respa(g, 0, h, MassSpringForce(), *walls);
      most = std::max(most, std::abs(mass[1].position().x - 1) / size);
    }
    return most;
  }
};

TEST(Respa, GrowsInsideOfTheWindowsOfTheoryAndNotOutside) {
  StiffPair pair;
  const StiffSplit split = split_springs(pair.g, 1, *pair.walls);
  ASSERT_EQ(split.alone, std::vector{pair.omega});
  const Resonances resonances(split, pair.soft);
  const auto grows = [&](double h) {
    return std::abs(HalfTrace(pair.omega, pair.soft, h, split.inner_steps(h))
                        .value) > 1;
  };
  int windows = 0;
  for (double h = 1e-3, step = 1e-4; h < 0.2; h += step) {
    if (grows(h) == grows(h + step)) continue;
    double before = h, behind = h + step;
    while (behind - before > 1e-12) {
      const double middle = (before + behind) / 2;
      (grows(middle) == grows(h) ? before : behind) = middle;
    }
    const double in = grows(h) ? -3e-5 : 3e-5;
    EXPECT_GT(pair.growth(before + in), 1e6) << before;
    EXPECT_LT(pair.growth(before - in), 100) << before;
    EXPECT_TRUE(resonances.at(before + in));
    if (windows++ == 0) {  // as close as the margin of 0.02 and side bands
      EXPECT_LT(resonances.first(), before);
      EXPECT_GT(resonances.first(), 0.9 * before);
    }
  }
  EXPECT_GE(windows, 8);
}

/** A cloth of 25 to 81 nodes, pinned at two corners, without drag, drawn at
 * random: masses, velocities, and which springs are of 1e4 to 1e6 N/m. */
Problem drawn(const std::string& kind, unsigned seed) {
  std::mt19937 random(seed);
  const auto draw = [](std::mt19937& r) { return double(r()) / 4294967296.; };
  Problem p = grid_problem(kind, kind, 1, 5 + random() % 5);
  p.gamma = 0;
  p.build = [=, build = p.build](Cloth& g) mutable {
    build(g);
    const double K = std::pow(10, 4 + 2 * draw(random));
    const double spread = draw(random) / 2, speed = draw(random);
    for (Node n : g.nodes()) {
      n.value().mass *= Real(1 + spread * (2 * draw(random) - 1));
      for (int k : {0, 1, 2}) n.value().vel[k] = speed * (draw(random) - 0.5);
    }
    if (kind == "a band")
      for (Edge e : g.edges())
        if (e.node1().position().x + e.node2().position().x < 0.01)
          e.value().K = Real(K);
    Edge any = g.edge(random() % g.num_edges());
    if (kind != "a band") any.value().K = Real(K);
    for (Edge e : any.node1().edges())
      if (kind == "a triangle" && g.has_edge(e.node2(), any.node2())) {
        e.value().K = Real(K);
        for (Edge f : any.node2().edges())
          if (f.node2() == e.node2()) f.value().K = Real(K);
        break;
      }
    for (int k = 0; k < 2 && kind == "three edges"; ++k)
      g.edge(random() % g.num_edges()).value().K = Real(K);
  };
  return p;
}

// The table of README.md: SCENES=12 STEPS=5000 build/test_respa
// --gtest_filter='*BeyondTheFirst*' draws that many of each kind.
TEST(Respa, DivergesOnlyBeyondTheFirstResonance) {
  const auto number = [](const char* name, int other) {
    const char* text = std::getenv(name);
    return text ? std::atoi(text) : other;
  };
  const int scenes = number("SCENES", 1), steps = number("STEPS", 1500);
  int diverged_of_all = 0;
  for (const char* kind : {"an edge", "three edges", "a triangle", "a band"}) {
    int count[2][2] = {};  // by: resonant, diverged
    for (int seed = 1; seed <= scenes; ++seed) {
      Problem p = drawn(kind, unsigned(seed));
      const Start s(p);
      const double soft =
          omega_safe(s.cloth, soft_stiffness(s.cloth, s.force, s.constraint),
                     s.constraint);
      const Resonances resonances(split_springs(s.cloth, 1, s.constraint),
                                  soft);
      std::printf("%-12s", kind);
      for (int k = 0; k < 17; ++k) {
        const double dt = (0.3 + 0.6 * k / 16) * 2 / soft;
        p.t_end = steps * dt;
        Respa respa;
        const bool resonant = resonances.at(dt);
        const bool diverged = !run(p, respa, steps).ok();
        ++count[resonant][diverged];
        std::printf(" %c%c", resonant ? 'r' : '-', diverged ? 'D' : '.');
      }
      std::printf("\n");
      for (double share : {0.3, 0.6}) {
        const double dt = share * std::min(resonances.first(), 2 / soft);
        p.t_end = steps * dt;
        Respa respa;
        EXPECT_FALSE(resonances.at(dt));
        EXPECT_TRUE(run(p, respa, steps).ok()) << kind << ' ' << seed;
      }
    }
    std::printf("%s: %d free, %d of them diverged; %d resonant, %d of them\n",
                kind, count[0][0] + count[0][1], count[0][1],
                count[1][0] + count[1][1], count[1][1]);
    diverged_of_all += count[1][1];
  }
  EXPECT_GT(diverged_of_all, 10);
}

// Of a resonant step that diverges, and what is chosen instead.
TEST(Respa, ChoosesAStepThatDoesNotResonateAndNamesTheOneThatDid) {
  const auto scene_of = [](const Problem& p, const TimeStep& step) {
    return std::make_unique<Scene>(recipe_of(p), step, *find_method("respa"));
  };
  const Problem p = stiff_edge(5, 1);
  const auto chosen = scene_of(p, {.rule = StepRule::safe});
  const Resonances r = *chosen->resonances();
  EXPECT_FALSE(r.at(chosen->dt()));
  EXPECT_GT(chosen->dt(), 10 * r.first());
  EXPECT_LT(chosen->dt(), chosen->safe_limit());
  EXPECT_EQ(r.below(r.first() / 2), r.first() / 2);

  std::unique_ptr<Scene> failed;
  double dt = 0;
  for (int k = 60; k < 90 && !(failed && !failed->failure().empty()); ++k) {
    dt = k / 100. * chosen->safe_limit();
    if (!r.at(dt)) continue;
    failed = scene_of(p, {.dt = dt});
    failed->run_to(20000 * dt);
  }
  ASSERT_TRUE(failed && !failed->failure().empty());
  const Diagnosis& d = failed->diagnosis();
  EXPECT_EQ(d.cause, Cause::resonance);
  EXPECT_EQ(d.text.find("the step resonates with the stiff springs: dt is "),
            0u);
  EXPECT_NE(d.text.find(" times half of their period of "), std::string::npos);
  ASSERT_TRUE(d.cure) << d.text;
  EXPECT_FALSE(r.at(d.cure->dt));
  EXPECT_LT(d.cure->dt, dt);
}

// All steps from the first resonance of connected springs on.
TEST(Respa, FindsNoGapsBetweenResonancesOfConnectedSprings) {
  Start s(drawn("a band", 1));
  const StiffSplit split = split_springs(s.cloth, 1, s.constraint);
  EXPECT_TRUE(split.alone.empty());
  EXPECT_EQ(split.connected, split.omega);
  const Resonances r(split, 300);
  EXPECT_LT(r.first(), std::numbers::pi / split.omega);
  EXPECT_GT(r.first(), 0.9 * std::numbers::pi / split.omega);
  for (double share = 0.1; share < 50; share += 0.07)
    EXPECT_EQ(r.at(share * r.first()), share > 1) << share;
  EXPECT_NEAR(r.below(1) / r.first(), 0.6, 0.06);
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
