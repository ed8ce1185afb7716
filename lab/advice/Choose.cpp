#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "CME212/Util.hpp"
#include "lab/advice/Adviser.hpp"
#include "lab/methods/Methods.hpp"
#include "lab/stepping/Trial.hpp"

namespace lab::adviser_detail {

void Adviser::find_parts() {
  auto& parts = advice_.parts;
  const Model all = seen_[base_].model;
  const Trial& pilot = advice_.grids[base_].trial;
  const double work = seen_[base_].work;
  const double springs = springs_of(all), verlet = StepCosts(all).verlet();
  advice_.tried_on = advice_.grids[base_].nodes;
  parts.clear();
  for (const Variation& v : without_parts(all)) {
    PartReport r{v.part, infinite, springs - springs_of(v.model)};
    const StepCosts costs(v.model);
    if (costs.verlet() < no_limit) r.step = costs.verlet() / verlet;
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
  reductions_ = {{{}, Effect(pilot.answer.size())}};
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
    if (!(size_of(effect) <= room)) continue;
    // Parts that change nothing need no choice of their own.
    if (size_of(Effect(effect.by, reductions_.back().effect.by)) <=
        1e-3 * advice_.tolerance)
      reductions_.pop_back();
    reductions_.push_back({removed, effect});
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
  rest_time_ = scene_.t_end;
  const double work = seen_[base_].work;
  if (!dissipates(scene_) || !pilots_.affords(work, "an earlier end", 0.1))
    return;
  const Model& m = seen_[base_].model;
  std::vector<std::pair<double, Answer>> looked;
  std::optional<Observer> observer;
  const Trial t = pilots_.run(
      m, "when it comes to rest", work, {}, nullptr, [&](Scene& scene) {
        if (!observer) observer.emplace(m, scene);
        if (m.measure.over_time()) observer->look(m, scene);
        if (scene.time() >= double(looked.size()) * m.t_end / looks)
          looked.emplace_back(scene.time(), observer->answer(m, scene));
      });
  for (; t.ok() && !looked.empty(); looked.pop_back()) {
    const auto& [time, then] = looked.back();
    if (then.empty() ||
        !(size_of(Effect(then, t.answer)) <= advice_.tolerance / 10))
      break;
    if (time <= 0.9 * m.t_end) rest_time_ = time;
  }
}

double Adviser::springs_of(const Model& m) {
  Cloth g;
  build_model(g, m, mesh_of(m));
  return double(g.num_edges());
}

bool Adviser::suffices(const Sides& s, double most_work, double& work) {
  try {
    double finest = 1e-9;
    for (const auto& sheet : s) finest = std::max({finest, sheet[0], sheet[1]});
    const Model m = pilot(on_grid(s), finest);
    work = work_of_run(m);
    if (!(work < most_work) || !pilots_.affords(work, "coarser grids", 0.3))
      return false;
    const std::string nodes = std::to_string(nodes_of(m)) + " nodes";
    return accepts(error_of(pilots_.run(m, nodes, work)), uncertainty_);
  } catch (const SceneError&) {  // its nodes miss a pin
    return false;
  }
}

std::vector<int> Adviser::starts() const {
  if (from_files()) return {0};  // its own error is unknown
  auto meets = [this](std::size_t k) {
    return accepts(error_of(advice_.grids[k].trial), uncertainty_);
  };
  std::vector<int> all;
  for (std::size_t k = 0; k < levels_.size(); ++k) {
    const auto twice = std::ranges::find(levels_, levels_[k] + 2);
    if (meets(k) &&
        (twice == levels_.end() || meets(std::size_t(twice - levels_.begin()))))
      all.push_back(levels_[k]);
  }
  return all;
}

std::vector<Sides> Adviser::frontier(int start) {
  if (from_files()) return {{}};
  std::vector<std::pair<double, Sides>> all;
  double most = infinite;
  auto meets = [&](const Sides& s, double& work) {
    const bool ok = suffices(s, most, work);
    if (ok) all.push_back({work, s}), most = work;
    return ok;
  };
  double work = 0;
  meets(all_sides(factor(start), factor(start)), work);
  // Fewer cells along one side; more along the other one only if that is
  // needed and still cheaper.
  for (int side : {0, 1})
    for (int level = start - 1, other = start;
         other <= levels_.back() && cells(factor(level + 1), side) > 2;
         --level) {
      if (cells(factor(level), side) == cells(factor(level + 1), side))
        continue;
      for (bool ok = false; !ok && other <= levels_.back();) {
        const double a = factor(level), b = factor(other);
        ok = meets(side == 0 ? all_sides(a, b) : all_sides(b, a), work);
        if (!ok && !(work < most)) other = levels_.back();
        if (!ok) ++other;
      }
    }
  std::ranges::stable_sort(all, {}, &std::pair<double, Sides>::first);
  std::vector<Sides> best;
  for (const auto& [cost, s] : all)
    if (best.size() < 3 && cost <= 1.6 * all[0].first) best.push_back(s);
  if (!best.empty()) {
    const auto thin = thinned(best[0], most);
    best.insert(best.begin(), thin.rbegin(), thin.rend());
  }
  return best;
}

std::vector<Sides> Adviser::thinned(Sides s, double work) {
  std::vector<Sides> found;
  double less = 0;
  for (std::size_t k = 0; k < s.size(); ++k)
    for (unsigned along : {0, 1}) {
      const Sides before = s;
      const double all = scene_.sheets[k].nodes[along] - 1.;
      double now = on_grid(s).sheets[k].nodes[along] - 1.;
      auto with = [&](double cells) {
        Sides fewer = s;
        fewer[k][along] = cells / all;
        if (!suffices(fewer, work, less)) return false;
        s = fewer, now = cells, work = less;
        return true;
      };
      // First a side on which nothing depends.
      if (now > 2 && !with(2))
        while (now > 3 && with(std::floor(0.85 * now))) {
        }
      if (s != before) found.push_back(s);
    }
  return found;
}

std::vector<Adviser::Choice> Adviser::choices(const Sides& s) const {
  std::vector<const MethodEntry*> methods = {
      &table::verlet, &table::symplectic_euler, &table::pefrl,
      &table::mollified_impulse, &table::tr_bdf2};
  if (rules_.keeps_method) methods = {scene_.method};
  std::vector<Choice> all;
  for (std::size_t k = reductions_.size(); k-- > 0;) {
    const auto& removed = reductions_[k].removed;
    std::optional<Model> m = without_all(on_grid(s), removed);
    if (!m) continue;
    m->t_end = dissipates(*m) ? rest_time_ : scene_.t_end;
    const StepCosts costs(*m);
    for (const MethodEntry* method : methods) {
      m->method = method;
      const MethodInfo& info = m->method->info;
      const double limit = costs.limit(info);
      // Without stiff springs it is Verlet.
      if (info.multirate && !rules_.keeps_method && !(limit > costs.verlet()))
        continue;
      const bool bounded = limit != no_limit;
      double dt = bounded ? 0.9 * limit : m->t_end;
      for (int n = 0; n < (bounded ? 7 : 11); ++n) {
        m->step = {.dt = std::min(dt, m->t_end)};
        if (rules_.keeps_step) m->step = scene_.step;
        m->step.dt = step_of(*m);
        all.push_back({{.model = *m, .work = costs.of_run(*m)},
                       removed,
                       s,
                       bounded ? m->step.dt / limit : dt});
        dt /= bounded ? std::sqrt(2) : 2;
        if (rules_.keeps_step) break;
      }
    }
  }
  std::ranges::stable_sort(all, {}, &AdvisedRun::work);
  return all;
}

bool Adviser::holds(Choice& c) {
  auto run = [&](const Model& m, double work, const std::string& by) {
    return pilots_.run(m,
                       std::to_string(nodes_of(m)) + " nodes by " +
                           c.model.method->info.name + by,
                       work);
  };
  const Trial t = run(c.model, c.work, "");
  c.error = error_of(t);
  c.seconds = t.seconds, c.answer = t.answer, c.checked = true;
  c.uncertainty = uncertainty_;
  advice_.choices.push_back({nodes_of(c.model), c.model.method->info.name,
                             c.model.step.dt, c.error, c.work});
  if (!accepts(c.error, uncertainty_)) return false;
  Model finer = c.model;
  finer.step.dt /= 2;
  const Trial half = run(finer, 2 * c.work, " and half the step");
  c.half_step = error_of(half);
  if (!accepts(*c.half_step, uncertainty_)) return false;
  c.half = half.answer;
  for (const auto& [more, by] :
       {std::pair(std::sqrt(2), " and 1.4 times the cells"),
        std::pair(2., " and twice the cells")}) {
    const double work = std::pow(more, 3) * c.work;
    if (from_files() ||
        !pilots_.affords(work, "a check on twice the cells", 0.5))
      break;
    Sides sides = c.sides;
    for (auto& sheet : sides)
      for (double& side : sheet) side *= more;
    finer = *without_all(on_grid(sides), c.removed);
    finer.method = c.model.method, finer.t_end = c.model.t_end;
    finer.step = {.dt = c.model.step.dt / more};
    const double error = error_of(run(finer, work, by));
    if (!accepts(error, uncertainty_)) return false;
    if (more == 2) c.finer_grid = error;
  }
  c.scatter = perturb(c);
  c.uncertainty += scatter_share * c.scatter;
  return c.scatter <= advice_.tolerance / 2 && accepts(c.error, c.uncertainty);
}

void Adviser::choose() {
  // The choice found before holds if finer grids do not contradict it.
  if (found_) {
    found_->error = size_of(Effect(found_->answer, limit_));
    found_->uncertainty = uncertainty_ + scatter_share * found_->scatter;
    if (!(found_->error <= advice_.tolerance)) found_.reset();
  }
  advice_.choices.clear();
  std::map<std::string, double> too_long;  // by method: Choice::step
  std::optional<Choice> best;
  const auto try_all = [&](const Sides& s) {
    // Parts left out for which smaller steps are no remedy, and the last error
    // of each method with them.
    std::set<std::size_t> fail;
    std::map<std::pair<std::size_t, std::string>, double> errors;
    for (Choice& c : choices(s)) {
      if (best && !(c.work < best->work)) break;
      if (fail.contains(c.removed.size())) continue;
      const std::string method = c.model.method->info.name;
      const auto fails = too_long.find(method);
      if (fails != too_long.end() && c.step > 0.99 * fails->second) continue;
      if (!pilots_.affords(c.work, "more expensive choices", 0.33)) break;
      if (holds(c)) {
        best = c;
        break;
      }
      if (!(c.error <= 1.5 * advice_.tolerance)) too_long[method] = c.step;
      double& before = errors.try_emplace({c.removed.size(), method}, infinite)
                           .first->second;
      // From files all error is by the step; implicit steps begin very long.
      const bool bounded = std::isnormal(c.model.method->info.limit);
      if (!from_files() && (accepts(c.error, uncertainty_) ||
                            (bounded && c.error > 0.9 * before)))
        fail.insert(c.removed.size());
      before = c.error;
    }
  };
  for (int start : starts()) {
    if (best) break;
    for (const Sides& s : frontier(start)) try_all(s);
  }
  if (best) {
    found_ = best;
  } else if (!found_ && rest_time_ < scene_.t_end) {
    rest_time_ = scene_.t_end;  // other grids come to rest later
    choose();
  }
}

void Adviser::foresee() {
  const Refinement& grids = advice_.grids;
  if (grids.size() < fewest() || too_uncertain()) return;
  // Pilots tell nothing of another method or of a step that was asked for.
  if (rules_.keeps_step ||
      (rules_.keeps_method && scene_.method != method_->method))
    return;
  for (int level = levels_.front(); level < level_ + 12; ++level) {
    Model m = on_level(level);
    if (!from_files() && double(nodes_of(m)) > rules_.most_nodes) return;
    try {
      m = pilot(m, factor(level));
      m.step = {.dt = step_of(m)};
    } catch (const SceneError&) {
      continue;  // a pin holds no node
    }
    const double error = size_of(grids.error(over(m))),
                 uncertainty = uncertainty_ + scatter_share * advice_.scatter;
    if (!(error + uncertainty <= advice_.tolerance)) continue;
    found_ = Choice{{.model = m,
                     .work = work_of_run(m),
                     .error = error,
                     .uncertainty = uncertainty}};
    // A step on a mesh from files was run, maybe with half of it.
    for (std::size_t k = 0; k < levels_.size(); ++k) {
      const Trial& t = grids[k].trial;
      if (levels_[k] == level && from_files())
        found_->answer = t.answer, found_->seconds = t.seconds,
        found_->checked = true;
      if (levels_[k] == level + 2 && found_->checked)
        found_->half_step = grids[k].error;
    }
    return;
  }
}

}  // namespace lab::adviser_detail
