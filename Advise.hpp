#pragma once
/** @file Advise.hpp
 * What a scene needs for its answer, found by short runs of it: which parts,
 * which grid, which method and step. docs/advice.md tells how, and how often
 * it is right. */
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "Variation.hpp"

/** How tolerance is shared out; how far pilots go. */
struct AdviceRules {
  double margin = 0.97;       ///< of the tolerance, for all errors together
  double for_grid = 0.95;     ///< of the margin, at most
  double for_parts = 0.5;     ///< of what the grid leaves, at most
  double first_cells = 5;     ///< along the shortest side of the first grid
  double most_nodes = 40000;  ///< of a grid that is tried or advised
};

/** A part, tried by leaving it out. */
struct PartReport {
  std::string part;
  double change = 0;  ///< of the answer, in its unit; infinite: the run failed
  double cost = 0;    ///< what the part takes: of the time of a run with it
  bool needed = true;
};

/** A grid, tried or foreseen. */
struct GridReport {
  double factor = 1;  ///< cells along each side, of those named
  std::size_t nodes = 0;
  double error = 0;    ///< of the answer, estimated; infinite: not known
  double seconds = 0;  ///< of the run; 0: it was foreseen only
  Answer answer;       // empty: foreseen
};

/** A method and a step, tried on the grid of the pilots. */
struct StepReport {
  std::string method;
  double dt = 0;     ///< there [s]
  double error = 0;  ///< of the answer; infinite: the run failed
  double seconds = 0;
};

/** What was found. */
struct Advice {
  Measure measure = Measure::com;
  double tolerance = 0;
  std::vector<GridReport> grids;
  std::vector<PartReport> parts;
  std::vector<StepReport> steps;
  double floor = 0;     ///< what the answer makes of a start moved by 1e-6 m
  std::string refusal;  ///< why there is no advice; empty: there is
  Model model;          ///< the cheapest that was found
  double error = 0;     ///< predicted, in the unit of the measure
  double seconds = 0;   ///< predicted, of this machine
  double spent = 0;     ///< by the pilots [s]
};

namespace advise_detail {

constexpr double infinite = std::numeric_limits<double>::infinity();

inline std::size_t nodes_of(const Model& m) { return mesh_of(m).points.size(); }

/** As Verlet computes it, by the step that is safe in every shape: the pilots'
 * choice. */
inline Model as_pilot(Model m) {
  m.method = "verlet";
  m.with.rule = StepRule::safe;
  return m;
}

/** Finds an Advice. */
class Adviser {
 public:
  Adviser(const Model& m, const AdviceRules& rules) : scene_(m), rules_(rules) {
    advice_.measure = read_measure(m.measure);
    advice_.tolerance = m.tolerance;
  }

  Advice find() {
    check_question(scene_);
    if (!(scene_.t_end > 0))
      throw SceneError("t-end", "is 0, so there is nothing to find out");
    if (!find_grid() || !look_for_chaos()) return advice_;
    const Model pilot = on_grid(pilot_factor_);
    Model needed = find_parts(pilot);
    find_step(needed);
    return advice_;
  }

 private:
  Model scene_;
  AdviceRules rules_;
  Advice advice_;
  double pilot_factor_ = 1;  // of the grid on which the rest is tried
  double grid_error_ = 0, part_error_ = 0;
  double factor_ = 1;                 // of the grid that is advised
  Trial pilot_;                       // all parts, on the pilots' grid
  std::vector<Answer> still_;         // of that, to all questions
  std::vector<std::string> dropped_;  // parts that are not needed

  Model on_grid(double factor) const {
    return scene_.sheets.empty() ? scene_ : refined(scene_, factor);
  }
  Trial run(
      const Model& m, double shake = 0,
      const std::function<void(const Cloth&)>& look = [](const Cloth&) {}) {
    Trial t = try_out(m, shake, look);
    advice_.spent += t.seconds;
    return t;
  }
  /** Run the scene with all its parts, on some grid. */
  Trial run_pilot(const Model& m) {
    const Model pilot = as_pilot(m);
    return run(pilot, 0, all_answers(pilot, still_));
  }
  double budget() const { return rules_.margin * advice_.tolerance; }
  double room_for_parts() const {
    return rules_.for_parts * (budget() - grid_error_);
  }
  double apart(const Trial& a, const Trial& b) const {
    return a.ok() && b.ok() ? distance(a.answer, b.answer, advice_.measure)
                            : infinite;
  }
  bool refuse(const std::string& why) {
    advice_.refusal = why;
    return false;
  }

