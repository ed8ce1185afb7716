// Advise.hpp: advice that holds against the truth, what can't be had is
// refused, and the parts of a scene are told apart.
#include <gtest/gtest.h>

#include <cmath>

#include "lab/advice/Advise.hpp"
#include "lab/advice/Parts.hpp"
#include "lab/advice/Variation.hpp"
#include "lab/methods/Methods.hpp"
#include "lab/scenes/Words.hpp"
#include "lab/stepping/Trial.hpp"
#include "tests/ReadParts.hpp"
#include "tests/Says.hpp"

using namespace lab;

namespace {

/** A cloth that hangs from its upper side, let go unstretched. */
Model hanging(double tolerance, const std::string& nodes = "11 11") {
  Model m = with_sheet("u 1 0 0 v 0 0 -1 nodes " + nodes);
  m.pins = {read_pin("z 0")};
  m.material.density = 1;
  m.material.modulus = 100;
  m.t_end = 0.2;
  m.tolerance = tolerance;
  return m;
}

/** The limit of the answer on grids of up to so many times the cells, by small
 * steps of a method that the adviser's pilots do not use. */
Answer truth(const Model& m, double factor) {
  Refinement grids(m.measure);
  for (double coarser : {4, 2, 1}) {
    Model fine = refined(m, factor / coarser);
    fine.method = &table::pefrl;
    fine.step = {.rule = StepRule::safe};
    GridReport g;
    g.factor = factor / coarser;
    g.trial = try_out(fine);
    grids.add(g);
  }
  return grids.limit();
}

GridReport grid(double factor, Answer answer) {
  GridReport g;
  g.factor = factor;
  g.trial.answer = std::move(answer);
  return g;
}

/** Grids of 1, 1.5, 2, 3, 4, 6 ... times the cells, with these answers. */
Refinement of_answers(const std::vector<double>& answers, bool slow = false) {
  Refinement r(Measure::energy, slow);
  for (std::size_t k = 0; k < answers.size(); ++k)
    r.add(grid((k % 2 ? 1.5 : 1) * std::pow(2, k / 2), {answers[k]}));
  return r;
}
/** The answers 1 + h^order, off by these. */
Refinement by_order(double order, const std::vector<double>& off) {
  std::vector<double> answers;
  for (std::size_t k = 0; k < off.size(); ++k)
    answers.push_back(1 + off[k] +
                      std::pow((k % 2 ? 1.5 : 1) * std::pow(2, k / 2), -order));
  return of_answers(answers);
}

TEST(Refinement, FindsTheLimitOfWhatGoesByAnOrder) {
  for (double order : {1.0, 1.5, 2.0}) {
    Refinement r(Measure::com);
    const double c[] = {0.3, -0.2, 0.05};
    auto off = [&](double factor, int k) {
      return c[k] * std::pow(factor, -order);
    };
    for (double f : {1., 1.7, 4., 8.})  // cells of any ratio
      r.add(grid(f, {1 + off(f, 0), 2 + off(f, 1), 3 + off(f, 2)}));
    for (double f : {1., 1.7, 8., 5.5, 16.}) {  // the last two: not tried
      const Effect e = r.error(f);
      for (int k : {0, 1, 2})
        EXPECT_NEAR(e.by[unsigned(k)], off(f, k), 1e-12) << order << ' ' << f;
    }
    EXPECT_NEAR(r[0].error, std::hypot(c[0], c[1], c[2]), 1e-12);
    EXPECT_NEAR(r.order(), order, 1e-12);
    EXPECT_TRUE(r.asymptotic());
    // A fifth of the last error, as all grids agree.
    EXPECT_NEAR(r.uncertainty(), r.back().error / 5, 1e-12);
  }
}

TEST(Refinement, DoesNotBelieveEveryOrder) {
  for (auto [order, believed] :
       {std::pair(0.4, false), {0.6, true}, {2.0, true}, {2.4, false}}) {
    const Refinement r = by_order(order, {0, 0, 0, 0, 0, 0});
    EXPECT_EQ(r.asymptotic(), believed) << order;
    EXPECT_NEAR(r.order(), order > 2.1 ? 2 : order, 1e-12);
    if (order > 0.5) {
      EXPECT_LE(std::abs(r.limit()[0] - 1), r.uncertainty() + 1e-12) << order;
    }
  }
  // Order 0.1 has 3/4 of the deviation of order 1, and its limit is -2.
  EXPECT_NEAR(by_order(1, {-0.4, 0, 0.2, 0, 0, 0}).limit()[0], 1, 0.1);
}

// A node that is held carries a load at a point. The compliance of a membrane
// there grows with the logarithm of the cells (Boussinesq and Kelvin), so a
// force that is limited by it goes slower than by any power of h.
TEST(Refinement, KnowsThatASlowConvergenceMayGoOn) {
  for (double order : {0.15, 0.2, 0.3, 0.4}) {
    const Refinement r = by_order(order, {0, 0, 0, 0, 0, 0, 0});
    EXPECT_NEAR(r.limit()[0], 1, 1e-9) << order;
    EXPECT_FALSE(r.asymptotic());
    // Order 1 is possible, too.
    EXPECT_GT(r.uncertainty(), 0.6 * r.back().error) << order;
  }
  for (double compliance : {0.03, 0.1, 0.3, 1.}) {
    auto force = [&](double cells) {
      return 1 / (1 + compliance * std::log(cells));
    };
    const Refinement r = of_answers({force(2), force(3), force(4), force(6),
                                     force(8), force(12), force(16)});
    for (double cells : {100, 1000})
      EXPECT_LE(std::abs(r.limit()[0] - force(cells)), r.uncertainty())
          << compliance;
  }
}

// Coarse grids go by order 2, as bending and masses at the rim do; in the end a
// pin of one node gives way by order 1/2.
TEST(Refinement, IsNotDeceivedWhereAPinHoldsOneNode) {
  for (double other : {-4., -1., 1., 4.}) {
    std::vector<double> answers;
    for (double cells : {2, 3, 4, 6, 8, 12, 16, 24, 32, 48}) {
      answers.push_back(1 + std::pow(cells, -0.5) +
                        other * std::pow(cells, -2));
      if (answers.size() < 5) continue;
      const Refinement r = of_answers(answers, true);
      EXPECT_LE(std::abs(r.limit()[0] - 1), r.uncertainty()) << other;
      if (cells > 20) {
        EXPECT_LE(r.uncertainty(), 2 * std::abs(answers.back() - 1)) << other;
      }
      EXPECT_FALSE(r.asymptotic());
      if (cells == 8 && other < -2) {
        const Refinement any = of_answers(answers);
        EXPECT_GT(std::abs(any.limit()[0] - 1), any.uncertainty());
      }
    }
  }
}

// One grid that is off tells that all may be; by how much is of its size.
TEST(Refinement, IsUncertainOfWhatGoesByNoOrder) {
  double before = by_order(1, {0, 0, 0, 0, 0, 0}).uncertainty();
  for (double off : {0.01, 0.1, 1.}) {
    const Refinement r = by_order(1, {0, 0, 0, off, 0, 0});
    EXPECT_GT(r.uncertainty(), before);
    EXPECT_GT(r.uncertainty(), 0.5 * off);
    EXPECT_GT(r.deviation(), 0.1 * off);
    EXPECT_LE(std::abs(r.limit()[0] - 1), r.uncertainty());
    before = r.uncertainty();
  }
  // Three grids always fit.
  EXPECT_NEAR(by_order(1, {0, 0, 0}).uncertainty(), 1.5, 1e-9);
}

// A grid of a tenth of the cells says little about the limit.
TEST(Refinement, ForgetsGridsThatAreMuchCoarser) {
  const Refinement r = by_order(2, {9, 0, 0, 0, 0, 0, 0, 0});
  EXPECT_NEAR(r.limit()[0], 1, 1e-12);
  EXPECT_NEAR(r[0].error, 10, 1e-12);
}

TEST(Refinement, TellsWhatDriftsApart) {
  EXPECT_FALSE(of_answers({0, 1, 2, 4, 7}).converges(0.1));
  EXPECT_TRUE(of_answers({0, 4, 6, 7, 7.4}).converges(0.1));
  EXPECT_TRUE(of_answers({0, 1, 2, 4}).converges(0.1));  // too few to tell
  // Round-off is no drift: a body in free fall.
  EXPECT_TRUE(of_answers({0, 1e-15, 2e-15, 4e-15, 7e-15}).converges(0.1));
}

TEST(Advise, MeetsTheToleranceByHalfTheStepAndOnTwiceTheCells) {
  const Answer right = truth(hanging(1), 4);
  std::size_t nodes = 0;
  for (double tolerance : {1e-2, 1e-4}) {
    const Advice a = advise(hanging(tolerance));
    ASSERT_EQ(a.refusal, "");
    EXPECT_LE(a.error + 0.45 * a.uncertainty, tolerance);
    ASSERT_TRUE(a.half_step && a.finer_grid);
    EXPECT_GT(a.perturbed, 3);
    Model smaller = a.model;
    smaller.step.dt /= 2;
    for (const Model& m : {a.model, smaller, refined(smaller, 2)})
      EXPECT_LE(distance(try_out(m).answer, right, a.measure), tolerance);
    const std::size_t now = mesh_of(a.model).points.size();
    EXPECT_GE(now, nodes);  // a finer answer, a finer grid
    nodes = now;
  }
  EXPECT_GT(nodes, 100u);
}

TEST(Advise, LeavesOutWhatChangesNothing) {
  Model m = hanging(1e-3);
  m.planes = {read_plane("at 0 0 -9")};              // far below
  m.spheres = {read_sphere("at 5 5 5 radius 0.1")};  // far away
  const Advice a = advise(m);
  ASSERT_EQ(a.refusal, "");
  EXPECT_TRUE(a.model.planes.empty() && a.model.spheres.empty());
  EXPECT_EQ(a.model.pins, m.pins);
  for (const PartReport& p : a.parts) {
    const bool far =
        p.part.rfind("plane", 0) == 0 || p.part.rfind("sphere", 0) == 0;
    if (far || p.part == "gravity" || p.part.rfind("pin", 0) == 0) {
      EXPECT_EQ(p.needed, !far) << p.part << " changes " << p.change;
    }
    EXPECT_EQ(p.change == 0, far) << p.part;
  }
}

// A hanging strip comes back to its start after 4 L/c, c =
// sqrt(modulus/density): there its center is as if there were no gravity.
TEST(Advise, KeepsAPartWhoseEffectIsSmallAtTheEndAlone) {
  Model m = with_sheet("v 0 0 -1 nodes 9 9");
  m.edges.diagonals = false, m.pins = {read_pin("z 0")};
  m.material.density = 0.3, m.material.modulus = 200;
  m.t_end = 4 * std::sqrt(0.3 / 200), m.tolerance = 1.5e-3;
  const Advice a = advise(m);
  ASSERT_EQ(a.refusal, "");
  EXPECT_EQ(a.model.gravity, m.gravity);
  EXPECT_EQ(a.answer[0], 0.5);
  EXPECT_NEAR(a.answer[2], -0.5, m.tolerance);
}

/** A membrane that swings for ever. At 1.5 s it passes its mean, -0.037 m. */
Model membrane() {
  Model m = with_sheet("nodes 21 21");
  for (const char* side : {"x 0", "x 1", "y 0", "y 1"})
    m.pins.push_back(read_pin(side));
  m.material.density = 0.13, m.material.modulus = 310;
  m.measure = Measure::drape_height;
  m.t_end = 1.5, m.tolerance = 0.0099;
  return m;
}

// One long implicit step has its answer at rest, which is right at the end.
TEST(Advise, MovesAsTheSceneDoes) {
  Advice a = advise(membrane());
  ASSERT_EQ(a.refusal, "");
  // Of 33 and 49 nodes a side by verlet, high and low.
  for (auto [t, right] : {std::pair(1.35, -0.015), {1.45, -0.0628}}) {
    a.model.t_end = t;
    EXPECT_NEAR(try_out(a.model).answer[0], right, 0.015);
  }
  Model falls = with_sheet("nodes 21 21");
  falls.planes = {read_plane("at 0 0 -0.5")};
  falls.material.density = 0.3, falls.material.modulus = 100;
  falls.measure = Measure::kinetic_energy, falls.tolerance = 0.02;
  falls.t_end = 1;
  a = advise(falls);
  EXPECT_NEAR(a.answer[0], 0, 1e-6);
  const Trial t = try_out(a.model);
  EXPECT_NEAR(t.earlier[15][0], 0.3 / 2 * std::pow(grav * 0.25, 2), 0.05);
}

// A sphere that has passed is forgotten at the end, but not before.
TEST(Advise, KeepsAPartThatActsBeforeTheEnd) {
  Model m = hanging(1e-2);
  m.material.drag = 20, m.t_end = 2;
  m.spheres = {read_sphere("at 0.5 -0.5 -0.5 radius 0.2 velocity 0 2 0")};
  Question q(m, {}, 1);
  GridStudy grids(q);
  for (int k = 0; k < 3; ++k) ASSERT_EQ(grids.add(), "");
  PartStudy parts(q, grids);
  parts.study(2);
  const auto sphere = std::ranges::find_if(
      q.advice.parts, [](auto& p) { return p.part.starts_with("sphere"); });
  ASSERT_NE(sphere, q.advice.parts.end());
  EXPECT_GT(sphere->change, m.tolerance);
}

TEST(Advise, OfAClothAtRestIsItsRest) {
  Model m = with_sheet("nodes 13 13");
  m.pins = {read_pin("x 0"), read_pin("x 1")};
  m.material = {.density = 0.3, .modulus = 200, .drag = 3};
  m.measure = Measure::drape_height;
  m.t_end = 5, m.tolerance = 0.001;
  const Advice a = advise(m);
  ASSERT_EQ(a.refusal, "");
  EXPECT_TRUE(has(as_options(a.model), " --rest"));
  EXPECT_FALSE(has(as_options(a.model), "--t-end"));
  EXPECT_NEAR(a.answer[0], -0.080587, m.tolerance);  // of 129 x 129 nodes [m]
  for (const char* proof : {"N are left of", "stable: the smallest",
                            "the drag of this scene brings it there by "})
    EXPECT_TRUE(has(in_words(a), proof));
  m.t_end = 0.5;  // it still swings
  EXPECT_EQ(advise(m).at_rest, "");
  m.from_rest = true;
  EXPECT_TRUE(has(as_options(m), " --from-rest=true"));
}

TEST(Advise, DoesNotWarnOfItself) {
  Model m = with_sheet("nodes 13 13");
  m.pins = {read_pin("x 0")};
  m.material.density = 1, m.t_end = 0.5;
  Pilots pilots(0, [](const std::string&, double) {});
  m.method = find_method("implicit-midpoint"), m.step = {.dt = 0.1};
  EXPECT_TRUE(has(pilots.warning_of(m, m, 1), "has added"));
  m.method = &table::verlet, m.step = {.dt = 0.0028};
  EXPECT_EQ(pilots.warning_of(m, m, 1), "");
  EXPECT_EQ(pilots.spent(), 6);
}

TEST(Advise, RefusesWhatNoGridCanGive) {
  AdviceRules rules;
  rules.most_nodes = 500;
  const Advice a = advise(hanging(1e-6), rules);
  EXPECT_TRUE(has(a.refusal, "would be too large"));
  EXPECT_TRUE(has(in_words(a), "no advice: "));
  rules.most_nodes = 8;  // the first grid has 9
  EXPECT_TRUE(has(advise(hanging(1), rules).refusal, "a grid of 9 nodes"));
}

// A cloth pushed together buckles: which way is decided by round-off.
TEST(Advise, RefusesChaosAndNamesWhatCanBeHad) {
  Model m;
  m.nodes = "data/grid1.nodes", m.tets = "data/grid1.tets";
  m.pins = {read_pin("x 0 y 0"), read_pin("x 1 y 0")};
  m.measure = Measure::positions;
  m.t_end = 1.5;
  m.tolerance = 1e-3;
  const Advice a = advise(m);
  EXPECT_TRUE(has(a.refusal, "chaotic"));
  EXPECT_TRUE(has(a.refusal, "earlier --t-end"));
}

// Coarser grids have no node where a pin is, finer ones nodes that are too
// near.
TEST(Advise, TellsWhichGridIsNoScene) {
  Model m = hanging(1e-2, "21 21");
  m.pins = {read_pin("z 0"), read_pin("x 0.05")};  // of the second column
  m.t_end = 0.05;
  AdviceRules rules;
  rules.patience = 1e6;  // no finer grids than it takes
  const Advice a = advise(m, rules);
  EXPECT_EQ(a.refusal, "");
  ASSERT_FALSE(a.grids.empty());
  EXPECT_EQ(a.grids[0].factor, 1);
  m.pins = {read_pin("z 0")};
  m.t_end = 0.2;
  m.self_collision =
      read_self_collision("thickness 0.04");  // two sides of 81 nodes: 0.025 m
  // On finer grids it goes down, and is no reason to refuse.
  EXPECT_EQ(advise(m, rules).refusal, "");
  m.t_end = 0;
  EXPECT_THROW(advise(m), SceneError);
}

// Grids begin at two cells, whatever grid the user has.
TEST(Advise, BeginsAtTwoCells) {
  for (auto [nodes, first] :
       {std::pair("22 27", 9u), {"25 25", 9u}, {"9 40", 33u}}) {
    Model m = hanging(1e-2, nodes);
    const Advice a = advise(m);
    ASSERT_EQ(a.refusal, "");
    EXPECT_EQ(a.grids[0].nodes, first) << nodes;
    for (std::size_t k = 1; k < a.grids.size(); ++k) {
      const double ratio = a.grids[k].factor / a.grids[k - 1].factor;
      EXPECT_GT(ratio, 1.05);
      EXPECT_LT(ratio, 2.3);
    }
    EXPECT_LE(mesh_of(a.model).points.size(), 33u) << nodes;
  }
}

// Grids of 5 x 3 and 15 x 8 cells would be of another material.
TEST(Advise, KeepsTheShapeOfTheCells) {
  std::string first;
  for (const char* nodes : {"17 9", "21 11", "25 13"}) {
    Model m = with_sheet(std::string("u 2 0 0 v 0 1 0 nodes ") + nodes);
    m.pins = {read_pin("x 0"), read_pin("x 2")};
    m.material = {.density = 0.4, .modulus = 1000, .drag = 20};
    m.measure = Measure::drape_height;
    m.t_end = 3, m.tolerance = 2, m.percent = true;
    const Advice a = advise(m);
    ASSERT_EQ(a.refusal, "") << nodes;
    if (first.empty()) first = as_options(a.model);
    EXPECT_EQ(as_options(a.model), first);
    EXPECT_NEAR(a.grids.limit()[0], -0.1272, 0.0018);  // of 129 x 65 nodes
  }
  // Of 21 x 26 cells, 5 x 6 have the shape, and 6 x 7 do not.
  Model m = hanging(1e-4, "22 27");
  const Advice a = advise(m);
  int seen = 0;
  for (std::size_t k = 0; k < a.grids.size(); ++k) {
    const double cells = 21 * 26 * std::pow(a.grids[k].factor, 2),
                 sides = double(a.grids[k].nodes) - 1 - cells,
                 side = (sides - std::sqrt(sides * sides - 4 * cells)) / 2;
    if (side < 4.5) continue;
    EXPECT_NEAR((sides - side) / side, 26 / 21., 0.05) << side;
    ++seen;
  }
  EXPECT_GT(seen, 1);
}

// On the grid of the cheapest choice by Verlet, others meet the tolerance by
// accident. Implicit steps of a sheet that falls almost freely need no
// iteration, which is not predicted.
TEST(Advise, NoMethodAloneIsCheaper) {
  Model hangs = with_sheet("v 0 0 -1 nodes 11 11");
  hangs.pins = {read_pin("z 0")};
  hangs.material = {.density = 0.3, .modulus = 200, .drag = 3};
  hangs.measure = read_measure("point u 0.5 v 1 z");
  hangs.t_end = 1, hangs.tolerance = 2, hangs.percent = true;
  Model falls = with_sheet("u 1.2 0 0 v 0 0.91 0 nodes 33 50");
  falls.planes = {read_plane("at 0 0 -0.24 normal -0.12 0 1 friction 0.15")};
  falls.material.density = 0.16, falls.material.modulus = 47;
  falls.measure = Measure::drape_height;
  falls.t_end = 0.17, falls.tolerance = 0.0075;
  AdviceRules rules;
  rules.keeps_method = true;
  for (Model m : {hangs, falls}) {
    const Advice a = advise(m);
    ASSERT_EQ(a.refusal, "");
    for (const char* method : {"verlet", "implicit-euler", "tr-bdf2"}) {
      m.method = find_method(method);
      const Advice alone = advise(m, rules);
      if (alone.refusal.empty()) {
        EXPECT_LE(a.work, 1.5 * alone.work) << method;
      }
    }
  }
}

TEST(Advise, RefinesARope) {
  Model m = hanging(1e-2);
  m.sheets = {read_sheet("u 1 0 0 nodes 13 1")};
  m.material = {};
  m.pins = {read_pin("x 0"), read_pin("x 1")};
  const Advice a = advise(m);
  ASSERT_EQ(a.refusal, "");
  EXPECT_EQ(a.grids[0].nodes, 3u);  // two springs
  // Waves in it go at K/N cells: a fine one falls freely, except near its pins.
  EXPECT_NEAR(a.grids.limit()[2], -grav * m.t_end * m.t_end / 2,
              a.grids.uncertainty());
  EXPECT_EQ(a.model.sheets[0].nodes[1], 1u);
}

TEST(Advise, AConservedEnergyNeedsNoRun) {
  Model m = hanging(4);
  m.measure = Measure::energy, m.percent = true;
  const Advice a = advise(m);
  EXPECT_EQ(a.refusal, "");
  EXPECT_EQ(a.model.t_end, 0);  // no step can fail
  EXPECT_EQ(a.spent_work, 0);
  EXPECT_NEAR(a.answer[0], -grav / 2, 1e-9);  // of 1 kg, 0.5 m below its pins
  EXPECT_TRUE(begins(in_words(a), "advice: no run is needed"));
}

// A sheet that falls freely needs no cells, whatever the other one needs.
TEST(Advise, CoarsensEachSheetOnItsOwn) {
  Model m = hanging(1e-4);
  m.edges.diagonals = false;
  m.sheets = {read_sheet("u 1 0 0 v 0 0 -1 nodes 9 9"),
              read_sheet("at 3 0 0 u 1 0 0 v 0 1 0 nodes 15 12")};
  const Advice a = advise(m);
  ASSERT_EQ(a.refusal, "");
  using Nodes = std::array<unsigned, 2>;
  EXPECT_EQ(a.model.sheets[1].nodes, (Nodes{3, 3}));
  EXPECT_EQ(a.model.sheets[0].nodes[0], 3u);
  EXPECT_GT(a.model.sheets[0].nodes[1], 5u);
  m.sheets[0].nodes = {61, 61}, m.sheets[1].nodes = {4, 4};
  EXPECT_LT(advise(m).grids[0].nodes, 200u);
}

// Pilots by Verlet tell nothing of a method or a step that was asked for.
TEST(Advise, KeepsAMethodAndAStepOrRefuses) {
  Model m = hanging(1e-2);
  AdviceRules rules;
  rules.keeps_method = true;
  m.method = &table::rkn64;
  const Advice a = advise(m, rules);
  ASSERT_EQ(a.refusal, "");
  EXPECT_EQ(a.model.method->info.name, "rkn64");
  EXPECT_EQ(a.of_stable, 0);  // it has no limit
  m.method = &table::implicit_euler;
  m.step = {.dt = 0.2};
  rules.keeps_step = true;
  EXPECT_EQ(advise(m, rules).refusal,
            "no step of implicit-euler that was tried meets the tolerance");
}

// A mesh takes pilots, a choice and its checks: up to 24 runs of the scene.
TEST(Advise, AMeshFromFilesTakesAFewRuns) {
  Model m;
  m.nodes = "data/grid1.nodes", m.tets = "data/grid1.tets";
  m.material = {.density = 0.3, .modulus = 200, .drag = 3};
  m.pins = {read_pin("x 0"), read_pin("x 1")};
  m.method = &table::verlet, m.step = {.rule = StepRule::safe};
  m.t_end = 0.5, m.tolerance = 1e-3;
  AdviceRules rules;
  rules.budget = 24 * work_of_run(m);
  const Advice a = advise(m, rules);
  ASSERT_EQ(a.refusal, "");
  EXPECT_LE(a.spent_work, rules.budget);
  EXPECT_LE(a.error + a.uncertainty, m.tolerance);
  const std::string text = in_words(a), first = text.substr(0, text.find('\n'));
  EXPECT_TRUE(begins(first, "advice: 625 nodes, ")) << text;
  EXPECT_TRUE(has(first, "the mesh's own error is not known")) << text;
  EXPECT_TRUE(has(text, "--nodes data/grid1.nodes --tets"));
  Model fine = a.model;
  fine.step.dt /= 8;
  EXPECT_LE(distance(try_out(a.model).answer, try_out(fine).answer, m.measure),
            a.error + a.uncertainty);
  rules.budget = 2 * work_of_run(m);  // one run tells no error
  EXPECT_TRUE(has(advise(m, rules).refusal, "1 step is not enough"));
  m.t_end = 1e4;
  Question q(m, {}, 1);
  const GridStudy grids(q);
  EXPECT_EQ(q.pilots.budget(), 24 * work_of_run(m));
}

// Pushed together in its plane, a cloth without gravity stays there, although
// it would buckle: the scene has an answer, and a warning.
TEST(Advise, AMotionInAPlaneHasAnAnswer) {
  Model m;
  m.nodes = "data/grid1.nodes", m.tets = "data/grid1.tets";
  m.material = {.density = 0.3, .modulus = 200, .drag = 1};
  m.gravity = 0;
  m.t_end = 1, m.tolerance = 1e-3, m.measure = Measure::positions;
  for (bool pushed : {false, true}) {
    m.pins = {read_pin("x 0"), read_pin(pushed ? "x 1 velocity -0.2 0 0"
                                               : "x 1 velocity 0.2 0 0")};
    const Advice a = advise(m);
    EXPECT_EQ(a.refusal, "") << pushed;
    EXPECT_EQ(a.buckles.find("no node ever leaves its plane along z"),
              pushed ? 0u : std::string::npos)
        << a.buckles;
  }
}

// The last condition counts the uncertainty with the scatter of perturbed
// starts: a sheet that falls has no other one, so only that can refuse it.
TEST(Advise, CountsTheScatterWhenItAccepts) {
  Model m = hanging(1e-3);
  m.pins.clear();
  AdviceRules rules;
  rules.counted_share = 100;
  const Advice a = advise(m, rules);
  ASSERT_EQ(a.refusal, "");
  EXPECT_GT(a.uncertainty, 1e-8);
  EXPECT_LE(a.error + rules.counted_share * a.uncertainty, m.tolerance);
  rules.counted_share = 30 * m.tolerance / a.uncertainty;
  rules.most_nodes = 100;
  EXPECT_NE(advise(m, rules).refusal, "");
}

// ---------------------------------------------------------------------- Budget

TEST(Budget, ForeseesWhatARunCosts) {
  Model m = hanging(1);
  m.method = &table::verlet;
  m.step = {.dt = 0.002};
  const double first = StepCosts(m).springs();  // the force at the start
  EXPECT_EQ(work_of_run(m), try_out(m).work - first);
  m.step = {.rule = StepRule::safe};
  EXPECT_NEAR(work_of_run(m), try_out(m).work - first, 1e-12 * work_of_run(m));
  const double verlet = work_of_run(m);
  m.method = &table::tr_bdf2;
  EXPECT_GT(work_of_run(m), 20 * verlet);  // by the same step, with solves
}

TEST(Budget, IsKeptAndSaysWhatItLeftOut) {
  double before = 0;
  for (double budget : {1e4, 1e5, 1e6, 1e7}) {
    AdviceRules rules;
    rules.budget = budget;
    int told = 0;
    double last = 0;
    rules.tell = [&](const std::string& doing, double done) {
      EXPECT_NE(doing, "");
      EXPECT_LE(done, 1);
      EXPECT_GE(done, last);
      last = done, ++told;
    };
    const Advice a = advise(hanging(1e-4), rules);
    EXPECT_LE(a.spent_work, budget);
    EXPECT_GE(a.spent_work, before);
    before = a.spent_work;
    EXPECT_GT(told, 0);
    EXPECT_FALSE(a.left_out.empty()) << budget;
    if (budget == 1e4) {
      EXPECT_TRUE(has(a.refusal, "the budget ended"));
    }
    // The same again: no clock has a say.
    rules.tell = [](const std::string&, double) {};
    EXPECT_EQ(advise(hanging(1e-4), rules).spent_work, a.spent_work);
  }
  EXPECT_TRUE(advise(hanging(1e-2)).left_out.empty());
}

// More work finds at least what less work found; the work that a refusal names
// is more than the work that was allowed.
TEST(Budget, MoreOfItLosesNothing) {
  Model swing = hanging(2e-3), late = hanging(0.02);
  late.sheets = {read_sheet("nodes 11 11")};
  late.pins = {read_pin("x 0"), read_pin("x 1")};
  late.spheres = {read_sphere("at 0.5 0.5 -0.5 radius 0.3 velocity 0 0 1")};
  for (const Model& m : {swing, late}) {
    std::string found;
    for (double budget : {1e3, 3e4, 3e5, 3e6, 3e7, 3e8}) {
      AdviceRules rules;
      rules.budget = budget;
      const Advice a = advise(m, rules);
      EXPECT_EQ(a.refusal == "", found != "" || a.refusal == "") << budget;
      if (found != "") {
        EXPECT_EQ(as_options(a.model), found) << budget;
      }
      if (a.refusal.empty() && a.left_out.empty()) found = as_options(a.model);
      const auto at = a.refusal.find("--advise-work ");
      if (at != std::string::npos) {
        EXPECT_GT(std::stod(a.refusal.substr(at + 14)), budget);
      }
    }
    EXPECT_NE(found, "");
  }
}

TEST(Budget, ARefusalNamesTheToleranceAndTheWorkThatAreEnough) {
  Model m = hanging(0.2);
  m.t_end = 0.5, m.measure = read_measure("pin-force z 0");
  AdviceRules rules;
  rules.budget = 1e6;
  const std::string why = advise(m, rules).refusal;
  auto named = [&](const std::string& option) {
    const auto at = why.find(option);
    EXPECT_NE(at, std::string::npos) << why;
    return std::stod(why.substr(at + option.size()));
  };
  Model easier = m;
  easier.tolerance = named("--tolerance ");
  EXPECT_GT(easier.tolerance, m.tolerance);
  EXPECT_EQ(advise(easier, rules).refusal, "");
  rules.budget = named("--advise-work ");
  EXPECT_EQ(advise(m, rules).refusal, "");
}

// ---------------------------------------------------------------------- Words

// The first line does not promise more than is known.
TEST(InWords, SaysWhereTheErrorMayExceedTheTolerance) {
  Advice a;
  a.model = hanging(1e-3);
  a.model.step = {.dt = 1e-3};
  a.tolerance = 1e-3, a.error = 0.8e-3;
  for (auto [u, exceeds] : {std::pair(0.19e-3, false), {0.21e-3, true}}) {
    a.uncertainty = u;
    const std::string text = in_words(a);
    const auto said = text.find("it may be more");
    EXPECT_EQ(said < text.find('\n'), exceeds) << text;
  }
}

// -------------------------------------------------------------------- Refusals

TEST(Refusals, TellWhyGridsConvergeSlowly) {
  Model m = hanging(1e-5);
  m.pins = {read_pin("x 0 z 0"), read_pin("x 1 z 0")};
  EXPECT_TRUE(has(converging_slowly(m), "--pin \"x 0\""));
  AdviceRules rules;
  rules.budget = 5e6;
  const Advice a = advise(m, rules);
  ASSERT_GE(a.grids.size(), 3u);
  EXPECT_TRUE(has(a.refusal, converging_slowly(m)));
  m.pins = {read_pin("z 0")};
  EXPECT_EQ(converging_slowly(m), "");
}

TEST(Refusals, OfferWhatOneWouldAsk) {
  const Model m = hanging(1);
  std::vector<Answer> still(5), shaken(5);
  still[std::size_t(Measure::com)] = {0, 0, 0};
  shaken[std::size_t(Measure::com)] = {0, 0, 1};  // 1 m of a cloth of 1.4 m
  still[std::size_t(Measure::drape_height)] = {-1};
  shaken[std::size_t(Measure::drape_height)] = {-1.01};
  Model asked = m;
  asked.measure = Measure::energy;
  const std::string some = offers(asked, still, shaken);
  EXPECT_TRUE(has(some, "--measure drape-height to 0.04 m"));
  EXPECT_FALSE(has(some, "com"));
  EXPECT_TRUE(has(offers(asked, still, {}), "earlier --t-end"));
}

}  // namespace
