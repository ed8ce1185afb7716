/** @file SceneFailure.cpp
 * Scene::diagnosis(): why a scene failed, and a cure that works. */
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>
#include <vector>

#include "lab/fast/GraphArrays.hpp"
#include "lab/methods/Methods.hpp"
#include "lab/scenes/Interrupt.hpp"
#include "lab/stepping/Scene.hpp"

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
  run.rigid =
      !failure && s.energy_watch() && s.energy_watch()->gains_beside_springs();
  return run;
}

/** The largest distance of a node of @a a from where it is in @a b, by the side
 * of a square sheet with so many nodes and such springs; infinite if the node
 * was removed there. */
double distance(const Cloth& a, const Cloth& b) {
  double most = 0, length = 0;
  for (Node n : a.nodes()) {
    if (!arrays(b).node_in_use(n.id())) return no_limit;
    const Point there = arrays(b).node_with_id(n.id()).position();
    most = std::max(most, double(norm(n.position() - there)));
  }
  for (Edge e : a.edges()) length += e.length();
  const double side = length / a.num_edges() * std::sqrt(a.num_nodes());
  return side > 0 ? most / side : most;
}

/** Run with @a cure and with half of its step; the energies of both runs must
 * agree at all times, because a run that does not fail may still be wrong. */
Attempt attempt(const Scene& failed, const Cure& cure, double t_end,
                double left) {
  const auto energy = [](const Energies& e, EnergyFlow flow) {
    flow.drag = 0;  // a sum over steps
    return balance(e, flow);
  };
  try {
    const auto trial = failed.anew(cure);
    trial->watch_energy(t_end);
    const long long every =
        1 + (long long)((t_end - trial->time()) / cure.dt / 64);
    std::vector<std::pair<double, double>> samples;  // time [s], balance [J]
    double largest = 0;                              // kinetic, elastic [J]
    while (!trial->done(t_end) && left > 0 && trial->step(t_end)) {
      const Cloth& g = trial->cloth();
      left -=
          evaluations_of(cure.method.info) * (g.num_nodes() + g.num_edges());
      end_if_interrupted();
      if (trial->steps() % every != 0) continue;
      const Energies e = trial->energy();
      largest = std::max(largest, e.kinetic + e.elastic);
      samples.emplace_back(trial->time(), energy(e, trial->flow()));
    }
    const double end = trial->time();
    bool passed = !trial->failure() && (trial->done(t_end) || trial->settle());
    const EnergyWatch& watch = *trial->energy_watch();
    passed = passed && !watch.gains() && !watch.is_off();
    const auto finer = failed.anew({cure.method, cure.dt / 2});
    const double apart =
        energy_tolerance / 2 * largest + failed.stepper().round_off();
    for (const auto& [time, b] : samples)
      passed = passed && finer->run_to(time, end_if_interrupted) &&
               std::abs(energy(finer->energy(), finer->flow()) - b) <= apart;
    passed = passed && finer->run_to(end, end_if_interrupted);
    return {passed, end, passed ? distance(trial->cloth(), finer->cloth()) : 0};
  } catch (const std::invalid_argument&) {  // not with this force
    return {false, 0};
  }
}

}  // namespace

std::optional<Attempt> Scene::half_step(double work) const {
  const double springs = cloth().num_nodes() + cloth().num_edges();
  if (changed_ ||
      2 * double(steps()) * evaluations_of(method()) * springs > work)
    return std::nullopt;
  const auto finer = anew({method_entry(), dt() / 2});
  // With order 1, that is half of the error.
  const double most = energy_tolerance / 4 * energy_watch()->largest() +
                      energy_watch()->slack();
  if (!finer->run_to(time(), end_if_interrupted)) return std::nullopt;
  return Attempt{std::abs(finer->energy().total() - energy().total()) <= most,
                 time(), distance(cloth(), finer->cloth())};
}

const Diagnosis& Scene::diagnosis() const {
  if (diagnosis_) return *diagnosis_;
  const FailedRun run = failed_run(*this);
  const bool ends = std::isfinite(t_end());  // else somebody waits for the cure
  const double end = ends ? t_end() : std::max(5., 2 * run.time);
  return diagnosis_.emplace(diagnose(run, [&](const Cure& cure) {
    return attempt(*this, cure, end, ends ? trial_work : trial_work / 16);
  }));
}

}  // namespace lab