  // ------------------------------------------------------------------- Grid

  /** Grids of twice as many cells each time, until one is fine enough, or it
   * can be foreseen that the next one is. The step goes down with the grid, so
   * its error is in it. */
  bool find_grid() {
    using CME212::short_text;
    auto& grids = advice_.grids;
    const double enough = rules_.for_grid * budget();
    if (scene_.sheets.empty()) {
      pilot_ = run_pilot(scene_);
      if (!pilot_.ok()) return refuse(pilot_.failure);
      grids.push_back({1, nodes_of(scene_), 0, pilot_.seconds, pilot_.answer});
      return true;
    }
    unsigned shortest = ~0u;
    for (const std::string& text : scene_.sheets)
      for (unsigned n : read_sheet(text).nodes)
        shortest = std::min(shortest, n);
    double factor = 1;
    while ((shortest - 1) * factor / 2 >= rules_.first_cells) factor /= 2;
    double order = 1;
    for (;; factor *= 2) {
      const Model m = on_grid(factor);
      const std::size_t nodes = nodes_of(m);
      if (double(nodes) > rules_.most_nodes)
        return refuse(
            does_not_settle()
                ? unsettled()
                : "a grid of " + std::to_string(nodes) +
                      " nodes would not be fine enough yet: the error of the "
                      "one before is " +
                      short_text(grids.empty() ? infinite
                                               : grids.back().error) +
                      ' ' + unit_of(advice_.measure));
      Trial t;
      try {
        t = run_pilot(m);
      } catch (const SceneError& e) {  // a pin between nodes, a thickness
        if (factor >= 1)
          return refuse("of a grid of " + std::to_string(nodes) +
                        " nodes: " + e.what());
        grids.clear();
        continue;
      }
      if (!t.ok()) return refuse(t.failure);
      grids.push_back({factor, nodes, infinite, t.seconds, t.answer});
      const std::size_t k = grids.size() - 1;
      if (k >= 2) {
        // Slower than that foresees nothing; faster goes no scheme here.
        const double d = step_between(k - 2), e = step_between(k - 1);
        order = std::clamp(e > 0 ? std::log2(d / e) : 2.0, 0.8, 2.0);
      }
      pilot_ = t, pilot_factor_ = factor_ = factor;
      if (k < 2) continue;
      estimate_errors(order);
      // The coarsest that is fine enough.
      for (const GridReport& g : grids)
        if (g.error <= enough) {
          factor_ = g.factor, grid_error_ = g.error;
          return true;
        }
      // Foreseen to be fine enough, not by a hair.
      const double next = grids.back().error / std::pow(2, order);
      const std::size_t more = nodes_of(on_grid(2 * factor));
      if (next <= enough / 1.5 && double(more) <= rules_.most_nodes) {
        grids.push_back({2 * factor, more, next, 0, {}});
        factor_ = 2 * factor, grid_error_ = next;
        return true;
      }
    }
  }
  /** The answers of the last grids do not come closer to each other. */
  bool does_not_settle() const {
    const std::size_t n = advice_.grids.size();
    return n >= 3 && step_between(n - 2) > 0.8 * step_between(n - 3);
  }
  std::string unsettled() const {
    const std::size_t n = advice_.grids.size();
    return "the answer does not settle as the grid gets finer: the last two "
           "steps changed it by " +
           CME212::two_digits(step_between(n - 3)) + " and " +
           CME212::two_digits(step_between(n - 2)) + ' ' +
           unit_of(advice_.measure);
  }
  double step_between(std::size_t k) const {
    const auto& g = advice_.grids;
    return distance(g[k].answer, g[k + 1].answer, advice_.measure);
  }
  /** Of all grids against what they tend to, by the last two (Richardson). */
  void estimate_errors(double order) {
    auto& grids = advice_.grids;
    const double shrink = std::pow(2, order);
    const Answer &last = grids.back().answer,
                 &before = grids[grids.size() - 2].answer;
    Answer limit = last;
    for (std::size_t k = 0; k < limit.size(); ++k)
      limit[k] += (last[k] - before[k]) / (shrink - 1);
    for (GridReport& g : grids)
      g.error = distance(g.answer, limit, advice_.measure);
  }

  // ------------------------------------------------------------------ Chaos

  /** Puts the answers to all questions into @a into, by Measure; nothing where
   * @a m can't answer. */
  static std::function<void(const Cloth&)> all_answers(
      const Model& m, std::vector<Answer>& into) {
    return [m, &into](const Cloth& g) {
      into.clear();
      for (std::size_t k = 0; k < measure_names.size(); ++k) {
        Model other = m;
        other.measure = measure_names[k];
        into.push_back(can_answer(m, Measure(k)) ? answer(other, g) : Answer());
      }
    };
  }

