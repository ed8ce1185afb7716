#pragma once
/** @file Scene.hpp
 * Scene: a cloth with its forces, its constraints and a clock, as a Recipe
 * makes them. */
#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "lab/methods/Method.hpp"
#include "lab/scenes/Compose.hpp"
#include "lab/stability/Diagnosis.hpp"
#include "lab/stability/Guard.hpp"

namespace lab {

/** A scene, ready to run. */
class Scene {
 public:
  /** Steps between two looks of the guard, and between two of SharpOmega. */
  static constexpr int guard_interval = 32, sharp_interval = 100;

  /** At t = 0 and at rest, as the recipe makes it.
   * @pre step.dt > 0
   * Throws std::invalid_argument if nothing bounds the step that it is to
   * choose; and what the recipe throws. */
  Scene(Recipe recipe, const TimeStep& step, const MethodEntry& method);
  /** The scene of @a m.  Throws InputError, SceneError, and as above. */
  explicit Scene(const Model& m);
  Scene(const Scene&) = delete;  // pins hold handles into the cloth
  Scene& operator=(const Scene&) = delete;

  /** Back to t = 0.  Invalidates: every handle into cloth(). */
  void restart();

  /** One step of dt(). The guard looks at every 32nd only, and at those that
   * change the graph: see check().
   * @return false if the run failed: then failure() says where and why, and the
   * cloth and the clock are those of the last good state.
   * @pre failure().empty()
   * Throws std::invalid_argument if the method can't do with this force. */
  bool step();

  /** Make sure that the present state is good: whoever shows it or writes it
   * down asks for that first. If it is not, the steps since the last check are
   * made again, one by one, to find the one that failed.
   * @return as step() */
  bool check();

  /** True at the end of a run to @a t_end [s], to round-off, so that 5000 steps
   * of 0.001 s are 5 s; and if the run failed. */
  bool done(double t_end) const {
    return !failure_.empty() || time() >= t_end * (1 - 1e-12);
  }
  /** Step until done(@a t_end), with a call of @a after() after each step, and
   * after the one that failed, if one did. The state at the end is checked.
   * @return as step()   Throws as step(), and what @a after throws. */
  bool run_to(double t_end, const std::function<void()>& after);
  bool run_to(double t_end) {
    return run_to(t_end, [] {});
  }

  /** The cloth; between two steps it may be changed in any way. */
  Cloth& cloth() { return cloth_; }
  const Cloth& cloth() const { return cloth_; }
  const Recipe& recipe() const { return recipe_; }
  const MethodInfo& method() const { return entry_.info; }
  StepRule step_rule() const { return step_.rule; }
  /** The next step [s]; it changes with StepRule::sharp only. */
  double dt() const { return clock_.dt; }
  /** Steps done, and the time [s] reached. */
  long long steps() const { return clock_.steps; }
  double time() const { return clock_.time(); }
  /** Why step() returned false; empty before. And where. */
  const std::string& failure() const { return failure_; }
  const std::optional<WorstPlace>& failed_at() const { return worst_; }
  /** What would have tunnelled through an obstacle. */
  const WatchedConstraint& watched() const { return *watched_; }

  /** The stability limit [s] of @a method, or of this scene's, in every
   * configuration of the cloth; no_limit if there is none, 0 if no step is
   * stable.
   * Complexity: the first call as omega_safe(). */
  double safe_limit(const MethodEntry& method);
  double safe_limit() { return safe_limit(entry_); }

 private:
  /** Steps and time: those of the last change of dt, and multiples of it, as
   * sums of steps would depend on rounding. */
  struct Clock {
    double dt = 0, from = 0;  // [s]
    long long steps = 0, from_steps = 0;
    double time() const { return from + double(steps - from_steps) * dt; }
    void set_dt(double next) {
      from = time(), from_steps = steps;
      dt = next;
    }
  };

  Recipe recipe_;
  TimeStep step_;
  MethodEntry entry_;
  Cloth cloth_;
  std::optional<ForcePlan> force_;
  std::optional<WatchedConstraint> watched_;
  ConstraintPlan constraint_;
  std::optional<DivergenceGuard> guard_;
  std::unique_ptr<Method> method_;
  Clock clock_, checked_;    // checked_: when the guard kept the state
  std::size_t version_ = 0;  // of the cloth, then
  double safe_omega_ = -1;   // [1/s]; negative: not known yet
  SharpOmega sharp_;
  std::string failure_, error_;  // error_: of the method
  std::optional<WorstPlace> worst_;

  void keep_clock();
  void watch_paths();
  void choose_step();
  bool advance();
  bool replay(long long last);
  void rewind();
  bool fail(const std::string& what);
};

}  // namespace lab
