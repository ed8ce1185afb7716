#include "lab/advice/Advise.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "CME212/Util.hpp"
#include "lab/advice/Variation.hpp"
#include "lab/methods/Methods.hpp"
#include "lab/scenes/Scene.hpp"
#include "lab/stability/StepLimit.hpp"

namespace lab {

Model as_pilot(Model m) {
  m.method = find_method("verlet");
  m.step = {.rule = StepRule::safe};
  return m;
}

namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

std::size_t nodes_of(const Model& m) { return mesh_of(m).points.size(); }

/** Finds an Advice. */
class Adviser {
 public:
  Adviser(const Model& m, const AdviceRules& rules) : scene_(m), rules_(rules) {
    advice_.measure = m.measure;
    advice_.tolerance = m.tolerance;
    advice_.grids = Refinement(advice_.measure);
  }

  Advice find() {
    check_question(scene_);
    if (!(scene_.t_end > 0))
      throw SceneError("t-end", "is 0, so there is nothing to find out");
    const CME212::Clock clock;
    do {
      if (!find_grid()) break;
      advice_.refusal.clear();
      if (base_ != find_base()) {
        base_ = find_base();
        find_parts();
        if (!try_steps()) break;
      }
      choose();
    } while (goes_on());
    // Chaos may be why nothing was found.
    if (!advice_.grids.empty() && look_for_chaos() && found_) take(*found_);
    advice_.spent = clock.seconds();
    return advice_;
  }

 private:
  /** Parts left out together. */
  struct Less {
    std::vector<std::string> gone;
    Effect effect;
    double work;  // of a run without them, to one with them
  };
  /** Method and step on the grid of base(). */
  struct Step {
    const MethodEntry* method;
    double dt, seconds, work;  // its largest; of a run with all parts
    Effect effect[2];          // of its largest step, and of the half of that
    bool works[2];
    double uncertainty = 1;  // of what it changes, relative to that
  };

  struct Choice {
    Model model;
    std::vector<std::string> gone;
    double error, uncertainty, seconds, work;
  };

  Model scene_;
  AdviceRules rules_;
  Advice advice_;
  std::vector<Answer> still_;   // of the finest grid, to all questions
  double first_ = 1;            // factor of the first grid
  Answer reference_;            // of base(), by small steps; with all parts
  double seconds_ = 0;          // of a pilot on base()
  std::size_t base_ = no_base;  // the grid on which parts and steps are tried
  std::vector<Less> less_;      // the first one: all parts
  std::vector<Step> steps_;     // the first one: Verlet
  std::optional<Choice> found_;
  static constexpr std::size_t no_base = ~std::size_t(0);

  /** The first grid has whole cells, and every other one twice as many as the
   * one before. */
  Model on_grid(double factor) const {
    if (scene_.sheets.empty()) return scene_;
    return refined(refined(scene_, first_), factor / first_);
  }
  /** What is no scene fails, like what blows up. */
  static Trial run(
      const Model& m, double shake = 0,
      const std::function<void(const Cloth&)>& look = [](const Cloth&) {}) {
    try {
      return try_out(m, shake, look);
    } catch (const std::exception& e) {
      Trial failed;
      failed.failure = e.what();
      return failed;
    }
  }
  bool refuse(const std::string& why) {
    advice_.refusal = why;
    return false;
  }
  double size_of(const Effect& e) const { return e.size(advice_.measure); }

  // ------------------------------------------------------------------- Grid

  const GridReport& base() const { return advice_.grids[base_]; }
  /** Where parts and steps are best tried: on the coarsest grid that may do,
   * and on none that takes more than an eighth of the finest one's work. */
  std::size_t find_base() const {
    const auto& grids = advice_.grids;
    std::size_t k = 0;
    while (k + 2 < grids.size() && !(grids[k].error <= advice_.tolerance)) ++k;
    return k;
  }

