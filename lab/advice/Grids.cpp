#include "lab/advice/Grids.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "CME212/Util.hpp"
#include "lab/advice/Constants.hpp"
#include "lab/methods/Methods.hpp"
#include "lab/scenes/Compose.hpp"
#include "lab/stepping/Trial.hpp"

namespace lab {

std::size_t nodes_of(const Model& m) { return mesh_of(m).points.size(); }

Question::Question(const Model& m, const AdviceRules& rules, double runs)
    : scene(m), rules(rules), pilots(rules.budget, rules.tell) {
  check_question(m);
  if (m.measure.counts() && !from_files())
    throw SceneError("measure", "is " + name_of(m.measure) +
                                    ", a number that depends on the grid: "
                                    "expected another measure, or a mesh from "
                                    "files");
  if (!(m.t_end > 0))
    throw SceneError("t-end", "is 0, expected a time to simulate");
  for (const Change& c : read_changes(m.at))
    if (c.name() != "gravity" && c.name() != "stiffness")
      throw SceneError("at", "has " + std::string(c.name()) +
                                 ", which is of one grid or one method: with "
                                 "advice expected gravity or stiffness");
  own_work = work_of_run(m);
  if (!std::isfinite(own_work)) own_work = 0;
  pilots.allow(runs * own_work);
  advice.measure = m.measure, advice.tolerance = m.tolerance;
  advice.grids = Refinement(m.measure, !converging_slowly(m).empty());
  advice.t_end = m.t_end, advice.from_files = from_files();
}

GridStudy::GridStudy(Question& q) : q_(q), most_nodes_(q.rules.most_nodes) {
  if (q.from_files()) {
    most_nodes_ = infinite;
    q.pilots.allow(constant.mesh_runs * q.own_work);
    choose_pilots();
    pilot_.step = {.dt = step_of(pilot(q.scene, 1))};
    return;
  }
  if (!(most_nodes_ > 0))
    most_nodes_ =
        std::min(1e6, std::max(Pilots::usual, q.pilots.budget()) / 1e4);
  for (const Sheet& s : q.scene.sheets)
    for (unsigned n : s.nodes)
      if (n > 1) shortest_ = std::min(shortest_, n - 1.);
  make_levels(2, constant.most_ratio);
  // Maybe a pin lies between the nodes of these grids.
  if (!costs_of(on_level(some_level()))) make_levels(shortest_, infinite);
  choose_pilots();
}

Model GridStudy::pilot(Model m, double factor) const {
  m.method = pilot_.method;
  m.step = pilot_.step;
  if (m.step.fixed()) m.step.dt = std::min(m.step.dt / factor, m.t_end);
  return m;
}

void GridStudy::choose_pilots() {
  pilot_ = {&table::verlet, {.rule = StepRule::safe}};
  const int level = some_level();
  const Model on = on_level(level);
  const auto costs = costs_of(on);
  if (!costs) return;
  double least = costs->of_run(pilot(on, factor(level)));
  if (!(least > constant.too_much)) return;
  least /= 2;
  for (const MethodEntry* method :
       {&table::mollified_impulse, &table::tr_bdf2}) {
    const auto before = pilot_;
    pilot_.method = method;
    if (method->info.limit == no_limit)
      pilot_.step = {.dt = q_.scene.t_end / 50 * factor(level)};
    if (const double work = costs->of_run(pilot(on, factor(level)));
        work < least)
      least = work;
    else
      pilot_ = before;
  }
}

std::string GridStudy::add() {
  GridReport run;
  for (;; ++level_) {
    run = {.level = level_, .model = on_level(level_)};
    run.nodes = nodes_of(run.model);
    const std::string on = (q_.from_files() ? "the mesh of " : "a grid of ") +
                           std::to_string(run.nodes) + " nodes";
    if (double(run.nodes) > most_nodes_)
      return on + " would be too large" +
             (grids().empty() ? "" : ": " + so_far());
    run.factor = factor(level_);
    if (!grids().empty() && !(run.factor > grids().back().factor)) continue;
    run.model = pilot(run.model, run.factor);
    std::string why;
    const auto costs = costs_of(run.model, &why);
    if (!costs) {
      if (++invalid_ > 3 && run.factor > 1) return "on " + on + ": " + why;
      continue;
    }
    invalid_ = 0;
    run.work = costs->of_run(run.model);
    run.evaluations = costs->evaluations(run.work);
    if (q_.from_files()) q_.pilots.allow(constant.mesh_runs * run.work);
    if (!q_.pilots.affords(run.work,
                           q_.from_files() ? "smaller steps" : "a finer grid",
                           are_enough() ? 0.7 : 1))
      return over_budget(run.work);
    auto look = [&](const Cloth& g) {
      run.all = all_answers(run.model, g);
      find_plane(g);
    };
    run.trial = q_.pilots.run(run.model, on, run.work, {}, {}, look);
    if (run.trial.ok()) break;
    if (run.factor >= 1) return "on " + on + ": " + *run.trial.failure;
    q_.advice.grids.clear();  // it is too coarse to carry the load
  }
  ++level_;
  if (q_.from_files() && !grids().empty())
    run.factor = grids()[0].trial.dt / run.trial.dt;
  q_.advice.grids.add(std::move(run));
  if (grids().size() < 3) return "";
  if (!know_tolerance())
    return q_.advice.share +
           ", but that is 0: expected a tolerance with its unit";
  q_.pilots.knows(so_far());
  return grids().converges(tolerance()) ? "" : diverging(q_.scene);
}

std::string GridStudy::hopeless() const {
  // By order 2 at best, the uncertainty falls with the square of the cells.
  const double work = grids().back().work,
               finer = std::pow(std::max(1., 0.7 * q_.pilots.left() / work),
                                1 / power_of_work()),
               needed = std::sqrt(grids().uncertainty() / tolerance());
  return finer >= needed
             ? ""
             : over_budget(work * std::pow(needed, power_of_work()));
}

bool GridStudy::may_go_on(bool found) const {
  if (q_.from_files()) return !found && !is_certain();
  if (!found) return true;
  const double next = 3 * grids().back().work;
  return !is_certain() && double(nodes_of(on_level(level_))) <= most_nodes_ &&
         next <= std::max(q_.rules.patience, 0.3 * q_.own_work) &&
         next <= 0.5 * q_.pilots.left();
}

std::string GridStudy::so_far() const {
  if (!are_enough())
    return CME212::count_of(grids().size(), q_.from_files() ? "step" : "grid") +
           (grids().size() == 1 ? " is" : " are") +
           " not enough to estimate an error";
  const Measure& what = q_.scene.measure;
  const std::string limit =
      with_unit(grids().uncertainty(), what) + ' ' + asked(q_.advice);
  if (too_uncertain())
    return "uncertainty is the reason: the limit of " + name_of(what) +
           (q_.from_files() ? " by smaller steps" : " on finer grids") +
           " is known only to +- " + limit;
  return "the error of " + name_of(what) +
         (q_.from_files()
              ? " by the smallest step is "
              : " on " + std::to_string(grids().back().nodes) + " nodes is ") +
         with_unit(grids().back().error, what) + " +- " + limit;
}

std::string GridStudy::over_budget(double work) const {
  return "the budget ended" +
         (grids().empty() ? std::string(" before the first grid")
                          : ": " + so_far()) +
         way_out(work) +
         (grids().size() < 3 ? "" : converging_slowly(q_.scene));
}

std::string GridStudy::way_out(double work) const {
  auto budget = [&](double work) {  // that of a run, and of all others
    return "; --advise-work " +
           CME212::two_digits(
               std::max(2 * q_.pilots.budget(), q_.pilots.spent() + 4 * work));
  };
  const double missing = double(fewest()) - double(grids().size());
  if (missing > 0)  // each takes 1.4 times the cells
    return budget(work * std::pow(1.4, power_of_work() * (missing - 1))) +
           " would continue";
  const GridReport& last = grids().back();
  const double u = grids().uncertainty(),
               reached = std::max(u / constant.most_uncertain,
                                  grids()[grids().size() - 3].error +
                                      q_.rules.counted_share * u),
               finer = std::pow(std::max(1.5, reached / tolerance()),
                                1 / grids().order());
  return "; --tolerance " + CME212::two_digits(1.1 * reached) +
         " can be reached" +
         (!q_.from_files() && double(last.nodes) * finer * finer > 1e6
              ? "; for this one no grid of up to 1e6 nodes is enough"
              : budget(last.work * std::pow(finer, power_of_work())) +
                    " should reach this one");
}

Answer GridStudy::answer_at_start() const {
  Scene start(grids().back().model);
  return Observer(start).answer();
}

/** The tolerance in the unit of the measure, if it is a share of the change
 * since t = 0, or of the answer.  @return false if that is 0 */
bool GridStudy::know_tolerance() {
  const Model& m = q_.scene;
  if (!m.percent) return true;
  const std::string unit = unit_of(m.measure);
  const bool itself = unit.empty() || unit == "N" || unit == "s";
  const Answer& limit = grids().limit();
  const double whole =
      distance_of(limit, itself ? Answer(limit.size()) : answer_at_start());
  q_.advice.tolerance = whole > 1e-9 ? m.tolerance / 100 * whole : 0;
  q_.advice.share = CME212::short_text(m.tolerance) + " % of " +
                    (itself ? "the answer" : "the change since t = 0");
  return tolerance() > 0;
}

std::string GridStudy::trivial() const {
  const Measure& what = q_.scene.measure;
  if ((what.quantity == Measure::energy ||
       what.quantity == Measure::lost_energy) &&
      q_.scene.conserves_energy())
    return "nothing changes the energy of this scene: any grid and any step "
           "keeps its initial value";
  if (grids().empty() || grids().limit().empty()) return "";
  const Answer at_start = answer_at_start();
  if (at_start.empty()) return "";
  double change = distance_of(at_start, grids().limit());
  for (const Answer& then : grids().back().trial.earlier)
    change = std::max(change, then.size() == at_start.size()
                                  ? distance_of(at_start, then)
                                  : infinite);
  if (!(change + grids().uncertainty() <= tolerance())) return "";
  return name_of(what) + " changes by only " + with_unit(change, what) +
         " until the end, which is less than the tolerance: its initial value "
         "is an answer";
}

}  // namespace lab
