// StepControl.hpp: steps chosen by the measured energy balance: scenes that a
// fixed share of the linear limit ruined, and random ones, by an independent
// sum of their energies. `make stability-soak` runs more of it:
//   SOAK_SCENES   random scenes (50; 1000 in the soak)
//   SOAK_SECONDS  of each [s] (1; 60 for a sample)
//   SOAK_FIRST    the first of them (0)
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iostream>
#include <random>

#include "lab/fast/GraphArrays.hpp"
#include "lab/methods/Methods.hpp"
#include "lab/stability/StepLimit.hpp"
#include "lab/stepping/Scene.hpp"
#include "tests/NetOf.hpp"

using namespace lab;

namespace {

double setting(const char* name, double otherwise) {
  const char* text = std::getenv(name);
  return text ? std::atof(text) : otherwise;
}

/** The energy balance of a run, by sums of its own. */
struct Watched {
  std::string failure;
  long long steps = 0;
  double gain = 0;   // the most that E was above E(0) + W - removed [J]
  double scale = 0;  // the largest kinetic + elastic energy [J]
  bool warned = false;
  StepControl::Report report = {};
  double share() const { return scale > 0 ? gain / scale : 0; }
  bool within() const { return failure.empty() && share() <= energy_tolerance; }
};

/** Run @a s to its end.  @param every steps between two sums */
Watched watch(Scene& s, double t_end, int every = 8) {
  struct Sum {
    long long step;
    double moving, total;
  };
  std::vector<Sum> sums;
  auto look = [&] {
    while (!sums.empty() && sums.back().step >= s.steps()) sums.pop_back();
    double moving = 0, weight = 0;
    for (Node n : s.cloth().nodes()) {
      moving += 0.5 * n.value().mass * normSq(n.value().vel);
      weight += n.value().mass * s.model().gravity.size() * n.position().z;
    }
    for (Edge e : s.cloth().edges())
      moving += 0.5 * e.value().K * std::pow(e.length() - e.value().L, 2);
    sums.push_back({s.steps(), moving,
                    moving + weight - s.flow().work + s.flow().removed});
  };
  look();
  s.run_to(t_end, [&] {
    if (s.steps() % every == 0 || s.done(t_end)) look();
  });
  while (sums.size() > 1 && sums.back().step > s.steps()) sums.pop_back();
  Watched w;
  w.failure = text_of(s.failure());
  w.steps = s.steps();
  for (const Sum& a : sums) {
    w.scale = std::max(w.scale, a.moving);
    w.gain = std::max(w.gain, a.total - sums[0].total);
  }
  if (s.control()) {
    w.report = s.control()->report();
    w.warned = s.control()->state().gain > s.control()->tolerance();
    w.steps += w.report.taken_back;
  }
  return w;
}

// --------------------------------------------------------------- Random scenes

/** A patch of cloth with masses over 50:1, K over up to 1e4:1, velocities up to
 * 20 m/s, gravity up to 100 m/s^2 and drag up to 1 1/s; some hold nodes, some
 * tear. */
struct RandomScene {
  Model model;
  Net net;
  const MethodEntry* method;
  double gamma = 0;

