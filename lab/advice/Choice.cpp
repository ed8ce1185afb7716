#include "lab/advice/Choice.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "lab/advice/Constants.hpp"
#include "lab/methods/Methods.hpp"
#include "lab/stepping/Trial.hpp"

namespace lab {

std::vector<Choice> ChoiceSearch::choices(
    const std::vector<GridStudy::Grid>& grids) const {
  std::vector<const MethodEntry*> tried;
  for (const MethodEntry& m : methods)
    if (m.info.limit > 0 || m.info.adaptive) tried.push_back(&m);
  if (q_.rules.keeps_method) tried = {q_.scene.method};
  std::vector<Choice> all;
  int kind = 0;
  for (const GridStudy::Grid& grid : grids)
    for (const auto& removed : parts_.reductions()) {
      std::optional<Model> m = without_all(grids_.on_grid(grid.sides), removed);
      if (!m) continue;
      // Long implicit steps may need all of the time to come to rest.
      std::set ends = {q_.scene.t_end};
      if (PartStudy::dissipates(*m)) ends.insert(parts_.rest_time());
      const StepCosts costs(*m);
      for (const double t_end : ends) {
        ++kind;
        for (const MethodEntry* method : tried) {
          m->method = method, m->t_end = t_end;
          const MethodInfo& info = method->info;
          const double limit = costs.limit(info);
          // Without stiff springs it is Verlet.
          if (info.multirate && !q_.rules.keeps_method &&
              !(limit > costs.verlet()))
            continue;
          const bool bounded = limit != no_limit;
          double dt = bounded ? 0.9 * limit : m->t_end;
          for (int n = 0; n < (bounded ? 7 : 11); ++n) {
            m->step = {.dt = std::min(dt, m->t_end)};
            if (q_.rules.keeps_step) m->step = q_.scene.step;
            m->step.dt = step_of(*m);
            all.push_back({{.model = *m, .work = costs.of_run(*m)},
                           removed,
                           grid,
                           bounded ? m->step.dt / limit : dt,
                           kind});
            dt /= bounded ? std::sqrt(2) : 2;
            if (q_.rules.keeps_step) break;
          }
        }
      }
    }
  std::ranges::stable_sort(all, {}, [](const Choice& c) {
    return std::tuple(c.work, -double(c.removed.size()),
                      -c.model.method->info.order);
  });
  return all;
}

bool ChoiceSearch::may_hold(const Choice& c) const {
  return std::ranges::none_of(step_errors_, [&](const StepError& e) {
    if (e.method != c.model.method || e.t_end != c.model.t_end) return false;
    if (!e.error) return c.step > 0.99 * e.step;
    const double error = grids_.size_of(Effect(c.grid.off).add(1, e.error->by));
    return c.model.step.dt > 0.99 * e.dt &&
           (e.removed == c.removed ? !grids_.accepts(0.8 * error)
                                   : error > 2 * grids_.tolerance());
  });
}

void ChoiceSearch::learn(const Choice& c, const Trial& t, double share) {
  StepError e{c.model.method,          c.removed, c.model.t_end, share * c.step,
              share * c.model.step.dt, {}};
  if (t.ok())
    e.error = Effect(t.answer, grids_.grids().limit()).add(-1, c.grid.off.by);
  step_errors_.push_back(e);
}

Trial ChoiceSearch::run(const Choice& c, const Model& m, double work,
                        const std::string& by, const Shake& shake) {
  return q_.pilots.run(m,
                       std::to_string(nodes_of(m)) + " nodes by " +
                           std::string(m.method->info.name) + by,
                       work, c.removed, shake);
}

ChoiceSearch::Outcome ChoiceSearch::judge(Choice& c, double most) {
  const Trial t = run(c, c.model, c.work, "");
  learn(c, t, 1);
  // Of Newton's iterations and of inner steps the number is known only now.
  if (t.ok() && work_varies(c.model.method->info)) {
    real_work_[c.model.method] = t.work / c.work;
    c.work = t.work;
  } else {
    real_work_.try_emplace(c.model.method, 1);
  }
  c.error = grids_.error_of(t);
  c.seconds = t.seconds, c.answer = t.answer;
  c.uncertainty = grids_.grids().uncertainty();
  q_.advice.choices.push_back(c);
  if (!grids_.accepts(c.error) || !(c.work < most)) return misses;
  Model smaller = c.model;
  smaller.step.dt /= 2;
  const Trial half = run(c, smaller, 2 * c.work, " and half the step");
  learn(c, half, 0.5);
  c.half_step = grids_.error_of(half);
  if (!grids_.accepts(*c.half_step)) return misses;
  c.half = half.answer;
  if (!grids_.follows(t, c.model.t_end)) {
    objection_ = "what meets the tolerance at the end is another motion before";
    return misses;
  }
  if (!holds_on_finer_grids(c)) return by_accident;
  c.scatter = perturb(c);
  c.uncertainty += c.scatter;
  if (c.scatter > grids_.tolerance() / 2 ||
      !grids_.accepts(c.error, c.uncertainty))
    return by_accident;
  if (!q_.pilots.affords(3 * c.work, "what its run would warn of"))
    return misses;
  const std::string warning = q_.pilots.warning_of(c.model, q_.scene, c.work);
  if (warning.empty()) return holds;
  objection_ = "a run that meets the tolerance warns: " + warning;
  return misses;
}

bool ChoiceSearch::holds_on_finer_grids(Choice& c) {
  for (const auto& [more, by] : {std::pair(1.5, " and 1.5 times the cells"),
                                 std::pair(2., " and twice the cells")}) {
    const double work = std::pow(more, 3) * c.work;
    if (c.grid.sides.empty() ||
        !q_.pilots.affords(work, "a check on twice the cells", 0.5))
      break;
    Sides sides = c.grid.sides;
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

bool ChoiceSearch::may_be_cheaper(const Choice& c, double most) const {
  if (!work_varies(c.model.method->info)) return c.work < most;
  const auto known = real_work_.find(c.model.method);
  return known == real_work_.end() ||
         std::min(1., known->second) * c.work < most;
}

void ChoiceSearch::try_all(const std::vector<GridStudy::Grid>& grids,
                           std::optional<Choice>& best) {
  // Grids and parts for which smaller steps are no remedy, and the method if
  // others may be; and the last error of each method with them.
  std::set<std::pair<int, const MethodEntry*>> fail;
  std::map<std::pair<int, const MethodEntry*>, double> errors;
  for (Choice& c : choices(grids)) {
    const MethodEntry* method = c.model.method;
    const double most = best ? best->work : infinite;
    if (!may_be_cheaper(c, most) || fail.contains({c.kind, nullptr}) ||
        fail.contains({c.kind, method}) || !may_hold(c))
      continue;
    if (!q_.pilots.affords(c.work, "more expensive choices", 0.33)) break;
    const Outcome outcome = judge(c, most);
    if (outcome == holds) {
      best = c;
      continue;
    }
    double& before =
        errors.try_emplace({c.kind, method}, infinite).first->second;
    // From files all error is by the step; implicit steps begin very long.
    const bool bounded = std::isnormal(method->info.limit);
    if (!c.grid.sides.empty() &&
        (outcome == by_accident || (bounded && c.error > 0.9 * before)))
      fail.insert({c.kind, outcome == by_accident ? method : nullptr});
    before = c.error;
  }
}

void ChoiceSearch::search() {
  // The choice found before holds if finer grids do not contradict it.
  if (found_) {
    found_->error = grids_.distance_of(found_->answer, grids_.grids().limit());
    found_->uncertainty = grids_.grids().uncertainty() + found_->scatter;
    if (!(found_->error <= grids_.tolerance())) found_.reset();
  }
  q_.advice.choices.clear();
  std::optional<Choice> best;
  for (const GridStudy::Grid& start : grids_.starts())
    if (!best || std::ranges::any_of(choices({start}), [&](const Choice& c) {
          return may_be_cheaper(c, best->work) && may_hold(c);
        }))
      try_all(grids_.frontier(start), best);
  if (best) found_ = best;
}

void ChoiceSearch::search_steps() {
  const GridStudy::Grid own{Sides(q_.scene.sheets.size(), {1, 1}),
                            Effect(grids_.grids().limit().size()), 0};
  for (Choice& c : choices({own}))
    if (q_.pilots.affords(c.work, "smaller steps", 0.33) &&
        judge(c, infinite) == holds) {
      found_ = c;
      return;
    }
}

}  // namespace lab
