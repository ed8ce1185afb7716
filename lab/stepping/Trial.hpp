#pragma once
/** @file Trial.hpp
 * The answer of a run: try_out() makes one and returns it. */
#include <array>
#include <cmath>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "lab/scenes/Measure.hpp"
#include "lab/stepping/Scene.hpp"
#include "lab/stepping/Settled.hpp"

namespace lab {

/** The value of any quantity in the present state of @a scene; the time of a
 * tear is infinite while nothing has torn.
 * Throws SceneError: pin-force where no pin holds a node */
Answer answer(const Scene& scene, const Measure& what);
/** The same of the measure of its model. */
inline Answer answer(const Scene& scene) {
  return answer(scene, scene.model().measure);
}

/** A number over time, reduced to what a Measure asks of it. Between two times
 * it is taken to be linear, and around a maximum a parabola. */
class TimeSeries {
 public:
  /** Add the value @a x at time @a t [s], later than all before.
   * Amortized O(1) */
  void add(const Measure& what, double t, double x);
  /** Empty if what is asked did not happen: the time of a level, or two maxima.
   * A maximum counts if the number falls on both sides of it by half of the
   * range that it has passed through: so ripples do not count.
   * O(1); of a period O(extrema) */
  Answer answer(const Measure& what) const;
  void archive(Archive& a);

 private:
  struct Sample {
    double t, x;
  };
  long long n_ = 0;
  Sample last_[2] = {};           // before the last; the last
  double best_ = 0, worst_ = 0;   // largest, smallest
  double sum_ = 0, span_ = 0;     // integral, and its duration [s]
  double first_ = -1, left_ = 0;  // when the level was first, last passed [s]
  std::vector<Sample> extrema_;   // maxima and minima, of a period
};

/** Answers a question about a scene that runs: looks at each state, if the
 * answer depends on all of them. Steps that are taken back are forgotten. */
class Observer {
 public:
  /** Looks at the present state of @a scene, which must live longer, for the
   * answer to the question of its model, or to @a what.  Throws as answer() */
  explicit Observer(Scene& scene) : Observer(scene, scene.model().measure) {}
  Observer(Scene& scene, const Measure& what);
  /** Begin anew, as the run does.  Throws as answer() */
  void restart();
  /** Does the answer depend on all states? */
  bool looks() const { return what_.over_time(); }
  /** Call it after each step if looks().  As long as answer() */
  void look();
  /** What to call after each step, for run_to(): look(), if it looks(); else
   * nothing, so that steps may be many at once. */
  std::function<void()> after_steps() {
    return looks() ? [this] { look(); } : std::function<void()>();
  }
  /** The answer so far; empty if what it asks about did not happen. */
  Answer answer() const;
  void archive(Archive& a) { a(settled_)(looks_); }

 private:
  struct Look {
    double time = 0, value = 0;
    void archive(Archive& a) { a(time)(value).require(value == value); }
  };
  const Scene& scene_;
  const Measure what_;
  TimeSeries settled_;  // steps that can't be taken back any more
  Settled<Look> looks_;
};

/** The cost of a factor of a matrix, in force sweeps: 10 per node of a side. */
inline double factor_sweeps(const Cloth& g) {
  return 10 * std::sqrt(double(g.num_nodes()));
}

/** The result of a run. */
struct Trial {
  Answer answer;  ///< empty if the run failed
  /** Its value at 1/64, 2/64 ... 63/64 of the time: a parabola through three
   * steps; of a measure over time, and where it had none before, that of the
   * next step. Empty if it had none. */
  std::vector<Answer> earlier;
  std::vector<double>
      kinetic;  ///< energy after these times, and at the end [J]
  static constexpr int looks = 64;
  std::optional<std::string> failure;  ///< why it failed
  double work = 0;     ///< springs times force evaluations and products with
                       ///< a matrix; a factor of it: factor_sweeps()
  double seconds = 0;  ///< duration on this machine
  double dt = 0;       ///< the first step [s]
  long long steps = 0;
  bool ok() const { return !failure; }
};

/** The step [s] of @a m: its dt, or the first step that is chosen, shortened so
 * that t-end is a multiple of it.  Throws as try_out(). */
double step_of(const Model& m);

/** A random change of each initial coordinate, by at most size [m]. If it
 * changes an answer much, the motion is chaotic: there is no better answer. */
struct Shake {
  double size = 0;
  unsigned seed = 1;
  std::array<bool, 3> along = {true, true, true};  ///< x, y, z
};

/** Run @a m to its end, with steps of step_of(m).
 * @param look called with the cloth at the end, unless the run failed
 * @param after called with the scene after each step; it may change the cloth
 * Throws InputError, SceneError; std::invalid_argument as Scene does;
 * Interrupted. */
Trial try_out(
    const Model& m, const Shake& shake = {},
    const std::function<void(const Cloth&)>& look = [](const Cloth&) {},
    const std::function<void(Scene&)>& after = [](Scene&) {});

}  // namespace lab
