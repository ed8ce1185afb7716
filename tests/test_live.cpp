// lab/live/Live.hpp: what each request does to the physics, in numbers from
// theory; two methods side by side; and that its changes, made again, give the
// same bits.
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <sstream>

#include "lab/fast/Energy.hpp"
#include "lab/fast/GraphArrays.hpp"
#include "lab/fast/OrderedCloth.hpp"
#include "lab/live/Live.hpp"
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
  for (double x : {0, 1}) m.pins.push_back({x, 0, 0, {}, {}});
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
unsigned id(const Live& live, unsigned i) { return live.scene().mesh().ids[i]; }

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
  EXPECT_EQ(live.readings().method, "pefrl");
  EXPECT_EQ(live.model().stiffness, 50);
  run(live, 10);
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
  EXPECT_TRUE(live.scene().stepper().time_step().fixed());
  run(live, 3);
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
  EXPECT_TRUE(has(why, "times the stability limit"));
  EXPECT_TRUE(has(why, "works"));
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

TEST(Live, RestartsAsItWasMade) {
  Model m = hung(5);
  m.at = {"0.002 gravity 4", "0.003 method rk4"};
  Live live(m);
  const auto x = positions(live.scene().cloth());
  live.apply(request("cut", id(live, 0), id(live, 1)));
  live.apply(request("pin", id(live, 7)));
  run(live, 50);
  EXPECT_EQ(live.scene().changes_left(), 0u);
  live.restart(m);
  EXPECT_EQ(positions(live.scene().cloth()), x);
  EXPECT_EQ(live.readings().torn_edges, 0u);
  EXPECT_EQ(live.model().gravity, grav);
  EXPECT_FALSE(live.scene().is_pinned(id(live, 7)));
  run(live, 50);
  Live other(m);
  run(other, 50);
  EXPECT_EQ(positions(live.scene().cloth()), positions(other.scene().cloth()));
  EXPECT_EQ(live.recording(), "50 end\n");
}

// A rope with its nodes in any order lies in memory from end to end.
TEST(Live, NamesNodesByTheirNumbersInTheNet) {
  constexpr unsigned n = 3000;
  const auto number = [](unsigned k) { return k * 1237 % n; };
  Net net;
  net.points.resize(n);
  for (unsigned k = 0; k < n; ++k) net.points[number(k)].x = 0.01 * k;
  for (unsigned k = 0; k + 1 < n; ++k)
    net.springs.push_back({number(k + 1), number(k)});
  Live live(loose(2), net);
  const Cloth& g = live.scene().cloth();
  EXPECT_TRUE(is_local(g));
  for (unsigned i = 0; i < n; ++i)
    ASSERT_EQ(g.node(i).position(), net.points[i]) << i;
  EXPECT_NE(id(live, 5), 5u);
  live.apply("pin 5");
  EXPECT_TRUE(live.scene().is_pinned(id(live, 5)));
  live.apply(request("cut", number(7), number(8)));
  EXPECT_EQ(live.readings().torn_edges, 1u);
  EXPECT_EQ(g.node(number(7)).degree(), 1u);
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

// -------------------------------------------------------------------- Readings

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
  live.apply("compare verlet 0.4");
  for (int k = 0; k < 100; ++k) {
    if (k == 30) live.apply(request("grab", id(live, 20), Point(0, 1, 1)));
    if (k == 40) live.apply("gravity 5");
    if (k == 50) live.apply(request("cut", id(live, 1), id(live, 2)));
    if (k == 60) live.apply(request("pin", id(live, 9)));
    ASSERT_TRUE(live.step());
    const Readings now = live.readings(false);
    ASSERT_EQ(now.rivals[0].error, now.error) << k;
  }
  const Readings r = live.readings();
  EXPECT_GT(r.error, 0);
  EXPECT_EQ(r.rivals[0].readings.time, r.time);
}

// Half the step: a quarter of the error, as the reference tells it.
TEST(Comparison, ErrorsAreOfTheOrderOfTheMethod) {
  Live live(hung(5));
  live.apply("step 0.2");
  live.apply("compare verlet 0.1");
  run(live, 60);
  const Readings r = live.readings();
  EXPECT_NEAR(r.error / r.rivals[0].error, 4, 0.4);
  EXPECT_NEAR(r.rivals[0].readings.dt, live.scene().dt() / 2, 1e-12);
  EXPECT_EQ(live.reference()->method().name, "srkn11b");
  EXPECT_LT(live.reference()->dt(), live.scene().dt() * 11 / 2);
}

