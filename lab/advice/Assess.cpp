#include <algorithm>
#include <cmath>
#include <string>

#include "CME212/Util.hpp"
#include "lab/advice/Adviser.hpp"

namespace lab {

namespace adviser_detail {

Advice Adviser::assess() {
  check();
  const CME212::Clock clock;
  choose_pilots();
  auto& grids = advice_.grids;
  while (add_grid())
    if (grids.size() >= fewest() &&
        (is_certain() || (grids.size() >= fewest() + 2 && hopeless())))
      break;
  Assessment own{.model = scene_};
  own.nodes = nodes_of(scene_);
  own.model.step = {.dt = step_of(scene_)};
  const StepCosts costs(own.model);
  const MethodInfo& info = scene_.method->info;
  if (const double limit = costs.limit(info); limit != no_limit)
    own.of_stable = own.model.step.dt / limit;
  Model half = own.model;
  half.step.dt /= 2;
  const double work = costs.of_run(own.model);
  if (grids.size() < 3 || advice_.tolerance == 0 ||
      !pilots_.affords(3 * work, "the scene's own run")) {
    if (advice_.refusal.empty()) refuse(over_budget(3 * work));
    return end(clock), advice_;
  }
  advice_.refusal.clear();
  const Trial run = pilots_.run(own.model, "its own run", work),
              finer = pilots_.run(half, "half the step", 2 * work);
  own.total = error_of(run);
  own.grid = own.step = infinite;
  if (run.ok() && finer.ok()) {
    // By Richardson's extrapolation; contact and tearing have order 1.
    const double p = scene_.has_contact() ? 1 : info.order;
    Effect step(run.answer.size()), grid(run.answer, limit_);
    step.add(1, run.answer).add(-1, finer.answer);
    own.step = size_of(step) / (1 - std::pow(0.5, p));
    if (!from_files())
      own.grid = size_of(grid.add(-1 / (1 - std::pow(0.5, p)), step.by));
  }
  rules_.keeps_method = true, rules_.keeps_step = false;
  reductions_ = {{}}, rest_time_ = scene_.t_end;
  if (from_files() || !run.ok() || accepts(own.grid, uncertainty_))
    for (Choice& c : choices(all_sides(1, 1)))
      if (pilots_.affords(c.work, "smaller steps", 0.33) && holds(c)) {
        take(c);
        break;
      }
  if (!advice_.checked)
    refuse(too_uncertain()
               ? so_far() + "; --advise-work " +
                     CME212::two_digits(8 * pilots_.budget()) +
                     " would continue"
               : "no step that was tried meets the tolerance on this grid by " +
                     std::string(info.name) +
                     ": --advise finds a grid and a method");
  advice_.own = own;
  return end(clock), advice_;
}

}  // namespace adviser_detail

Advice assess(const Model& m, const AdviceRules& rules) {
  return adviser_detail::Adviser(m, rules, true).assess();
}

}  // namespace lab
