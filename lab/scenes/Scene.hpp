#pragma once
/** @file Scene.hpp
 * Scene: a cloth with its forces, its constraints and a clock, as a Recipe
 * makes them. */
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "lab/methods/Methods.hpp"
#include "lab/scenes/Compose.hpp"
#include "lab/stability/Guard.hpp"

namespace lab {

/** A scene, ready to run. */
class Scene {
 public:
  /** Steps between two looks of the guard, and between two of SharpOmega. */
  static constexpr int guard_interval = 32, sharp_interval = 100;

  /** At t = 0 and at rest, as the recipe makes it.
   * @pre the parameters are in range
   * Throws std::invalid_argument if nothing bounds the step that it is to
   * choose; and what the recipe throws. */
  Scene(Recipe recipe, const Parameters& with, const MethodEntry& method)
      : recipe_(std::move(recipe)),
        with_(with),
        entry_(method),
        method_(method.make()) {
    restart();
  }
  Scene(const Scene&) = delete;  // pins hold handles into the cloth
  Scene& operator=(const Scene&) = delete;

  /** Back to t = 0.  Invalidates: every handle into cloth(). */
  void restart() {
    cloth_.clear();
    recipe_.build(cloth_);
    force_ = recipe_.force(cloth_);
    watched_.emplace(recipe_.constraint(cloth_));
    constraint_ = *watched_;
    guard_.emplace(cloth_, with_.gravity);
    method_->restart();
    clock_ = {.dt = with_.dt};
    safe_omega_ = -1;
    failure_.clear();
    worst_.reset();
    if (with_.rule != StepRule::fixed) choose_step();
    keep_clock();
  }

  /** One step of dt(). The guard looks at every 32nd only, and at those that
   * change the graph: see check().
   * @return false if the run failed: then failure() says where and why, and the
   * cloth and the clock are those of the last good state.
   * @pre failure().empty()
   * Throws std::invalid_argument if the method can't do with this force. */
  bool step() {
    if (with_.rule == StepRule::sharp && clock_.steps > 0 &&
        clock_.steps % sharp_interval == 0) {
      if (!check()) return false;
      choose_step();
      keep_clock();  // with the new dt, in case that these steps are replayed
    }
    if (!advance()) return replay(clock_.steps + 1);
    if (clock_.steps - checked_.steps >= guard_interval ||
        cloth_.version() != version_)
      return check();
    return true;
  }

  /** Make sure that the present state is good: whoever shows it or writes it
   * down asks for that first. If it is not, the steps since the last check are
   * made again, one by one, to find the one that failed.
   * @return as step() */
  bool check() {
    if (!failure_.empty()) return false;
    if (clock_.steps == checked_.steps) return true;
    if (!guard_->accept(cloth_)) return replay(clock_.steps);
    keep_clock();
    return true;
  }

  /** The cloth; between two steps it may be changed in any way. */
  Cloth& cloth() { return cloth_; }
  const Cloth& cloth() const { return cloth_; }
  const Recipe& recipe() const { return recipe_; }
  const Parameters& parameters() const { return with_; }
  const MethodInfo& method() const { return entry_.info; }
  /** The next step [s]; it changes with StepRule::sharp only. */
  double dt() const { return clock_.dt; }
  /** Steps done, and the time [s] reached. */
  long long steps() const { return clock_.steps; }
  double time() const { return clock_.time(); }
  /** Why step() returned false; empty before. And where. */
  const std::string& failure() const { return failure_; }
  const std::optional<WorstPlace>& failed_at() const { return worst_; }
  /** What would have passed through an obstacle within a step. */
  const WatchedConstraint& watched() const { return *watched_; }

  /** The largest step [s] of @a method, or of this scene's, that is safe in
   * every shape of the cloth; no_limit if there is none, 0 if no step is.
   * Complexity: the first call as omega_safe(). */
  double safe_limit(const MethodEntry& method) {
    if (safe_omega_ < 0) safe_omega_ = omega_safe(cloth_, *force_, constraint_);
    return step_limit(method, safe_omega_,
                      largest_gamma(cloth_, force_->drag()));
  }
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
  Parameters with_;
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

  void keep_clock() {
    checked_ = clock_;
    version_ = cloth_.version();
    watch_paths();
  }

  /** From here on, if nodes get fast for the obstacles. Speeds are looked at
   * here only, so with room for them to grow. */
  void watch_paths() {
    const double thin = watched_->thinnest();
    if (!std::isfinite(thin)) return;
    const double gain = std::abs(with_.gravity) * guard_interval * clock_.dt;
    watched_->watch(cloth_, (max_speed(cloth_) + gain) * clock_.dt > thin / 8);
  }

  void choose_step() {
    double dt = safe_share * safe_limit();
    if (with_.rule == StepRule::sharp) {
      // A cloth let go flat stiffens by 40 % within fewer steps than lie
      // between two looks: so never beyond what holds in every shape.
      const double sharp =
          step_limit(entry_, sharp_(cloth_, *force_, constraint_),
                     largest_gamma(cloth_, force_->drag()));
      dt = std::min(sharp_share * sharp, safe_limit());
    }
    if (!(dt > 0 && std::isfinite(dt)))
      throw std::invalid_argument(
          std::string("nothing bounds the step of ") + entry_.info.name +
          (dt > 0 ? " here" : ": it has no stable step") +
          ", so it can't be chosen: give a number");
    clock_.set_dt(dt);
  }

  /** One step; no look at what came out.  @return false if it can't be made */
  bool advance() {
    try {
      method_->step(cloth_, time(), clock_.dt, *force_, constraint_);
    } catch (const StepError& e) {
      error_ = e.what();
      return false;
    }
    ++clock_.steps;
    return true;
  }

  /** From the last good state on, step by step, until one fails.
   * @param last the step known to fail  @return false if one did */
  bool replay(long long last) {
    rewind();
    while (clock_.steps < last) {
      if (!advance()) return fail("failed (" + error_ + ")");
      if (!guard_->good(cloth_)) return fail("diverged");
      guard_->keep(cloth_);
      keep_clock();
    }
    return true;  // what was torn meanwhile is gone, so it may go well now
  }
  void rewind() {
    guard_->restore(cloth_);
    clock_ = checked_;
    method_->restart();
    watch_paths();
  }

  /** Say what happened to the step, and go back to before it. */
  bool fail(const std::string& what) {
    using CME212::short_text;
    worst_.emplace(cloth_);
    const std::string where = worst_->text(cloth_);
    rewind();
    constexpr MethodEntry verlet = entry_of<Verlet>();
    const double sharp =
        step_limit(entry_, sharp_(cloth_, *force_, constraint_, 40),
                   largest_gamma(cloth_, force_->drag()));
    failure_ = what + " in step " + std::to_string(clock_.steps + 1) +
               " with dt = " + short_text(clock_.dt) + " s, method " +
               entry_.info.name + ": " + where + "; the last good state is " +
               "that of t = " + short_text(time()) + " s; " +
               why_it_failed(entry_.info, clock_.dt, sharp, safe_limit(),
                             safe_limit(verlet));
    return false;
  }
};

}  // namespace lab