TEST(Comparison, MeetsAfterAFewStepsOfAnyRatio) {
  Live live(hung(4));
  for (double share : {0.05, 0.13, 0.37, 1., 2.23}) {
    live.apply("step 0.31");
    live.apply(request("compare", "implicit-euler", share));
    run(live, 2);
    const Readings r = live.readings();
    const RunReadings& rival = r.rivals[0].readings;
    EXPECT_NEAR(rival.dt / (share * r.dt_unit), 1, 0.02) << share;
    EXPECT_EQ(rival.time, r.time);
  }
}

TEST(Comparison, RacesFourAtEqualWork) {
  Live live(hung(8));
  live.apply("step 0.3");
  live.apply("race symplectic-euler rk4 xpbd");
  EXPECT_FALSE(has(live.recording(), "race"));
  while (live.scene().time() < 0.3) ASSERT_TRUE(live.step());
  const Readings r = live.readings();
  ASSERT_EQ(r.rivals.size(), 3u);
  for (const auto& [rival, error] : r.rivals) {
    EXPECT_NEAR(rival.work / r.work, 1, 0.1) << rival.method;
    EXPECT_NEAR(rival.time, r.time, 1e-9);
    EXPECT_GT(error, r.error) << rival.method;
  }
  EXPECT_NE(Live::error_in("race verlet verlet verlet verlet"), "");
  live.apply("compare");
  EXPECT_TRUE(live.readings().rivals.empty());
}

// In one step of a second method there is no end of those of the first one.
TEST(Comparison, TakesNoMoreThanSomeStepsInARound) {
  for (double share : {1e-300, 1e300}) {
    Live live(hung(4));
    live.apply(request("compare", "xpbd", share));
    const double ratio = live.rival()->dt() / live.scene().dt();
    EXPECT_NEAR(ratio, share < 1 ? 1e-4 : 1e4, 1e-9 * ratio) << share;
    EXPECT_GE(live.reference()->dt(),
              std::min(ratio, 1.) * live.scene().dt() / 1e4);
    live.step();
    EXPECT_EQ(live.rival()->time(), live.scene().time());
  }
}

TEST(Comparison, OfOneThatFailsGoesOn) {
  Model m = hung(6);
  m.t_end = 100;
  Live live(m);
  live.apply("step 0.5");
  live.apply("compare symplectic-euler 1.5");
  for (int k = 0; k < 400; ++k) ASSERT_TRUE(live.step());
  const Readings r = live.readings();
  EXPECT_TRUE(r.rivals[0].readings.failure);
  EXPECT_FALSE(r.failure);
  EXPECT_TRUE(std::isfinite(r.rivals[0].error));
}

// -------------------------------------------------------------------- Requests

TEST(Requests, AreRefusedAndChangeNothing) {
  Live live(hung(4));
  for (const auto& [text, error] :
       {std::pair("", "ends too early, expected a request"),
        std::pair("gravitas 3",
                  "'gravitas' is not a request: did you mean gravity?"),
        std::pair("gravity nan",
                  "is not finite, expected an acceleration or a vector of "
                  "three [m/s^2]"),
        std::pair(
            "gravity 1e999",
            "'1e999' is not an acceleration or a vector of three [m/s^2]"),
        std::pair("gravity 1 0",
                  "ends too early, expected an acceleration or a vector of "
                  "three [m/s^2]"),
        std::pair("move 1 2 3 4",
                  "continues with '4', expected the end of the line"),
        std::pair("stiffness -1", "-1 is not 0 N/m or more"),
        std::pair("method verlett",
                  "'verlett' is not a method: did you mean verlet?"),
        std::pair("method trapezoidal",
                  "'trapezoidal' is not a method: did you mean "
                  "implicit-midpoint?"),
        std::pair("step -1",
                  "-1 is not a positive multiple of the stability limit"),
        std::pair("grab 1 0 0",
                  "ends too early, expected three coordinates [m]"),
        std::pair("cut 1", "ends too early, expected the number of a node"),
        std::pair("pin -1", "'-1' is not the number of a node")}) {
    EXPECT_EQ(Live::error_in(text), error);
    EXPECT_THROW(live.apply(text), std::invalid_argument) << text;
  }
  EXPECT_EQ(live.recording(), "0 end\n");
  EXPECT_EQ(Live::error_in("cut"), "");
}

