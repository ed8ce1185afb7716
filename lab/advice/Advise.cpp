#include "lab/advice/Adviser.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include "CME212/Util.hpp"
#include "lab/advice/Refusals.hpp"
#include "lab/methods/Methods.hpp"
#include "lab/scenes/Scene.hpp"

namespace lab {

Model as_pilot(Model m) {
  m.method = find_method("verlet");
  m.step = {.rule = StepRule::safe};
  return m;
}

namespace adviser_detail {

Advice Adviser::find() {
  check_question(scene_);
  if (!(scene_.t_end > 0))
    throw SceneError("t-end", "is 0, expected a time to simulate");
  const CME212::Clock clock;
  do {
    if (!find_grid()) break;
    advice_.refusal.clear();
    if (base_ != find_base()) {
      base_ = find_base();
      if (!try_steps()) break;
      find_parts();
      find_rest();
      try_longer_steps();
    }
    if (may_go_on()) pilots_.keep(next_work());
    choose();
    pilots_.keep(0);
  } while (goes_on());
  if (!found_) found_ = fragile_;
  if (!found_ && pilots_.cut_short()) foresee();
  // Chaos may be why nothing was found.
  if (!advice_.grids.empty() && look_for_chaos() && found_) {
    try_floats(*found_);
    take(*found_);
  }
  advice_.left_out = pilots_.left_out(), advice_.rate = rules_.rate;
  advice_.spent_work = pilots_.spent(), advice_.budget = pilots_.budget();
  advice_.spent = clock.seconds();
  return advice_;
}

double Adviser::budget_of(const Model& m, const AdviceRules& rules) {
  if (rules.budget > 0) return rules.budget;
  const double run = work_of_run(m);
  return std::isfinite(run) ? std::max(2e8, run) : 2e8;
}

void Adviser::choose_pilots(const Model& first) {
  const StepCosts costs(first);
  method_ = as_pilot(first);
  first_work_ = costs.of_run(*method_);
  if (!(first_work_ > pilots_.budget() / 100)) return;
  Model m = *method_;
  m.method = find_method("respa");
  std::vector<Model> others = {m};
  m.method = find_method("tr-bdf2");
  m.step = {.dt = m.t_end / 32};
  others.push_back(m);
  for (const Model& other : others)
    if (const double work = costs.of_run(other); work < first_work_ / 2)
      method_ = other, first_work_ = work;
}

std::size_t Adviser::find_base() const {
  const auto& grids = advice_.grids;
  std::size_t k = 0;
  while (k + 2 < grids.size() && !(grids[k].error <= advice_.tolerance)) ++k;
  return k;
}

bool Adviser::find_grid() {
  auto& grids = advice_.grids;
  if (grids.empty()) first_ = first_factor();
  double factor = grids.empty() ? first_ : 2 * grids.back().factor;
  for (;; factor *= 2) {
    const Model on = on_grid(factor);
    const std::size_t nodes = nodes_of(on);
    if (double(nodes) > rules_.most_nodes)
      return refuse(grids.settles() ? too_many_nodes(nodes) : not_converging());
    const std::string doing = "grid of " + std::to_string(nodes) + " nodes";
    std::vector<Answer> all;
    Track track(scene_.t_end, nodes);
    Trial t;
    try {
      if (!method_) choose_pilots(on);
      // With less than three grids there is no estimate. After that, half of
      // the budget is kept for running choices.
      if (!pilots_.affords(pilot_work(factor), "a finer grid",
                           grids.empty()      ? 1
                           : grids.size() < 3 ? 0.8
                           : found_           ? most_left
                                              : most_for_any))
        return refuse(over_budget(pilot_work(factor)));
      const Model m = pilot(on, factor);
      t = pilots_.run(m, doing, pilot_work(factor), {}, all_answers(m, all),
                      [&track](Scene& scene) { track.look(scene); });
    } catch (const SceneError& e) {
      t.failure = e.what();
    }
    if (!t.ok()) {
      if (factor >= 1)
        return refuse("on a grid of " + std::to_string(nodes) +
                      " nodes: " + t.failure);
      // The grid is too coarse for the pins, or to carry the load.
      grids.clear(), base_ = no_base, method_.reset();
      first_ *= 2, factor = first_ / 2;
      continue;
    }
    finest_answers_ = all, track_ = std::move(track);
    grids.add(report(factor, on, t));
    // A finer grid corrects the estimates that these choices are based on.
    found_.reset(), fragile_.reset();
    if (grids.size() >= 2) try_intermediate();
    if (grids.size() >= 3) pilots_.knows(so_far());
    if (!grids.settles())
      if (const std::string why = diverging(scene_); !why.empty())
        return refuse(why);
    if (scene_.sheets.empty()) return true;
    if (grids.size() >= 3 && may_suffice()) return true;
  }
}

void Adviser::try_intermediate() {
  auto& grids = advice_.grids;
  const double factor =
      next_factor(grids[grids.size() - 2].factor, between / 2);
  const Model on = on_grid(factor);
  const double work = pilot_work(factor);
  if (!pilots_.affords(work, "an intermediate grid")) return;
  // A grid whose nodes miss a pin is skipped.
  const Trial t =
      pilots_.run(pilot(on, factor),
                  "grid of " + std::to_string(nodes_of(on)) + " nodes", work);
  if (t.ok()) grids.add_intermediate(report(factor, on, t));
}

GridReport Adviser::report(double factor, const Model& on,
                           const Trial& t) const {
  return {factor, nodes_of(on), infinite, t,
          pilot_work(factor) / std::max(1.0, springs_of(on))};
}

double Adviser::first_factor() const {
  unsigned shortest = ~0u;
  for (const Sheet& s : scene_.sheets)
    for (unsigned n : s.nodes) shortest = std::min(shortest, n);
  double factor = 1;
  while (!scene_.sheets.empty() &&
         (shortest - 1) * factor / 2 >= rules_.first_cells)
    factor /= 2;
  return factor;
}

std::vector<double> Adviser::factors() const {
  std::vector<double> all;
  const Refinement& grids = advice_.grids;
  for (std::size_t g = 0; g < grids.size(); ++g) {
    all.push_back(grids[g].factor);
    if (scene_.sheets.empty()) break;
    for (int k = 1; k <= between; ++k)
      if (const double f = next_factor(grids[g].factor, k);
          (k < between || g + 1 == grids.size()) &&
          double(nodes_of(on_grid(f))) <= rules_.most_nodes)
        all.push_back(f);
  }
  return all;
}

bool Adviser::may_suffice() const {
  return std::ranges::any_of(factors(), [this](double f) {
    return size_of(advice_.grids.error(f)) + advice_.grids.uncertainty(f) <=
           advice_.tolerance;
  });
}

std::string Adviser::so_far() const {
  const GridReport& last = advice_.grids.back();
  return "the error of " + std::string(name_of(advice_.measure)) + " on " +
         std::to_string(last.nodes) + " nodes is " +
         with_unit(last.error, advice_.measure) + " +- " +
         with_unit(advice_.grids.uncertainty_of_limit(), advice_.measure) +
         " (asked: " + with_unit(advice_.tolerance, advice_.measure) + ')';
}

std::string Adviser::over_budget(double work) const {
  const auto& grids = advice_.grids;
  return "the budget ended" +
         (grids.empty()      ? std::string(" before the first grid")
          : grids.size() < 3 ? " after " + std::to_string(grids.size()) +
                                   " grids, too few to estimate an error"
                             : ": " + so_far()) +
         "; --advise-budget " +
         CME212::two_digits(std::ceil(3 * work / rules_.rate)) +
         " would continue" +
         (grids.size() < 3 ? "" : converging_slowly(scene_));
}

std::string Adviser::not_converging() const {
  const auto& grids = advice_.grids;
  return "the answer does not converge as the grid gets finer: the last two "
         "refinements changed it by " +
         CME212::two_digits(grids.step_to(grids.size() - 2)) + " and " +
         with_unit(grids.step_to(grids.size() - 1), advice_.measure) +
         converging_slowly(scene_);
}

std::string Adviser::limit_uncertain() const {
  return "the limit on finer grids is uncertain by " +
         with_unit(advice_.grids.uncertainty_of_limit(), advice_.measure) +
         " after " + std::to_string(advice_.grids.size()) + " grids" +
         converging_slowly(scene_);
}

std::string Adviser::too_many_nodes(std::size_t nodes) const {
  const std::string why =
      "a grid of " + std::to_string(nodes) + " nodes would be too large";
  return advice_.grids.size() < 3
             ? why + ", and the error of the one before is unknown"
             : why + ": " + so_far() + converging_slowly(scene_);
}

/** The end time, as text, until which perturbed starts stay close enough. Only
 * for measures in meters, which change at most by as much as positions do. */
std::string Adviser::same_until(const Separation& apart) const {
  const bool in_meters = unit_of(advice_.measure) == std::string("m");
  const double horizon = apart.horizon(advice_.tolerance / 2);
  if (!in_meters || !(horizon > 0) || horizon >= scene_.t_end) return "";
  return ", of up to " + CME212::short_text(horizon) + " s";
}

std::function<void(const Cloth&)> Adviser::all_answers(
    const Model& m, std::vector<Answer>& into) {
  return [m, &into](const Cloth& g) {
    into.clear();
    for (std::size_t k = 0; k < measure_names.size(); ++k) {
      const Measure what = Measure(k);
      into.push_back(can_answer(m, what) ? answer(m, g, what) : Answer());
    }
  };
}

bool Adviser::look_for_chaos() {
  std::vector<Answer> shaken;
  Track track = track_->beside();
  const double factor = advice_.grids.back().factor;
  const Model m = pilot(on_grid(factor), factor);
  if (pilots_.affords(pilot_work(factor), "perturbed starts")) {
    const Trial t = pilots_.run(m, "a perturbed start", pilot_work(factor),
                                {rules_.shake}, all_answers(m, shaken),
                                [&track](Scene& scene) { track.look(scene); });
    if (!t.ok()) return refuse(t.failure);
    ++advice_.perturbed;
    const std::size_t k = std::size_t(advice_.measure);
    advice_.scatter = distance(finest_answers_[k], shaken[k], advice_.measure);
  }
  if (found_) advice_.scatter = std::max(advice_.scatter, found_->scatter);
  if (advice_.scatter <= advice_.tolerance / 2) return true;
  // Less than ten times the shake is not chaos, but the shake itself.
  return refuse(
      (advice_.scatter > 10 * rules_.shake
           ? "the motion is chaotic: "
           : std::string("the tolerance is too small: ")) +
      "runs that should agree, with the start moved by 1e-6 m or with a "
      "slightly shorter step, differ by " +
      with_unit(advice_.scatter, advice_.measure) +
      ", so no grid and no step can meet the tolerance; " +
      offers(on_grid(factor), finest_answers_, shaken) +
      same_until(Separation(*track_, track)));
}

void Adviser::perturb(Choice& c) {
  auto look = [&](const Model& m, const Shake& shake, const Answer& expected) {
    if (!pilots_.affords(c.work, "perturbed starts")) return;
    const Trial t = pilots_.run(m, "the advised run, perturbed", c.work, shake);
    if (!t.ok()) return;
    ++advice_.perturbed;
    c.scatter =
        std::max(c.scatter, distance(t.answer, expected, advice_.measure));
  };
  for (unsigned seed : {2, 3, 4})
    look(c.model, {(seed - 1) * rules_.shake, seed}, c.answer);
  Model other = c.model;
  other.step.dt *= 0.8;
  other.step.dt = step_of(other);
  const double p = c.model.method->info.order,
               way = (1 - std::pow(other.step.dt / c.model.step.dt, p)) /
                     (1 - std::pow(0.5, p));
  Effect expected(c.answer.size());
  expected.add(1 - way, c.answer).add(way, c.half);
  look(other, {}, expected.by);
}

void Adviser::try_floats(const Choice& c) {
  if (std::is_same_v<Real, float> || !c.checked ||
      !pilots_.affords(c.work, "single precision"))
    return;
  auto round = [](Point& p) { p = Point(float(p.x), float(p.y), float(p.z)); };
  const Trial t = pilots_.run(c.model, "in single precision", c.work, {},
                              nullptr, [&](Scene& scene) {
                                for (Node n : scene.cloth().nodes())
                                  round(n.position()), round(n.value().vel);
                              });
  if (t.ok()) advice_.floats = size_of(Effect(t.answer, c.answer));
}

void Adviser::foresee() {
  const Refinement& grids = advice_.grids;
  if (grids.size() < 3 || too_uncertain()) return;
  for (double factor = grids[0].factor;; factor *= std::pow(2, 1. / between)) {
    Model m = on_grid(factor);
    if (double(nodes_of(m)) > rules_.most_nodes) return;
    const double error = size_of(grids.error(factor));
    const double uncertainty = grids.uncertainty(factor);
    if (!(error + uncertainty <= advice_.tolerance)) continue;
    m = pilot(m, factor);
    if (!is_scene(m)) continue;
    const GridReport& last = grids.back();
    m.step = {.dt = last.trial.dt * last.factor / factor};
    m.step.dt = step_of(m);
    found_ = Choice{m, {}, factor, error, uncertainty, pilot_work(factor)};
    return;
  }
}

double Adviser::next_work() const {
  const double finer = 2 * advice_.grids.back().factor;
  return pilot_work(finer) + pilot_work(next_factor(finer / 2, between / 2));
}

bool Adviser::may_go_on() const {
  const auto& grids = advice_.grids;
  const double finer = 2 * grids.back().factor;
  return !scene_.sheets.empty() &&
         (grids.size() < 5 ||
          grids.uncertainty_of_limit() >
              rules_.most_uncertainty * advice_.tolerance) &&
         pilot_work(finer) <=
             std::min(rules_.patience, most_left * pilots_.left()) &&
         double(nodes_of(on_grid(finer))) <= rules_.most_nodes;
}

bool Adviser::goes_on() const {
  return !scene_.sheets.empty() && (!found_ || may_go_on());
}

void Adviser::take(const Choice& c) {
  advice_.refusal.clear();
  advice_.model = c.model;
  advice_.checked = c.checked;
  advice_.error = c.error;
  advice_.uncertainty = c.uncertainty + scatter_share * advice_.scatter;
  advice_.robustness = c.robustness;
  advice_.answer = c.answer;
  advice_.work = c.work, advice_.seconds = c.seconds;
  advice_.evaluations = c.work / std::max(1.0, springs_of(c.model));
  if (const double limit = StepCosts(c.model).limit(c.model.method->info);
      limit != no_limit)
    advice_.of_stable = c.model.step.dt / limit;
  advice_.t_end = scene_.t_end;
  auto removed = c.removed;  // two equal parts are counted one by one
  for (PartReport& p : advice_.parts) {
    const auto it = std::ranges::find(removed, p.part);
    p.needed = it == removed.end() && !goes_with_another(p.part, c.removed);
    if (it != removed.end()) removed.erase(it);
  }
}

}  // namespace adviser_detail

AdviceRules rules_of(const Model& m, double seconds) {
  AdviceRules rules;
  // Converts seconds to work; rounded to a power of 2, so that it is the same
  // in every run.
  const double rate = std::exp2(std::round(std::log2(measured_rate(m))));
  const double run = work_of_run(m);
  rules.budget = seconds > 0 ? rate * seconds
                             : std::max(2 * rate, std::isfinite(run) ? run : 0);
  // A run takes at least 1e4 spring evaluations per node.
  rules.most_nodes = std::max(rules.most_nodes, rules.budget / 1e4);
  return rules;
}

Advice advise(const Model& m, const AdviceRules& rules) {
  return adviser_detail::Adviser(m, rules).find();
}

}  // namespace lab