  /** Go on to grids of twice as many cells each time, until one is fine enough,
   * or it can be foreseen that the next one is. The step goes down with the
   * grid, so its error is in it. */
  bool find_grid() {
    auto& grids = advice_.grids;
    if (grids.empty()) first_ = first_factor();
    double factor = grids.empty() ? first_ : 2 * grids.back().factor;
    for (;; factor *= 2) {
      const Model m = as_pilot(on_grid(factor));
      const std::size_t nodes = nodes_of(m);
      if (double(nodes) > rules_.most_nodes)
        return refuse(grids.settles() ? too_coarse(nodes) : unsettled());
      std::vector<Answer> all;
      const Trial t = run(m, 0, all_answers(m, all));
      if (!t.ok()) {
        if (factor >= 1)
          return refuse("of a grid of " + std::to_string(nodes) +
                        " nodes: " + t.failure);
        // Too coarse for its pins, or to bear its load.
        grids.clear(), base_ = no_base;
        first_ *= 2, factor = first_ / 2;
        continue;
      }
      still_ = all;
      grids.add({factor, nodes, infinite, t});
      found_.reset();  // what coarser grids made believe counts no longer
      if (scene_.sheets.empty()) return true;
      if (grids.size() >= 3 && may_suffice()) return true;
    }
  }
  double first_factor() const {
    unsigned shortest = ~0u;
    for (const Sheet& s : scene_.sheets)
      for (unsigned n : s.nodes) shortest = std::min(shortest, n);
    double factor = 1;
    while (!scene_.sheets.empty() &&
           (shortest - 1) * factor / 2 >= rules_.first_cells)
      factor /= 2;
    return factor;
  }
  /** The grids to choose from, the coarsest first: those that were tried, the
   * next one, and one in the midst between each two. */
  std::vector<double> factors() const {
    std::vector<double> all;
    for (const GridReport& g : advice_.grids) {
      all.push_back(g.factor);
      if (scene_.sheets.empty()) break;
      for (double f : {std::sqrt(2.0) * g.factor, 2 * g.factor})
        if ((f < 2 * g.factor || &g == &advice_.grids.back()) &&
            double(nodes_of(on_grid(f))) <= rules_.most_nodes)
          all.push_back(f);
    }
    return all;
  }
  bool may_suffice() const {
    return std::ranges::any_of(factors(), [this](double f) {
      return size_of(advice_.grids.error(f)) + advice_.grids.uncertainty(f) <=
             advice_.tolerance;
    });
  }

  std::string unsettled() const {
    const auto& grids = advice_.grids;
    return "the answer does not settle as the grid gets finer: the last two "
           "steps changed it by " +
           CME212::two_digits(grids.step_to(grids.size() - 2)) + " and " +
           with_unit(grids.step_to(grids.size() - 1), advice_.measure);
  }
  std::string too_coarse(std::size_t nodes) const {
    const auto& grids = advice_.grids;
    std::string why = "a grid of " + std::to_string(nodes) +
                      " nodes would be too much, and the error of the one "
                      "before is ";
    if (grids.size() < 3) return why + "not known";
    return why + with_unit(grids.back().error, advice_.measure) + " +- " +
           with_unit(grids.uncertainty_of_limit(), advice_.measure);
  }

  // ------------------------------------------------------------------ Chaos

  /** Puts the answers to all questions into @a into, by Measure; nothing where
   * @a m can't answer. */
  static std::function<void(const Cloth&)> all_answers(
      const Model& m, std::vector<Answer>& into) {
    return [m, &into](const Cloth& g) {
      into.clear();
      for (std::size_t k = 0; k < measure_names.size(); ++k) {
        const Measure what = Measure(k);
        into.push_back(can_answer(m, what) ? answer(m, g, what) : Answer());
      }
    };
  }

  /** What the answer, and others that could be asked for, make of a start that
   * is off by a millionth of a meter: on the finest grid, as chaos grows. */
  bool look_for_chaos() {
    std::vector<Answer> shaken;
    const Model m = as_pilot(on_grid(advice_.grids.back().factor));
    const Trial t = run(m, 1e-6, all_answers(m, shaken));
    if (!t.ok()) return refuse(t.failure);
    std::string others;
    for (std::size_t k = 0; k < measure_names.size(); ++k) {
      const Answer& still = still_[k];
      if (still.empty()) continue;
      const Measure what = Measure(k);
      const double moved = distance(still, shaken[k], what);
      if (what == advice_.measure)
        advice_.floor = moved;
      else
        others += std::string(others.empty() ? "" : ", ") + name_of(what) +
                  " to " + with_unit(4 * moved, what);
    }
    if (advice_.floor <= advice_.tolerance / 2) return true;
    // Below ten times the shake it is no more than what was put in.
    return refuse((advice_.floor > 1e-5
                       ? "the motion is chaotic: a"
                       : std::string("the tolerance is too small: a")) +
                  " start that is off by 1e-6 m changes the answer by " +
                  with_unit(advice_.floor, advice_.measure) +
                  ", so no grid and no step can meet the tolerance; what can "
                  "be had: " +
                  others);
  }

  // ------------------------------------------------------------------ Parts

