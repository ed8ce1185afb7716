#include "lab/advice/Advise.hpp"

#include <cmath>
#include <utility>

#include "CME212/Util.hpp"
#include "lab/advice/Choice.hpp"
#include "lab/stepping/Trial.hpp"

namespace lab {

namespace {

/** A question and its studies, in the order in which they are made. */
struct Search {
  Question q;
  GridStudy grids{q};
  PartStudy parts{q, grids};
  ChoiceSearch choice{q, grids, parts};
  CME212::Clock clock = {};
  std::string chaos = {};  // why the motion has no answer; or empty
  std::optional<AdvisedRun> rest = {};

  /** @param runs of the scene that the budget allows, if it is not given */
  Search(const Model& m, const AdviceRules& rules, double runs)
      : q(m, rules, runs) {}

  bool is_chaotic(double scatter = 0) {
    chaos = grids.find_chaos(scatter);
    return !chaos.empty();
  }

  /** Step 3 of README.md: on the coarsest grid with an error of at most twice
   * the tolerance, or else the finest one. */
  void study_parts() {
    std::size_t k = 0;
    while (k + 1 < grids.grids().size() &&
           !(grids.grids()[k].error <= 2 * grids.tolerance()))
      ++k;
    // With a mesh from files each run is long.
    const bool first = q.from_files() && !parts.level();
    if (parts.level() == grids.grids()[k].level || (first && is_chaotic()))
      return;
    parts.study(k);
  }

  /** Steps 1 to 5.
   * @return why no more grids were run; empty: none was needed */
  std::string run() {
    const std::string why = run_grids();
    // It can't be known better: maybe the error leaves room for it.
    if (!choice.found() && chaos.empty() && !grids.knows_limit() &&
        grids.knows_limit(1) && !q.from_files()) {
      study_parts();
      choice.search();
    }
    return why;
  }
  std::string run_grids() {
    const bool kept = q.rules.keeps_method || q.rules.keeps_step;
    for (;;) {
      if (const std::string why = grids.add(); !why.empty()) return why;
      if (grids.knows_limit()) {
        rest = grids.at_rest();
        if (rest) return "";
        study_parts();
        if (q.from_files() ? !chaos.empty() : is_chaotic()) return chaos;
        choice.search();
        const bool found = choice.found().has_value();
        if (!grids.may_go_on(found) || (!found && kept && grids.is_certain()))
          return "";
      } else if (choice.found()) {
        return "";  // it stays
      } else if (grids.are_enough(2)) {
        if (is_chaotic()) return chaos;
        if (const std::string why = grids.hopeless(); !why.empty()) return why;
      }
    }
  }

  /** The advice: to run @a found; or its @a refusal, if there is one. */
  Advice finish(const std::string& refusal,
                const std::optional<AdvisedRun>& found = {},
                const std::vector<std::string>& removed = {}) {
    Advice& a = q.advice;
    a.refusal = refusal;
    a.trivial = grids.trivial();
    a.left_out = q.pilots.left_out(), a.impossible = q.pilots.impossible();
    a.spent_work = q.pilots.spent(), a.budget = q.pilots.budget();
    a.spent = clock.seconds();
    if (!refusal.empty() || !found) return std::move(a);
    static_cast<AdvisedRun&>(a) = *found;
    const StepCosts costs(a.model);
    a.evaluations = costs.evaluations(a.work);
    if (!a.model.from_rest) a.of_stable = costs.of_stable(a.model);
    auto left = removed;  // of two equal parts each is counted
    for (PartReport& p : a.parts) {
      const auto it = std::ranges::find(left, p.part);
      p.needed = it == left.end() && !goes_with_another(p.part, removed);
      if (it != left.end()) left.erase(it);
    }
    return std::move(a);
  }
};

}  // namespace

Advice advise(const Model& m, const AdviceRules& rules) {
  Search s(m, rules, 1);
  if (!s.grids.trivial().empty()) {  // on any grid, before a run
    Advice a = s.finish("");
    a.answer = answer(Scene(m));
    a.model = m, a.model.t_end = 0, a.error = 0;
    return a;
  }
  std::string refusal = s.run();
  if (!s.chaos.empty() || s.grids.tolerance() == 0) return s.finish(refusal);
  if (s.rest) return s.finish("", s.rest);
  std::optional<Choice> found = s.choice.found();
  if (!found && !s.choice.objection().empty())
    refusal = s.choice.objection();
  else if (!found && refusal.empty())
    refusal =
        rules.keeps_method || rules.keeps_step
            ? "no step of " + std::string(m.method->info.name) +
                  " that was tried meets the tolerance"
            : "no method meets the tolerance with the steps that were tried: "
              "the smallest was 1/8 of the largest stable one";
  // Step 6, once more: the advised run, too, may be chaotic.
  if (!s.grids.grids().empty() && !s.q.from_files() &&
      s.is_chaotic(found ? found->scatter : 0))
    return s.finish(s.chaos);
  if (!found) return s.finish(refusal);
  return s.finish("", found, found->removed);
}

Advice assess(const Model& m, const AdviceRules& rules) {
  AdviceRules own_method = rules;
  own_method.keeps_method = true, own_method.keeps_step = false;
  Search s(m, own_method, 8);
  GridStudy& grids = s.grids;
  std::string refusal;
  while ((refusal = grids.add()).empty()) {
    if (grids.are_enough() && grids.is_certain()) break;
    if (grids.are_enough(2) && !(refusal = grids.hopeless()).empty()) break;
  }
  Assessment own{.model = m};
  own.model.step = {.dt = step_of(m)};
  const StepCosts costs(own.model);
  own.of_stable = costs.of_stable(own.model);
  const double work = costs.of_run(own.model);
  if (grids.grids().size() < 3 || grids.tolerance() == 0 ||
      !s.q.pilots.affords(3 * work, "the scene's own run"))
    return s.finish(refusal.empty() ? grids.over_budget(3 * work) : refusal);
  Model half = own.model;
  half.step.dt /= 2;
  const Trial run = s.q.pilots.run(own.model, "its own run", work);
  const Trial finer = s.q.pilots.run(half, "half the step", 2 * work);
  own.total = grids.error_of(run);
  own.grid = own.step = infinite;
  if (run.ok() && finer.ok()) {
    // By Richardson's extrapolation; contact and tearing have order 1.
    const double p = m.has_contact() ? 1 : m.method->info.order,
                 share = 1 - std::pow(0.5, p);
    const Effect change(run.answer, finer.answer);
    own.step = grids.size_of(change) / share;
    if (!s.q.from_files())
      own.grid = grids.size_of(
          Effect(run.answer, grids.grids().limit()).add(-1 / share, change.by));
  }
  s.q.advice.own = own;
  if (s.q.from_files() || !run.ok() || grids.accepts(own.grid))
    s.choice.search_steps();
  if (s.choice.found()) return s.finish("", s.choice.found());
  return s.finish(
      grids.too_uncertain()
          ? grids.so_far() + grids.way_out(work)
          : "no step that was tried meets the tolerance on this grid by " +
                std::string(m.method->info.name) +
                ": --advise finds a grid and a method");
}

}  // namespace lab
