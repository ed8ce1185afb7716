#include "lab/advice/Advise.hpp"

#include <cmath>

#include "CME212/Util.hpp"
#include "lab/advice/Choice.hpp"
#include "lab/stepping/Trial.hpp"

namespace lab {

namespace {

/** The advice, without a run that is advised. */
Advice finish(Question& q, const GridStudy& grids, const CME212::Clock& clock) {
  Advice& a = q.advice;
  a.trivial = grids.trivial();
  a.left_out = q.pilots.left_out();
  a.spent_work = q.pilots.spent(), a.budget = q.pilots.budget();
  a.spent = clock.seconds();
  return a;
}

/** Advise @a c. */
void take(Advice& a, const Choice& c) {
  static_cast<AdvisedRun&>(a) = c;
  const StepCosts costs(c.model);
  a.evaluations = costs.evaluations(c.work);
  if (const double limit = costs.limit(c.model.method->info); limit != no_limit)
    a.of_stable = c.model.step.dt / limit;
  auto removed = c.parts.removed;  // two equal parts are counted one by one
  for (PartReport& p : a.parts) {
    const auto it = std::ranges::find(removed, p.part);
    p.needed =
        it == removed.end() && !goes_with_another(p.part, c.parts.removed);
    if (it != removed.end()) removed.erase(it);
  }
}

/** The coarsest grid whose error is at most twice the tolerance, or the finest
 * one: parts are tried on it. */
std::size_t base_of(const GridStudy& grids) {
  std::size_t k = 0;
  while (k + 1 < grids.grids().size() &&
         !(grids.grids()[k].error <= 2 * grids.tolerance()))
    ++k;
  return k;
}

/** Steps 1 to 4 of README.md.
 * @param calm is set to false if the motion is chaotic
 * @return why no more grids were run; empty: none was needed */
std::string search(const Question& q, GridStudy& grids, PartStudy& parts,
                   ChoiceSearch& choice, bool& calm) {
  const bool kept = q.rules.keeps_method || q.rules.keeps_step;
  for (;;) {
    if (const std::string why = grids.add(); !why.empty()) return why;
    if (!grids.knows_limit()) {
      if (choice.found()) return "";  // it stays
      if (grids.grids().size() < grids.kind().fewest + 2) continue;
      const std::string chaos = grids.find_chaos(0);
      calm = chaos.empty();
      if (!calm) return chaos;
      if (const std::string why = grids.hopeless(); !why.empty()) return why;
      continue;
    }
    const std::size_t base = base_of(grids);
    if (parts.level() != grids.runs()[base].level) {
      if (grids.kind().chaos_first && !parts.level()) {
        const std::string chaos = grids.find_chaos(0);
        calm = chaos.empty();
        if (!calm) return chaos;
      }
      parts.study(base);
    }
    choice.search();
    const bool found = choice.found().has_value();
    if (!grids.may_go_on(found) || (!found && kept && grids.is_certain()))
      return "";
  }
}

}  // namespace

Advice advise(const Model& m, const AdviceRules& rules) {
  const CME212::Clock clock;
  Question q(m, rules);
  const auto grids = study_grids(q);
  if (!grids->trivial().empty()) {  // on any grid, before a run
    Advice a = finish(q, *grids, clock);
    a.answer = answer(m, Scene(m), m.measure);
    a.model = m, a.error = 0, a.work = q.own_work;
    return a;
  }
  PartStudy parts(q, *grids);
  ChoiceSearch choice(q, *grids, parts);
  bool calm = true;
  std::string refusal = search(q, *grids, parts, choice, calm);
  calm = calm && grids->tolerance() > 0;
  std::optional<Choice> found = choice.found();
  if (!found && calm && !q.pilots.left_out().empty())
    if (const auto foreseen = grids->foresee()) found = Choice{*foreseen};
  if (!found && refusal.empty())
    refusal =
        rules.keeps_method || rules.keeps_step
            ? "no step of " + std::string(m.method->info.name) +
                  " that was tried meets the tolerance"
            : "no method meets the tolerance with the steps that were tried: "
              "the smallest was 1/8 of the largest stable one";
  bool advised = found && calm;
  // Chaos may be why nothing was found.
  if (calm && !grids->runs().empty() && !grids->kind().chaos_first)
    if (const std::string chaos = grids->find_chaos(found ? found->scatter : 0);
        !chaos.empty())
      refusal = chaos, advised = false;
  if (advised) refusal.clear(), grids->try_squares();
  Advice a = finish(q, *grids, clock);
  a.refusal = refusal;
  if (advised) take(a, *found);
  return a;
}

Advice assess(const Model& m, const AdviceRules& rules) {
  const CME212::Clock clock;
  Question q(m, rules);
  q.pilots.allow(8 * q.own_work);
  q.rules.keeps_method = true, q.rules.keeps_step = false;
  const auto study = study_grids(q);
  GridStudy& grids = *study;
  PartStudy parts(q, grids);
  ChoiceSearch choice(q, grids, parts);
  std::string refusal;
  while ((refusal = grids.add()).empty()) {
    const std::size_t n = grids.grids().size(), fewest = grids.kind().fewest;
    if (n >= fewest && grids.is_certain()) break;
    if (n >= fewest + 2 && !(refusal = grids.hopeless()).empty()) break;
  }
  Assessment own{.model = m};
  own.nodes = nodes_of(m);
  own.model.step = {.dt = step_of(m)};
  const StepCosts costs(own.model);
  const MethodInfo& info = m.method->info;
  if (const double limit = costs.limit(info); limit != no_limit)
    own.of_stable = own.model.step.dt / limit;
  Model half = own.model;
  half.step.dt /= 2;
  const double work = costs.of_run(own.model);
  if (grids.grids().size() < 3 || grids.tolerance() == 0 ||
      !q.pilots.affords(3 * work, "the scene's own run")) {
    Advice a = finish(q, grids, clock);
    a.refusal = refusal.empty() ? grids.over_budget(3 * work) : refusal;
    return a;
  }
  const Trial run = q.pilots.run(own.model, "its own run", work);
  const Trial finer = q.pilots.run(half, "half the step", 2 * work);
  own.total = grids.error_of(run);
  own.grid = own.step = infinite;
  const bool one_grid = m.sheets.empty();  // whose error is not known
  if (run.ok() && finer.ok()) {
    // By Richardson's extrapolation; contact and tearing have order 1.
    const double p = m.has_contact() ? 1 : info.order,
                 share = 1 - std::pow(0.5, p);
    const Effect change(run.answer, finer.answer);
    own.step = grids.size_of(change) / share;
    if (!one_grid)
      own.grid = grids.size_of(
          Effect(run.answer, grids.grids().limit()).add(-1 / share, change.by));
  }
  if (one_grid || !run.ok() || grids.accepts(own.grid)) choice.search_steps();
  Advice a = finish(q, grids, clock);
  a.own = own;
  if (choice.found())
    take(a, *choice.found());
  else
    a.refusal = grids.too_uncertain()
                    ? grids.so_far() + "; --advise-work " +
                          CME212::two_digits(8 * q.pilots.budget()) +
                          " would continue"
                    : "no step that was tried meets the tolerance on this "
                      "grid by " +
                          std::string(info.name) +
                          ": --advise finds a grid and a method";
  return a;
}

}  // namespace lab