  /** Leave out each part in turn; then one more each time, as long as together
   * they change little: those that change least first. */
  void find_parts() {
    auto& parts = advice_.parts;
    const Model all = as_pilot(on_grid(base().factor));
    const Trial& pilot = base().trial;
    seconds_ = std::min(pilot.seconds, run(all).seconds);  // the first is cold
    parts.clear();
    for (const Variation& v : without_parts(all)) {
      PartReport r{v.part, infinite};
      if (const Trial t = run(v.model); t.ok()) {
        r.change = distance(t.answer, pilot.answer, advice_.measure);
        r.cost = 1 - t.seconds / seconds_;
      }
      parts.push_back(r);
    }
    std::vector<PartReport> order = parts;
    std::ranges::sort(order, {}, &PartReport::change);
    const double room = rules_.for_parts * advice_.tolerance;
    less_ = {{{}, Effect(pilot.answer.size()), 1}};
    for (const PartReport& part : order) {
      if (!(part.change <= room)) break;
      std::vector<std::string> gone = less_.back().gone;
      gone.push_back(part.part);
      const std::optional<Model> without = without_all(all, gone);
      if (!without) continue;
      const Trial t = run(*without);
      if (!t.ok()) continue;
      const Effect effect(t.answer, pilot.answer);
      if (size_of(effect) <= room)
        less_.push_back({gone, effect, t.work / std::max(pilot.work, 1.0)});
    }
  }

  // ------------------------------------------------------------------- Step

  /** Each method by two steps. */
  bool try_steps() {
    struct Try {
      const char* method;
      double share;  // of Verlet's largest step
    };
    constexpr Try tries[] = {{"verlet", 0.9}, {"symplectic-euler", 0.9},
                             {"pefrl", 1.3},  {"srkn6b", 2.2},
                             {"tr-bdf2", 8},  {"implicit-euler", 8}};
    Model m = as_pilot(on_grid(base().factor));
    const double verlet = step_of(m) / safe_share;
    auto attempt = [&](const char* method, double dt) {
      m.method = find_method(method);
      m.step = {.dt = std::min(dt, m.t_end)};
      return run(m);
    };
    const Trial exact = attempt("srkn6b", 0.55 * verlet);
    if (!exact.ok()) return refuse(exact.failure);
    reference_ = exact.answer;
    // Explicit methods by counted work: a clock is not that exact.
    const double per_spring = seconds_ / std::max(base().trial.work, 1.0);
    steps_.clear(), advice_.steps.clear();
    for (const Try& t : tries) {
      Step s{find_method(t.method), 0, 0, 0, {}, {}, 1};
      for (int k : {0, 1}) {
        const Trial trial =
            attempt(t.method, k == 0 ? t.share * verlet : s.dt / 2);
        const double seconds = s.method->info.limit == no_limit
                                   ? trial.seconds
                                   : trial.work * per_spring;
        s.works[k] = trial.ok();
        if (s.works[k]) s.effect[k] = Effect(trial.answer, exact.answer);
        if (k == 0) {
          s.dt = trial.dt > 0 ? trial.dt : t.share * verlet;
          s.seconds = seconds, s.work = trial.work;
        }
        advice_.steps.push_back({t.method, k == 0 ? s.dt : s.dt / 2,
                                 s.works[k] ? size_of(s.effect[k]) : infinite,
                                 seconds});
      }
      // The two steps bear the order out, or they don't.
      if (s.works[0] && s.works[1] && size_of(s.effect[0]) > 0) {
        Effect surprise = s.effect[0];
        surprise.add(-std::pow(2, s.method->info.order), s.effect[1].by);
        s.uncertainty = std::clamp(size_of(surprise) / size_of(s.effect[0]),
                                   rules_.uncertainty_of_effects, 1.0);
      }
      steps_.push_back(s);
    }
    return true;
  }

  /** What @a share of the largest step of @a s changes on a grid of @a finer
   * times the cells. Never beyond the largest step: what lies there was not
   * tried. On a finer grid an explicit step is as much smaller. */
  static Effect of_step(const Step& s, double share, double finer) {
    if (s.method->info.limit == no_limit) finer = 1;
    const int k = share == 1 ? 0 : 1;
    return Effect(s.effect[k].by.size())
        .add(std::pow((k + 1) * share / finer, s.method->info.order),
             s.effect[k].by);
  }

  // ----------------------------------------------------------------- Choice

