#include "lab/advice/Parts.hpp"

#include <algorithm>
#include <tuple>
#include <utility>

#include "lab/stepping/Trial.hpp"

namespace lab {

void PartStudy::study(std::size_t k) {
  const GridReport& run = grids_.grids()[k];
  level_ = run.level, q_.advice.tried_on = run.nodes;
  try_each(run);
  combine(run);
  find_rest(run);
}

double PartStudy::change(const Trial& without, const Trial& whole) const {
  double most = grids_.distance_of(without.answer, whole.answer);
  const auto n = std::min(without.earlier.size(), whole.earlier.size());
  for (std::size_t k = 0; k < n; ++k) {
    const Answer &a = without.earlier[k], &b = whole.earlier[k];
    if (a.size() != b.size()) return infinite;  // one has not happened yet
    const double then = grids_.distance_of(a, b);
    if (then > grids_.tolerance()) most = std::max(most, then);
  }
  return most;
}

void PartStudy::try_each(const GridReport& run) {
  const StepCosts all(run.model);
  auto& parts = q_.advice.parts;
  parts.clear();
  for (const Variation& v : without_parts(run.model)) {
    const StepCosts costs(v.model);
    PartReport r{v.part, infinite, all.springs() - costs.springs()};
    if (costs.verlet() < no_limit) r.step = costs.verlet() / all.verlet();
    r.tried = q_.pilots.affords(run.work, "parts", 0.1);
    if (r.tried)
      if (const Trial t =
              q_.pilots.run(v.model, "without " + v.part, run.work, {v.part});
          t.ok())
        r.change = change(t, run.trial);
    parts.push_back(r);
  }
}

void PartStudy::combine(const GridReport& run) {
  std::vector<PartReport> order = q_.advice.parts;
  // Parts that save work come before the others.
  std::ranges::stable_sort(order, {}, [](const PartReport& p) {
    const bool saves = p.springs > 0 || p.step > 1.2;
    return std::tuple(p.change > 0, !saves, p.change);
  });
  const double room = 0.7 * grids_.tolerance();
  reductions_ = {{{}, Effect(run.trial.answer.size())}};
  for (const PartReport& part : order) {
    if (!(part.change <= room)) continue;
    std::vector<std::string> removed = reductions_.back().removed;
    removed.push_back(part.part);
    const std::optional<Model> without = without_all(run.model, removed);
    if (!without || !q_.pilots.affords(run.work, "combinations of parts", 0.2))
      continue;
    const Trial t =
        q_.pilots.run(*without, "without " + part.part, run.work, removed);
    if (!t.ok()) continue;
    const Effect effect(t.answer, run.trial.answer);
    if (!(change(t, run.trial) <= room)) continue;
    // Parts that change nothing need no choice of their own.
    if (grids_.distance_of(effect.by, reductions_.back().effect.by) <=
        1e-3 * grids_.tolerance())
      reductions_.pop_back();
    reductions_.push_back({removed, effect});
  }
}

bool PartStudy::dissipates(const Model& m) {
  auto rubs = [](const auto& part) { return part.friction > 0; };
  return m.damping > 0 || m.material.drag.value_or(0) > 0 ||
         std::ranges::any_of(m.planes, rubs) ||
         std::ranges::any_of(m.spheres, rubs);
}

void PartStudy::find_rest(const GridReport& run) {
  constexpr int looks = 64;  // samples of the answer at equal intervals
  const Model& m = run.model;
  rest_time_ = m.t_end;
  if (!dissipates(m) || !q_.pilots.affords(run.work, "an earlier end", 0.1))
    return;
  std::vector<std::pair<double, Answer>> looked;
  std::optional<Observer> observer;
  const Trial t = q_.pilots.run(
      m, "when it comes to rest", run.work, {}, {}, nullptr, [&](Scene& scene) {
        if (!observer) observer.emplace(m, scene);
        if (m.measure.over_time()) observer->look(m, scene);
        if (scene.time() >= double(looked.size()) * m.t_end / looks)
          looked.emplace_back(scene.time(), observer->answer(m, scene));
      });
  for (; t.ok() && !looked.empty(); looked.pop_back()) {
    const auto& [time, then] = looked.back();
    if (then.empty() ||
        !(grids_.distance_of(then, t.answer) <= grids_.tolerance() / 10))
      break;
    if (time <= 0.9 * m.t_end) rest_time_ = time;
  }
}

}  // namespace lab
