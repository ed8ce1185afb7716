// Measure.hpp: quantities whose values are known by hand, over time and at the
// end, and their words.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>

#include "lab/fast/Energy.hpp"
#include "lab/methods/Methods.hpp"
#include "lab/run/Run.hpp"
#include "lab/scenes/Fields.hpp"
#include "lab/scenes/Measure.hpp"
#include "lab/scenes/SceneFile.hpp"
#include "lab/scenes/Words.hpp"
#include "lab/stepping/Trial.hpp"
#include "tests/Built.hpp"
#include "tests/ReadParts.hpp"
#include "tests/TestFolder.hpp"

using namespace lab;

namespace {

Model scene_of(const std::string& sheet, double t_end, double dt) {
  Model m = with_sheet(sheet);
  m.method = &table::verlet;
  m.t_end = t_end, m.step.dt = dt;
  return m;
}

double answer_of(Model m, const std::string& measure) {
  m.measure = read_measure(measure);
  const Trial t = try_out(m);
  EXPECT_TRUE(t.ok());
  return t.ok() ? t.answer.at(0) : std::nan("");
}

/** Two masses of 1/4 kg below two pinned ones, by springs of 100 N/m: they
 * fall by 2 m g/K and come back to rest after a period. */
constexpr double omega = 20, amplitude = grav * 0.25 / 100;
Model oscillator(double dt, double periods = 1) {
  Model m = scene_of("v 0 0 -1 nodes 2 2", periods * 2 * M_PI / omega, dt);
  m.edges.diagonals = false;
  m.pins = {read_pin("z 0")};
  return m;
}

TEST(Measure, OverTimeFindsTheAmplitudeOfAnOscillator) {
  for (double dt : {0.01, 0.001}) {
    const Model m = oscillator(dt);
    // Verlet's amplitude is off by (omega dt)^2/4 of it, and the state of the
    // largest stretch lies up to half a step away.
    const double off = amplitude * (omega * dt) * (omega * dt) / 2;
    EXPECT_NEAR(answer_of(m, "max stretch"), 2 * amplitude, off);
    EXPECT_NEAR(answer_of(m, "min drape-height"), -1 - 2 * amplitude, off);
    EXPECT_NEAR(answer_of(m, "max drape-height"), -1, 1e-12);
    EXPECT_NEAR(answer_of(m, "min com z"), -0.5 - amplitude, off);
    EXPECT_NEAR(answer_of(m, "min point u 1 v 1 z"), -1 - 2 * amplitude, off);
    // Two springs, and the weight of the two nodes that are held.
    EXPECT_NEAR(answer_of(m, "max pin-force"), 1.5 * grav, 200 * off);
    EXPECT_NEAR(answer_of(m, "min pin-force"), 0.5 * grav, 1e-12);
    EXPECT_LT(answer_of(m, "max-stretch"), 4 * off) << "at the end";
  }
}

TEST(Measure, OverTimeKnowsTheTimesAndMeansOfAnOscillator) {
  for (double dt : {0.01, 0.001}) {
    const double T = 2 * M_PI / omega;
    // Verlet is too fast by (omega dt)^2/24; a straight line between two states
    // misses a passage by as little.
    const double off = 3 * T * (omega * dt) * (omega * dt) / 24 + 1e-9;
    const Model m = oscillator(dt, 3.2);
    auto level = [](double share) {  // of the center's way down
      return std::to_string(-0.5 - share * amplitude);
    };
    EXPECT_NEAR(answer_of(m, "period com z"), T, off);
    EXPECT_NEAR(answer_of(m, "period stretch"), T, off);
    EXPECT_NEAR(answer_of(m, "first com z below " + level(0.5)), T / 4, off);
    EXPECT_NEAR(answer_of(m, "first com z below " + level(0.75)), T / 3, off);
    EXPECT_NEAR(answer_of(m, "last com z below " + level(0.75)), 2.667 * T,
                3 * off + T / 3000);
    EXPECT_EQ(answer_of(m, "first com z above -1"), 0);
    EXPECT_EQ(answer_of(m, "last com z above 0"), 0) << "it never was";
    const Model whole = oscillator(dt, 3);
    EXPECT_NEAR(answer_of(whole, "mean com z"), -0.5 - amplitude / 2, off);
    // From the middle of a period on the mean is the same, of a half it is not:
    // the mean of cos over its second quarter is -2/pi.
    EXPECT_NEAR(answer_of(whole, "mean com z from " + std::to_string(2 * T)),
                -0.5 - amplitude / 2, 3 * off);
    EXPECT_NEAR(answer_of(oscillator(dt, 0.5),
                          "mean com z from " + std::to_string(T / 4)),
                -0.5 - amplitude / 2 * (1 + 2 / M_PI), 3 * off);
    const double v = amplitude * omega;
    EXPECT_NEAR(answer_of(m, "max kinetic-energy"), 0.25 * v * v,
                0.25 * v * v * (omega * dt) * (omega * dt));
    EXPECT_NEAR(answer_of(m, "max elastic-energy"),
                100 * 4 * amplitude * amplitude,
                400 * amplitude * amplitude * (omega * dt) * (omega * dt));
    for (const char* never : {"first com z below -1", "last com z below 0"}) {
      Model none = m;
      none.measure = read_measure(never);
      EXPECT_TRUE(begins(*try_out(none).failure, never));
    }
    Model one = oscillator(dt, 1.9);  // a start and one maximum
    one.measure = read_measure("period com z");
    EXPECT_FALSE(try_out(one).ok());
  }
}

TEST(Measure, RipplesOnASwingAreNoMaxima) {
  TimeSeries s;
  const Measure period = read_measure("period com z");
  for (double t = 0; t < 7; t += 0.003)
    s.add(period, t, std::sin(M_PI * t) + 0.2 * std::sin(37 * t));
  EXPECT_NEAR(s.answer(period).at(0), 2, 0.06);
}

TEST(Measure, AFloorCarriesTheWeightOfWhatRestsOnIt) {
  Model m = scene_of("nodes 5 5", 1, 0.002);
  m.planes = {read_plane("at 0 0 -0.1 friction 0.3")};
  EXPECT_NEAR(answer_of(m, "contact-force"), grav, 1e-6);
  EXPECT_EQ(answer_of(m, "min contact-force"), 0) << "before it lands";
  EXPECT_NEAR(answer_of(m, "first contact-force above 0"),
              std::sqrt(2 * 0.1 / grav), 0.004);
  m.planes = {read_plane("at 0 0 -0.1 velocity 0 0 0.01")};
  EXPECT_NEAR(answer_of(m, "contact-force"), grav, 1e-6);
  // With drag, on a slope, and whatever names the surface or the node again.
  const Wall slope = read_plane("at 0 0 0 normal 0.2 0 1 friction 1");
  m.material.drag = 5, m.step.dt = 0.01, m.method = &table::verlet;
  m.planes = {slope, slope};
  EXPECT_NEAR(answer_of(m, "contact-force"), grav / std::sqrt(1.04), 1e-3);
  m.pins = {read_pin("x 0")};  // they carry their nodes
  EXPECT_LT(answer_of(m, "contact-force"), 0.9 * grav);
  EXPECT_THROW(answer_of(m, "pin-force x 0.5"), SceneError);
  m.pins.clear();
  EXPECT_THROW(answer_of(m, "pin-force"), SceneError);
  m.planes.clear();
  m.measure = Measure::contact_force;
  EXPECT_THROW(check_question(m), SceneError);
}

/** Springs of 1 m between two rows, pulled apart at 0.5 m/s. */
Model pulled(double limit, double dt) {
  Model m = scene_of("nodes 2 2", 1, dt);
  m.gravity = 0, m.edges.diagonals = false, m.tear_strain = limit;
  m.pins = {read_pin("x 0"), read_pin("x 1 velocity 0.5 0 0")};
  return m;
}

TEST(Measure, WhatIsLostIsWhatDragContactAndTearingTook) {
  // 1 kg at 2 m/s, whose drag of 0.5 kg/s leaves exp(-2 c t/m) of its energy.
  Model m = scene_of("nodes 5 5 velocity 2 0 0", 1, 0.002);
  m.gravity = 0, m.damping = 0.5 / 25;
  EXPECT_NEAR(answer_of(m, "lost-energy"), 2 * (1 - std::exp(-1.)), 1e-3);
  // It falls flat on a floor, and stays there.
  m = scene_of("nodes 5 5", 1, 0.002);
  EXPECT_NEAR(answer_of(m, "lost-energy"), 0, 1e-2);
  m.planes = {read_plane("at 0 0 -0.1")};
  EXPECT_NEAR(answer_of(m, "lost-energy"), grav * 0.1, 1e-2);
  EXPECT_NEAR(answer_of(m, "first lost-energy above 0.5"),
              std::sqrt(2 * 0.1 / grav), 0.004);
  // A pin's work is not lost; torn springs take theirs.
  m = pulled(0.2, 0.001);
  EXPECT_NEAR(answer_of(m, "lost-energy"), 2 * 100 * 0.2 * 0.2 / 2, 0.05);
  m.tear_strain = 0.6;
  EXPECT_NEAR(answer_of(m, "lost-energy"), 0, 0.05);
}

TEST(Measure, TearTimeIsThatOfTheStrainLimit) {
  for (double dt : {0.01, 0.0013})
    for (double limit : {0.1, 0.2003}) {
      const double t = answer_of(pulled(limit, dt), "tear-time");
      EXPECT_GE(t, limit / 0.5 - 1e-9);
      EXPECT_LE(t, limit / 0.5 + dt + 1e-9);
    }
  EXPECT_EQ(answer_of(pulled(0.2, 0.01), "torn-edges"), 2);
  EXPECT_EQ(answer_of(pulled(0.2, 0.01), "torn-nodes"), 0);
  Model apart = pulled(0.2, 0.01);
  apart.tear_strain.reset();
  EXPECT_NEAR(answer_of(apart, "stretch-at u 0.3 v 0"), 0.5, 1e-12);
  EXPECT_NEAR(answer_of(apart, "distance u 0 v 0"), std::hypot(1.5, 1), 1e-12);
  EXPECT_NEAR(answer_of(apart, "max distance u 0 v 0 to-u 0 to-v 1"), 1, 1e-12);
  EXPECT_THROW(answer_of(apart, "torn-edges"), SceneError);
  EXPECT_THROW(answer_of(apart, "distance to-sheet 2"), SceneError);
  Model whole = pulled(0.6, 0.01);
  whole.measure = Measure::tear_time;
  EXPECT_EQ(try_out(whole).failure, "nothing tears until t = 1 s");
  whole.tear_strain.reset();
  EXPECT_THROW(check_question(whole), SceneError);
  whole.tears = {read_tear("at 0 0 5")};
  EXPECT_NO_THROW(check_question(whole));
}

TEST(Measure, PointOfAFreeFallIsWhereItFell) {
  Model m = scene_of("nodes 4 3 velocity 1 2 3", 0.5, 0.01);
  m.sheets.push_back(read_sheet("at 0 0 9 u 0 2 0 v 0 0 4 nodes 3 6"));
  const double fall = grav / 2 * 0.25;
  m.measure = read_measure("point u 0.25 v 0.9");
  const Answer a = try_out(m).answer;
  ASSERT_EQ(a.size(), 3u);
  EXPECT_NEAR(a[0], 0.25 + 0.5, 1e-12);
  EXPECT_NEAR(a[1], 0.9 + 1, 1e-12);
  EXPECT_NEAR(a[2], 1.5 - fall, 1e-12);
  EXPECT_NEAR(answer_of(m, "point v 0.9 u 0.25 z"), 1.5 - fall, 1e-12);
  EXPECT_NEAR(answer_of(m, "point sheet 2 u 0.3 v 0.6 z"), 11.4 - fall, 1e-12);
  EXPECT_NEAR(answer_of(m, "point sheet 2 u 0.3 v 0.6 y"), 0.6, 1e-12);
  EXPECT_THROW(answer_of(m, "point sheet 3"), SceneError);
  m.tear_strain = 1;
  EXPECT_THROW(answer_of(m, "point"), SceneError);
}

TEST(Measure, HelpNamesAllQuantities) {
  Model m;
  const auto fields = fields_of(m);
  const auto field =
      std::ranges::find(fields, std::string_view("measure"), &Field::name);
  for (const Quantity& q : quantities)
    EXPECT_TRUE(has(field->help, q.name)) << q.name;
}

TEST(Measure, WordsAreReadAndWritten) {
  const auto takes = [](std::initializer_list<const char*> all) {
    for (const char* text : all) {
      EXPECT_EQ(name_of(read_measure(text)), text);
      EXPECT_EQ(read_measure(name_of(read_measure(text))), read_measure(text));
    }
  };
  takes({"distance u 0 to-u 0.25 to-sheet 2", "last kinetic-energy below 1e-06",
         "min point v 0 sheet 3 y", "first stretch above 0.1",
         "point u 0.25 sheet 2", "pin-force x 0 z 0.5", "period point u 1 z",
         "max pin-force y 1", "mean com z from 2", "max drape-height",
         "point u 0.25 v 1"});
  takes({"stretch-at v 1", "contact-force", "drape-height", "max-stretch",
         "max stretch", "min stretch", "min energy", "torn-nodes", "max com z",
         "positions", "pin-force", "tear-time", "energy", "com x", "point",
         "com"});
  EXPECT_EQ(unit_of(read_measure("max pin-force")), std::string("N"));
  EXPECT_EQ(unit_of(read_measure("tear-time")), std::string("s"));
  EXPECT_EQ(unit_of(read_measure("last energy above 1")), std::string("s"));
  EXPECT_EQ(unit_of(read_measure("mean distance")), std::string("m"));
  const auto refuses = [](std::initializer_list<const char*> all) {
    for (const char* text : all)
      EXPECT_THROW(read_measure(text), SceneError) << text;
  };
  refuses({"first energy above 1 below 2", "first tear-time above 1",
           "mean energy from -1", "max energy from 1", "period positions",
           "max max stretch", "point sheet 1.5", "distance to-u 2"});
  refuses({"energy above 1", "max positions", "max tear-time", "point u -0.01",
           "point sheet 0", "point u 1.01", "first energy", "pin-force x",
           "period com", "min point", "energy x", "mean com", "max-com",
           "com x y", "max com", "point u", "com w", "max", ""});
  EXPECT_NO_THROW(read_measure("point u 1 v 0"));
}

TEST(Measure, SeesNoStepThatIsTakenBack) {
  Model m = scene_of("nodes 15 15", 2, 0.001);
  m.step = read_time_step("auto:sharp:0.001");
  m.pins = {read_pin("x 0")};
  m.spheres = {read_sphere("at 0.6 0.5 -0.4 radius 0.2")};
  Scene scene(m);
  struct Asked {
    Measure what;
    std::unique_ptr<Observer> observer;
    std::map<long long, double> seen;  // by step
    double most_ever;                  // also of steps that are taken back
  };
  std::vector<Asked> all;
  for (const char* text :
       {"max stretch", "max com x", "max com y", "max energy", "max pin-force",
        "max point u 1 z", "max point u 1 v 0 x", "max point v 0 y",
        "max point u 0.25 z"}) {
    const Measure what = read_measure(text);
    const double start = answer(scene, what)[0];
    all.push_back(
        {what, std::make_unique<Observer>(scene, what), {{0, start}}, start});
  }
  scene.run_to(m.t_end, [&] {
    for (Asked& a : all) {
      a.observer->look();
      a.seen.erase(a.seen.upper_bound(scene.steps()), a.seen.end());
      const double now = answer(scene, a.what)[0];
      a.seen[scene.steps()] = now;
      a.most_ever = std::max(a.most_ever, now);
    }
  });
  ASSERT_FALSE(scene.failure());
  int differ = 0;
  for (const Asked& a : all) {
    const auto most = std::ranges::max_element(
        a.seen, {}, [](const auto& at) { return at.second; });
    EXPECT_EQ(a.observer->answer(), Answer{most->second});
    differ += a.most_ever > most->second;
  }
  EXPECT_GT(differ, 0);
}

TEST(Measure, GoesOnFromACheckpointWithTheSameBits) {
  const CME212::TestFolder folder;
  // The largest stretch is that of step 52, the tear that of step 134.
  for (const auto& [text, stop] :
       {std::pair("max stretch", 70), std::pair("max stretch", 54),
        std::pair("max stretch", 20), std::pair("mean stretch", 54),
        std::pair("tear-time", 40), std::pair("tear-time", 200)}) {
    const bool tears = text == std::string("tear-time");
    Options o;
    o.model = tears ? pulled(0.2, 0.003) : oscillator(0.003);
    o.model.measure = read_measure(text), o.quiet = true;
    auto end = [&](const Options& options) {
      Scene scene(options.model);
      lab::Run run(scene, options);
      run.to_end();
      EXPECT_EQ(run.finish(), 0);
      return run.answer();
    };
    const Answer whole = end(o);
    ASSERT_EQ(whole.size(), 1u);
    Options first = o;
    first.checkpoint = folder / "c", first.every_seconds = 0;
    Scene scene(first.model);
    lab::Run run(scene, first);
    while (scene.steps() < stop) run.advance();
    Options rest = o;
    rest.restart = first.checkpoint;
    EXPECT_EQ(end(rest), whole) << text << ' ' << stop;
    rest.model.measure = read_measure("min stretch");
    EXPECT_THROW(end(rest), SceneError) << "was not looked at before";
    rest.model.measure = Measure::max_stretch;
    EXPECT_NO_THROW(end(rest));
  }
}

TEST(Measure, HasColumnsOfItsOwnAtTheEndOfATable) {
  const CME212::TestFolder folder;
  for (const auto& [text, columns] :
       {std::pair("point u 1 v 1", ",point_x,point_y,point_z"),
        std::pair("max point u 1 v 1 z", ",point_z"),
        std::pair("pin-force", ",pin_force"), std::pair("max energy", ""),
        std::pair("com", ""), std::pair("max stretch", ",max_stretch")}) {
    Options o;
    o.model = oscillator(0.01), o.quiet = true, o.every = 7;
    o.model.measure = read_measure(text);
    o.csv = folder / "e.csv";
    Scene scene(o.model);
    lab::Run run(scene, o);
    run.to_end();
    ASSERT_EQ(run.finish(), 0);
    const std::string table = CME212::contents(o.csv);
    const std::string head = table.substr(0, table.find('\n'));
    EXPECT_EQ(head.substr(head.find("evaluations") + 11), columns);
    const std::string last = table.substr(table.rfind('\n', table.size() - 2));
    EXPECT_EQ(std::ranges::count(last, ','), std::ranges::count(head, ','));
    if (*columns) {
      EXPECT_EQ(std::strtod(&last[last.rfind(',') + 1], nullptr),
                answer(scene).back());
    }
  }
}

// By K (l - L), which it does not use, the cloth of 0.2 kg would pull with 46
// N.
TEST(PinForce, OfXpbdIsThatOfItsMultipliers) {
  Model m = scene_of("nodes 11 11", 4, 0.01);
  m.pins = {read_pin("y 0")};
  m.material.density = 0.2, m.material.modulus = 1e5, m.material.drag = 1;
  m.method = find_method("xpbd");
  EXPECT_NEAR(answer_of(m, "pin-force"), 0.2 * grav, 0.002 * grav);
}

}  // namespace