  explicit RandomScene(unsigned seed) {
    std::mt19937 random(seed);
    auto uniform = [&] { return double(random()) / double(random.max()); };
    auto one_in = [&](unsigned n) { return random() % n == 0; };
    const unsigned rows = 3 + random() % 7, columns = 3 + random() % 7;
    const MeshSprings::Kind mesh =
        one_in(2) ? MeshSprings::plain : MeshSprings::diagonals;
    const double masses = one_in(2) ? 50 : 1;
    const double decades = one_in(2) ? 4 * uniform() : 0;
    const double speed = one_in(3) ? 0 : std::pow(20, uniform());
    const double stiffness = std::pow(10, 1 + 2 * uniform());
    gamma = one_in(2) ? uniform() : 0;
    model.gravity = one_in(3) ? 0 : one_in(3) ? 100 * uniform() : grav;
    const std::array names = {"verlet", "verlet", "symplectic-euler", "pefrl",
                              "rk4"};
    method = find_method(names[random() % names.size()]);
    std::mt19937 r(random());
    auto u = [&r] { return double(r()) / double(r.max()); };
    Cloth g;
    build_cloth(g, grid_points(rows, columns), grid_quads(rows, columns), mesh);
    for (Edge e : g.edges())
      e.value().K = stiffness * std::pow(10, decades * u());
    for (Node n : g.nodes()) {
      n.value().mass *= std::pow(masses, u());
      n.value().vel = speed * Point(2 * u() - 1, 2 * u() - 1, 2 * u() - 1);
    }
    net = net_of(g);
    model.damping = gamma / g.num_nodes();
    if (!one_in(4)) net.held = {0, columns - 1};
    if (one_in(4)) model.tears = {{{0.5, 0.5, -0.3}, 0.2}};
  }
};

Watched run_fixed(unsigned seed, double dt, double seconds) {
  const RandomScene r(seed);
  Scene s(r.model, r.net, {.dt = dt}, *r.method);
  return watch(s, seconds);
}
Watched run_chosen(unsigned seed, double seconds) {
  const RandomScene r(seed);
  Scene s(r.model, r.net, {.rule = StepRule::safe}, *r.method);
  return watch(s, seconds);
}

// Without drag, from 0.6 of the limit: a step of that length gains more than
// the tolerance, the chosen one does not.
TEST(SteeredStep, IsShortenedWhereAShareOfTheLimitGainsEnergy) {
  for (unsigned seed : {0u, 36u, 118u}) {
    const RandomScene r(seed);
    const double first =
        Scene(r.model, r.net, {.rule = StepRule::safe}, *r.method).dt();
    EXPECT_EQ(r.gamma, 0);
    EXPECT_FALSE(run_fixed(seed, first, 60).within()) << seed;
    const Watched w = run_chosen(seed, 60);
    EXPECT_TRUE(w.within()) << seed << ' ' << w.share() << w.failure;
    EXPECT_FALSE(w.warned);
    EXPECT_GT(w.report.shortened, 0);
    EXPECT_LT(w.report.shortest, 0.75 * first);
    EXPECT_LE(w.report.longest, first * (1 + 1e-12));
  }
}

// With drag it is lengthened, beyond the linear limit, as far as it goes: no
// step 1.3 times its mean keeps the tolerance.
TEST(SteeredStep, IsNearTheLongestOneWithDrag) {
  for (unsigned seed : {4u, 44u, 57u}) {
    const Watched w = run_chosen(seed, 60);
    EXPECT_TRUE(w.within()) << seed << ' ' << w.share() << w.failure;
    EXPECT_GT(w.report.lengthened, 5);
    EXPECT_FALSE(run_fixed(seed, 1.3 * 60 / double(w.steps), 60).within())
        << seed;
  }
}

/** A loose sheet whose nodes move at random, up to 5 m/s each way, and all of
 * it at @a speed upwards [m/s]; nothing acts on it. */
Scene thrown_sheet(double speed, const TimeStep& step) {
  std::mt19937 random(1);
  auto u = [&] { return 10 * (double(random()) / double(random.max()) - 0.5); };
  Model m;
  m.gravity = 0;
  Net sheet = {grid_points(9, 9), grid_quads(9, 9)};
  for ([[maybe_unused]] const Point& p : sheet.points)
    sheet.velocities.push_back(Point(u(), u(), u() + speed));
  return Scene(m, sheet, step, table::verlet);
}

/** Elastic energy, and kinetic of the motion about the center of mass [J]. */
double internal_energy(const Cloth& g) {
  Point momentum;
  double mass = 0, sum = 0;
  for (Node n : g.nodes()) {
    mass += n.value().mass;
    momentum += n.value().mass * n.value().vel;
  }
  for (Node n : g.nodes())
    sum += 0.5 * n.value().mass * normSq(n.value().vel - momentum / mass);
  for (Edge e : g.edges())
    sum += 0.5 * e.value().K * std::pow(e.length() - e.value().L, 2);
  return sum;
}

// However fast the cloth as a whole flies: its energy hides no gain.
TEST(SteeredStep, IsTheSameForAClothThatFlies) {
  for (double speed : {0.0, 100.0, 1000.0}) {
    Scene s = thrown_sheet(speed, {.rule = StepRule::sharp});
    const double before = internal_energy(s.cloth());
    EXPECT_TRUE(s.run_to(30)) << text_of(s.failure());
    const double after = internal_energy(s.cloth());
    EXPECT_LT(after, 1.25 * before) << speed;
    Scene longer = thrown_sheet(speed, {.dt = 1.1 * s.safe_limit()});
    EXPECT_FALSE(longer.run_to(30)) << speed;
    EXPECT_LT(internal_energy(longer.cloth()), 5 * before) << speed;
  }
}

// Output during a run changes nothing, and a second run is the same, also where
// steps are taken back.
TEST(SteeredStep, IsTheSameWhoeverLooks) {
  const RandomScene r(4);
  Scene s(r.model, r.net, {.rule = StepRule::safe}, *r.method);
  std::vector<Point> ends[2];
  for (auto& end : ends) {
    s.restart();
    long long last = 0, back = 0;
    EXPECT_TRUE(s.run_to(30, [&] {
      const bool looked = &end != ends || s.check();
      EXPECT_TRUE(looked);
      back += s.steps() <= last ? last + 1 - s.steps() : 0;
      EXPECT_GE(s.steps(), s.stepper().settled_steps());
      last = s.steps();
    }));
    EXPECT_EQ(s.time(), 30);
    EXPECT_EQ(back, s.control()->report().taken_back);
    EXPECT_GT(back, 0);
    const auto x = arrays(s.cloth()).positions();
    end.assign(x.begin(), x.end());
  }
  EXPECT_EQ(ends[0], ends[1]);
}

TEST(StepControl, TakesBackWhatGainsAndSaysSoIfItCant) {
  using Verdict = StepControl::Verdict;
  StepControl c(1, {.kinetic = 100}, {});
  double energy = 100, share = 1;
  while (c.can_shorten()) {
    const auto then = c.state();
    ASSERT_EQ(c.look({.kinetic = energy + 9}, {}, 1, 0), Verdict::take_back);
    c.take_back(then, 16);
    share = std::max(0.7 * share, 1 / 64.);
    EXPECT_DOUBLE_EQ(c.dt(), share);
  }
  EXPECT_EQ(c.report().shortened, 12);
  EXPECT_EQ(c.report().taken_back, 12 * 16);
  EXPECT_EQ(c.look({.kinetic = energy + 30}, {}, 1, 0), Verdict::go_on);
  EXPECT_DOUBLE_EQ(c.state().gain, 30);
  EXPECT_GT(c.state().gain, c.tolerance());
}

// rk4 takes (dt omega)^6/72 of the energy in a step, a splitting nothing.
TEST(StepControl, KeepsWhatAMethodDampsBelowTheDrag) {
  const MethodEntry& rk4 = table::rk4;
  const double omega = 2000, gamma = 0.3;
  const double longest = std::pow(72 * 0.1 * gamma / std::pow(omega, 6), 0.2);
  const double mild = mild_step(rk4, 1.7 / omega, omega, gamma, 0.1);
  EXPECT_LT(mild, 1.02 * longest);
  EXPECT_GT(mild, 0.88 * longest);
  EXPECT_EQ(mild_step(rk4, 0.8 * longest, omega, gamma, 0.1), no_limit);
  EXPECT_EQ(mild_step(rk4, 1.6 / omega, omega, 1e-9, 0.1), 0.1 / omega);
  for (const char* name : {"verlet", "symplectic-euler", "pefrl"})
    EXPECT_EQ(mild_step(*find_method(name), 1 / omega, omega, gamma, 0.1),
              no_limit);
}

// -------------------------------------------------------------- Settling cloth

/** The kinetic energy of a sheet that was thrown at 18 m/s in air that stops it
 * at 0.3/s: its mean from 16.5 s to 22 s [J]. */
double settled_energy(const TimeStep& step) {
  Model m;
  m.sheets = {{.u = Point(0.508, 0, 0),
               .v = Point(0, 0.905, 0),
               .nodes = {5, 4},
               .velocity = Point(2.05, 5.11, 17.6)}};
  m.edges.diagonals = false;
  m.stiffness = 1146, m.damping = 0.0153, m.gravity = 12.1;
  m.pins = {{.x = 0, .y = 0}};
  m.method = &table::verlet, m.step = step;
  Scene s(m);
  std::vector<std::array<double, 2>> samples;  // time, energy
  EXPECT_TRUE(s.run_to(22, [&] {
    while (!samples.empty() && samples.back()[0] >= s.time())
      samples.pop_back();  // steps were taken back
    if (s.time() >= 16.5)
      samples.push_back({s.time(), kinetic_energy(s.cloth())});
  }));
  double sum = 0;
  for (const auto& [t, energy] : samples) sum += energy;
  return sum / double(samples.size());
}

// One that was many times too hot by a tolerance that is a share of the largest
// energy ever, as its motion decays to e^-7 of that.
TEST(SteeredStep, LeavesAClothToSettle) {
  const double small = settled_energy({.dt = 0.001});  // 0.2 of the limit
  EXPECT_NEAR(settled_energy({.rule = StepRule::safe}) / small, 1, 0.1);
}

// What lies on a floor is put back in each step: that is no gain.
TEST(SteeredStep, LeavesAClothToLieOnAFloor) {
  Model m;
  m.sheets.resize(1), m.sheets[0].nodes = {9, 12};
  m.planes.resize(1), m.planes[0].at = Point(0, 0, -0.3);
  m.damping = 0.06, m.gravity = 25, m.t_end = 2;
  for (const char* method : {"verlet", "pefrl"}) {
    m.method = find_method(method), m.step = {.rule = StepRule::safe};
    Scene s(m);
    ASSERT_TRUE(s.run_to(m.t_end)) << method;
    EXPECT_LE(s.control()->state().gain, s.control()->tolerance()) << method;
    EXPECT_LT(s.control()->report().shortened, 10) << method;
  }
}

// A flat fall stretches nothing, and symplectic Euler's speed is early in it:
// shorter steps would not help.
TEST(SteeredStep, LeavesAClothToFallFlat) {
  Model m;
  m.sheets = {{.nodes = {9, 9}}};
  m.planes = {{.at = Point(0, 0, -0.2), .friction = 0.5, .motion = {}}};
  m.stiffness = 1e4, m.t_end = 4;
  m.step = {.rule = StepRule::safe};
  for (double damping : {0.01, 0.1}) {
    m.damping = damping;
    Scene s(m);
    ASSERT_TRUE(s.run_to(m.t_end));
    EXPECT_LT(s.steps(), 10000) << damping;
  }
}

TEST(SteeredStep, KeepsItsToleranceInRandomScenes) {
  const int first = int(setting("SOAK_FIRST", 0));
  const int scenes = int(setting("SOAK_SCENES", 50));
  const double seconds = setting("SOAK_SECONDS", 1);
  const bool talk = std::getenv("SOAK_SCENES");
  int beyond = 0, unnoticed = 0, failed = 0, damped = 0, slow = 0;
  std::vector<double> ratios;
  for (int seed = first; seed < first + scenes; ++seed) {
    const RandomScene r{unsigned(seed)};
    Scene s(r.model, r.net,
            {.rule = seed % 4 == 3 ? StepRule::sharp : StepRule::safe},
            *r.method);
    const double start = s.dt();
    const Watched w = watch(s, seconds);
    failed += !w.failure.empty();
    const bool over = w.share() > energy_tolerance;
    beyond += over;
    unnoticed += over && !w.warned && w.failure.empty();
    EXPECT_TRUE(!over || w.warned || !w.failure.empty())
        << "seed " << seed << ": gains " << w.share();
    EXPECT_EQ(w.failure, "") << seed;
    double ratio = 0;
    const bool lossy = r.method->info.name == "rk4";
    if (talk && r.gamma > 0.2 && w.scale > 0 && !lossy) {
      // The longest fixed step that keeps the tolerance, too.
      double low = start / 16, high = 4 * start;
      for (int k = 0; k < 12; ++k) {
        const double dt = std::sqrt(low * high);
        Scene fixed(r.model, r.net, {.dt = dt}, *r.method);
        (watch(fixed, seconds).within() ? low : high) = dt;
      }
      ratio = double(w.steps) / (seconds / low);
      ratios.push_back(ratio);
      ++damped, slow += ratio > 1.3;
    }
    if (talk)
      std::cout << seed << ' ' << r.method->info.name << " gamma " << r.gamma
                << " gain " << w.share() << " dt " << w.report.shortest / start
                << " to " << w.report.longest / start << " end "
                << s.dt() / start << " shortened " << w.report.shortened
                << " lengthened " << w.report.lengthened << " back "
                << w.report.taken_back << " steps " << w.steps << " ratio "
                << ratio << (over ? " BEYOND" : "")
                << (w.warned ? " warned" : "") << '\n';
  }
  std::cout << scenes << " random scenes of " << seconds << " s: " << failed
            << " failed, " << beyond << " beyond the tolerance, of these "
            << unnoticed << " unnoticed";
  if (!ratios.empty()) {
    std::ranges::sort(ratios);
    std::cout << "; " << damped
              << " with drag > 0.2 1/s: steps by those of the "
              << "longest fixed one: median " << ratios[ratios.size() / 2]
              << ", 90 % " << ratios[ratios.size() * 9 / 10] << ", most "
              << ratios.back() << ", above 1.3: " << slow;
  }
  std::cout << '\n';
  EXPECT_LE(beyond, scenes / 20);
}

}  // namespace
