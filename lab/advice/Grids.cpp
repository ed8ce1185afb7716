#include "lab/advice/Grids.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "CME212/Util.hpp"
#include "lab/advice/Refusals.hpp"
#include "lab/methods/Methods.hpp"
#include "lab/scenes/Compose.hpp"
#include "lab/stepping/Trial.hpp"

namespace lab {

std::size_t nodes_of(const Model& m) { return mesh_of(m).points.size(); }

std::vector<Answer> all_answers(const Model& m, const Cloth& g) {
  std::vector<Answer> all;
  for (int k = 0; k < Measure::pin_force; ++k) {
    const Measure what = Measure::Quantity(k);
    all.push_back(can_answer(m, what) ? answer(m, g, what) : Answer());
  }
  return all;
}

Question::Question(const Model& m, const AdviceRules& rules)
    : scene(m), rules(rules), pilots(rules.budget, rules.tell) {
  check_question(m);
  if (m.measure.counts() && !m.sheets.empty())
    throw SceneError("measure", "is " + name_of(m.measure) +
                                    ", a number that depends on the grid: "
                                    "expected another measure, or a mesh from "
                                    "files");
  if (!(m.t_end > 0))
    throw SceneError("t-end", "is 0, expected a time to simulate");
  own_work = work_of_run(m);
  if (!std::isfinite(own_work)) own_work = 0;
  pilots.allow(own_work);
  advice.measure = m.measure, advice.tolerance = m.tolerance;
  advice.grids = Refinement(m.measure);
  advice.t_end = m.t_end, advice.from_files = m.sheets.empty();
}

GridStudy::GridStudy(Question& q, const Kind& kind)
    : q_(q),
      most_nodes_(
          q.rules.most_nodes > 0
              ? q.rules.most_nodes
              : std::min(1e6,
                         std::max(Pilots::usual, q.pilots.budget()) / 1e4)),
      kind_(kind) {}

double GridStudy::power(int level) {
  const int two = int(std::floor(level / 2.));
  return std::pow(2, two) * (level - 2 * two == 1 ? 1.5 : 1);
}

Model GridStudy::pilot(Model m, double factor) const {
  m.method = pilot_.method;
  m.step = pilot_.step;
  if (m.step.fixed()) m.step.dt = std::min(m.step.dt / factor, m.t_end);
  return m;
}

bool GridStudy::choose_pilots(int some) {
  pilot_ = {&table::verlet, {.rule = StepRule::safe}};
  try {
    const Model on = on_level(some);
    const StepCosts costs(on);
    double least = costs.of_run(pilot(on, factor(some)));
    if (!(least > q_.rules.stiff)) return true;
    least /= 2;
    for (const MethodEntry* method :
         {&table::mollified_impulse, &table::tr_bdf2}) {
      const auto before = pilot_;
      pilot_.method = method;
      if (method->info.limit == no_limit)
        pilot_.step = {.dt = q_.scene.t_end / 50 * factor(some)};
      if (const double work = costs.of_run(pilot(on, factor(some)));
          work < least)
        least = work;
      else
        pilot_ = before;
    }
    return true;
  } catch (const SceneError&) {
    return false;
  }
}

std::string GridStudy::add() {
  for (;; ++level_) {
    Run run{level_, on_level(level_), 0, {}, Track(q_.scene.t_end, 1)};
    const std::size_t nodes = nodes_of(run.model);
    const std::string on = kind_.on + std::to_string(nodes) + " nodes";
    if (double(nodes) > most_nodes_)
      return on + " would be too large" +
             (grids().empty() ? "" : ": " + so_far());
    const Model& m = run.model = pilot(run.model, factor(level_));
    GridReport report;
    try {
      report.factor = factor_of(m), report.nodes = nodes;
      if (!grids().empty() && !(report.factor > grids().back().factor))
        continue;
      const StepCosts costs(m);
      run.work = costs.of_run(m);
      report.evaluations = costs.evaluations(run.work);
      q_.pilots.allow(kind_.runs * run.work);
      if (!q_.pilots.affords(run.work, kind_.finer_grid,
                             grids().size() < kind_.fewest ? 1 : 0.7))
        return over_budget(run.work);
      run.track = Track(q_.scene.t_end, nodes);
      auto look = [&](const Cloth& g) {
        run.all = all_answers(m, g);
        find_plane(g);
      };
      report.trial =
          q_.pilots.run(m, on, run.work, {}, {}, look,
                        [&](Scene& scene) { run.track.look(scene); });
      invalid_ = 0;
    } catch (const SceneError& e) {
      // Between the cells of the scene a pin may hold no node.
      if (++invalid_ > 3 && factor(level_) > 1)
        return "on " + on + ": " + e.what();
      continue;
    }
    if (report.trial.ok()) {
      q_.advice.grids.add(report);
      runs_.push_back(std::move(run));
      ++level_;
      break;
    }
    if (factor(level_) >= 1) return "on " + on + ": " + report.trial.failure;
    q_.advice.grids.clear(),
        runs_.clear();  // it is too coarse to carry the load
  }
  if (grids().size() < 3) return "";
  if (!know_tolerance())
    return q_.advice.share +
           ", but that is 0: expected a tolerance with its unit";
  q_.pilots.knows(so_far());
  return grids().converges(tolerance() / 10) ? "" : diverging(q_.scene);
}

std::string GridStudy::hopeless() const {
  // By order 2 at best, the uncertainty falls with the square of the cells.
  const double work = runs_.back().work,
               finer = std::pow(std::max(1., 0.7 * q_.pilots.left() / work),
                                1 / kind_.power),
               needed = std::sqrt(grids().uncertainty() / tolerance() /
                                  q_.rules.most_uncertain);
  return finer >= needed ? ""
                         : over_budget(work * std::pow(needed, kind_.power));
}

std::string GridStudy::so_far() const {
  if (grids().size() < kind_.fewest)
    return CME212::count_of(grids().size(), kind_.grid) +
           (grids().size() == 1 ? " is" : " are") +
           " not enough to estimate an error";
  const Measure& what = q_.scene.measure;
  const std::string limit = with_unit(grids().uncertainty(), what),
                    asked =
                        ' ' + lab::asked(tolerance(), q_.advice.share, what);
  if (too_uncertain())
    return "uncertainty is the reason: the limit of " + name_of(what) + ' ' +
           kind_.finer + " is known only to +- " + limit + asked;
  return "the error of " + name_of(what) + ' ' + finest() + " is " +
         with_unit(grids().back().error, what) + " +- " + limit + asked;
}

std::string GridStudy::over_budget(double work) const {
  const double more =
      std::max(2 * q_.pilots.budget(), q_.pilots.spent() + 3 * work);
  return "the budget ended" +
         (grids().empty() ? std::string(" before the first grid")
                          : ": " + so_far()) +
         "; --advise-work " + CME212::two_digits(more) + " would continue" +
         (grids().size() < 3 ? "" : converging_slowly(q_.scene));
}

Answer GridStudy::answer_at_start() const {
  const Model& m = runs_.back().model;
  const Scene start(m);
  return Observer(m, start).answer(m, start);
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
  if (what.quantity == Measure::energy && q_.scene.conserves_energy())
    return "nothing changes the energy of this scene: any grid and any step "
           "keeps its initial value";
  if (runs_.empty() || grids().limit().empty()) return "";
  const Answer at_start = answer_at_start();
  if (at_start.empty()) return "";
  const double change = distance_of(at_start, grids().limit());
  if (!(change + grids().uncertainty() <= tolerance())) return "";
  return name_of(what) + " changes by only " + with_unit(change, what) +
         " until the end, which is less than the tolerance: its initial value "
         "is an answer";
}

std::optional<GridStudy::Grid> GridStudy::that_meets(const Sides& s,
                                                     double most_work,
                                                     double& work) {
  try {
    double finest = 1e-9;
    for (const auto& sheet : s) finest = std::max({finest, sheet[0], sheet[1]});
    const Model m = pilot(on_grid(s), finest);
    work = work_of_run(m);
    if (!(work < most_work) || !q_.pilots.affords(work, "coarser grids", 0.3))
      return {};
    const Trial t =
        q_.pilots.run(m, std::to_string(nodes_of(m)) + " nodes", work);
    if (!accepts(error_of(t))) return {};
    return Grid{s, Effect(t.answer, grids().limit())};
  } catch (const SceneError&) {  // its nodes miss a pin
    return {};
  }
}

std::optional<AdvisedRun> GridStudy::foresee() const {
  if (!knows_limit()) return {};
  // Pilots tell nothing of another method or of a step that was asked for.
  if (q_.rules.keeps_step ||
      (q_.rules.keeps_method && q_.scene.method != pilot_.method))
    return {};
  for (int level = runs_[0].level; level < level_ + 12; ++level) {
    AdvisedRun r{.model = on_level(level)};
    if (double(nodes_of(r.model)) > most_nodes_) return {};
    try {
      r.model = pilot(r.model, factor(level));
      r.model.step = {.dt = step_of(r.model)};
    } catch (const SceneError&) {
      continue;  // a pin holds no node
    }
    r.error = size_of(grids().error(factor_of(r.model)));
    r.uncertainty = grids().uncertainty() + scatter_share * q_.advice.scatter;
    if (!(r.error + r.uncertainty <= tolerance())) continue;
    r.work = work_of_run(r.model);
    // A step on a mesh from files was run, maybe with half of it.
    for (std::size_t k = 0; k < runs_.size() && r.model.sheets.empty(); ++k) {
      const Trial& t = grids()[k].trial;
      if (runs_[k].level == level)
        r.answer = t.answer, r.seconds = t.seconds, r.checked = true;
      if (runs_[k].level == level + 2 && r.checked)
        r.half_step = grids()[k].error;
    }
    return r;
  }
  return {};
}

}  // namespace lab