  /** The cheapest of all choices that meets the tolerance. One that does not
   * take long is run and looked at, so that it may be uncertain; a long one
   * must not be. */
  void choose() {
    const Refinement& grids = advice_.grids;
    // A mesh from files is all there is: its step is what can be wrong.
    const Answer limit = scene_.sheets.empty() ? reference_ : grids.limit();
    int runs = 0;
    for (Choice& c : choices()) {
      if (c.work <= rules_.patience && runs < rules_.most_checked) {
        ++runs;
        const Trial t = run(c.model);
        if (!t.ok()) continue;
        c.error = size_of(Effect(t.answer, limit));
        c.uncertainty = grids.uncertainty_of_limit();
        c.seconds = t.seconds;
      } else if (!is_scene(c.model)) {
        continue;
      }
      if (!(c.error + c.uncertainty <= advice_.tolerance)) continue;
      found_ = c;
      return;
    }
    refuse(
        "no method meets the tolerance by steps down to 1/64 of its largest");
  }
  /** False if the nodes of a grid that was not tried miss a pin. */
  static bool is_scene(const Model& m) {
    try {
      Scene scene(m);
      return true;
    } catch (const SceneError&) {
      return false;
    }
  }
  /** True if there is no choice yet; or if no fourth grid bears three out, or
   * much of the tolerance is uncertainty, and a finer grid does not take long.
   */
  bool goes_on() const {
    if (scene_.sheets.empty()) return false;
    if (!found_) return true;
    const GridReport& last = advice_.grids.back();
    return (advice_.grids.size() < 4 ||
            advice_.grids.uncertainty_of_limit() >
                rules_.most_uncertainty * advice_.tolerance) &&
           8 * last.trial.work <= rules_.patience &&
           double(nodes_of(on_grid(2 * last.factor))) <= rules_.most_nodes;
  }
  void take(const Choice& c) {
    advice_.refusal.clear();
    advice_.model = c.model;
    advice_.error = c.error, advice_.uncertainty = c.uncertainty;
    advice_.seconds = c.seconds;
    auto gone = c.gone;  // each of them once, if two parts are alike
    for (PartReport& p : advice_.parts) {
      const auto it = std::ranges::find(gone, p.part);
      p.needed = it == gone.end() && !goes_with_another(p.part, c.gone);
      if (it != gone.end()) gone.erase(it);
    }
  }

  /** All grids, sets of parts, methods and steps of which the effects, added
   * up, are within the tolerance, uncertainties aside: the cheapest first, and
   * of each method on a grid the largest step only. */
  std::vector<Choice> choices() const {
    std::vector<Choice> all;
    for (double factor : factors()) {
      const double finer = factor / base().factor;
      const Effect of_grid = advice_.grids.error(factor);
      // The pilots' own step is in that of the grid; Verlet is of order 2.
      const double pilots = base().trial.dt / (steps_[0].dt / 2) / finer;
      Effect of_pilot(of_grid.by.size());
      if (steps_[0].works[1] && !scene_.sheets.empty())
        of_pilot.add(pilots * pilots, steps_[0].effect[1].by);
      for (auto less = less_.rbegin(); less != less_.rend(); ++less)
        for (const Step& s : steps_)
          for (double share = 1; share > 1 / 64.; share /= std::sqrt(2)) {
            if (!s.works[share == 1 ? 0 : 1]) continue;
            // Below its second step it goes as its order says, if at all.
            if (share < 0.49 && s.uncertainty == 1) break;
            const Effect step = of_step(s, share, finer);
            Effect effect = of_grid;
            effect.add(1, less->effect.by).add(1, step.by).add(-1, of_pilot.by);
            const double error = size_of(effect);
            if (!(error <= advice_.tolerance)) continue;
            const double uncertainty =
                advice_.grids.uncertainty(factor) +
                s.uncertainty * size_of(step) +
                rules_.uncertainty_of_effects *
                    (size_of(less->effect) + size_of(of_pilot));
            const bool shrinks = s.method->info.limit != no_limit;
            const double more =
                less->work / share * std::pow(finer, shrinks ? 3 : 2);
            const auto m = scene_with(factor, *less, s,
                                      s.dt * share / (shrinks ? finer : 1));
            if (!m) continue;
            all.push_back({*m, less->gone, error, uncertainty, s.seconds * more,
                           s.work * more});
            if (error + uncertainty <= advice_.tolerance) break;
          }
    }
    std::ranges::stable_sort(all, {}, &Choice::seconds);
    return all;
  }
  /** With a step of which t-end is a multiple, so that a run ends there. */
  std::optional<Model> scene_with(double factor, const Less& less,
                                  const Step& s, double dt) const {
    std::optional<Model> m = without_all(on_grid(factor), less.gone);
    if (!m) return m;
    m->method = s.method;
    m->step = {.dt = std::min(dt, m->t_end)};
    m->step.dt = step_of(*m);
    return m;
  }
};

}  // namespace

Advice advise(const Model& m, const AdviceRules& rules) {
  return Adviser(m, rules).find();
}

}  // namespace lab
