#include "lab/scenes/Scene.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "CME212/Util.hpp"
#include "lab/methods/Methods.hpp"
#include "lab/stability/StepLimit.hpp"

namespace lab {

Scene::Scene(Recipe recipe, const TimeStep& step, const MethodEntry& method)
    : recipe_(std::move(recipe)),
      step_(step),
      entry_(method),
      method_(method.make()) {
  restart();
}
Scene::Scene(const Model& m) : Scene(recipe_of(m), m.step, *m.method) {}

void Scene::restart() {
  cloth_.clear();
  recipe_.build(cloth_);
  force_ = recipe_.force(cloth_);
  watched_.emplace(recipe_.constraint(cloth_));
  constraint_ = *watched_;
  guard_.emplace(cloth_, recipe_.gravity);
  method_->restart();
  clock_ = {.dt = step_.dt};
  safe_omega_ = -1;
  failure_.clear();
  worst_.reset();
  if (!step_.fixed()) choose_step();
  keep_clock();
}

bool Scene::step() {
  if (step_.rule == StepRule::sharp && clock_.steps > 0 &&
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

bool Scene::check() {
  if (!failure_.empty()) return false;
  if (clock_.steps == checked_.steps) return true;
  if (!guard_->accept(cloth_)) return replay(clock_.steps);
  keep_clock();
  return true;
}

bool Scene::run_to(double t_end, const std::function<void()>& after) {
  while (!done(t_end)) {
    step();
    after();
  }
  return check();
}

double Scene::safe_limit(const MethodEntry& method) {
  if (safe_omega_ < 0) safe_omega_ = omega_safe(cloth_, *force_, constraint_);
  return step_limit(method, safe_omega_, largest_gamma(cloth_, force_->drag()));
}

void Scene::keep_clock() {
  checked_ = clock_;
  version_ = cloth_.version();
  watch_paths();
}

/** From here on, if nodes get fast for the obstacles. Speeds are looked at here
 * only, so with room for them to grow. */
void Scene::watch_paths() {
  const double thin = watched_->thinnest();
  if (!std::isfinite(thin)) return;
  const double gain = std::abs(recipe_.gravity) * guard_interval * clock_.dt;
  watched_->watch(cloth_, (max_speed(cloth_) + gain) * clock_.dt > thin / 8);
}

void Scene::choose_step() {
  double dt = safe_share * safe_limit();
  if (step_.rule == StepRule::sharp) {
    // A cloth let go flat stiffens by 40 % within fewer steps than lie between
    // two looks: so never beyond what holds in every configuration.
    const double sharp =
        step_limit(entry_, sharp_(cloth_, *force_, constraint_),
                   largest_gamma(cloth_, force_->drag()));
    dt = std::min(sharp_share * sharp, safe_limit());
  }
  if (!(dt > 0 && std::isfinite(dt)))
    throw std::invalid_argument(std::string("nothing bounds the step of ") +
                                entry_.info.name +
                                (dt > 0 ? " here" : ": it has no stable step") +
                                ", so it can't be chosen: give a number");
  clock_.set_dt(dt);
}

/** One step; no look at what came out.  @return false if it can't be made */
bool Scene::advance() {
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
bool Scene::replay(long long last) {
  rewind();
  while (clock_.steps < last) {
    if (!advance()) return fail("failed (" + error_ + ")");
    if (!guard_->good(cloth_)) return fail("diverged");
    guard_->keep(cloth_);
    keep_clock();
  }
  return true;  // what was torn meanwhile is gone, so it may go well now
}

void Scene::rewind() {
  guard_->restore(cloth_);
  clock_ = checked_;
  method_->restart();
  watch_paths();
}

/** Say what happened to the step, and go back to before it. */
bool Scene::fail(const std::string& what) {
  using CME212::short_text;
  worst_.emplace(cloth_);
  const std::string where = worst_->text(cloth_);
  rewind();
  const double sharp =
      step_limit(entry_, sharp_(cloth_, *force_, constraint_, 40),
                 largest_gamma(cloth_, force_->drag()));
  failure_ = what + " in step " + std::to_string(clock_.steps + 1) +
             " with dt = " + short_text(clock_.dt) + " s, method " +
             entry_.info.name + ": " + where + "; the last good state is " +
             "that of t = " + short_text(time()) + " s; " +
             why_it_failed(entry_.info, clock_.dt, sharp, safe_limit(),
                           safe_limit(*find_method("verlet")));
  return false;
}

}  // namespace lab
