/** @file SceneFailure.cpp
 * Why a scene failed, what comes next, and what works instead. */
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>
#include <vector>

#include "lab/Interrupt.hpp"
#include "lab/methods/Methods.hpp"
#include "lab/scenes/Scene.hpp"
#include "lab/stability/StepLimit.hpp"

namespace lab {

const Diagnosis& Scene::diagnosis() const {
  if (diagnosis_) return *diagnosis_;
  FailedRun run = {.method = entry_, .dt = clock_.dt, .time = no_limit};
  if (is_finite()) {
    run.time = std::min(time() + clock_.dt, t_end_);
    run.solver = !error_.empty();
    run.sharp = sharp_limit(40);
    run.safe = safe_limit();
    run.safe_without_drag =
        entry_.info.multirate ? run.safe : step_limit(entry_, safe_omega_);
    run.verlet = safe_limit(*find_method("verlet"));
    // In a gap between resonances large motion may still meet one.
    if (const auto r = resonances(); r && run.dt > r->first()) {
      run.resonance = r->text(run.dt);
      run.clear = r->below(r->at(run.dt) ? run.dt : r->first());
    }
  }
  const double end = std::isfinite(t_end_) ? t_end_ : 2 * run.time;
  diagnosis_ =
      diagnose(run, [&](const Cure& cure) { return attempt(cure, end); });
  return *diagnosis_;
}

std::string Scene::explanation() const {
  try {
    return failure_ + "; " + diagnosis().text;
  } catch (const Interrupted&) {
    return failure_ + "; a signal ended the search for its cause";
  }
}

std::unique_ptr<Scene> Scene::beyond_failure(double distance) const {
  const auto copy = [this] {
    auto scene = std::make_unique<Scene>(
        *this, TimeStep{.dt = clock_.dt, .tolerance = step_.tolerance}, entry_);
    scene->failure_ = failure_;
    return scene;
  };
  auto ahead = copy();
  const auto is_far = [&] {
    const auto now = std::as_const(ahead->cloth_).positions();
    for (Node n : cloth_.nodes())
      if (ahead->cloth_.node_in_use(n.id()) &&
          norm(now[n.id()] - n.position()) > distance)
        return true;
    return false;
  };
  for (int left = 1000; left > 0 && !is_far() && ahead->advance(); --left)
    if (interrupted()) break;
  return ahead->is_finite() ? std::move(ahead) : copy();
}

/** The scene anew by @a cure: from its start; or from here, if a user has
 * changed it since. */
std::unique_ptr<Scene> Scene::anew(const Cure& cure) const {
  const TimeStep step = {
      .dt = cure.dt,
      .rule = StepRule::fixed,
      .tolerance = cure.method.info.adaptive ? step_.tolerance : 0};
  return changed_ ? std::make_unique<Scene>(*this, step, cure.method)
                  : std::make_unique<Scene>(recipe_, step, cure.method);
}

/** Try @a cure, and half of its step, which must have the same energy on the
 * way: a run that does not fail may still be far from the motion. */
Attempt Scene::attempt(const Cure& cure, double t_end) const {
  // An implicit step is worth some hundred force evaluations.
  const MethodInfo& info = cure.method.info;
  const double evaluations = info.sweeps * (info.limit == no_limit ? 100 : 1);
  try {
    const auto trial = anew(cure);
    if (watch_) trial->watch_energy(t_end);
    const auto size = [](const Cloth& g) {
      return g.num_nodes() + g.num_edges();
    };
    const long long every =
        1 + (long long)((t_end - trial->time()) / cure.dt / 64);
    std::vector<std::pair<double, double>> on_the_way;  // time [s], balance [J]
    double largest = 0;                                 // internal [J]
    double left = trial_work;
    while (!trial->done(t_end) && left > 0 && trial->step(t_end)) {
      left -= evaluations * size(trial->cloth());
      end_if_interrupted();
      if (trial->steps() % every != 0) continue;
      const Energies e = trial->energy();
      largest = std::max(largest, e.internal());
      on_the_way.emplace_back(trial->time(), balance(e, trial->flow()));
    }
    const double end = trial->time();
    bool passed = trial->failure().empty() &&
                  (trial->done(t_end) || trial->look(trial->energy()));
    if (watch_)
      passed = passed && std::abs(trial->watch_->share()) <= energy_tolerance;
    const auto finer = anew({cure.method, cure.dt / 2});
    const double apart = energy_tolerance * largest + guard_->round_off();
    for (const auto& [time, b] : on_the_way)
      passed = passed && finer->run_to(time, end_if_interrupted) &&
               std::abs(balance(finer->energy(), finer->flow()) - b) <= apart;
    return {passed, end};
  } catch (const std::invalid_argument&) {  // not with this force
    return {false, 0};
  }
}

}  // namespace lab
