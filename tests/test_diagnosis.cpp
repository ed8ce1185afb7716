// Diagnosis.hpp: a run that fails says why, and what works. That is tested by
// its own advice: it is followed, and the run passes.
#include "lab/stability/Diagnosis.hpp"

#include <gtest/gtest.h>
#include <signal.h>

#include <cctype>
#include <cstdlib>
#include <iostream>
#include <set>
#include <sstream>

#include "CME212/Util.hpp"
#include "lab/methods/Methods.hpp"
#include "lab/run/Options.hpp"
#include "lab/scenes/Interrupt.hpp"
#include "lab/stepping/Scene.hpp"
#include "tests/Says.hpp"

using namespace lab;

namespace {

/** The model of a command line. Words in '' are one. */
Model parsed(const std::string& options) {
  std::vector<std::string> words = {"cloth", "--headless"};
  std::istringstream in(options);
  for (std::string word; in >> word;) {
    if (word[0] == '\'') {
      std::string rest;
      if (word.back() != '\'' || word.size() == 1) std::getline(in, rest, '\'');
      word = word.substr(1) + rest;
      if (word.back() == '\'') word.pop_back();
    }
    words.push_back(word);
  }
  std::vector<char*> argv;
  for (std::string& w : words) argv.push_back(w.data());
  Options o;
  EXPECT_LT(parse(int(argv.size()), argv.data(), o), 0) << options;
  return o.model;
}

/** A scene that fails. */
struct Failing {
  const char *kind, *method;
  double share;  ///< dt, as a share of the method's limit; of Verlet's if none
  double t_end;  ///< [s]
  std::string scene;
  Cause cause;
};

const std::string net = "--sheet 'nodes 8 8' --edges sides ";
const std::string cloth = "--sheet 'nodes 8 8' ";
const std::string corners = "--pin 'x 0 y 0' --pin 'x 1 y 0' ";
const std::vector<Failing> failing = {
    // Beyond the limit of the flat cloth
    {"step", "symplectic-euler", 1.3, 1, cloth + corners, Cause::step},
    {"step", "srkn11b", 1.3, 1, cloth + corners, Cause::step},
    // Beyond the limit once it hangs
    {"sharp", "symplectic-euler", 1.1, 3, net + corners, Cause::step},
    {"sharp", "verlet", 1.1, 3, net + corners, Cause::step},
    {"sharp", "rk4", 1.6, 1, net + "--pin 'x 0'", Cause::step},
    // Drag as a force
    {"drag", "symplectic-euler", 1.3, 1, cloth + corners + "--damping 3",
     Cause::drag},
    {"drag", "symplectic-euler", 1.3, 1,
     cloth + corners + "--density 1 --drag 200", Cause::drag},
    {"drag", "rk4", 1.3, 1, cloth + corners + "--damping 10", Cause::drag},
    // No stable step
    {"no step", "forward-euler", 0.1, 2, net + corners, Cause::no_step},
    // Buckling that nothing damps
    {"midpoint", "implicit-midpoint", 10, 2, cloth + corners, Cause::waves},
    // Across a flat cloth one linear solve sees no stiffness
    {"flat", "implicit-euler", 82, 1.2, "--sheet 'nodes 12 12' " + corners,
     Cause::flat},
    // Too few substeps
    {"xpbd", "xpbd", 150, 0.5,
     "--sheet 'nodes 12 12' --stiffness 1e4 " + corners, Cause::rounds},
    // Large motion, within the limit of small oscillations
    {"large", "verlet", 0.95, 5,
     "--sheet 'nodes 7 9 velocity 5 0 10' --pin 'x 0'", Cause::nonlinear},
    {"large", "symplectic-euler", 0.95, 20, net + "--stiffness 10 " + corners,
     Cause::nonlinear},
    // What moves is too fast
    {"moving", "verlet", 0.9, 1,
     cloth + "--pin 'x 0' --pin 'x 1 velocity -30 0 0 until 0.05'",
     Cause::nonlinear},
    {"moving", "verlet", 0.9, 1,
     cloth + "--pin 'x 0' --sphere 'at 0.5 0.5 -1 radius 0.3 velocity 0 0 30'",
     Cause::nonlinear},
    // Light nodes, stiff edges
    {"masses", "verlet", 5, 1,
     cloth + corners +
         "--region 'from 0.4 0.4 0 to 0.6 0.6 0 mass-factor 0.02'",
     Cause::step},
    {"masses", "symplectic-euler", 2, 0.1,
     cloth + corners +
         "--region 'from 0.2 0 0 to 0.8 1 0 stiffness-factor 1e4'",
     Cause::step},
    // Equations that are not solved
    {"solver", "tr-bdf2", 1e4, 2,
     "--sheet 'nodes 5 5' --stiffness 1e6 " + corners, Cause::solver},
    {"solver", "implicit-midpoint", 3e3, 2,
     "--sheet 'nodes 5 5' --stiffness 1e6 " + corners, Cause::solver},
    // Layers and friction
    {"layers", "verlet", 1.5, 0.5,
     "--sheet 'nodes 9 9' --sheet 'at 0.1 0.1 0.2 nodes 9 9' --plane 'at 0 0 0 "
     "friction 0.5' --self-collision 'thickness 0.1 friction 0.5'",
     Cause::step},
    {"layers", "implicit-midpoint", 10, 1,
     "--sheet 'nodes 6 6' --sheet 'at 0.1 0.1 0.2 nodes 6 6' --sphere 'at 0.5 "
     "0.5 -0.4 radius 0.35 friction 0.3' --self-collision 'thickness 0.15 "
     "friction 0.5'",
     Cause::waves},
    // Weight that stretches springs by many times their length
    {"gravity", "verlet", 0.95, 10, net + corners + "--gravity 100",
     Cause::nonlinear},
    {"gravity", "rk4", 1.2, 5, cloth + "--pin 'x 0' --gravity 1e3",
     Cause::step},
};

/** The step of @a f, in two digits. */
std::string dt_of(const Failing& f) {
  const Scene about(parsed(f.scene + " --dt 1 --method " + f.method));
  double limit = about.safe_limit();
  if (!(limit > 0 && limit < no_limit)) limit = about.safe_limit(table::verlet);
  return CME212::two_digits(f.share * limit);
}

class AFailedRun : public ::testing::TestWithParam<Failing> {};

// The advice is taken from the message, put on the command line, and followed.
TEST_P(AFailedRun, IsCuredByItsOwnAdvice) {
  const Failing& f = GetParam();
  const std::string end = " --t-end " + CME212::short_text(f.t_end);
  const std::string method = " --method " + std::string(f.method);
  const Model m = parsed(f.scene + method + " --dt " + dt_of(f) + end);
  Scene scene(m);
  ASSERT_FALSE(scene.run_to(m.t_end)) << "does not fail";
  const Diagnosis& d = scene.diagnosis();
  EXPECT_EQ(d.cause, f.cause) << scene.explanation().text();
  EXPECT_FALSE(has(d.cause_text(), "dt is 0 "));
  const std::string remedy = d.remedy_text();
  const auto works = remedy.find(
      " works: a trial to t = " + CME212::short_text(f.t_end) + " s passed");
  ASSERT_NE(works, std::string::npos) << remedy;
  std::string advice = remedy.substr(0, works);
  if (advice.find("--method") == std::string::npos) advice += method;
  const Model cured = parsed(f.scene + ' ' + advice + end);
  EXPECT_EQ(cured.step.dt, d.cure->dt) << advice;
  Scene again(cured);
  EXPECT_TRUE(again.run_to(m.t_end))
      << advice << ": " << text_of(again.failure());
  EXPECT_EQ(again.time(), m.t_end);
}

INSTANTIATE_TEST_SUITE_P(Diagnosis, AFailedRun, ::testing::ValuesIn(failing),
                         [](const auto& row) {
                           std::string name =
                               row.param.kind + std::string(row.param.method);
                           std::erase_if(
                               name, [](char c) { return !std::isalnum(c); });
                           return name + std::to_string(row.index);
                         });

// The same cloth, also flat, but nothing moves it out of its plane.
TEST(Diagnosis, NamesTheFlatClothWhereThatIsTheOnlyCause) {
  const Model m = parsed(
      "--sheet 'v 0 0 -1 nodes 12 12' --pin 'x 0 z 0' --pin 'x 1 z 0' --method "
      "implicit-euler --dt 0.4 --t-end 1.2");
  Scene scene(m);
  EXPECT_TRUE(scene.run_to(m.t_end)) << text_of(scene.failure());
  EXPECT_TRUE(is_flat(scene.cloth()));
  scene.cloth().node(5).position().y = 1e-6;
  EXPECT_FALSE(is_flat(scene.cloth()));
}

// ------------------------------------------------------------ What is claimed

/** A run by Verlet at 0.7 of its limit of 0.01 s that fails at t = 2 s. */
FailedRun within_the_limit() {
  FailedRun run = {.method = table::verlet, .dt = 0.007, .time = 2};
  run.sharp = run.safe = run.safe_without_drag = run.verlet = 0.01;
  return run;
}

TEST(Diagnosis, NamesTheFirstCureThatOutlivesTheFailure) {
  std::vector<double> tried;
  const Diagnosis d = diagnose(within_the_limit(), [&](const Cure& cure) {
    tried.push_back(cure.dt);
    return Attempt{cure.dt < 0.002, 5};
  });
  EXPECT_EQ(tried, (std::vector{0.0035, 0.00175}));
  ASSERT_TRUE(d.cure);
  EXPECT_EQ(d.cure->dt, 0.00175);
  EXPECT_EQ(d.cause, Cause::nonlinear);
  EXPECT_EQ(d.cause_text(),
            "the motion is large or fast, or nodes are held or moved: dt is "
            "70 % of the stability limit (0.01 s, verlet), which holds for "
            "small oscillations only");
  EXPECT_EQ(d.remedy_text(),
            "--dt 0.00175 works: a trial to t = 5 s passed, and half of that "
            "step gives the same energy and positions");
}

// A cure has to mend the answer or the positions, too.
TEST(Diagnosis, KnowsNoCureThatIsNoBetterThanTheRun) {
  for (const bool asks : {false, true}) {
    FailedRun run = within_the_limit();
    asks ? run.asked = "pin-force" : (run.apart = 0.2, "");
    const auto with = [&](double largest) {
      return diagnose(run, [&](const Cure& cure) {
        const double off = cure.dt / run.dt;  // 1/2, 1/4, 1/16, ...
        return Attempt{true, 5, asks ? 0 : largest * off,
                       asks ? largest * off : 0};
      });
    };
    ASSERT_TRUE(with(0.19).cure);
    EXPECT_EQ(with(0.19).cure->dt, asks ? 0.00175 : 0.0035);
    EXPECT_TRUE(has(with(0.19).remedy_text(),
                    asks ? "the same energy and pin-force"
                         : "but positions that differ by up to 9.5 %"))
        << with(0.19).remedy_text();
    EXPECT_FALSE(with(1e3).cure);
    // Positions alone: no step below a quarter is tried.
    EXPECT_EQ(with(1e3).grows, !asks);
    EXPECT_EQ(with(1e3).failed.size() == 2, !asks);
    if (asks) continue;
    EXPECT_EQ(with(1e3).remedy_text(),
              "shorter steps do not help: trials of --dt 0.0035, --dt "
              "0.00175 have positions that differ as much, and the energy "
              "of half of their step");
  }
}

// Zero rest lengths make the forces linear: then one linear solve is exact,
// whatever the step. Else springs that turn are the only cause.
TEST(Diagnosis, NamesTheOneLinearSolveWhereThatIsTheOnlyCause) {
  for (int length : {0, 1}) {
    Model m = parsed(
        "--sheet 'nodes 8 8 velocity 3 1 10' --pin 'x 0 y 0' --method "
        "implicit-euler --dt 0.2 --t-end 2 --rest-length " +
        std::to_string(length));
    Scene scene(m);
    scene.watch(m.t_end);
    ASSERT_TRUE(scene.run_to(m.t_end));
    EXPECT_EQ(scene.witness()->verdict().gains(), length == 1);
    if (length == 0) continue;
    EXPECT_FALSE(is_flat(scene.cloth()));
    EXPECT_EQ(scene.diagnosis().cause, Cause::linear);
  }
}

// TR-BDF2 solves its equations, and damps fast waves: what is left is the error
// of its steps, of order 2.
TEST(Diagnosis, NamesTheErrorOfAStepWhereThatIsTheOnlyCause) {
  double off[3];
  for (int k : {0, 1, 2}) {
    Model m = parsed(
        "--sheet 'nodes 8 8 velocity 0 0 4' --pin 'x 0 y 0' --rest-length 0 "
        "--method tr-bdf2 --t-end 2");
    m.step.dt = 0.008 / (1 << k);
    Scene scene(m);
    scene.watch(m.t_end);
    ASSERT_TRUE(scene.run_to(m.t_end));
    off[k] = scene.witness()->verdict().off;
    if (k > 0) continue;
    EXPECT_TRUE(scene.witness()->verdict().is_off());
    EXPECT_EQ(scene.diagnosis().cause, Cause::error);
  }
  EXPECT_LT(off[1], 4 * off[2]);  // both are losses
}

// Springs of a thrown sheet stay at rest: no wave in them gained that energy.
TEST(Diagnosis, NamesNoWavesWhereSpringsHaveNoEnergy) {
  Model m = parsed(
      "--sheet 'nodes 3 3 velocity 1.4 -0.68 2.1' --density 0.13 --drag 0.1 "
      "--method implicit-midpoint --dt 0.1 --t-end 0.2");
  for (bool stretched : {false, true}) {
    if (stretched) m.rest_length = 0.5;
    Scene scene(m);
    scene.watch(m.t_end);
    ASSERT_TRUE(scene.run_to(m.t_end));
    scene.witness()->verdict();
    EXPECT_EQ(scene.diagnosis().cause, stretched ? Cause::waves : Cause::error);
  }
}

TEST(Diagnosis, NamesNoCureWhoseTrialWasStopped) {
  int trials = 0;
  const Diagnosis d = diagnose(within_the_limit(), [&](const Cure&) {
    return Attempt{++trials > 1, 1.5};  // s, of 2
  });
  EXPECT_LE(trials, 10);
  EXPECT_FALSE(d.cure);
  EXPECT_TRUE(begins(d.remedy_text(),
                     "no remedy was found: trials of --dt 0.0035 failed, too; "
                     "trials of --dt 0.00175, --dt "));
  EXPECT_TRUE(has(d.remedy_text(), " were stopped before the time of the"));
}

TEST(Diagnosis, ClaimsNothingIfAllTrialsFail) {
  std::set<std::string> tried;
  int trials = 0;
  const FailedRun run = within_the_limit();
  const Diagnosis d = diagnose(run, [&](const Cure& cure) {
    tried.insert(cure.options(run.method)), ++trials;
    return Attempt{false, 1.9};
  });
  EXPECT_FALSE(d.cure);
  EXPECT_EQ(int(tried.size()), trials);  // nothing twice
  EXPECT_GE(trials, 5);
  EXPECT_LE(trials, 10);
  const std::string text = d.remedy_text();
  EXPECT_TRUE(
      begins(text, "no remedy was found: trials of --dt 0.0035, --dt "));
  EXPECT_TRUE(has(text, "--method tr-bdf2 --dt 0.007"));
}

TEST(Diagnosis, TellsDragFromWaves) {
  FailedRun run = within_the_limit();
  run.method = table::symplectic_euler;
  run.sharp = run.safe = 0.005;
  const auto fails = [](const Cure&) { return Attempt{false, 0}; };
  EXPECT_EQ(diagnose(run, fails).cause, Cause::drag);
  run.safe_without_drag = 0.005;
  EXPECT_EQ(diagnose(run, fails).cause, Cause::step);
  run.dt = 0.0048;
  EXPECT_EQ(diagnose(run, fails).cause, Cause::nonlinear);
  run.dt = 0.0049;  // a sharp limit is found from below, to 2 %
  EXPECT_EQ(diagnose(run, fails).cause, Cause::step);
}

TEST(Diagnosis, OfAStartThatIsAtFaultTriesNothing) {
  Scene scene(parsed("--sheet 'nodes 3 3 velocity 1e200 0 0'"));
  ASSERT_TRUE(scene.failure());
  const Diagnosis& d = scene.diagnosis();
  EXPECT_EQ(d.cause, Cause::start);
  EXPECT_FALSE(d.cure);
  EXPECT_EQ(d.cause_text(),
            "the initial state fails with every method and step");
  EXPECT_EQ(d.remedy_text(), "check its values");
}

// No step is named as the cure of a failure that no step cures.
TEST(Diagnosis, OfTwoHeldNodesThatMeetKnowsNoCure) {
  const Model m = parsed(
      "--sheet 'nodes 3 3' --sheet 'at 0 0 0.5 nodes 3 3' --pin 'z 0' --pin "
      "'z 0.5 velocity 0 0 -1' --self-collision 'thickness 0.4' --t-end 1");
  Scene scene(m);
  ASSERT_FALSE(scene.run_to(m.t_end));
  EXPECT_EQ(scene.diagnosis().cause, Cause::solver);
  const Explanation why = scene.explanation();
  EXPECT_FALSE(scene.diagnosis().cure) << why.text();
  EXPECT_TRUE(has(why.cause, "are held closer than the thickness"));
  EXPECT_TRUE(begins(why.remedy, "no remedy was found: trials of "))
      << why.text();
}

// A user who ends the program waits for no trials, but learns what happened.
TEST(Diagnosis, IsCutShortByASignal) {
  const Model m = parsed("--sheet 'nodes 5 5' --pin 'x 0' --dt 0.02");
  Scene scene(m);
  ASSERT_FALSE(scene.run_to(m.t_end));
  const auto explain = [&] {
    catch_interrupts();
    raise(SIGTERM);
    std::cerr << scene.explanation().text();
    std::_Exit(0);  // without the sanitizer's last words
  };
  EXPECT_EXIT(explain(), testing::ExitedWithCode(0),
              "^diverged; a signal ended the search for a remedy; step .* of "
              "t = .* s$");
  EXPECT_TRUE(scene.diagnosis().cure);
}

TEST(Diagnosis, IsForgottenByARestart) {
  const Model m = parsed("--sheet 'nodes 5 5' --pin 'x 0' --dt 0.02");
  Scene scene(m);
  ASSERT_FALSE(scene.run_to(m.t_end));
  const double cure = scene.diagnosis().cure.value().dt;
  scene.restart();
  EXPECT_FALSE(scene.failure());
  ASSERT_FALSE(scene.run_to(m.t_end));
  EXPECT_EQ(scene.diagnosis().cure.value().dt, cure);
}

}  // namespace
