#include "lab/advice/Adviser.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "CME212/Util.hpp"
#include "lab/methods/Methods.hpp"
#include "lab/scenes/Scene.hpp"

namespace lab::adviser_detail {

void Adviser::find_parts() {
  auto& parts = advice_.parts;
  const double factor = base().factor, work = pilot_work(factor);
  const Model all = pilot(on_grid(factor), factor);
  const Trial& pilot = base().trial;
  const double springs = springs_of(all);
  advice_.tried_on = base().nodes;
  parts.clear();
  for (const Variation& v : without_parts(all)) {
    PartReport r{v.part, infinite, springs - springs_of(v.model)};
    if (const double limit = StepCosts(v.model).verlet(); limit < no_limit)
      r.step = limit / costs_->verlet();
    r.tried = pilots_.affords(work, "parts", 0.1);
    if (r.tried)
      if (const Trial t = pilots_.run(v.model, "without " + v.part, work);
          t.ok())
        r.change = distance(t.answer, pilot.answer, advice_.measure);
    parts.push_back(r);
  }
  std::vector<PartReport> order = parts;
  // Parts that save work come before the others.
  std::ranges::stable_sort(order, {}, [](const PartReport& p) {
    const bool saves = p.springs > 0 || p.step > 1.2;
    return std::tuple(p.change > 0, !saves, p.change);
  });
  const double room = rules_.for_parts * advice_.tolerance;
  reductions_ = {{{}, Effect(pilot.answer.size()), 1}};
  for (const PartReport& part : order) {
    if (!(part.change <= room)) continue;
    std::vector<std::string> removed = reductions_.back().removed;
    removed.push_back(part.part);
    const std::optional<Model> without = without_all(all, removed);
    if (!without || !pilots_.affords(work, "combinations of parts", 0.2))
      continue;
    const Trial t = pilots_.run(*without, "without " + part.part, work);
    if (!t.ok()) continue;
    const Effect effect(t.answer, pilot.answer);
    if (size_of(effect) <= room)
      reductions_.push_back(
          {removed, effect, springs_of(*without) / std::max(springs, 1.0)});
  }
}

bool Adviser::dissipates(const Model& m) {
  auto rubs = [](const auto& part) { return part.friction > 0; };
  return m.damping > 0 || m.material.drag.value_or(0) > 0 ||
         std::ranges::any_of(m.planes, rubs) ||
         std::ranges::any_of(m.spheres, rubs);
}

void Adviser::find_rest() {
  constexpr int looks = 64;  // samples of the answer at equal intervals
  rest_time_ = scene_.t_end, rest_effect_ = Effect(base().trial.answer.size());
  const double work = pilot_work(base().factor);
  if (!dissipates(scene_) || !pilots_.affords(work, "an earlier end", 0.1))
    return;
  const Model m = pilot(on_grid(base().factor), base().factor);
  std::vector<std::pair<double, Answer>> seen;
  const Trial t = pilots_.run(
      m, "when it comes to rest", work, {}, nullptr, [&](Scene& scene) {
        if (scene.time() >= double(seen.size()) * m.t_end / looks)
          seen.emplace_back(scene.time(), answer(m, scene.cloth()));
      });
  if (!t.ok()) return;
  while (!seen.empty()) {
    const Effect e(seen.back().second, t.answer);
    if (!(size_of(e) <= advice_.tolerance / 10)) break;
    if (seen.back().first <= 0.9 * m.t_end)
      rest_time_ = seen.back().first, rest_effect_ = e;
    seen.pop_back();
  }
}

double Adviser::springs_of(const Model& m) {
  Cloth g;
  build_model(g, m, mesh_of(m));
  return double(g.num_edges());
}

bool Adviser::try_steps() {
  const Model on = on_grid(base().factor);
  const StepCosts& costs = costs_.emplace(on);
  const double verlet = costs.verlet(), few = scene_.t_end / 32;
  steps_.clear(), advice_.steps.clear();
  return try_methods(on, costs,
                     {{method_->method->info.name, 1.5 * base().trial.dt},
                      {"verlet", 0.9 * verlet},
                      {"symplectic-euler", 0.9 * verlet},
                      {"pefrl", 1.3 * verlet},
                      {"srkn6b", 2.2 * verlet},
                      {"respa", 0.9 * costs.multirate()},
                      {"tr-bdf2", 16 * few},
                      {"tr-bdf2", 4 * few},
                      {"tr-bdf2", few},
                      {"tr-bdf2", few / 8},
                      {"implicit-euler", few / 4}},
                     0);
}

void Adviser::try_longer_steps() {
  double longest = costs_->verlet();
  for (std::size_t k = 1; k < reductions_.size(); ++k) {
    const auto on = without_all(on_grid(base().factor), reductions_[k].removed);
    const StepCosts costs(*on);
    if (!(costs.verlet() > 1.2 * longest) || costs.verlet() == no_limit)
      continue;
    longest = costs.verlet();
    try_methods(
        *on, costs,
        {{"verlet", 0.9 * longest}, {"symplectic-euler", 0.9 * longest}}, k);
  }
}

bool Adviser::try_methods(const Model& on, const StepCosts& costs,
                          const std::vector<Try>& tries,
                          std::size_t reduction) {
  const double verlet = costs.verlet();
  auto attempt = [&](const char* method, double dt) {
    Model m = on;
    m.method = find_method(method);
    m.step = {.dt = std::min(dt, m.t_end)};
    return std::pair(m, costs.of_run(m));
  };
  auto run = [&](const char* method, double dt) {
    const auto [m, work] = attempt(method, dt);
    return pilots_.run(
        m, std::string(method) + " by " + CME212::two_digits(dt) + " s", work);
  };
  const char* own = method_->method->info.name;
  const char* fine = "srkn6b";
  double small = 0.55 * verlet;
  if (!pilots_.affords(attempt(fine, small).second, fine, 0.3))
    fine = own, small = base().trial.dt / 4;
  if (!pilots_.affords(attempt(fine, small).second, fine))
    return refuse(over_budget(attempt(fine, small).second));
  const Trial accurate = run(fine, small);
  if (!accurate.ok()) return refuse(accurate.failure);
  if (reduction == 0) reference_ = accurate.answer;
  double least = infinite;  // work by the largest step of a method so far
  // On finer grids all methods except implicit ones need smaller steps.
  const double finest = factors().back() / base().factor;
  for (const Try& t : tries) {
    const bool first = steps_.empty();
    const double work = attempt(t.method, t.dt).second;
    const MethodEntry* method = find_method(t.method);
    // A multirate method without stiff springs is Verlet.
    if (!first &&
        ((reduction == 0 && std::string_view(t.method) == own) ||
         !(work <= (method->info.limit == no_limit ? finest : 1) * 4 * least) ||
         (method->info.multirate && t.dt < verlet) ||
         !pilots_.affords(3 * work, t.method, 0.15)))
      continue;
    least = std::min(least, work);
    Step s{method, std::min(t.dt, scene_.t_end), work, {}, {}, 1, reduction};
    for (int k : {0, 1}) {
      const double dt = k == 0 ? t.dt : s.dt / 2;
      const Trial trial = run(t.method, dt);
      s.works[k] = trial.ok();
      if (s.works[k]) s.effect[k] = Effect(trial.answer, accurate.answer);
      if (k == 0 && trial.dt > 0) s.dt = trial.dt;
      advice_.steps.push_back(
          {t.method + std::string(reduction > 0 ? ", parts dropped" : ""),
           k == 0 ? s.dt : s.dt / 2,
           s.works[k] ? size_of(s.effect[k]) : infinite,
           attempt(t.method, dt).second / std::max(1.0, costs.springs()),
           trial.seconds});
    }
    // Do the two steps confirm the order of the method?
    if (s.works[0] && s.works[1] && size_of(s.effect[0]) > 0) {
      Effect deviation = s.effect[0];
      deviation.add(-std::pow(2, s.method->info.order), s.effect[1].by);
      s.uncertainty = std::clamp(size_of(deviation) / size_of(s.effect[0]),
                                 rules_.uncertainty_of_effects, 1.0);
    }
    steps_.push_back(s);
  }
  return true;
}

Effect Adviser::of_step(const Step& s, double share, double finer) {
  if (s.method->info.limit == no_limit) finer = 1;
  const int k = share == 1 ? 0 : 1;
  return Effect(s.effect[k].by.size())
      .add(std::pow((k + 1) * share / finer, s.method->info.order),
           s.effect[k].by);
}

void Adviser::choose() {
  const Refinement& grids = advice_.grids;
  // A mesh from files can't be refined: only the error of the step is known.
  const Answer limit = scene_.sheets.empty() ? reference_ : grids.limit();
  auto error_of = [&](const Model& m, double work, const std::string& doing,
                      Trial& t) {
    t = pilots_.run(m, doing, work);
    return t.ok() ? size_of(Effect(t.answer, limit)) : infinite;
  };
  const double uncertain = grids.uncertainty_of_limit();
  if (too_uncertain()) {
    refuse(limit_uncertain());
    return;
  }
  const double counted = rules_.counted_share * uncertain;
  int runs = 0;
  // A lower bound of the error of the grid, by factor; long shots apart, as
  // their predictions are less reliable.
  std::map<std::pair<double, bool>, double> of_grid;
  for (Choice& c : choices()) {
    double& least = of_grid[{c.factor, c.long_shot}];
    if (least - c.effects > advice_.tolerance) continue;
    if (c.long_shot && c.work > rules_.long_shot_work * pilots_.left())
      continue;
    if (!c.long_shot &&
        !pilots_.affords(c.work, "more expensive choices", 0.5)) {
      if (!pilots_.keeps() && c.error + c.uncertainty <= advice_.tolerance &&
          is_scene(c.model)) {
        found_ = c;
        return;
      }
      continue;
    }
    if (!c.long_shot && ++runs > rules_.most_checked) break;
    Trial t, half;
    const std::string nodes = std::to_string(nodes_of(c.model)) + " nodes by " +
                              c.model.method->info.name + ' ';
    c.error = error_of(c.model, c.work, nodes, t);
    c.uncertainty = std::max(uncertain, of_itself * c.error);
    c.seconds = t.seconds, c.answer = t.answer, c.checked = true;
    if (t.ok()) least = std::max(least, c.error + counted - c.effects);
    if (!(c.error + counted <= advice_.tolerance)) continue;
    Model smaller = c.model;
    smaller.step.dt /= 2;
    c.robustness.half_step =
        error_of(smaller, 2 * c.work, nodes + "and half the step", half);
    c.half = half.answer;
    // A mesh from files has no limit of grids; its uncertainty is estimated by
    // the difference of two small steps.
    if (scene_.sheets.empty() && half.ok())
      c.uncertainty = std::max(*c.robustness.half_step,
                               size_of(Effect(half.answer, t.answer)) / 3);
    const double most = advice_.tolerance - counted;
    bool robust = *c.robustness.half_step <= most;
    if (robust && !scene_.sheets.empty() &&
        pilots_.affords(8 * c.work, "a check on twice the cells", 0.3)) {
      Model finer = refined_without(2 * c.factor, c.removed);
      finer.method = c.model.method;
      finer.step = {.dt = c.model.step.dt / 2};
      finer.t_end = c.model.t_end;
      c.robustness.finer_grid =
          error_of(finer, 8 * c.work, nodes + "and twice the cells", half);
      robust = *c.robustness.finer_grid <= most;
    }
    if (robust) perturb(c);
    const double all = c.uncertainty + scatter_share * c.scatter;
    robust =
        robust && c.error + rules_.counted_share * all <= advice_.tolerance;
    if (robust) {
      found_ = c;
      return;
    }
    if (!fragile_) fragile_ = c;
  }
  refuse(
      "no method meets the tolerance with steps down to 1/64 of its largest "
      "one");
}

bool Adviser::is_scene(const Model& m) {
  try {
    Scene scene(m);
    return true;
  } catch (const SceneError&) {
    return false;
  }
}

std::vector<Adviser::Choice> Adviser::choices() const {
  std::vector<Choice> all;
  for (double factor : factors()) {
    const double finer = factor / base().factor;
    const Effect of_grid = advice_.grids.error(factor);
    // The error of the grid includes that of the pilots' step: subtract it.
    const double pilots = base().trial.dt / (steps_[0].dt / 2) / finer;
    Effect of_pilot(of_grid.by.size());
    if (steps_[0].works[1] && !scene_.sheets.empty())
      of_pilot.add(pilots * pilots, steps_[0].effect[1].by);
    for (std::size_t k = reductions_.size(); k-- > 0;)
      for (const Step& s : steps_) {
        if (k < s.reduction || !s.works[1]) continue;
        const Reduction& without = reductions_[k];
        for (double share = 1; share > 1 / 64.; share /= std::sqrt(2)) {
          if (share == 1 && !s.works[0]) continue;
          // Below its second step the error is predicted only if both steps
          // confirmed the order.
          if (share < 0.49 && s.uncertainty == 1) break;
          const Effect step = of_step(s, share, finer);
          auto error_with = [&](const Effect& grid, const Effect& by_step) {
            Effect effect = grid;
            effect.add(1, without.effect.by).add(1, by_step.by);
            effect.add(1, rest_effect_.by);
            return size_of(effect.add(-1, of_pilot.by));
          };
          const double error = error_with(of_grid, step);
          const bool long_shot =
              !(std::max(error,
                         error_with(of_grid, of_step(s, share / 2, finer))) <=
                advice_.tolerance);
          if (long_shot && (share < 0.49 || !(error <= rules_.long_shot_error *
                                                           advice_.tolerance)))
            continue;
          const double uncertainty =
              advice_.grids.uncertainty(factor) +
              s.uncertainty * size_of(step) +
              rules_.uncertainty_of_effects *
                  (size_of(without.effect) + size_of(of_pilot));
          const bool shrinks = s.method->info.limit != no_limit;
          const auto m = scene_with(factor, without, s,
                                    s.dt * share / (shrinks ? finer : 1));
          if (!m) continue;
          const double work = costs_->of_step(*s.method, m->step.dt, finer) *
                              without.springs *
                              std::ceil(m->t_end / m->step.dt);
          all.push_back({*m, without.removed, factor, error, uncertainty, work,
                         size_of(without.effect) + size_of(step) +
                             size_of(rest_effect_)});
          all.back().long_shot = long_shot;
          if (error + uncertainty <= advice_.tolerance) break;
        }
      }
  }
  std::ranges::stable_sort(all, {}, &Choice::work);
  return all;
}

std::optional<Model> Adviser::scene_with(double factor,
                                         const Reduction& without,
                                         const Step& s, double dt) const {
  std::optional<Model> m = without_all(on_grid(factor), without.removed);
  if (!m) return m;
  m->method = s.method;
  m->t_end = dissipates(*m) ? rest_time_ : scene_.t_end;
  m->step = {.dt = std::min(dt, m->t_end)};
  m->step.dt = step_of(*m);
  return m;
}

}  // namespace lab::adviser_detail