  /** What the answer, and others that could be asked for, make of a start that
   * is off by a millionth of a meter. */
  bool look_for_chaos() {
    std::vector<Answer> shaken;
    const Model m = as_pilot(on_grid(pilot_factor_));
    const Trial t = run(m, 1e-6, all_answers(m, shaken));
    if (!t.ok()) return refuse(t.failure);
    std::string others;
    for (std::size_t k = 0; k < measure_names.size(); ++k) {
      if (still_[k].empty()) continue;
      const Measure what = Measure(k);
      const double moved = distance(still_[k], shaken[k], what);
      if (what == advice_.measure)
        advice_.floor = moved;
      else
        others += std::string(others.empty() ? "" : ", ") + name_of(what) +
                  " to " + CME212::short_text(4 * moved) +
                  (*unit_of(what) ? " " : "") + unit_of(what);
    }
    if (advice_.floor <= budget() / 2) return true;
    return refuse(
        "the motion is chaotic: a start that is off by 1e-6 m "
        "changes the answer by " +
        CME212::short_text(advice_.floor) +
        (*unit_of(advice_.measure) ? " " : "") + unit_of(advice_.measure) +
        ", so no grid and no step can meet the tolerance; what can "
        "be had: " +
        others);
  }

  // ------------------------------------------------------------------ Parts

  /** Leave out each part in turn; then all together that change little.
   * @return the scene on the pilots' grid without them */
  Model find_parts(const Model& pilot) {
    auto& parts = advice_.parts;
    const auto variations = without_parts(as_pilot(pilot));
    for (const Variation& v : variations) {
      PartReport r{v.part};
      try {
        const Trial t = run(v.model);
        r.change = apart(t, pilot_);
        r.cost = 1 - t.seconds / pilot_.seconds;
      } catch (const std::exception&) {
        r.change = infinite;  // it is no scene without that part
      }
      parts.push_back(r);
    }
    std::vector<std::size_t> order(parts.size());
    for (std::size_t k = 0; k < order.size(); ++k) order[k] = k;
    std::ranges::sort(order, {},
                      [&](std::size_t k) { return parts[k].change; });
    std::vector<std::string> gone;
    Model least = pilot;
    for (std::size_t k : order) {
      if (!(parts[k].change <= room_for_parts())) break;
      gone.push_back(parts[k].part);
      const std::optional<Model> without = without_all(pilot, gone);
      const double change =
          without ? apart(run(as_pilot(*without)), pilot_) : infinite;
      if (!(change <= room_for_parts())) {
        gone.pop_back();
        continue;
      }
      part_error_ = change;
      parts[k].needed = false;
      least = *without;
    }
    dropped_ = gone;
    return least;
  }

  /** @a m without these parts; nothing if one went with another. */
  static std::optional<Model> without_all(Model m,
                                          std::vector<std::string> gone) {
    // A part goes with its friction; so friction first.
    std::ranges::stable_sort(gone, {}, [](const std::string& s) {
      return s.rfind("friction of ", 0) != 0;
    });
    for (const std::string& part : gone) {
      const auto all = without_parts(m);
      auto it = std::ranges::find(all, part, &Variation::part);
      if (it == all.end()) return std::nullopt;
      m = it->model;
    }
    return m;
  }

  // ------------------------------------------------------------------- Step

