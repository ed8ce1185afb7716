// Scene.hpp: the scenes of the assignment as they really run.
#include <gtest/gtest.h>

#include "lab/fast/Energy.hpp"
#include "lab/fast/GraphArrays.hpp"
#include "lab/stepping/Scene.hpp"
#include "tests/Stages.hpp"

using namespace lab;

namespace {

TEST(Scene, ConstraintsHoldInEveryStep) {
  Scene scene(stage_scene("constraints", 15));
  bool touched_ball = false, touched_floor = false;
  for (int n = 0; n < 3000; ++n) {
    ASSERT_TRUE(scene.step());
    for (Node m : scene.cloth().nodes()) {
      double distance = norm(m.position() - Ball().center);
      ASSERT_GE(distance, Ball().radius - 1e-15);
      ASSERT_GE(m.position().z, -0.75);
      touched_ball |= distance < Ball().radius + 1e-15;
      touched_floor |= m.position().z == -0.75;
    }
  }
  EXPECT_TRUE(touched_ball);
  EXPECT_TRUE(touched_floor);
}

TEST(Scene, RestartRepeatsTheRunExactly) {
  Scene scene(stage_scene("tear", 15));
  auto run = [&scene] {
    for (int n = 0; n < 1500; ++n) scene.step();
    std::vector<Point> x;
    for (Node n : scene.cloth().nodes()) x.push_back(n.position());
    return x;
  };
  auto first = run();
  EXPECT_LT(first.size(), 225u);
  scene.restart();
  EXPECT_EQ(scene.steps(), 0);
  EXPECT_EQ(scene.cloth().num_nodes(), 225u);
  EXPECT_EQ(run(), first);
}

TEST(Scene, RunsToTheEndAndCallsAfterEachStep) {
  Model m = stage_scene("forces", 5);
  m.step.dt = 0.01;  // 0.07 / 0.01 is rounded up: 7.000000000000001
  Scene scene(m);
  EXPECT_FALSE(scene.done(0.07));
  int calls = 0;
  EXPECT_TRUE(scene.run_to(0.07, [&] { EXPECT_EQ(scene.steps(), ++calls); }));
  EXPECT_EQ(calls, 7);
  EXPECT_TRUE(scene.done(0.07));
  EXPECT_TRUE(scene.run_to(0.07, [&] { ++calls; }));  // there already
  EXPECT_EQ(calls, 7);
  EXPECT_FALSE(scene.done(0.08));
}

TEST(Scene, RunsToItsFailure) {
  Scene scene(stage_scene("tear", 100));
  int calls = 0, failed = 0;
  EXPECT_FALSE(scene.run_to(5, [&] {
    ++calls;
    failed += scene.failure().has_value();
  }));
  EXPECT_TRUE(scene.done(5));
  EXPECT_EQ(failed, 1);
  EXPECT_GT(calls, 15);
  EXPECT_FALSE(scene.run_to(5, [&] {
    ++calls;
    ADD_FAILURE();
  }));
}

// What diverges in the last steps is found at the end, whatever the guard's
// interval.
TEST(Scene, ChecksTheStateAtTheEnd) {
  Scene scene(stage_scene("tear", 100));
  EXPECT_FALSE(scene.run_to(0.02));
  EXPECT_EQ(scene.steps(), 13);
}

// A picture of a failure shows the first state in which a node has gone that
// far; the scene itself stays where it is.
TEST(Scene, IsSeenBeyondItsFailure) {
  Scene scene(stage_scene("tear", 100));
  while (scene.step()) ASSERT_LT(scene.steps(), 100);
  const double before = kinetic_energy(scene.cloth());
  for (double distance : {0.1, 0.3}) {
    const auto ahead = scene.beyond_failure(distance);
    double farthest = 0;
    for (Node n : scene.cloth().nodes())
      farthest = std::max(
          farthest,
          norm(ahead->cloth().node(n.index()).position() - n.position()));
    EXPECT_GT(farthest, distance);
    EXPECT_LT(farthest, 30 * distance);  // a step multiplies it by less
    EXPECT_GT(ahead->time(), scene.time());
    EXPECT_EQ(text_of(ahead->failure()), text_of(scene.failure()));
  }
  EXPECT_EQ(scene.steps(), 13);
  EXPECT_EQ(kinetic_energy(scene.cloth()), before);
}

// At 300 times the gravity of the Earth the ball is two steps of 0.01 s away.
TEST(Scene, WatchesFastNodesFromTheFirstStepOn) {
  Model m = stage_scene("tear", 5);
  m.step.dt = 0.01, m.gravity = 3000;
  Scene scene(m);
  for (int n = 0; n < 3; ++n) ASSERT_TRUE(scene.step());
  EXPECT_GT(scene.watched().count(), 0);
  EXPECT_GT(scene.watched().first().length, Ball().radius);
  Scene slow(stage_scene("tear", 5));
  for (int n = 0; n < 1000; ++n) ASSERT_TRUE(slow.step());
  EXPECT_EQ(slow.watched().count(), 0);
}

TEST(Scene, RunsWithoutSpringsGravityOrWithOneQuad) {
  for (const char* stage : {"problem1", "tear"}) {
    Model m = stage_scene(stage, 2);
    m.stiffness = 0, m.gravity = 0;
    Scene still(m);
    for (int n = 0; n < 100; ++n) ASSERT_TRUE(still.step());
    EXPECT_EQ(kinetic_energy(still.cloth()), 0);
    m = stage_scene(stage, 2);
    m.gravity = Gravity(Point(0, 0, 9.81));
    Scene up(m);
    for (int n = 0; n < 100; ++n) ASSERT_TRUE(up.step());
    EXPECT_GT(center_of_mass(up.cloth()).z, 0);
  }
}

}  // namespace
