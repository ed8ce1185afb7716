// How far runs that should be the same get apart, what tolerance a run keeps,
// and how far its energy is off.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "lab/fast/GraphArrays.hpp"
#include "lab/methods/Methods.hpp"
#include "lab/stability/EnergyBalance.hpp"
#include "lab/stepping/Accuracy.hpp"
#include "lab/stepping/Scene.hpp"
#include "lab/stepping/Separation.hpp"
#include "tests/Says.hpp"

using namespace lab;

namespace {

Model sheet(unsigned n, double t_end) {
  Model m;
  m.sheets.resize(1), m.sheets[0].nodes = {n, n};
  m.t_end = t_end;
  m.method = &table::rkn64;
  m.step = {.dt = std::min(1 / 30., t_end)};
  return m;
}
/** Hangs by two corners, without drag: it buckles. */
Model hanging(unsigned n, double t_end) {
  Model m = sheet(n, t_end);
  m.pins = {Pin{0, 0, {}, {}, {}}, Pin{1, 0, {}, {}, {}}};
  return m;
}

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

// ---------------------------------------------------------------- Energy

/** The energy watch's verdict on a run. */
EnergyWatch watched(Model m, const char* method, double dt) {
  m.method = find_method(method), m.step = {.dt = dt};
  Scene scene(m);
  scene.watch_energy(m.t_end);
  EXPECT_TRUE(scene.run_to(m.t_end));
  return *scene.energy_watch();
}

TEST(EnergyWatch, TellsWhatTheMethodMadeOrLost) {
  Model m = hanging(9, 2);
  const double limit = 2 / std::sqrt(12 * 100. * 81);
  const EnergyWatch good = watched(m, "verlet", limit / 4);
  EXPECT_LT(std::abs(good.share()), 0.01);
  EXPECT_LE(good.gain(), good.tolerance());
  const EnergyWatch loss = watched(m, "implicit-euler", 0.02);
  EXPECT_LT(loss.share(), -0.1);
  EXPECT_LE(loss.gain(), loss.tolerance());
  m.stiffness = 1e4;
  const EnergyWatch sick = watched(m, "xpbd", 0.0333);
  EXPECT_GT(std::abs(sick.share()), 0.1);
  EXPECT_GT(sick.gain(), sick.tolerance());
}

// Whatever is named that does not act: a floor far below, air so thin, a pin
// that hardly moves.
TEST(EnergyWatch, JudgesTheSameWhateverElseIsNamed) {
  for (int part : {0, 1, 2, 3}) {
    Model m = sheet(9, 2);
    m.sheets[0].velocity = Point(0, 0, 4);
    m.pins = {Pin{0, 0, {}, {}}};
    if (part == 1) m.planes = {{.at = Point(0, 0, -50), .motion = {}}};
    if (part == 2) m.damping = 1e-7;
    if (part == 3) m.pins[0].motion = {Point(1e-5, 0, 0), 1};
    const EnergyWatch gains = watched(m, "implicit-euler", 0.05);
    EXPECT_TRUE(gains.gains()) << part;
    EXPECT_NEAR(gains.gain(), 5.2, 0.1) << part;
    EXPECT_TRUE(gains.is_off()) << part;
    EXPECT_EQ(gains.taken(), 0);
    const EnergyWatch good = watched(m, "verlet", 0.001);
    EXPECT_FALSE(good.gains() || good.is_off()) << part;
  }
  Model m = sheet(9, 1);  // it falls onto a floor, which takes its energy
  m.planes = {{.at = Point(0, 0, -0.3), .motion = {}}};
  const EnergyWatch falls = watched(m, "verlet", 0.001);
  EXPECT_GT(falls.taken(), 2);
  EXPECT_LT(std::abs(falls.off()), 0.05);
  EXPECT_FALSE(falls.gains() || falls.is_off());
}

// What contact took bounds what is put down to it: 0.6 J here, by Verlet.
TEST(EnergyWatch, JudgesWhatAMethodLosesWhileSomethingTouches) {
  Model m = sheet(8, 0.76);
  m.sheets[0].velocity = Point(0, 0, 1.4);
  m.pins = {Pin{0, {}, {}, {}}};
  m.planes = {{.at = Point(0, 0, -0.3), .motion = {}}};
  m.stiffness = 750;
  const EnergyWatch loss = watched(m, "implicit-euler", 0.01);
  EXPECT_LT(loss.off(), -0.5);
  EXPECT_TRUE(loss.is_off());
  const EnergyWatch good = watched(m, "verlet", 0.0005);
  EXPECT_GT(good.taken(), 0.1);
  EXPECT_FALSE(good.gains() || good.is_off());
}

// A loose cloth falls for 6 steps: the positions of implicit Euler are a step
// ahead, a sixth of the energy. After 100 steps that is 1 %.
TEST(EnergyWatch, JudgesALossOfAFewStepsOfFall) {
  Model m = sheet(4, 0.48);
  EXPECT_TRUE(watched(m, "implicit-euler", 0.08).is_off());
  EXPECT_FALSE(watched(m, "implicit-euler", 0.0048).is_off());
  EXPECT_FALSE(watched(m, "tr-bdf2", 0.08).is_off());
}

// In 5 steps from rest an Euler method is off by a fifth. A gain of that share
// is tolerated only where velocities are ahead.
TEST(EnergyWatch, ToleratesOneOfNOnlyWhereVelocitiesAreAhead) {
  for (const char* name :
       {"symplectic-euler", "forward-euler", "implicit-euler"}) {
    const EnergyWatch w = watched(hanging(5, 0.02), name, 0.004);
    const bool ahead = find_method(name)->info.ahead();
    EXPECT_NEAR(w.share(), ahead ? 0.2 : -0.2, 0.01) << name;
    EXPECT_NEAR(w.tolerance() * w.share() / w.off(), ahead ? 0.35 : 0.1, 0.01);
  }
}

// A method's loss is its own where something tears: what is torn is known.
TEST(EnergyWatch, JudgesLossesBesideContactAndTearing) {
  Model m = hanging(9, 2);
  m.tears = {Ball{Point(0.5, 0.5, -0.2), 0.05}};
  const EnergyWatch loss = watched(m, "implicit-euler", 0.02);
  EXPECT_GT(loss.taken(), 0);
  EXPECT_TRUE(loss.is_off());
  const EnergyWatch good = watched(m, "verlet", 0.001);
  EXPECT_GT(good.taken(), 0);
  EXPECT_FALSE(good.gains() || good.is_off());
}

TEST(EnergyWatch, HasNoShareWhereNothingIsStretched) {
  Model m = sheet(4, 0.5);
  m.sheets[0].velocity = Point(1, 0, 2);
  const EnergyWatch flight = watched(m, "verlet", 0.01);
  EXPECT_EQ(flight.share(), 0);
  EXPECT_LT(std::abs(flight.off()), 1e-12);
  EXPECT_LE(flight.gain(), flight.tolerance());
  const EnergyWatch early = watched(m, "symplectic-euler", 0.01);
  EXPECT_EQ(early.share(), 0);
  EXPECT_LE(early.gain(), early.tolerance());
}

}  // namespace