  /** Each method by two steps; the cheapest of them, and of what lies between
   * and below them, that leaves room for the other errors. */
  void find_step(const Model& needed) {
    struct Try {
      const char* method;
      double first, second;  // of Verlet's largest step
    };
    constexpr Try tries[] = {
        {"verlet", 0.9, 0.45}, {"symplectic-euler", 0.9, 0.45},
        {"pefrl", 1.3, 0.65},  {"srkn6b", 2.2, 1.1},
        {"tr-bdf2", 8, 4},     {"implicit-euler", 8, 4},
    };
    Model m = as_pilot(needed);
    const double verlet = step_of(m) / safe_share;
    auto attempt = [&](const Try& t, double share) {
      m.method = t.method;
      m.with.rule = StepRule::fixed;
      m.with.dt = std::min(share * verlet, m.t_end);
      return run(m);
    };
    const Trial exact = attempt({"srkn6b", 0, 0}, 0.55);
    const double room = budget() - grid_error_ - part_error_;
    // Explicit methods by counted work: a clock is not that exact.
    const double per_spring = pilot_.seconds / pilot_.work;
    double least = infinite;
    for (const Try& t : tries) {
      const MethodInfo& info = find_method(t.method)->info;
      double errors[2], dts[2], seconds[2];
      for (int k : {0, 1}) {
        const Trial trial = attempt(t, k == 0 ? t.first : t.second);
        errors[k] = apart(trial, exact), dts[k] = trial.dt;
        seconds[k] =
            info.limit == no_limit ? trial.seconds : trial.work * per_spring;
        advice_.steps.push_back({t.method, dts[k], errors[k], seconds[k]});
      }
      // Never beyond the first step: what lies there was not tried.
      for (double share = 1; share > 1 / 64.; share /= 2) {
        const int k = share == 1 ? 0 : 1;
        const double down = share == 1 ? 1 : 2 * share;
        const double error = errors[k] * std::pow(down, info.order);
        // On a finer grid an explicit step is as much smaller.
        const double finer = factor_ / pilot_factor_;
        const bool shrinks = info.limit != no_limit;
        const double there =
            shrinks ? error * std::pow(1 / finer, info.order) : error;
        if (!(there <= room)) continue;
        const double cost =
            seconds[k] / down * finer * finer * (shrinks ? finer : 1);
        if (cost >= least) break;
        least = cost;
        advice_.error = grid_error_ + part_error_ + there;
        advice_.seconds = cost;
        advice_.model = *without_all(on_grid(factor_), dropped_);
        advice_.model.method = t.method;
        advice_.model.with.dt = dts[k] * down / (shrinks ? finer : 1);
        advice_.model.with.rule = StepRule::fixed;
        advice_.model.dt = CME212::exact_text(advice_.model.with.dt);
        break;
      }
    }
    if (least == infinite)
      refuse(
          "no method meets the tolerance on this grid by steps down to 1/64 "
          "of its largest");
  }
};

}  // namespace advise_detail

/** Find out what @a m needs for its answer. Runs it many times: on coarser
 * grids first, without each part, by several methods.
 * @pre check_model(m), check_has_cloth(m)
 * Throws InputError, SceneError: also if @a m can't answer its question. */
inline Advice advise(const Model& m, const AdviceRules& rules = {}) {
  return advise_detail::Adviser(m, rules).find();
}

/** @a a as tables, and what it comes to, for people. */
inline std::string in_words(const Advice& a) {
  using CME212::short_text;
  std::string text;
  char line[200];
  const std::string unit =
      *unit_of(a.measure) ? std::string(" [") + unit_of(a.measure) + ']' : "";
  auto add = [&](const char* format, auto... values) {
    std::snprintf(line, sizeof line, format, values...);
    text += line;
  };
  auto number = [](double x) {
    return std::isfinite(x) ? CME212::two_digits(x) : std::string("-");
  };
  add("asked: %s%s to %s\n", name_of(a.measure), unit.c_str(),
      short_text(a.tolerance).c_str());
  if (a.grids.size() > 1) {
    add("\n%-44s %10s %10s\n", "nodes", "error", "time [s]");
    for (const GridReport& g : a.grids)
      add("%-44zu %10s %10s\n", g.nodes, number(g.error).c_str(),
          g.answer.empty() ? "foreseen" : number(g.seconds).c_str());
  }
  if (!a.parts.empty()) {
    add("\n%-44s %10s %10s\n", "part", "changes", "costs");
    for (const PartReport& p : a.parts)
      add("%-44.44s %10s %9.0f%%  %s\n", p.part.c_str(),
          number(p.change).c_str(), 100 * std::max(0.0, p.cost),
          p.needed ? "needed" : "not needed");
  }
  if (!a.steps.empty()) {
    add("\n%-30s %13s %10s %10s\n", "method", "dt [s]", "error", "time [s]");
    for (const StepReport& s : a.steps)
      add("%-30s %13s %10s %10s\n", s.method.c_str(), number(s.dt).c_str(),
          number(s.error).c_str(), number(s.seconds).c_str());
  }
  if (!a.refusal.empty()) return text + "\nno advice: " + a.refusal + '\n';
  add("\nadvice: %zu nodes, %s, dt = %s s: error %s%s, %s s; finding out took "
      "%s s\n",
      mesh_of(a.model).points.size(), a.model.method.c_str(),
      short_text(a.model.with.dt).c_str(), number(a.error).c_str(),
      *unit_of(a.measure) ? (std::string(" ") + unit_of(a.measure)).c_str()
                          : "",
      number(a.seconds).c_str(), number(a.spent).c_str());
  return text;
}
