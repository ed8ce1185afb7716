#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include "CME212/Util.hpp"
#include "lab/advice/Adviser.hpp"
#include "lab/advice/Refusals.hpp"
#include "lab/methods/Methods.hpp"
#include "lab/stepping/Trial.hpp"

namespace lab {

Model as_pilot(Model m) {
  m.method = &table::verlet;
  m.step = {.rule = StepRule::safe};
  return m;
}

namespace adviser_detail {

namespace {
double work_or_0(const Model& m) {
  const double work = work_of_run(m);
  return std::isfinite(work) ? work : 0;
}

/** Every quantity of a cloth at the end; empty where @a m has none. */
std::vector<Answer> all_answers(const Model& m, const Cloth& g) {
  std::vector<Answer> all;
  for (int k = 0; k < Measure::pin_force; ++k) {
    const Measure what = Measure::Quantity(k);
    all.push_back(can_answer(m, what) ? answer(m, g, what) : Answer());
  }
  return all;
}
}  // namespace

Adviser::Adviser(const Model& m, const AdviceRules& rules, bool assesses)
    : scene_(m),
      rules_(rules),
      run_work_(work_or_0(m)),
      pilots_(rules.budget > 0
                  ? rules.budget
                  : std::max(AdviceRules::usual,
                             (from_files() || assesses ? 8 : 1) * run_work_),
              rules.tell) {
  if (!(rules_.most_nodes > 0))
    rules_.most_nodes = std::max(AdviceRules::usual, pilots_.budget()) / 1e4;
  advice_.measure = m.measure;
  advice_.tolerance = m.tolerance;
  advice_.grids = Refinement(advice_.measure);
  advice_.t_end = m.t_end;
  advice_.from_files = from_files();
}

Advice Adviser::find() {
  check();
  const CME212::Clock clock;
  choose_pilots();
  const bool kept = rules_.keeps_method || rules_.keeps_step;
  bool calm = true;
  while (add_grid()) {
    const auto& grids = advice_.grids;
    if (grids.size() < fewest() || too_uncertain()) {
      if (found_) break;  // it stays
      if (grids.size() < fewest() + 2) continue;
      calm = look_for_chaos(0);
      if (!calm || hopeless()) break;
      continue;
    }
    std::size_t base = 0;
    while (base + 1 < grids.size() &&
           !(grids[base].error <= 2 * advice_.tolerance))
      ++base;
    if (base_ != base) {
      // All runs of a mesh are long, so its parts and steps come afterwards.
      if (from_files() && base_ == no_base) calm = look_for_chaos(0);
      if (!calm) break;
      base_ = base;
      find_parts();
      find_rest();
    }
    choose();
    if (found_ ? !may_go_on() : (from_files() || kept) && is_certain()) break;
  }
  calm = calm && advice_.tolerance > 0;
  if (!found_ && calm && !pilots_.left_out().empty()) foresee();
  if (!found_ && advice_.refusal.empty())
    refuse(kept ? std::string("no step of ") + scene_.method->info.name +
                      " that was tried meets the tolerance"
                : "no method meets the tolerance with the steps that were "
                  "tried: the smallest was 1/8 of the largest stable one");
  // Chaos may be why nothing was found.
  if (calm && !seen_.empty() &&
      (from_files() || look_for_chaos(found_ ? found_->scatter : 0)) &&
      found_) {
    try_squares();
    take(*found_);
  }
  end(clock);
  return advice_;
}

void Adviser::end(const CME212::Clock& clock) {
  advice_.trivial = trivial();
  advice_.left_out = pilots_.left_out();
  advice_.spent_work = pilots_.spent(), advice_.budget = pilots_.budget();
  advice_.spent = clock.seconds();
}

void Adviser::check() const {
  check_question(scene_);
  if (!(scene_.t_end > 0))
    throw SceneError("t-end", "is 0, expected a time to simulate");
}

// ---------------------------------------------------------------------- Grids

double Adviser::factor(int level) {
  const int two = level >= 0 ? level / 2 : (level - 1) / 2;
  return std::pow(2, two) * (level - 2 * two == 1 ? 1.5 : 1);
}

double Adviser::cells(double factor, int side) const {
  double most = 0;
  for (const Sheet& s : scene_.sheets)
    most =
        std::max(most, std::round((s.nodes[std::size_t(side)] - 1) * factor));
  return std::max(2., most);
}

double Adviser::over(const Model& m) const {
  if (from_files())
    return seen_.empty() ? 1 : step_of(seen_[0].model) / step_of(m);
  auto count = [](const Model& m) {
    double all = 0;
    for (const Sheet& s : m.sheets)
      all += double(s.nodes[0] - 1) * (s.nodes[1] - 1);
    return all;
  };
  return std::sqrt(count(m) / count(scene_));
}

Model Adviser::pilot(Model m, double factor) const {
  m.method = method_->method;
  m.step = method_->step;
  if (from_files()) m.step = {.dt = step_of(m)};
  if (m.step.fixed()) m.step.dt = std::min(m.step.dt / factor, m.t_end);
  return m;
}

void Adviser::choose_pilots() {
  // A grid of some 8 cells along the shortest side stands for those to come.
  double shortest = infinite;
  for (const Sheet& s : scene_.sheets)
    for (unsigned n : s.nodes) shortest = std::min(shortest, n - 1.);
  while (shortest * factor(first_level_) > 2 && !from_files()) --first_level_;
  level_ = first_level_;
  const double some = from_files() ? 1 : factor(first_level_ + 4);
  method_ = as_pilot(scene_);
  try {
    const Model on = on_grid(all_sides(some, some));
    const StepCosts costs(on);
    double least = costs.of_run(pilot(on, some));
    if (!(least > rules_.stiff)) return;
    least /= 2;
    for (const MethodEntry* method :
         {&table::mollified_impulse, &table::tr_bdf2}) {
      const std::optional<Model> before = method_;
      method_->method = method;
      if (method_->method->info.limit == no_limit)
        method_->step = {.dt = scene_.t_end / 50 * some};  // over the cells
      if (const double work = costs.of_run(pilot(on, some)); work < least)
        least = work;
      else
        method_ = before;
    }
  } catch (const SceneError&) {  // that grid misses a pin
  }
}

bool Adviser::add_grid() {
  auto& grids = advice_.grids;
  for (;; ++level_) {
    Seen seen{{}, Track(scene_.t_end, 1), on_level(level_), 0};
    const std::size_t nodes = nodes_of(seen.model);
    const std::string on = (from_files() ? "the mesh of " : "a grid of ") +
                           std::to_string(nodes) + " nodes";
    if (!from_files() && double(nodes) > rules_.most_nodes)
      return refuse(on + " would be too large" +
                    (grids.empty() ? "" : ": " + so_far()));
    Trial t;
    try {
      seen.model = pilot(seen.model, factor(level_));
      if (!grids.empty() && !(over(seen.model) > grids.back().factor)) continue;
      seen.track = Track(scene_.t_end, nodes);
      seen.work = work_of_run(seen.model);
      if (from_files() && rules_.budget == 0) pilots_.allow(8 * seen.work);
      if (!pilots_.affords(seen.work,
                           from_files() ? "smaller steps" : "a finer grid",
                           grids.size() < fewest() ? 1 : 0.7))
        return refuse(over_budget(seen.work));
      const Model& m = seen.model;
      t = pilots_.run(
          m, on, seen.work, {},
          [&](const Cloth& g) {
            seen.all = all_answers(m, g);
            find_plane(g);
          },
          [&](Scene& scene) { seen.track.look(scene); });
      invalid_ = 0;
    } catch (const SceneError& e) {
      // Between the cells of the scene a pin may hold no node.
      if (++invalid_ > 3 && level_ > 0)
        return refuse("on " + on + ": " + e.what());
      continue;
    }
    if (!t.ok()) {
      if (level_ >= 0 || from_files())
        return refuse("on " + on + ": " + t.failure);
      // It is too coarse to carry the load.
      grids.clear(), seen_.clear(), levels_.clear(), base_ = no_base;
      continue;
    }
    seen_.push_back(seen);
    levels_.push_back(level_++);
    grids.add({over(seen.model), nodes, infinite, t,
               seen.work / std::max(1.0, springs_of(seen.model))});
    break;
  }
  limit_ = grids.limit();
  if (grids.size() > 2) {
    uncertainty_ = grids.uncertainty();
    if (!know_tolerance()) return false;
    pilots_.knows(so_far());
    if (!grids.converges(advice_.tolerance / 10))
      if (const std::string why = diverging(scene_); !why.empty())
        return refuse(why);
  }
  return true;
}

bool Adviser::may_go_on() const {
  const Model next = on_level(level_);
  return !from_files() && !is_certain() &&
         double(nodes_of(next)) <= rules_.most_nodes &&
         seen_.back().work * 3 <= std::max(rules_.patience, 0.3 * run_work_) &&
         seen_.back().work * 3 <= 0.5 * pilots_.left();
}

bool Adviser::hopeless() {
  // By order 2 at best, the uncertainty falls with the square of the cells.
  const double work = seen_.back().work, power = from_files() ? 1 : 3,
               finer = std::pow(std::max(1., 0.7 * pilots_.left() / work),
                                1 / power),
               needed = std::sqrt(uncertainty_ / advice_.tolerance /
                                  rules_.most_uncertain);
  if (finer >= needed) return false;
  refuse(over_budget(work * std::pow(needed, power)));
  return true;
}

std::string Adviser::so_far() const {
  const auto& grids = advice_.grids;
  if (grids.size() < fewest())
    return CME212::count_of(grids.size(), from_files() ? "step" : "grid") +
           (grids.size() == 1 ? " is" : " are") +
           " not enough to estimate an error";
  const std::string name = name_of(advice_.measure),
                    limit = with_unit(uncertainty_, advice_.measure),
                    asked = ' ' + lab::asked(advice_);
  if (too_uncertain())
    return "uncertainty is the reason: the limit of " + name +
           (from_files() ? " by smaller steps" : " on finer grids") +
           " is known only to +- " + limit + asked;
  return "the error of " + name +
         (from_files()
              ? " by the smallest step"
              : " on " + std::to_string(grids.back().nodes) + " nodes") +
         " is " + with_unit(grids.back().error, advice_.measure) + " +- " +
         limit + asked;
}

std::string Adviser::over_budget(double work) const {
  const double more =
      std::max(2 * pilots_.budget(), pilots_.spent() + 3 * work);
  return "the budget ended" +
         (advice_.grids.empty() ? std::string(" before the first grid")
                                : ": " + so_far()) +
         "; --advise-work " + CME212::two_digits(more) + " would continue" +
         (advice_.grids.size() < 3 ? "" : converging_slowly(scene_));
}

Answer Adviser::answer_at_start() const {
  const Model& m = seen_.back().model;
  const Scene start(m);
  return Observer(m, start).answer(m, start);
}

bool Adviser::know_tolerance() {
  if (!scene_.percent) return true;
  const auto what = advice_.measure.quantity;
  const bool itself = what == Measure::max_stretch ||
                      what == Measure::pin_force || what == Measure::tear_time;
  const double whole = size_of(itself ? Effect(limit_.size()).add(1, limit_)
                                      : Effect(limit_, answer_at_start()));
  advice_.tolerance = whole > 1e-9 ? scene_.tolerance / 100 * whole : 0;
  advice_.share = CME212::short_text(scene_.tolerance) + " % of " +
                  (itself ? "the answer" : "the change since t = 0");
  return advice_.tolerance > 0 || refuse(advice_.share +
                                         ", but that is 0: expected a "
                                         "tolerance with its unit");
}

std::string Adviser::trivial() const {
  const std::string name = name_of(advice_.measure);
  if (scene_.measure.quantity == Measure::energy && scene_.conserves_energy())
    return "nothing changes the energy of this scene: any grid and any step "
           "keeps its initial value";
  if (seen_.empty() || limit_.empty()) return "";
  const Answer at_start = answer_at_start();
  if (at_start.empty()) return "";
  const double change = distance(at_start, limit_, advice_.measure);
  if (!(change + uncertainty_ <= advice_.tolerance)) return "";
  return name + " changes by only " + with_unit(change, advice_.measure) +
         " until the end, which is less than the tolerance: its initial value "
         "is an answer";
}

// ---------------------------------------------------------------------- Chaos

/** The end time, as text, until which perturbed starts stay close enough. Only
 * for measures in meters, which change at most by as much as positions do. */
std::string Adviser::same_until(const Separation& apart) const {
  const bool in_meters = unit_of(advice_.measure) == std::string("m");
  const double horizon = apart.horizon(advice_.tolerance / 2);
  if (!in_meters || !(horizon > 0) || horizon >= scene_.t_end) return "";
  return ", of up to " + CME212::short_text(horizon) + " s";
}

void Adviser::find_plane(const Cloth& g) {
  for (unsigned k = 0; k < 3; ++k)
    shake_.along[k] = std::ranges::any_of(g.nodes(), [&, k](Node n) {
      return n.position()[k] != g.node(0).position()[k] ||
             n.value().vel[k] != 0;
    });
}

bool Adviser::look_for_chaos(double scatter) {
  std::size_t k = seen_.size() - 1;
  while (k > 0 && advice_.grids[k].factor > 0.55 * advice_.grids.back().factor)
    --k;
  const Seen& seen = seen_[k];
  std::vector<Answer> shaken;
  Track track = seen.track.beside();
  const Model& m = seen.model;
  if (pilots_.affords(seen.work, "perturbed starts")) {
    const Trial t = pilots_.run(
        m, "a perturbed start", seen.work, shake_,
        [&](const Cloth& g) { shaken = all_answers(m, g); },
        [&](Scene& scene) { track.look(scene); });
    if (!t.ok()) return refuse(t.failure);
    ++advice_.perturbed;
    scatter = std::max(scatter, distance(advice_.grids[k].trial.answer,
                                         t.answer, advice_.measure));
  }
  advice_.scatter = scatter;
  if (scatter <= advice_.tolerance / 2) {
    find_buckling(m, seen.work, advice_.grids[k].trial.answer);
    return true;
  }
  // Less than ten times the shake is not chaos, but the shake itself.
  return refuse(
      (scatter > 10 * shake_.size
           ? "the motion is chaotic: "
           : std::string("the tolerance is too small: ")) +
      "runs that should agree, with the start moved by 1e-6 m or with a "
      "slightly shorter step, differ by " +
      with_unit(scatter, advice_.measure) +
      ", so no grid and no step can meet the tolerance; " +
      offers(seen.model, seen.all, shaken) +
      same_until(Separation(seen.track, track)));
}

void Adviser::find_buckling(const Model& m, double work, const Answer& plane) {
  const auto along = std::ranges::find(shake_.along, false);
  if (along == shake_.along.end() ||
      !pilots_.affords(work, "a start moved out of its plane", 0.3))
    return;
  const Trial t = pilots_.run(m, "out of its plane", work, {shake_.size});
  const double off =
      t.ok() ? distance(t.answer, plane, advice_.measure) : infinite;
  if (off > advice_.tolerance / 2)
    advice_.buckles = std::string("no node ever leaves its plane along ") +
                      "xyz"[along - shake_.along.begin()] +
                      ", but the cloth buckles: " +
                      (t.ok() ? name_of(advice_.measure) + " changes by " +
                                    with_unit(off, advice_.measure)
                              : t.failure) +
                      " if its start is moved out of that plane by 1e-6 m";
}

double Adviser::perturb(const Choice& c) {
  double most = 0;
  auto look = [&](const Model& m, const Shake& shake, const Answer& expected) {
    if (!pilots_.affords(c.work, "perturbed starts")) return;
    const Trial t = pilots_.run(m, "the advised run, perturbed", c.work, shake);
    if (!t.ok()) return;
    ++advice_.perturbed;
    most = std::max(most, distance(t.answer, expected, advice_.measure));
  };
  for (unsigned seed : {2, 3, 4})
    look(c.model, {(seed - 1) * shake_.size, seed, shake_.along}, c.answer);
  Model other = c.model;
  other.step.dt *= 0.8;
  other.step.dt = step_of(other);
  const double p = c.model.method->info.order,
               way = (1 - std::pow(other.step.dt / c.model.step.dt, p)) /
                     (1 - std::pow(0.5, p));
  Effect expected(c.answer.size());
  expected.add(1 - way, c.answer).add(way, c.half);
  look(other, {}, expected.by);
  return most;
}

void Adviser::try_squares() {
  const double f = factor(levels_.back());
  Sides s = all_sides(f, f);
  double longest = 1;
  for (std::size_t k = 0; k < s.size(); ++k) {
    const Sheet& sheet = scene_.sheets[k];
    const double ratio = norm(sheet.u) / (sheet.nodes[0] - 1.) /
                         (norm(sheet.v) / (sheet.nodes[1] - 1.));
    s[k] = {f * std::sqrt(ratio), f / std::sqrt(ratio)};
    for (unsigned along : {0, 1})  // a grid has at least 2 cells
      if ((sheet.nodes[along] - 1) * s[k][along] < 1.5) return;
    longest = std::max({longest, ratio, 1 / ratio});
  }
  if (!(longest > 1.2) ||
      !pilots_.affords(longest * seen_.back().work, "square cells", 0.5))
    return;
  try {
    const Model m = pilot(on_grid(s), f * std::sqrt(longest));
    const Trial t = pilots_.run(m, "on square cells", work_of_run(m));
    if (!t.ok()) return;
    const double off =
        distance(t.answer, advice_.grids.back().trial.answer, advice_.measure);
    if (off > advice_.tolerance / 2)
      advice_.oblong =
          "springs along oblong cells are another material: on "
          "square cells " +
          name_of(advice_.measure) + " changes by " +
          with_unit(off, advice_.measure);
  } catch (const SceneError&) {  // that grid misses a pin
  }
}

void Adviser::take(const Choice& c) {
  advice_.refusal.clear();
  static_cast<AdvisedRun&>(advice_) = c;
  advice_.evaluations = c.work / std::max(1.0, springs_of(c.model));
  if (const double limit = StepCosts(c.model).limit(c.model.method->info);
      limit != no_limit)
    advice_.of_stable = c.model.step.dt / limit;
  auto removed = c.removed;  // two equal parts are counted one by one
  for (PartReport& p : advice_.parts) {
    const auto it = std::ranges::find(removed, p.part);
    p.needed = it == removed.end() && !goes_with_another(p.part, c.removed);
    if (it != removed.end()) removed.erase(it);
  }
}

}  // namespace adviser_detail

Advice advise(const Model& m, const AdviceRules& rules) {
  return adviser_detail::Adviser(m, rules).find();
}

}  // namespace lab
