// Advise.hpp: what is said of a scene's own grid and step, tolerances in
// percent, and the advice as JSON.
#include <gtest/gtest.h>

#include <cmath>

#include "lab/advice/Advise.hpp"
#include "lab/methods/Methods.hpp"
#include "lab/scenes/SceneFile.hpp"
#include "lab/scenes/StoredScenes.hpp"
#include "lab/scenes/Words.hpp"
#include "lab/stepping/Trial.hpp"
#include "tests/ReadParts.hpp"
#include "tests/Says.hpp"

using namespace lab;

namespace {

Model hanging(const std::string& grid) {
  Model m = with_sheet(grid);
  m.material = {.density = 0.3, .modulus = 200, .drag = 3};
  m.pins = {read_pin("x 0"), read_pin("x 1")};
  m.method = &table::verlet;
  m.t_end = 2, m.step.dt = 0.0005;
  return m;
}

// It falls by g T^2/2, by symplectic Euler g T dt/2 less: an error of the step
// alone.
TEST(Assess, TellsTheErrorOfTheStep) {
  Model m = hanging("nodes 9 9");
  m.pins.clear(), m.material.drag.reset();
  m.method = &table::symplectic_euler;
  m.t_end = 0.5;
  for (double dt : {0.001, 0.0005}) {
    m.step.dt = dt;
    m.tolerance = grav * m.t_end * 0.0008 / 2;  // that of a step of 0.8 ms
    const Advice a = assess(m);
    ASSERT_TRUE(a.own);
    const double error = grav * m.t_end * dt / 2;
    EXPECT_NEAR(a.own->step, error, 1e-6);
    EXPECT_NEAR(a.own->total, error, 1e-4 * error + a.grids.uncertainty());
    EXPECT_LT(a.own->grid, a.grids.uncertainty() + 1e-6);
    EXPECT_NEAR(a.own->of_stable, dt / Scene(m).safe_limit(*m.method), 1e-12);
    const std::string text = in_words(a);
    EXPECT_TRUE(has(text, dt > 0.0008 ? ": this run does not meet it\n"
                                      : ": this run meets it\n"));
    // The largest step that it tries below 0.8 ms, and no larger one.
    ASSERT_EQ(a.refusal, "") << text;
    EXPECT_LE(a.model.step.dt, 0.0008);
    EXPECT_GT(a.model.step.dt, 0.0008 / std::sqrt(2) * 0.99);
    EXPECT_EQ(a.model.method, m.method);
    EXPECT_EQ(a.model.sheets, m.sheets);
  }
}

TEST(Assess, TellsTheErrorOfTheGrid) {
  Model m = hanging("nodes 9 9");
  m.measure = Measure::drape_height, m.tolerance = 1e-4;
  const Advice a = assess(m);
  ASSERT_TRUE(a.own);
  const double right = -0.080587;  // of 129 x 129 nodes [m]
  const double error = std::abs(try_out(m).answer[0] - right);
  EXPECT_NEAR(a.own->grid, error, a.grids.uncertainty() + 2e-6);
  EXPECT_NEAR(a.own->total, error, a.grids.uncertainty() + 2e-6);
  EXPECT_LT(a.own->step, 1e-6);
  EXPECT_GT(a.own->grid, 1.5e-4);
  // No step mends a grid.
  EXPECT_TRUE(has(a.refusal, "--advise finds a grid"));
  EXPECT_TRUE(has(in_words(a), "does not meet it\n  no step"));
}

TEST(Percent, IsOfTheChangeOrOfTheAnswer) {
  Model m = hanging("nodes 9 9");
  m.tolerance = 5, m.percent = true;
  for (const char* measure : {"com", "drape-height", "point z"}) {
    m.measure = read_measure(measure);
    const Advice a = advise(m);
    ASSERT_EQ(a.refusal, "") << measure;
    const Scene start(m);
    EXPECT_NEAR(a.tolerance,
                0.05 * distance(answer(start), a.grids.limit(), m.measure),
                1e-12);
    EXPECT_EQ(asked(a), "(asked: 5 % of the change since t = 0, " +
                            with_unit(a.tolerance, m.measure) + ')');
  }
  m.edges.diagonals = false;  // no singular corners
  for (const char* measure : {"max-stretch", "pin-force", "pin-force x 0"}) {
    m.measure = read_measure(measure);
    const Advice a = advise(m);
    ASSERT_EQ(a.refusal, "") << measure;
    EXPECT_NEAR(a.tolerance, 0.05 * a.grids.limit()[0], 1e-12);
    EXPECT_EQ(asked(a), "(asked: 5 % of the answer, " +
                            with_unit(a.tolerance, m.measure) + ')');
  }
  m.measure = read_measure("com y");  // does not change
  EXPECT_EQ(advise(m).refusal,
            "5 % of the change since t = 0, but that is 0: expected a "
            "tolerance with its unit");
}

TEST(Percent, IsReadAndWritten) {
  Model m = hanging("nodes 9 9");
  m.tolerance = 0.7, m.percent = true;
  const std::string text = to_scene_file(m);
  EXPECT_TRUE(has(text, "tolerance = \"0.7%\""));
  const Model again = StoredScene{"s", "s", text.c_str()}.model();
  EXPECT_TRUE(again.percent);
  EXPECT_EQ(again.tolerance, 0.7);
}

TEST(Json, HasTheAdvice) {
  Model m = hanging("nodes 9 9");
  m.measure = Measure::drape_height, m.tolerance = 0.002;
  const std::string text = as_json(advise(m));
  EXPECT_TRUE(begins(text,
                     "{\"measure\":\"drape-height\",\"unit\":\"m\","
                     "\"tolerance\":0.002,"));
  for (const char* name :
       {"limit", "limit_uncertainty", "observed_order", "options", "nodes",
        "method", "dt_s", "t_end_s", "error", "uncertainty", "answer",
        "work_spring_evaluations", "spent_spring_evaluations"})
    EXPECT_TRUE(has(text, ",\"" + std::string(name) + "\":")) << name;
  EXPECT_FALSE(has(text, "own_"));
  EXPECT_FALSE(has(text, "nan"));
  EXPECT_FALSE(has(text, "inf"));
  EXPECT_TRUE(has(as_json(assess(m)), "\"own_step_error\":"));
  m.tolerance = 1e-9;
  AdviceRules little;
  little.budget = 1e5;
  const std::string refused = as_json(advise(m, little));
  EXPECT_TRUE(has(refused, "\"refusal\":\"the budget ended"));
  EXPECT_FALSE(has(refused, "options"));
}

}  // namespace
