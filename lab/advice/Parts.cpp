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
  const auto &a = without.earlier, &b = whole.earlier;
  for (std::size_t k = 0; k < std::min(a.size(), b.size()); ++k)
    if (const double then = grids_.apart(a[k], b[k], k + 1);
        then > grids_.tolerance())
      most = std::max(most, then);
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
  const double room = grids_.tolerance();
  reductions_ = {{}};
  Answer before = run.trial.answer;  // with the last reduction
  for (const PartReport& part : order) {
    if (!(part.change <= room)) continue;
    std::vector<std::string> removed = reductions_.back();
    removed.push_back(part.part);
    const std::optional<Model> without = without_all(run.model, removed);
    if (!without || !q_.pilots.affords(run.work, "combinations of parts", 0.2))
      continue;
    const Trial t =
        q_.pilots.run(*without, "without " + part.part, run.work, removed);
    if (!t.ok() || !(change(t, run.trial) <= room)) continue;
    // Parts that change nothing need no choice of their own.
    if (grids_.distance_of(t.answer, before) <= 1e-3 * grids_.tolerance())
      reductions_.pop_back();
    reductions_.push_back(removed);
    before = t.answer;
  }
}

bool PartStudy::dissipates(const Model& m) {
  auto rubs = [](const auto& part) { return part.friction > 0; };
  return m.damping > 0 || m.material.drag.value_or(0) > 0 ||
         std::ranges::any_of(m.planes, rubs) ||
         std::ranges::any_of(m.spheres, rubs);
}

void PartStudy::find_rest(const GridReport& run) {
  rest_time_ = q_.scene.t_end;
  if (!dissipates(run.model)) return;
  const auto& then = run.trial.earlier;
  for (std::size_t k = then.size();
       k > 0 && !then[k - 1].empty() &&
       grids_.distance_of(then[k - 1], run.trial.answer) <=
           constant.negligible * grids_.tolerance();
       --k)
    if (const double share = double(k) / Trial::looks; share <= 0.9)
      rest_time_ = share * q_.scene.t_end;
}

}  // namespace lab
