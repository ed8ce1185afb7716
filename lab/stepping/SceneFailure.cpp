/** @file SceneFailure.cpp
 * Scene::diagnosis(): why a scene failed, and a cure that works. */
#include <algorithm>
#include <cmath>
#include <functional>
#include <stdexcept>
#include <utility>
#include <vector>

#include "lab/methods/Methods.hpp"
#include "lab/scenes/Interrupt.hpp"
#include "lab/stepping/Scene.hpp"
#include "lab/stepping/Trial.hpp"

namespace lab {

namespace {

FailedRun failed_run(const Scene& s) {
  const Stepper& stepper = s.stepper();
  const MethodEntry& method = stepper.method_entry();
  const auto& failure = s.failure();  // none: its energy is wrong
  FailedRun run = {.method = method, .dt = s.dt(), .time = no_limit};
  if (failure && failure->kind == Failure::Kind::start) return run;
  run.time = std::min(s.time() + s.dt(), stepper.t_end());
  run.solver = failure && failure->kind == Failure::Kind::refused;
  run.sharp = stepper.sharp_limit(40);
  run.safe = s.safe_limit();
  run.safe_without_drag = stepper.limits().safe_without_drag(method);
  run.verlet = s.safe_limit(table::verlet);
  run.flat = is_flat(s.cloth());
  const Verdict* verdict = s.witness() ? s.witness()->said() : nullptr;
  run.rigid =
      !failure && verdict &&
      (verdict->scale <= verdict->slack || verdict->gain > 2 * verdict->mine);
  if (failure || !verdict) return run;
  if (!verdict->has_answer()) run.asked = verdict->asked;
  if (!verdict->gains() && !verdict->is_off()) run.apart = verdict->apart;
  return run;
}

/** Run with @a cure until @a t_end, or until it took @a left, and let a witness
 * judge that run: one that does not fail may still be wrong. */
Attempt attempt(const Scene& failed, const Cure& cure, double t_end,
                double left) {
  try {
    const auto trial = failed.anew(cure);
    t_end = std::min(t_end, trial->time() + left / trial->work_of(1) * cure.dt);
    trial->watch(t_end, true);
    std::optional<Observer> observer;
    if (trial->model().measure.quantity != Measure::positions)
      observer.emplace(*trial);
    std::function<void()> look;
    if (observer && observer->looks()) look = [&] { observer->look(); };
    if (!trial->run_to(t_end, look)) return {false, trial->time()};
    const Answer mine = observer ? observer->answer() : Answer();
    if (!trial->witness()) return {true, trial->time()};
    const Verdict& v = trial->witness()->verdict(observer ? &mine : nullptr);
    return {!v.gains() && !v.was_off(), trial->time(), v.apart, v.answer};
  } catch (const std::invalid_argument&) {  // not with this force
    return {false, 0};
  }
}

}  // namespace

const Diagnosis& Scene::diagnosis() const {
  if (diagnosis_) return *diagnosis_;
  const FailedRun run = failed_run(*this);
  const bool ends = std::isfinite(t_end());  // else somebody waits for the cure
  const double end = ends ? t_end() : std::max(5., 2 * run.time);
  return diagnosis_.emplace(diagnose(run, [&](const Cure& cure) {
    return attempt(*this, cure, end, trial_work);
  }));
}

}  // namespace lab
