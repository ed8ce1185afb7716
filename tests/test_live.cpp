// lab/live/Live.hpp: what each request does to the physics, in numbers from
// theory; two methods side by side; and that a recording runs again to the same
// bits.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <numbers>
#include <random>

#include "lab/fast/Energy.hpp"
#include "lab/fast/GraphArrays.hpp"
#include "lab/live/Recording.hpp"
#include "lab/methods/Methods.hpp"
#include "lab/stepping/Checkpoint.hpp"
#include "tests/TestFolder.hpp"

using namespace lab;

namespace {

const MethodEntry* method(const char* name) { return find_method(name); }

/** A sheet of side x side nodes over the unit square, of 1 kg, by verlet. */
Model loose(unsigned side, double gravity = 0, double dt = 0.001) {
  Model m;
  m.sheets = {{.nodes = {side, side}}};
  m.gravity = gravity;
  m.method = method("verlet");
  m.step = {.dt = dt};
  return m;
}
/** The same, held at two corners. */
Model hung(unsigned side, double gravity = grav, double dt = 0.001) {
  Model m = loose(side, gravity, dt);
  for (double x : {0, 1}) m.pins.push_back({x, 0, 0, {}});
  return m;
}
void run(Live& live, int steps) {
  for (int k = 0; k < steps; ++k) ASSERT_TRUE(live.step());
}
std::vector<Point> positions(const Cloth& g) {
  return {arrays(g).positions().begin(), arrays(g).positions().end()};
}
Point velocity(const Cloth& g) {  // of the center of mass
  Point p;
  for (Node n : g.nodes()) p += n.value().mass * n.value().vel;
  return p / total_mass(g);
}
/** The id of the node of index @a i at the start. */
unsigned id(const Live& live, unsigned i) {
  return live.scene().recipe().built->ids[i];
}

// ------------------------------------------------------------------ Parameters

TEST(Live, ChangesNothingButWhatIsAsked) {
  Live live(hung(6));
  run(live, 100);
  const std::string requests[] = {"method pefrl", "step 0.3",
                                  "stiffness 50", "drag 0.01",
                                  "gravity 3",    request("pin", id(live, 20))};
  for (const std::string& r : requests) {
    const auto x = positions(live.scene().cloth());
    const double t = live.scene().time();
    live.apply(r);
    EXPECT_EQ(positions(live.scene().cloth()), x);
    EXPECT_EQ(live.scene().time(), t);
    EXPECT_EQ(live.readings(false).edges, 110u);
  }
  EXPECT_STREQ(live.readings().method, "pefrl");
  EXPECT_EQ(live.model().stiffness, 50);
  run(live, 10);
}

TEST(Live, GravityAcceleratesTheCenterOfMass) {
  Live live(loose(6));
  live.apply("gravity 5");
  run(live, 100);
  EXPECT_NEAR(velocity(live.scene().cloth()).z, -0.5, 1e-13);
  live.apply("gravity -2");
  run(live, 100);
  EXPECT_NEAR(velocity(live.scene().cloth()).z, -0.3, 1e-13);
}

TEST(Live, DragOfEachNodeSlowsItDownByCOverM) {
  Model m = loose(5);
  m.sheets[0].velocity = Point(1, 0, 0);
  Live live(m);
  live.apply(request("drag", 2 / 25.));  // gamma = 2 1/s
  run(live, 500);
  EXPECT_NEAR(velocity(live.scene().cloth()).x, std::exp(-1), 1e-12);
  const Readings r = live.readings();
  EXPECT_NEAR(r.drift, 0, 2e-4 * live.scene().flow().drag);
  EXPECT_NEAR(live.scene().flow().drag, 0.5 * (1 - std::exp(-2)), 1e-3);
}

TEST(Live, DragByAreaStaysByArea) {
  Model m = loose(5);
  m.material.density = 1, m.material.drag = 0.5;
  m.sheets[0].velocity = Point(1, 0, 0);
  Live live(m);
  live.apply("drag 2");
  run(live, 500);
  for (Node n : live.scene().cloth().nodes())
    EXPECT_NEAR(n.value().vel.x, std::exp(-1), 1e-12);
}

// Rest lengths stay, so the elastic energy grows by the ratio; that is work.
TEST(Live, StiffnessIsThatOfASceneMadeWithIt) {
  Model m = hung(7);
  m.regions = {{.box = {Point(0, 0, -1), Point(0.5, 1, 1)}, .stiffness = 3}};
  Live live(m);
  run(live, 200);
  const Readings before = live.readings();
  live.apply("stiffness 250");
  const Readings after = live.readings();
  EXPECT_NEAR(after.energy.elastic, 2.5 * before.energy.elastic, 1e-12);
  EXPECT_NEAR(after.drift, before.drift, 1e-12);
  EXPECT_NEAR(after.safe_limit, before.safe_limit / std::sqrt(2.5), 1e-6);
  m.stiffness = 250;
  Scene made(m);
  for (Edge e : live.scene().cloth().edges()) {
    EXPECT_EQ(e.value().K, arrays(made.cloth()).edge_values()[e.id()].K);
    EXPECT_EQ(e.value().L, arrays(made.cloth()).edge_values()[e.id()].L);
  }
  run(live, 200);
}

TEST(Live, StepIsAShareOfTheLimitOfTheMethod) {
  Live live(hung(6));
  const double limit = live.scene().safe_limit();
  live.apply("step 0.25");
  EXPECT_DOUBLE_EQ(live.scene().dt(), 0.25 * limit);
  live.apply("method pefrl");
  EXPECT_DOUBLE_EQ(live.scene().dt(), 0.25 * limit);  // as it was
  const Readings r = live.readings();
  EXPECT_NEAR(r.safe_limit, limit * method("pefrl")->info.limit / 2, 1e-9);
  EXPECT_EQ(r.dt_unit, r.safe_limit);
  // What has no limit, and what has no stable step: shares of verlet's.
  for (const char* name : {"implicit-euler", "forward-euler"}) {
    live.apply(request("method", name));
    EXPECT_DOUBLE_EQ(live.readings(false).dt_unit, limit) << name;
  }
  EXPECT_EQ(live.readings(false).safe_limit, 0);
  live.apply("stiffness 0");  // nothing bounds a step
  EXPECT_DOUBLE_EQ(live.readings().dt_unit, 0.001);
}

TEST(Live, AMethodThatCannotChooseItsStepTakesThePresentOne) {
  Model m = hung(5);
  m.step.rule = StepRule::safe;
  Live live(m);
  run(live, 20);
  const double dt = live.scene().dt();
  live.apply("method implicit-euler");
  EXPECT_EQ(live.scene().dt(), dt);
  EXPECT_TRUE(live.model().step.fixed());
  run(live, 3);
}

TEST(Live, GoesOnPastTheEndOfItsModel) {
  Model m = hung(5);
  m.t_end = 0.005;
  Live live(m);
  run(live, 20);
  EXPECT_GT(live.scene().time(), 2 * m.t_end);
  EXPECT_FALSE(live.done());
}

TEST(Live, BeyondTheLimitItFailsAndGoesOnFromTheLastGoodState) {
  Live live(hung(8));
  run(live, 300);
  live.apply("step 1.3");
  while (live.step()) ASSERT_LT(live.calls(), 1000);
  const Readings r = live.readings();
  EXPECT_TRUE(live.done());
  ASSERT_TRUE(r.failure);
  EXPECT_EQ(r.failure->kind, Failure::Kind::diverged);
  const std::string why = live.scene().explanation().text();
  EXPECT_NE(why.find("times the stability limit"), std::string::npos) << why;
  EXPECT_NE(why.find("works"), std::string::npos) << why;
  EXPECT_LT(r.energy.kinetic, 100);
  const auto x = positions(live.scene().cloth());
  live.apply(
      request("grab", id(live, 30), Point(0, 0, 1)));  // of what stands still
  EXPECT_FALSE(live.readings().grabbed);
  EXPECT_FALSE(live.step());
  live.apply("step 0.5");
  EXPECT_EQ(positions(live.scene().cloth()), x);
  EXPECT_EQ(live.scene().time(), r.time);
  run(live, 200);
}

// Verlet's energy oscillates, and does not drift, whatever the user does.
TEST(Live, DriftIsTheMethodsAlone) {
  Live live(hung(8));
  live.apply("step 0.25");
  double scale = 0, worst = 0;
  const auto look = [&] {
    const Readings r = live.readings(false);
    scale = std::max(scale, r.energy.internal());
    worst = std::max(worst, std::abs(r.drift));
  };
  for (int k = 0; k < 1500; ++k) {
    if (k == 300) live.apply("gravity 2");
    if (k == 600) live.apply(request("drag", 0.2 / 64));
    if (k == 700) live.apply(request("grab", id(live, 63), Point(1, 1, 0.5)));
    if (k > 700 && k < 900)
      live.apply(request("move", Point(1, 1 - 0.004 * (k - 700), 0.5)));
    if (k == 1000) live.apply("stiffness 200");
    if (k == 1200) live.apply("release");
    ASSERT_TRUE(live.step());
    look();
  }
  EXPECT_GT(scale, 1);
  EXPECT_LT(worst, 0.03 * scale);
  EXPECT_GT(live.scene().flow().work, 0.3);
}

TEST(Live, RestartsWithTheParametersAsTheyAre) {
  Live live(hung(5));
  const auto x = positions(live.scene().cloth());
  live.apply("gravity 4");
  live.apply(request("cut", id(live, 0), id(live, 1)));
  live.apply(request("pin", id(live, 7)));
  run(live, 50);
  live.apply("restart");
  EXPECT_EQ(positions(live.scene().cloth()), x);
  const Readings r = live.readings();
  EXPECT_EQ(r.time, 0);
  EXPECT_EQ(r.torn_edges, 0u);
  EXPECT_EQ(live.model().gravity, 4);
  EXPECT_FALSE(live.scene().is_pinned(id(live, 7)));
  EXPECT_EQ(live.calls(), 50);
}

// ------------------------------------------------------------------------ Hand

// Far away the force is its bound, so the center of mass gets F/M; released,
// it keeps its speed.
TEST(Live, HandPullsWithABoundedForce) {
  Live live(loose(6));
  const double bound = 2 * grav;  // of 1 kg
  live.apply(request("grab", id(live, 14), Point(1e7, 0, 0)));
  for (int k = 0; k < 50; ++k) {
    const Point before = velocity(live.scene().cloth());
    ASSERT_TRUE(live.step());
    ASSERT_LT(norm(velocity(live.scene().cloth()) - before),
              0.001 * bound * (1 + 1e-9));
  }
  EXPECT_NEAR(velocity(live.scene().cloth()).x, 0.05 * bound, 1e-6);
  EXPECT_TRUE(live.readings().grabbed);
  live.apply("release");
  const Point v = velocity(live.scene().cloth());
  run(live, 50);
  EXPECT_LT(norm(velocity(live.scene().cloth()) - v), 1e-12);
  EXPECT_FALSE(live.readings().grabbed);
}

// All of it comes from the hand.
TEST(Live, WorkOfTheHandIsTheEnergyOfTheCloth) {
  Live live(loose(6));
  live.apply("step 0.1");
  live.apply(request("grab", id(live, 0), Point(0.05, 0, 0.2)));
  run(live, 500);
  const Readings r = live.readings();
  EXPECT_GT(r.energy.total(), 0.01);
  EXPECT_NEAR(live.scene().flow().work, r.energy.total(),
              0.01 * r.energy.total());
  EXPECT_NEAR(r.drift, r.energy.total() - live.scene().flow().work, 1e-12);
}

TEST(Live, LimitsCountTheHand) {
  Model m = loose(6);
  m.t_end = 100;
  Live live(m);
  const double free = live.scene().safe_limit();
  live.apply(request("grab", id(live, 14), Point(0.5, 0.5, 0.1)));
  const double k = live.scene().hand()->stiffness();
  EXPECT_DOUBLE_EQ(k, 100);  // eight springs of 100 N/m
  const double held = live.scene().safe_limit();
  EXPECT_NEAR(4 / (held * held) - 4 / (free * free), 36 * k, 1e-6);
  EXPECT_GT(held, free / 1.07);
  // Within it: pulled about for long, and nothing diverges.
  live.apply("step 0.98");
  for (int n = 0; n < 2000; ++n) {
    const double a = 0.01 * n;
    live.apply(request("move", Point(std::cos(a), std::sin(a), 0.1)));
    ASSERT_TRUE(live.step()) << text_of(live.scene().failure());
  }
}

TEST(Live, EveryMethodTakesTheHand) {
  for (const MethodEntry& m : methods) {
    Model model = hung(5, grav, 0.001);
    model.method = &m;
    Live live(model);
    live.apply(request("grab", id(live, 24), Point(1, 1, 0.6)));
    run(live, 300);
    EXPECT_GT(arrays(live.scene().cloth()).positions()[id(live, 24)].z, 0.05)
        << m.info.name;
    EXPECT_FALSE(live.scene().failure()) << m.info.name;
  }
}

TEST(Live, WhatIsGoneCanNotBeGrabbedCutOrPinned) {
  Live live(hung(4));
  for (unsigned node : {16u, 4000000000u}) {
    live.apply(request("grab", node, Point()));
    live.apply(request("pin", node));
    live.apply(request("unpin", node));
    live.apply(request("cut", node, 0u));
  }
  live.apply("move 0 0 0");
  live.apply("release");
  EXPECT_FALSE(live.readings().grabbed);
  EXPECT_EQ(live.readings().torn_edges, 0u);
}

// ------------------------------------------------------------------------ Cuts

// Straight down on a flat grid, between two columns of nodes.
TEST(Cuts, AreOfTheEdgesThatTheStrokeCrosses) {
  Live live(loose(6));
  const Cloth& g = live.scene().cloth();
  const auto down = [](double x, double y) {
    return Ray{Point(x, y, 5), Point(x, y, -100)};
  };
  const std::vector<Ray> stroke = {down(0.5, -1), down(0.5, 0.11),
                                   down(0.5, 0.49)};
  const auto edges = crossed_edges(g, stroke);
  // Of 5 squares in this column: sides along x at y = 0, 0.2, 0.4; diagonals of
  // those from 0 and 0.2, and the parts below 0.49 of that from 0.4: none, as
  // its diagonals cross x = 0.5 at y = 0.5.
  EXPECT_EQ(edges.size(), 3u + 4u);
  for (const auto& [i, j] : edges) {
    const Point a = arrays(g).positions()[i], b = arrays(g).positions()[j];
    EXPECT_LT((a.x - 0.5) * (b.x - 0.5), 0);
    EXPECT_LT((a.y + b.y) / 2, 0.49);
  }
  std::string cut = "cut";
  for (const auto& [i, j] : edges) cut += request_word(i) + request_word(j);
  live.apply(cut);
  const Readings r = live.readings();
  EXPECT_EQ(r.torn_edges, 7u);
  EXPECT_EQ(r.nodes, 36u);
  for (const auto& [i, j] : edges)
    EXPECT_FALSE(
        g.has_edge(arrays(g).node_with_id(i), arrays(g).node_with_id(j)));
  EXPECT_NO_THROW(g.check_invariants());
  EXPECT_TRUE(crossed_edges(g, std::span(stroke).first(1)).empty());
  EXPECT_TRUE(crossed_edges(g, {}).empty());
}

// Seen by an eye at a point: what is behind it is not cut.
TEST(Cuts, AreInFrontOfTheEye) {
  Cloth g;
  for (double z : {-1, 1})
    for (double x : {-1, 1}) g.add_node(Point(x, 0, z));
  g.add_edge(g.node(0), g.node(1));  // before it
  g.add_edge(g.node(2), g.node(3));  // behind
  const auto ray = [](double y) {
    return Ray{Point(0, 0, -0.1), Point(0, 10 * y, -10)};
  };
  const std::vector<Ray> stroke = {ray(-0.2), ray(0.3)};
  const auto edges = crossed_edges(g, stroke);
  ASSERT_EQ(edges.size(), 1u);
  EXPECT_EQ(edges[0][0] + edges[0][1], 1u);
}

// Through the diagonal of the surface between two rays, at y = 0, or exactly
// through the second ray: from either side, by a stroke of either way.
TEST(Cuts, MissNothingWhereTrianglesMeet) {
  const auto down = [](double y) {
    return Ray{Point(0, y, 1), Point(0, y, -1)};
  };
  for (double way : {-1, 1})
    for (double from : {-1, 1}) {
      Cloth g;
      for (double y : {0., way, 3.})
        g.add_edge(g.add_node(Point(from, y, 0)),
                   g.add_node(Point(-from, y, 0)));
      const std::vector<Ray> stroke = {down(-way), down(way), down(2 * way)};
      EXPECT_EQ(crossed_edges(g, stroke).size(), 2u) << way << from;
    }
}

// ------------------------------------------------------------------------ Pins

TEST(Pins, HoldANodeWhereItIs) {
  Live live(hung(6));
  run(live, 150);
  const unsigned n = id(live, 28);
  const Point place = arrays(live.scene().cloth()).positions()[n];
  EXPECT_LT(place.z, -0.01);
  live.apply(request("pin", n));
  EXPECT_TRUE(live.scene().is_pinned(n));
  run(live, 200);
  EXPECT_EQ(arrays(live.scene().cloth()).positions()[n], place);
  live.apply(request("unpin", n));
  EXPECT_FALSE(live.scene().is_pinned(n));
  run(live, 20);
  EXPECT_NE(arrays(live.scene().cloth()).positions()[n], place);
  EXPECT_TRUE(live.scene().is_pinned(id(live, 0)));
}

TEST(Pins, OfTheSceneLetGo) {
  Model m = hung(6);
  m.pins[1].motion = {Point(0.1, 0, 0), 0.05};  // one that moves
  Live live(m);
  run(live, 100);
  live.apply(request("unpin", id(live, 0)));
  live.apply(request("unpin", id(live, 30)));
  EXPECT_FALSE(live.scene().is_pinned(id(live, 30)));
  const double v = velocity(live.scene().cloth()).z;
  run(live, 100);
  EXPECT_NEAR(velocity(live.scene().cloth()).z - v, -0.1 * grav, 1e-12);
  EXPECT_TRUE(live.scene().flow().loose);
}

// One that moves goes on moving when another one is let go.
TEST(Pins, ThatMoveGoOnMoving) {
  Model m = hung(6);
  m.pins[1].motion.velocity = Point(0, 0, 0.5);
  Live live(m);
  run(live, 100);
  live.apply(request("unpin", id(live, 0)));
  run(live, 100);
  const Point p = arrays(live.scene().cloth()).positions()[id(live, 30)];
  EXPECT_NEAR(norm(p - Point(1, 0, 0.1)), 0, 1e-12);
}

// -------------------------------------------------------------------- Readings

TEST(Readings, CountNodesOnObstacles) {
  Model m = loose(5, grav);
  m.sheets[0].at = Point(0, 0, 0.01);
  m.planes = {{.at = Point(), .motion = {}}};
  Live live(m);
  EXPECT_EQ(live.readings().touching, 0u);
  run(live, 100);
  EXPECT_EQ(live.readings().touching, 25u);
}

TEST(Readings, CountForceEvaluations) {
  for (const auto& [name, sweeps] :
       {std::pair("symplectic-euler", 1), std::pair("rk4", 4),
        std::pair("pefrl", 4)}) {
    Model m = hung(5);
    m.method = method(name);
    Live live(m);
    run(live, 100);
    const Readings r = live.readings();
    EXPECT_EQ(r.evaluations, 100 * sweeps) << name;
    EXPECT_NEAR(r.evaluations_rate, 1000 * sweeps, 1e-6) << name;
    EXPECT_EQ(r.steps, 100);
    EXPECT_NEAR(r.time, 0.1, 1e-12);
  }
}

TEST(Readings, SharpLimitMovesWithTheConfiguration) {
  Live live(hung(6, 60));
  const double flat = live.readings().sharp_limit;
  EXPECT_GT(flat, 1.1 * live.readings().safe_limit);
  run(live, 300);  // it hangs in its springs
  EXPECT_EQ(live.readings(false).sharp_limit, flat);
  EXPECT_LT(live.readings().sharp_limit, 0.98 * flat);
  EXPECT_GT(live.readings().sharp_limit, 0.98 * live.readings().safe_limit);
}

// ----------------------------------------------------------------- Side by
// side

TEST(Comparison, OfAMethodWithItselfIsZero) {
  Live live(hung(6));
  run(live, 37);
  live.apply("step 0.4");
  live.apply("compare verlet 0.4 equal-time");
  for (int k = 0; k < 100; ++k) {
    if (k == 30) live.apply(request("grab", id(live, 20), Point(0, 1, 1)));
    if (k == 40) live.apply("gravity 5");
    if (k == 50) live.apply(request("cut", id(live, 1), id(live, 2)));
    if (k == 60) live.apply(request("pin", id(live, 9)));
    ASSERT_TRUE(live.step());
    ASSERT_EQ(live.readings(false).comparison->apart.largest, 0) << k;
  }
  const Readings r = live.readings();
  EXPECT_EQ(r.comparison->error.rms, r.comparison->rival_error.rms);
  EXPECT_GT(r.comparison->error.rms, 0);
  EXPECT_EQ(r.comparison->rival.time, r.time);
  live.apply("alone");
  EXPECT_FALSE(live.readings().comparison);
  EXPECT_EQ(live.rival(), nullptr);
}

// Half the step: a quarter of the error, as the reference tells it.
TEST(Comparison, ErrorsAreOfTheOrderOfTheMethod) {
  Live live(hung(5));
  live.apply("step 0.2");
  live.apply("compare verlet 0.1 equal-time");
  run(live, 60);
  const auto c = *live.readings().comparison;
  EXPECT_NEAR(c.error.rms / c.rival_error.rms, 4, 0.4);
  EXPECT_LE(c.rival_error.rms, c.rival_error.largest);
  EXPECT_NEAR(c.rival.dt, live.scene().dt() / 2, 1e-12);
  EXPECT_STREQ(c.reference, "srkn11b");
  EXPECT_LT(c.reference_dt, live.scene().dt() * 11 / 2);
}

TEST(Comparison, AtEqualWorkHasEqualForceEvaluations) {
  Live live(hung(5));
  run(live, 10);
  for (const char* name : {"rk4", "pefrl", "srkn11b", "symplectic-euler"}) {
    live.apply(request("compare", name, 1., "equal-work"));
    const long long start = live.scene().evaluations();
    const double from = live.scene().time();
    run(live, 40);
    const Readings r = live.readings();
    EXPECT_NEAR(double(r.evaluations - start),
                double(r.comparison->rival.evaluations),
                method(name)->info.sweeps)
        << name;
    EXPECT_EQ(r.comparison->rival.time, r.time);
    EXPECT_GT(r.time, from);
    EXPECT_DOUBLE_EQ(r.comparison->rival.dt, r.dt * method(name)->info.sweeps /
                                                 method("verlet")->info.sweeps);
  }
}

TEST(Comparison, MeetsAfterAFewStepsOfAnyRatio) {
  Live live(hung(4));
  for (double share : {0.05, 0.13, 0.37, 1., 2.23}) {
    live.apply("step 0.31");
    live.apply(request("compare", "implicit-euler", share, "equal-time"));
    run(live, 2);
    const Readings r = live.readings();
    EXPECT_NEAR(r.comparison->rival.dt / (share * r.dt_unit), 1, 0.02) << share;
    EXPECT_EQ(r.comparison->rival.time, r.time);
  }
}

TEST(Comparison, OfOneThatFailsGoesOn) {
  Model m = hung(6);
  m.t_end = 100;
  Live live(m);
  live.apply("step 0.5");
  live.apply("compare symplectic-euler 1.5 equal-time");
  for (int k = 0; k < 400; ++k) ASSERT_TRUE(live.step());
  const Readings r = live.readings();
  EXPECT_TRUE(r.comparison->rival.failure);
  EXPECT_FALSE(r.failure);
  EXPECT_TRUE(std::isfinite(r.comparison->apart.rms));
  live.apply("restart");
  EXPECT_FALSE(live.readings().comparison->rival.failure);
}

// -------------------------------------------------------------------- Break it

TEST(Breakages, FailWithAReason) {
  Live live(hung(3));
  for (const StoredScene& b : failing_scenes()) {
    if (b.model().method->info.limit != 2) continue;  // test_cloth_replay
    live.apply(request("break", b.name));
    while (live.step()) {
    }
    if (std::string(b.name) == "tunnel")
      EXPECT_GT(live.scene().watched().count(), 0);
    else
      EXPECT_TRUE(live.scene().failure()) << b.name;
  }
}

// -------------------------------------------------------------------- Requests

TEST(Requests, AreRefusedAndChangeNothing) {
  Live live(hung(4));
  const std::string before = live.recording();
  for (const auto& [text, error] :
       {std::pair("", "ends too early, expected a request"),
        std::pair("gravitas 3",
                  "'gravitas' is not a request: did you mean gravity?"),
        std::pair("gravity nan", "is not finite, expected a number"),
        std::pair("gravity 1e999", "'1e999' is not a number"),
        std::pair("move 1 2 3 4",
                  "continues with '4', expected the end of the line"),
        std::pair("stiffness -1", "-1 is not 0 N/m or more")}) {
    EXPECT_EQ(Live::error_in(text), error);
    EXPECT_THROW(live.apply(text), std::invalid_argument) << text;
  }
  EXPECT_EQ(live.recording(), before);
  EXPECT_EQ(Live::error_in("cut"), "");
}

// What depends on the present state is recorded as what it came to.
TEST(Requests, OfTheMouseAreRecordedByNodes) {
  Live live(loose(3));
  const std::string start = live.recording();
  const std::string n = std::to_string(id(live, 4));
  live.apply("toggle " + n), live.apply("toggle " + n);
  live.apply("stroke 0.25 -9 9 0.25 -9 -9 0.25 9 9 0.25 9 -9");
  live.apply("stroke 5 -9 9 5 -9 -9 5 9 9 5 9 -9");  // beside it: nothing
  std::string all = live.recording().substr(start.rfind("0 end"));
  EXPECT_EQ(all.substr(0, all.find("cut")),
            "0 pin " + n + "\n0 unpin " + n + "\n0 ");
  EXPECT_EQ(std::ranges::count(all, '\n'), 4);
  EXPECT_EQ(live.readings().torn_edges, 3u + 4u);
}

TEST(Requests, SetTheParametersOfAModel) {
  Live live(hung(4));
  for (const auto& [name, value] : Live::parameters(live.model())) {
    const std::string r = request(std::string(name).c_str(), value + 0.5);
    EXPECT_TRUE(Live::overrides(r));
    live.apply(r);
  }
  EXPECT_EQ(live.model().gravity, grav + 0.5);
  EXPECT_EQ(live.model().damping, 0.5);
  EXPECT_EQ(live.model().stiffness, 100.5);
  EXPECT_FALSE(Live::overrides("restart"));
}

// ------------------------------------------------------------------- Recording

/** Requests at random, between steps, by one who looks, or does not. */
void play(Live& live, unsigned seed, bool looks) {
  std::mt19937 random(seed);
  const auto upto = [&](unsigned n) { return unsigned(random() % n); };
  const auto real = [&] { return double(random()) / 4294967296.; };
  const auto point = [&] { return Point(real(), real(), real() - 0.5); };
  for (int k = 0; k < 60; ++k) {
    const unsigned node = upto(40);
    const MethodEntry* m = &methods[upto(9)];
    switch (upto(16)) {
      case 0:
        live.apply(request("method", m->info.name));
        break;
      case 1:
        live.apply(request("step", 0.05 + 1.2 * real()));
        break;
      case 2:
        live.apply(request("stiffness", 200 * real()));
        break;
      case 3:
        live.apply(request("drag", 0.1 * real()));
        break;
      case 4:
        live.apply(request("gravity", 20 * real() - 10));
        break;
      case 5:
        live.apply("restart");
        break;
      case 6:
        live.apply(request("grab", node, point()));
        break;
      case 7:
        live.apply(request("move", point()));
        break;
      case 8:
        live.apply("release");
        break;
      case 9:
        live.apply(request("cut", node, upto(36), upto(36), upto(36)));
        break;
      case 10:
        live.apply(request("pin", node));
        break;
      case 11:
        live.apply(request("unpin", node));
        break;
      case 12:
        live.apply(request("compare", m->info.name, 0.1 + real(),
                           upto(2) ? "equal-work" : "equal-time"));
        break;
      case 13:
        live.apply("alone");
        break;
      default:
        break;
    }
    for (unsigned n = upto(12); n > 0; --n) {
      live.step();
      if (!looks || live.scene().failure().has_value()) continue;
      if (upto(3) == 0) live.check();
      if (upto(5) == 0) live.readings(upto(2) == 0);
    }
  }
}

class Recordings : public ::testing::Test {
 protected:
  const CME212::TestFolder folder;
  std::string file(const std::string& text) {
    const std::string name = folder / "input.txt";
    std::ofstream(name) << text;
    return name;
  }
};

TEST_F(Recordings, RunAgainToTheSameBits) {
  for (unsigned seed = 0; seed < 6; ++seed) {
    Model m = hung(6, grav, 0.002);
    m.name = "a \"name\"";
    m.planes = {{.at = Point(0, 0, -0.3), .friction = 0.3, .motion = {}}};
    m.tears = {Ball{Point(0.5, 0.9, -0.2), 0.1}};
    if (seed % 3 == 1) m.pins[0].motion.velocity = Point(0.1, 0, 0);
    if (seed % 3 == 2) m.step.rule = StepRule::safe;
    Live live(m);
    play(live, seed, true);
    Replay again(file(live.recording()));
    while (again.step()) {
    }
    EXPECT_EQ(again.live().calls(), live.calls());
    EXPECT_EQ(again.live().scene().time(), live.scene().time());
    EXPECT_EQ(again.live().model().name, m.name);
    ASSERT_EQ(checksum_of(again.live().scene().cloth()),
              checksum_of(live.scene().cloth()))
        << live.recording();
    ASSERT_EQ(again.live().rival() == nullptr, live.rival() == nullptr);
    if (live.rival()) {
      EXPECT_EQ(checksum_of(again.live().rival()->cloth()),
                checksum_of(live.rival()->cloth()));
    }
    EXPECT_EQ(again.live().recording(), live.recording());
  }
}

TEST_F(Recordings, HoldTheScenesThatWereLoaded) {
  Live live(hung(4));
  run(live, 5);
  Model other = hung(5);
  other.name = "other";
  other.material = {.density = 0.3, .modulus = 40, .drag = 0.2};
  live.apply(scene_request(other));
  run(live, 5);
  live.apply("break path");
  run(live, 3);
  Replay again(file(live.recording()));
  while (again.step()) {
  }
  EXPECT_EQ(again.live().calls(), 13);
  EXPECT_EQ(again.live().model().name, "path");
  EXPECT_EQ(positions(again.live().scene().cloth()),
            positions(live.scene().cloth()));
}

TEST_F(Recordings, AreRefusedWithTheLine) {
  Live live(hung(3));
  run(live, 2);
  std::string good = live.recording();
  good.erase(good.rfind("2 end"));
  const auto lines = std::ranges::count(good, '\n');
  const auto at = [&](const std::string& line) {
    const std::string name = file(good + line);
    std::string what = CME212::error_of([&] {
      Replay r(name);
      while (r.step()) {
      }
    });
    const std::string place = name + ':' + std::to_string(lines + 1) + ": ";
    return what.starts_with(place) ? what.substr(place.size()) : what;
  };
  EXPECT_EQ(at("2 end\n"), "no error");
  EXPECT_EQ(at("2 methode verlet\n"),
            "'methode' is not a request: did you mean method?");
  EXPECT_EQ(at("2 method verlett\n"),
            "'verlett' is not a method: did you mean verlet?");
  EXPECT_EQ(at("2 step -1\n"),
            "-1 is not a positive multiple of the stability limit");
  EXPECT_EQ(at("2 stiffness inf\n"), "is not finite, expected 0 N/m or more");
  EXPECT_EQ(at("2 drag x\n"), "'x' is not 0 or more");
  EXPECT_EQ(at("2 grab 1 0 0\n"),
            "ends too early, expected three coordinates [m]");
  EXPECT_EQ(at("2 cut 1\n"), "ends too early, expected the id of a node");
  EXPECT_EQ(at("2 pin -1\n"), "'-1' is not the id of a node");
  EXPECT_EQ(at("2 break steps\n"),
            "'steps' is not a failure: did you mean step?");
  EXPECT_EQ(at("2 compare rk4 1 equal\n"),
            "'equal' is not equal-time or equal-work");
  EXPECT_EQ(at("2 restart now\n"),
            "continues with 'now', expected the end of the line");
  EXPECT_EQ(at("x restart\n"), "'x' is not a number of steps");
  EXPECT_EQ(at("2\n"), "ends too early, expected a request");
  EXPECT_EQ(at("2 step 1\n1 step 1\n").substr(file("").size()),
            ":" + std::to_string(lines + 2) +
                ": 1 comes after 2, expected 2 or more");
  EXPECT_EQ(at("2 end\n3 restart\n").substr(file("").size()),
            ":" + std::to_string(lines + 2) +
                ": comes after \"end\", expected no more lines");
  EXPECT_EQ(at("2 scene 5 0 \"x\"\n| sheet = [\"nodes 3 3\"]\n3 end\n"),
            "belongs to another cloth: the mesh files or the program changed");
  EXPECT_EQ(at("2 scene 5 0 \"x\"\n3 end\n"),
            "--nodes is missing: expected files NODES and TETS, or --sheet");
  EXPECT_EQ(at("2 scene 5 0 \"x\"\n| sheet = [\"nodes 3\"]\n3 end\n")
                .substr(file("").size(), 4),
            ":" + std::to_string(lines + 2) + ":");
  // The file as a whole.
  const auto whole = [&](const std::string& text) {
    const std::string name = file(text);
    return CME212::error_of([&] { Replay r(name); }).substr(name.size());
  };
  EXPECT_EQ(whole(good), ":" + std::to_string(lines) +
                             ": ends too early, expected a line \"N end\"");
  EXPECT_EQ(whole("x\n"),
            ":1: expected \"mass_spring input 1\", the first line of a "
            "recording");
  EXPECT_EQ(whole("mass_spring input 1\n0 restart\n"),
            ":2: begins with 'restart', expected \"0 scene\"");
  EXPECT_EQ(
      whole("mass_spring input 1\n| nodes = 3\n"),
      ":2: begins with | but does not follow a scene, expected a request");
}

}  // namespace
