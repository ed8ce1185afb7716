// Scene.hpp: the stages as they really run.
#include <gtest/gtest.h>

#include "lab/scenes/Scene.hpp"

using namespace lab;

namespace {

Scene make_scene(Stage stage, unsigned side, const Parameters& with = {}) {
  return Scene(stage, grid_points(side), grid_quads(side), with);
}

TEST(Scene, AppliesTheStageToTheMesh) {
  EXPECT_EQ(make_scene(Stage::problem1, 5).cloth().num_edges(), 40u);
  for (Stage stage :
       {Stage::diagonals, Stage::forces, Stage::constraints, Stage::tear})
    EXPECT_EQ(make_scene(stage, 5).cloth().num_edges(), 72u);
}

TEST(Scene, HoldsTheCornersInEveryStage) {
  for (Stage stage : {Stage::problem1, Stage::diagonals, Stage::forces,
                      Stage::constraints, Stage::tear}) {
    Scene scene = make_scene(stage, 5);
    Node first = scene.cloth().node(0), second = scene.cloth().node(20);
    for (int n = 0; n < 2000; ++n) ASSERT_TRUE(scene.step());
    EXPECT_EQ(first.position(), Point(0, 0, 0));
    EXPECT_EQ(second.position(), Point(1, 0, 0));
    EXPECT_EQ(scene.steps(), 2000);
    EXPECT_DOUBLE_EQ(scene.time(), 2);
    EXPECT_LT(center_of_mass(scene.cloth()).z, -0.1);
  }
}

// A pin is what the assignment's step does by skipping the corners.
TEST(Scene, StageForcesIsTheStepThatSkipsTheCorners) {
  Scene scene = make_scene(Stage::forces, 10);
  Cloth g;
  build_cloth(g, grid_points(10), grid_quads(10), Mesh::diagonals);
  auto force = make_combined_force(GravityForce(), MassSpringForce());
  for (int n = 0; n < 400; ++n) {
    scene.step();
    symp_euler_step(g, 0, 0.001, force);
  }
  for (unsigned i = 0; i < g.num_nodes(); ++i)
    ASSERT_LT(norm(g.node(i).position() - scene.cloth().node(i).position()),
              1e-13);
}

TEST(Scene, DampingTakesEnergyFromStageForcesOn) {
  auto energy_after_5s = [](Stage stage, double c) {
    Scene scene = make_scene(stage, 5, {.damping = c});
    for (int n = 0; n < 5000; ++n) scene.step();
    return kinetic_energy(scene.cloth());
  };
  EXPECT_EQ(energy_after_5s(Stage::diagonals, 0.2),
            energy_after_5s(Stage::diagonals, 0));
  EXPECT_GT(energy_after_5s(Stage::forces, 0), 0.1);
  EXPECT_LT(energy_after_5s(Stage::forces, 0.2), 0.01);
}

TEST(Scene, ConstraintsHoldInEveryStep) {
  Scene scene = make_scene(Stage::constraints, 15);
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

// A whole run on grid1: no node inside the ball, and a sound graph, always.
TEST(Scene, TearsWithASoundGraphInEveryStep) {
  Scene scene = make_scene(Stage::tear, 25);
  unsigned nodes = scene.cloth().num_nodes();
  int tears = 0;
  for (int n = 0; n < 5000; ++n) {
    ASSERT_TRUE(scene.step());
    for (Point p : scene.cloth().positions())
      ASSERT_FALSE(Ball().holds(p));  // a removed node's slot holds Point()
    ASSERT_NO_THROW(scene.cloth().check_invariants());
    tears += scene.cloth().num_nodes() < nodes;
    nodes = scene.cloth().num_nodes();
  }
  EXPECT_GT(tears, 3);
  EXPECT_LT(nodes, 620u);
  EXPECT_GT(nodes, 500u);
}

TEST(Scene, RestartRepeatsTheRunExactly) {
  Scene scene = make_scene(Stage::tear, 15);
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

TEST(Scene, StopsAtTheLastGoodStateWhenItDiverges) {
  Scene scene = make_scene(Stage::tear, 100);  // grid3 at dt = 0.001 blows up
  while (scene.step()) ASSERT_LT(scene.steps(), 100);
  EXPECT_EQ(scene.steps(), 15);
  EXPECT_EQ(
      scene.failure().find("diverged in step 16 with dt = 0.001 s, method "
                           "symplectic-euler: node "),
      0u);
  EXPECT_NE(scene.failure().find("spring to node"), std::string::npos);
  EXPECT_TRUE(std::isfinite(kinetic_energy(scene.cloth())));
}

// At 300 times the gravity of the Earth the ball is two steps of 0.01 s away.
TEST(Scene, WatchesFastNodesFromTheFirstStepOn) {
  Scene scene = make_scene(Stage::tear, 5, {.dt = 0.01, .gravity = 3000});
  for (int n = 0; n < 3; ++n) ASSERT_TRUE(scene.step());
  EXPECT_GT(scene.constraint().count(), 0);
  EXPECT_GT(scene.constraint().first().length, Ball().radius);
  Scene slow = make_scene(Stage::tear, 5);
  for (int n = 0; n < 1000; ++n) ASSERT_TRUE(slow.step());
  EXPECT_EQ(slow.constraint().count(), 0);
}

TEST(Scene, RunsWithoutSpringsGravityOrWithOneQuad) {
  for (Stage stage : {Stage::problem1, Stage::tear}) {
    Scene still = make_scene(stage, 2, {.stiffness = 0, .gravity = 0});
    for (int n = 0; n < 100; ++n) ASSERT_TRUE(still.step());
    EXPECT_EQ(kinetic_energy(still.cloth()), 0);
    Scene up = make_scene(stage, 2, {.gravity = -9.81});
    for (int n = 0; n < 100; ++n) ASSERT_TRUE(up.step());
    EXPECT_GT(center_of_mass(up.cloth()).z, 0);
  }
}

}  // namespace
