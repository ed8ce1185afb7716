// Witness.hpp: what half of the step shows of sound and of wrong runs, of whole
// ones and by windows.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "lab/methods/Methods.hpp"
#include "lab/scenes/Fields.hpp"
#include "lab/scenes/KeyValues.hpp"
#include "lab/stepping/Scene.hpp"
#include "lab/stepping/Trial.hpp"
#include "tests/Built.hpp"
#include "tests/Says.hpp"

using namespace lab;

namespace {

Model hanging(unsigned n, double t_end) { return hung(square(n, t_end)); }

/** The verdict on a run of @a m.  @param end of the run for the witness */
Verdict verdict(Model m, const char* method, double dt, double end = 0) {
  m.method = find_method(method), m.step = {.dt = dt};
  Scene scene(m);
  scene.watch(end > 0 ? end : m.t_end);
  EXPECT_TRUE(scene.run_to(m.t_end)) << text_of(scene.failure());
  const Observer mine(scene);
  return scene.witness()->verdict(&mine);
}

TEST(Witness, RepeatsTheChangesOfAScene) {
  Model m = hanging(5, 0.5);
  m.at = {"0.2004 stiffness 1600", "0.3 unpin 0", "0.35 cut 6 7"};
  const Verdict good = verdict(m, "verlet", 0.001);
  EXPECT_TRUE(good.whole && good.fine()) << good.text();
  m.t_end = 0.4, m.at = {"0.2 method forward-euler"};
  const Verdict bad = verdict(m, "verlet", 0.005);
  EXPECT_TRUE(bad.whole && bad.is_off()) << bad.text();
}

TEST(Witness, HoldsErrorsOfAFastFallAgainstItsWay) {
  Model m = square(3, 2);
  m.sheets[0].velocity = Point(0, 0, -100);
  EXPECT_TRUE(verdict(m, "verlet", 0.01).fine());
}

TEST(Witness, TearsAtTheStartWhatIsStrainedTooFar) {
  Model m = hanging(5, 0.1);
  m.rest_length = 0.7, m.tear_strain = 0.1;
  Scene scene(m);
  EXPECT_EQ(scene.cloth().num_edges(), 0u);
  EXPECT_TRUE(verdict(m, "verlet", 0.001).fine());
}

TEST(Witness, SeesWhatTheMethodMadeOrLost) {
  Model m = hanging(9, 2);
  const Verdict loss = verdict(m, "implicit-euler", 0.02);
  EXPECT_TRUE(loss.is_off()) << loss.text();
  EXPECT_LT(loss.off, -0.1 * loss.scale);
  EXPECT_FALSE(loss.gains());
  m.stiffness = 1e4;
  EXPECT_TRUE(verdict(m, "xpbd", 0.0333).gains());
  // Whatever is named that does not act.
  for (int part : {0, 1, 2}) {
    Model thrown = square(9, 2);
    thrown.sheets[0].velocity = Point(0, 0, 4);
    thrown.pins = {Pin{0, 0, {}, {}}};
    if (part == 1) thrown.planes = {{.at = Point(0, 0, -50), .motion = {}}};
    if (part == 2) thrown.damping = 1e-7;
    const Verdict gains = verdict(thrown, "implicit-euler", 0.05);
    EXPECT_TRUE(gains.gains()) << part << gains.text();
    EXPECT_TRUE(gains.is_off()) << part;
    EXPECT_TRUE(has(gains.wrong_text(), "has added ")) << gains.wrong_text();
    const Verdict good = verdict(thrown, "verlet", 0.001);  // chaotic
    EXPECT_FALSE(good.wrong() || good.is_off()) << part << good.text();
  }
}

// In 5 steps from rest an Euler method is off by a fifth; that counts only
// where velocities are not ahead.
TEST(Witness, ToleratesVelocitiesThatAreAStepEarly) {
  EXPECT_TRUE(verdict(hanging(5, 0.02), "symplectic-euler", 0.004).fine());
  EXPECT_TRUE(verdict(hanging(5, 0.02), "implicit-euler", 0.004).is_off());
  EXPECT_TRUE(verdict(square(4, 0.5), "symplectic-euler", 0.01).fine());
}

// A run without an end is looked at in windows, at a quarter of its cost, and
// not at twice of it.
TEST(Witness, SeesTheSameInWindows) {
  EXPECT_NEAR(verdict(hanging(7, 1), "verlet", 0.0005).cost, 2, 0.1);
  for (const bool windy : {false, true}) {
    Model m = hanging(7, 5);
    if (windy) m.wind = Wind{Point(2, 0, 5)}, m.damping = 0.05;
    const Verdict v = verdict(m, "verlet", 0.0005, no_limit);
    EXPECT_FALSE(v.whole);
    EXPECT_FALSE(v.wrong() || v.is_off()) << v.text();
    EXPECT_GT(v.cost, 0.2);
    EXPECT_LT(v.cost, 0.26);
  }
  const Model m = hanging(7, 5);
  const Verdict loss = verdict(m, "implicit-euler", 0.01, no_limit);
  EXPECT_TRUE(loss.is_off()) << loss.text();
  EXPECT_LT(loss.off, 0);
  const Verdict gain = verdict(m, "rk4", 0.0001, no_limit);
  EXPECT_FALSE(gain.wrong()) << gain.text();
}

// What holds a cloth, and what lies on a floor, weighs what it weighs; or the
// witness says that the force is not known.
TEST(Witness, VouchesForForcesAtRestByEveryMethod) {
  for (const MethodEntry& method : methods) {
    const bool has_limit = std::isfinite(method.info.limit);
    if (method.info.limit == 0) continue;  // needs a tiny step
    for (const bool lies : {false, true}) {
      Model m = square(5, 3);
      m.material.density = 0.2;
      m.material.modulus = has_limit ? 100 : 1e5;
      m.material.drag = 2;
      if (lies) {
        m.planes = {{.at = Point(0, 0, -0.01), .motion = {}}};
        m.measure = Measure::contact_force;
      } else {
        m.pins = {Pin{{}, 0, {}, {}, {}}};
        m.measure = Measure::pin_force;
      }
      m.method = &method, m.step = {.dt = has_limit ? 0.001 : 0.01};
      Scene scene(m);
      scene.watch(m.t_end, true);
      ASSERT_TRUE(scene.run_to(m.t_end)) << text_of(scene.failure());
      const Observer asked(scene);
      const Answer force = asked.answer();
      const Verdict& v = scene.witness()->verdict(&asked);
      if (v.fine()) {
        const double known = std::max(0.01, 2 * v.answer);
        EXPECT_NEAR(force[0], 0.2 * grav, known * 0.2 * grav)
            << method.info.name << lies << v.text();
      }
      // One that never vouches would be right, too.
      EXPECT_TRUE(v.fine() || !has_limit) << method.info.name << v.text();
    }
  }
}

// The energy of a sheet that the wind blows comes from no start, no gravity and
// no pin.
TEST(Guard, LetsTheWindBlow) {
  Model m = square(3, 1);
  m.pins = {Pin{0, {}, {}, {}, {}}};
  m.damping = 0.05, m.gravity = 0;
  m.wind = Wind{Point(0, 0, 5)};
  for (const char* method : {"symplectic-euler", "verlet", "tr-bdf2"})
    EXPECT_TRUE(verdict(m, method, 0.001).fine()) << method;
  m.step.rule = StepRule::safe, m.method = find_method("verlet");
  Scene scene(m);
  EXPECT_TRUE(scene.run_to(m.t_end)) << text_of(scene.failure());
}

TEST(Witness, ForgetsWhatWasBeforeAChange) {
  Model m = hanging(7, 1);
  m.method = find_method("verlet"), m.step = {.dt = 0.001};
  Scene scene(m);
  scene.watch(m.t_end);
  ASSERT_TRUE(scene.run_to(0.3));
  ASSERT_TRUE(scene.pin(24));  // work that no second run would repeat
  ASSERT_TRUE(scene.run_to(m.t_end));
  const Verdict& v = scene.witness()->verdict();
  EXPECT_FALSE(v.whole);
  EXPECT_FALSE(v.wrong() || v.is_off()) << v.text();
}

}  // namespace
