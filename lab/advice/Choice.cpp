#include "lab/advice/Choice.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "lab/methods/Methods.hpp"
#include "lab/stepping/Trial.hpp"

namespace lab {

std::vector<Choice> ChoiceSearch::choices(const Sides& s) const {
  std::vector<const MethodEntry*> methods = {
      &table::verlet, &table::symplectic_euler, &table::pefrl,
      &table::mollified_impulse, &table::tr_bdf2};
  if (q_.rules.keeps_method) methods = {q_.scene.method};
  std::vector<Choice> all;
  for (std::size_t k = parts_.reductions().size(); k-- > 0;) {
    const auto& removed = parts_.reductions()[k].removed;
    std::optional<Model> m = without_all(grids_.on_grid(s), removed);
    if (!m) continue;
    m->t_end = PartStudy::dissipates(*m) ? parts_.rest_time() : q_.scene.t_end;
    const StepCosts costs(*m);
    for (const MethodEntry* method : methods) {
      m->method = method;
      const MethodInfo& info = method->info;
      const double limit = costs.limit(info);
      // Without stiff springs it is Verlet.
      if (info.multirate && !q_.rules.keeps_method && !(limit > costs.verlet()))
        continue;
      const bool bounded = limit != no_limit;
      double dt = bounded ? 0.9 * limit : m->t_end;
      for (int n = 0; n < (bounded ? 7 : 11); ++n) {
        m->step = {.dt = std::min(dt, m->t_end)};
        if (q_.rules.keeps_step) m->step = q_.scene.step;
        m->step.dt = step_of(*m);
        all.push_back({{.model = *m, .work = costs.of_run(*m)},
                       removed,
                       s,
                       bounded ? m->step.dt / limit : dt});
        dt /= bounded ? std::sqrt(2) : 2;
        if (q_.rules.keeps_step) break;
      }
    }
  }
  std::ranges::stable_sort(all, {}, &AdvisedRun::work);
  return all;
}

Trial ChoiceSearch::run(const Choice& c, const Model& m, double work,
                        const std::string& by, const Shake& shake) {
  return q_.pilots.run(m,
                       std::to_string(nodes_of(m)) + " nodes by " +
                           std::string(m.method->info.name) + by,
                       work, c.removed, shake);
}

bool ChoiceSearch::holds(Choice& c) {
  const Trial t = run(c, c.model, c.work, "");
  c.error = grids_.error_of(t);
  c.seconds = t.seconds, c.answer = t.answer, c.checked = true;
  c.uncertainty = grids_.grids().uncertainty();
  q_.advice.choices.push_back({nodes_of(c.model),
                               std::string(c.model.method->info.name),
                               c.model.step.dt, c.error, c.work});
  if (!grids_.accepts(c.error)) return false;
  Model smaller = c.model;
  smaller.step.dt /= 2;
  const Trial half = run(c, smaller, 2 * c.work, " and half the step");
  c.half_step = grids_.error_of(half);
  if (!grids_.accepts(*c.half_step)) return false;
  c.half = half.answer;
  if (!holds_on_finer_grids(c)) return false;
  c.scatter = perturb(c);
  c.uncertainty += scatter_share * c.scatter;
  return c.scatter <= grids_.tolerance() / 2 &&
         grids_.accepts(c.error, c.uncertainty);
}

bool ChoiceSearch::holds_on_finer_grids(Choice& c) {
  for (const auto& [more, by] :
       {std::pair(std::sqrt(2), " and 1.4 times the cells"),
        std::pair(2., " and twice the cells")}) {
    const double work = std::pow(more, 3) * c.work;
    if (c.sides.empty() ||
        !q_.pilots.affords(work, "a check on twice the cells", 0.5))
      break;
    Sides sides = c.sides;
    for (auto& sheet : sides)
      for (double& side : sheet) side *= more;
    Model finer = *without_all(grids_.on_grid(sides), c.removed);
    finer.method = c.model.method, finer.t_end = c.model.t_end;
    finer.step = {.dt = c.model.step.dt / more};
    const double error = grids_.error_of(run(c, finer, work, by));
    if (!grids_.accepts(error)) return false;
    if (more == 2) c.finer_grid = error;
  }
  return true;
}

double ChoiceSearch::perturb(const Choice& c) {
  double most = 0;
  auto look = [&](const Model& m, const Shake& shake, const Answer& expected) {
    if (!q_.pilots.affords(c.work, "perturbed starts")) return;
    const Trial t = run(c, m, c.work, ", perturbed", shake);
    if (!t.ok()) return;
    ++q_.advice.perturbed;
    most = std::max(most, grids_.distance_of(t.answer, expected));
  };
  const Shake& shake = grids_.shake();
  for (unsigned seed : {2, 3, 4})
    look(c.model, {(seed - 1) * shake.size, seed, shake.along}, c.answer);
  Model other = c.model;
  other.step.dt *= 0.8;
  other.step.dt = step_of(other);
  const double p = c.model.method->info.order,
               way = (1 - std::pow(other.step.dt / c.model.step.dt, p)) /
                     (1 - std::pow(0.5, p));
  Effect expected(c.answer.size());
  expected.add(1 - way, c.answer).add(way, c.half);
  look(other, {}, expected.by);
  return most;
}

void ChoiceSearch::try_all(const Sides& s, std::optional<Choice>& best) {
  // Parts left out for which smaller steps are no remedy, and the last error
  // of each method with them.
  std::set<std::size_t> fail;
  std::map<std::pair<std::size_t, std::string>, double> errors;
  for (Choice& c : choices(s)) {
    if (best && !(c.work < best->work)) break;
    if (fail.contains(c.removed.size())) continue;
    const std::string method(c.model.method->info.name);
    const auto fails = too_long_.find(method);
    if (fails != too_long_.end() && c.step > 0.99 * fails->second) continue;
    if (!q_.pilots.affords(c.work, "more expensive choices", 0.33)) break;
    if (holds(c)) {
      best = c;
      break;
    }
    if (!(c.error <= 1.5 * grids_.tolerance())) too_long_[method] = c.step;
    double& before =
        errors.try_emplace({c.removed.size(), method}, infinite).first->second;
    // From files all error is by the step; implicit steps begin very long.
    const bool bounded = std::isnormal(c.model.method->info.limit);
    if (!s.empty() &&
        (grids_.accepts(c.error) || (bounded && c.error > 0.9 * before)))
      fail.insert(c.removed.size());
    before = c.error;
  }
}

void ChoiceSearch::search() {
  // The choice found before holds if finer grids do not contradict it.
  if (found_) {
    found_->error = grids_.distance_of(found_->answer, grids_.grids().limit());
    found_->uncertainty =
        grids_.grids().uncertainty() + scatter_share * found_->scatter;
    if (!(found_->error <= grids_.tolerance())) found_.reset();
  }
  q_.advice.choices.clear(), too_long_.clear();
  std::optional<Choice> best;
  for (int start : grids_.starts()) {
    if (best) break;
    for (const Sides& s : grids_.frontier(start)) try_all(s, best);
  }
  if (best) {
    found_ = best;
  } else if (!found_ && parts_.rest_time() < q_.scene.t_end) {
    parts_.forget_rest();
    search();
  }
}

void ChoiceSearch::search_steps() {
  for (Choice& c : choices(grids_.all_sides(1, 1)))
    if (q_.pilots.affords(c.work, "smaller steps", 0.33) && holds(c)) {
      found_ = c;
      return;
    }
}

}  // namespace lab