// What depends on the present state is recorded as what it came to.
TEST(Requests, OfTheMouseAreRecordedByNodes) {
  Live live(loose(3));
  const std::string n = std::to_string(id(live, 4));
  live.apply("toggle " + n), live.apply("toggle " + n);
  live.apply("stroke 0.25 -9 9 0.25 -9 -9 0.25 9 9 0.25 9 -9");
  live.apply("stroke 5 -9 9 5 -9 -9 5 9 9 5 9 -9");  // beside it: nothing
  const std::string all = live.recording();
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
  EXPECT_FALSE(Live::overrides("release"));
}

// --------------------------------------------------------------------- Changes

/** Requests at random, between steps, by one who looks, or does not. */
void play(Live& live, unsigned seed, bool looks) {
  std::mt19937 random(seed);
  const auto upto = [&](unsigned n) { return unsigned(random() % n); };
  const auto real = [&] { return double(random()) / 4294967296.; };
  const auto point = [&] { return Point(real(), real(), real() - 0.5); };
  for (int k = 0; k < 40; ++k) {
    const unsigned node = upto(40);
    const MethodEntry* m = &methods[upto(9)];
    const std::string all[] = {
        request("method", m->info.name),
        request("step", 0.05 + 1.2 * real()),
        request("stiffness", 50 + 150 * real()),
        request("drag", 0.1 * real()),
        request("gravity", 20 * real() - 10),
        request("grab", node, point()),
        request("move", point()),
        "release",
        request("cut", node, upto(36), upto(36), upto(36)),
        request("pin", node),
        request("unpin", node),
        request("compare", m->info.name, 0.1 + real())};
    if (const unsigned n = upto(15); n < std::size(all)) live.apply(all[n]);
    for (unsigned n = upto(12); n > 0; --n) {
      live.step();
      if (!looks || live.scene().failure().has_value()) continue;
      if (upto(3) == 0) live.check();
      if (upto(5) == 0) live.readings(upto(2) == 0);
    }
  }
}

TEST(Changes, MadeAgainGiveTheSameBits) {
  for (unsigned seed = 0; seed < 3; ++seed) {
    Model m = hung(6, grav, 0.002);
    m.planes = {{.at = Point(0, 0, -0.3), .friction = 0.3, .motion = {}}};
    m.tears = {Ball{Point(0.5, 0.9, -0.2), 0.1}};
    if (seed % 3 == 1) m.pins[0].motion.velocity = Point(0.1, 0, 0);
    if (seed % 3 == 2) m.step.rule = StepRule::safe;
    m.t_end = no_limit;
    Live live(m);
    play(live, seed, true);
    std::istringstream in(live.recording());
    Live again(m);
    // A request makes one that failed go on.
    std::string line;
    for (long long calls; in >> calls && std::getline(in >> std::ws, line);) {
      for (long long last = -1; last < again.calls() && again.calls() < calls;)
        last = again.calls(), again.step();
      if (line != "end") again.apply(line);
    }
    EXPECT_EQ(line, "end");
    EXPECT_EQ(again.calls(), live.calls());
    EXPECT_EQ(again.scene().time(), live.scene().time());
    ASSERT_EQ(checksum_of(again.scene().cloth()),
              checksum_of(live.scene().cloth()))
        << live.recording();
    ASSERT_EQ(again.rival() == nullptr, live.rival() == nullptr);
    if (live.rival()) {
      EXPECT_EQ(checksum_of(again.rival()->cloth()),
                checksum_of(live.rival()->cloth()));
    }
  }
}

TEST(Changes, AreRefusedWithTheLine) {
  const auto error = [](const std::vector<std::string>& lines) {
    return error_of([&] { read_changes(lines); });
  };
  EXPECT_EQ(error({"0.2 pin 1", "0.2 gravity 0 0 -3"}), "");
  EXPECT_EQ(error({"0.2 pin 1", "0.1 unpin 1"}),
            "--at \"0.1 unpin 1\": comes after 0.2 s");
  EXPECT_EQ(error({"x pin 1"}), "--at \"x pin 1\": 'x' is not a time [s]");
  EXPECT_EQ(error({"2"}), "--at \"2\": ends too early, expected a request");
  EXPECT_EQ(error({"2 pin 1 2"}),
            "--at \"2 pin 1 2\": continues with '2', expected the end of the "
            "line");
}

}  // namespace
