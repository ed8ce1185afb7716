// How far runs that should be the same get apart, and what tolerance a run
// keeps.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "lab/fast/GraphArrays.hpp"
#include "lab/methods/Methods.hpp"
#include "lab/stepping/Accuracy.hpp"
#include "lab/stepping/Scene.hpp"
#include "tests/Built.hpp"
#include "tests/Says.hpp"

using namespace lab;

namespace {

Model sheet(unsigned n, double t_end) {
  Model m = square(n, t_end);
  m.method = &table::rkn64;
  m.step = {.dt = std::min(1 / 30., t_end)};
  return m;
}
/** It buckles. */
Model hanging(unsigned n, double t_end) { return hung(sheet(n, t_end)); }

Track track_of(const Model& m, const Point& off = Point(), double from = 0) {
  Scene scene(m);
  Track track(m.t_end, scene.cloth().num_nodes());
  scene.run_to(m.t_end, [&] {
    if (scene.time() > from)
      for (Node n : scene.cloth().nodes()) n.position() += off;
    track.look(scene);
    if (scene.time() > from)
      for (Node n : scene.cloth().nodes()) n.position() -= off;
  });
  return track;
}

TEST(Separation, IsTheDistanceOfTheNodesAtEachTimeThatBothHaveKept) {
  Model m = sheet(3, 0.5);
  m.gravity = 0, m.stiffness = 0;
  m.method = &table::verlet, m.step.dt = 0.01;
  const Track still = track_of(m);
  const Separation same(still, track_of(m));
  EXPECT_EQ(same.most().rms, 0);
  EXPECT_EQ(same.horizon(0), 0.5);
  const Separation apart(still, track_of(m, Point(3e-4, 4e-4, 0), 0.245));
  EXPECT_NEAR(apart.most().rms, 5e-4, 1e-15);
  EXPECT_NEAR(apart.most().largest, 5e-4, 1e-15);
  EXPECT_NEAR(apart.horizon(4.9e-4), 0.24, 1e-12);
  EXPECT_EQ(apart.horizon(5.1e-4), 0.5);
  EXPECT_EQ(apart.all().size(), 50u);  // each step
}

TEST(Separation, IsInfiniteOnceOtherNodesAreTornOff) {
  Model m = sheet(4, 0.2);
  m.method = &table::verlet, m.step.dt = 0.01;
  Model torn = m;
  torn.tears = {Ball{Point(0, 0, -0.05), 0.02}};
  const Separation apart(track_of(m), track_of(torn));
  EXPECT_TRUE(std::isinf(apart.most().rms));
  EXPECT_GT(apart.horizon(1), 0);
  EXPECT_LT(apart.horizon(1), 0.15);
}

/** The RMS distance over the nodes [m] of a run of @a m, as @a found says, from
 * one by another method and much smaller errors, at t-end. */
double error_of(Model m, const Accuracy& found) {
  m.step = found.step;
  Scene run(m);
  EXPECT_TRUE(run.run_to(m.t_end));
  m.method = &table::rkn64;
  m.step.tolerance = found.step.tolerance / 1e4;
  Scene exact(m);
  EXPECT_TRUE(exact.run_to(m.t_end));
  double sum = 0;
  for (Node n : run.cloth().nodes())
    sum += normSq(n.position() -
                  arrays(exact.cloth()).node_with_id(n.id()).position());
  return std::sqrt(sum / run.cloth().num_nodes());
}

Accuracy accuracy(Model m, double asked) {
  m.step.tolerance = asked / 4;
  return find_accuracy(m, asked, [](const std::string&, double) {});
}

TEST(Accuracy, OfASmoothMotionIsKeptByTheFirstToleranceOrALarger) {
  Model m = sheet(5, 1);
  m.pins = {Pin{{}, 0, {}, {}, {}}};
  for (double asked : {1e-3, 1e-6, 1e-9}) {
    const Accuracy a = accuracy(m, asked);
    EXPECT_TRUE(a.kept()) << a.text();
    EXPECT_GE(a.step.tolerance, asked / 4);
    EXPECT_LE(a.rms, asked);
    EXPECT_LE(a.rms, a.largest);
    EXPECT_LE(error_of(m, a), 1.2 * a.rms) << asked;
  }
}

// One run by a local error of a quarter of the tolerance misses it by far.
TEST(Accuracy, OfAClothThatBucklesTakesSmallerInnerSteps) {
  const Model m = hanging(9, 3);
  const Accuracy a = accuracy(m, 1e-4);
  EXPECT_TRUE(a.kept()) << a.text();
  EXPECT_LT(a.step.tolerance, 1e-4 / 8);
  EXPECT_LE(error_of(m, a), 1e-4);
  Accuracy first = a;
  first.step.tolerance = 1e-4 / 4, first.step.dt = m.step.dt;
  EXPECT_GT(error_of(m, first), 1e-4);
}

TEST(Accuracy, OfAChaoticMotionHasAHorizon) {
  Model m = hanging(11, 3);
  const Accuracy a = accuracy(m, 1e-6);
  EXPECT_FALSE(a.kept());
  EXPECT_GT(a.horizon, 0.3);
  EXPECT_LT(a.horizon, 2.9);
  EXPECT_LE(error_of(m, a), 10 * a.rms);  // chaos: no two are alike
  EXPECT_TRUE(has(a.text(), "positions to 1e-06 m: predictable to "));
  m.t_end = a.horizon;
  EXPECT_LE(error_of(m, a), 2e-6);
}

TEST(Accuracy, OfContactCountsWithFirstOrder) {
  Model m = sheet(6, 0.6);
  m.spheres = {Solid{Ball{Point(0.5, 0.5, -0.4), 0.3}, 0, {}}};
  const Accuracy a = accuracy(m, 1e-2);
  const double error = error_of(m, a);
  EXPECT_LE(error, std::max(1e-2, a.rms)) << a.text();
}

TEST(Accuracy, IsNotMadeUpWhereARunFails) {
  Model m = hanging(4, 0.1);
  m.step.tolerance = 1e-30;
  const Accuracy a = find_accuracy(m, 4e-30, [](const std::string&, double) {});
  EXPECT_FALSE(a.kept());
  EXPECT_TRUE(has(a.text(), "not measured: "));
}

}  // namespace
