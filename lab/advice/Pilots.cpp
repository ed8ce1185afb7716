#include "lab/advice/Pilots.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "lab/advice/Advice.hpp"
#include "lab/advice/Constants.hpp"
#include "lab/advice/Variation.hpp"
#include "lab/methods/Methods.hpp"
#include "lab/methods/StiffSplit.hpp"
#include "lab/scenes/Compose.hpp"
#include "lab/scenes/Fields.hpp"
#include "lab/scenes/Warnings.hpp"
#include "lab/stepping/StepLimits.hpp"

namespace lab {

StepCosts::StepCosts(const Model& m) {
  const Net mesh = mesh_of(m);
  Cloth g;
  build_model(g, m, mesh);
  const CombinedConstraints constraints = constraint_of(m, mesh, g);
  const ConstraintPlan constraint = constraints;
  const std::optional<ForcePlan> force = force_of(m, mesh, g);
  const std::optional<HandForce> no_hand;
  const StepLimits limits(g, force, constraint, no_hand);
  springs_ = double(g.num_edges());
  side_ = std::sqrt(double(g.num_nodes()));
  verlet_ = limits.safe(table::verlet);
  multirate_ = limits.safe(table::mollified_impulse);
  const StiffSplit split = split_springs(g, 1, constraint);
  stiff_ = double(split.springs.size());
  if (!split.empty()) inner_ = split.inner_step();
}

double StepCosts::limit(const MethodInfo& method) const {
  return method.multirate               ? multirate_
         : !std::isnormal(method.limit) ? no_limit  // 0: no step is stable
                                        : verlet_ * method.limit / 2;
}

double StepCosts::of_stable(const Model& m) const {
  const double largest = limit(m.method->info);
  return largest == no_limit ? 0 : m.step.dt / largest;
}

double StepCosts::of_run(const Model& m) const {
  const MethodInfo& info = m.method->info;
  const double own = limit(info),
               share = m.step.rule == StepRule::safe ? safe_share : sharp_share,
               dt = m.step.fixed() ? m.step.dt
                                   : share * (own == no_limit ? verlet_ : own);
  if (!(std::isfinite(dt) && dt > 0)) return no_limit;
  double a_step = springs_;
  if (!info.multirate)
    a_step *= work_of_step(info, dt / verlet_, side_);
  else if (stiff_ > 0)
    a_step += cost_of_filter(stiff_) +
              std::ceil(dt / inner_) * cost_of_inner_step(stiff_);
  return a_step * std::ceil(m.t_end / dt);
}

double work_of_run(const Model& m) { return StepCosts(m).of_run(m); }

double work_at_rest(const Model& m) {
  Cloth g;
  build_model(g, m, mesh_of(m));
  return constant.rest_factors * factor_sweeps(g) * double(g.num_edges());
}

std::optional<StepCosts> costs_of(const Model& m, std::string* why) {
  try {
    return StepCosts(m);
  } catch (const SceneError& e) {
    if (why) *why = e.what();
    return {};
  }
}

namespace {
void add_once(std::vector<std::string>& all, const std::string& text) {
  if (std::ranges::find(all, text) == all.end()) all.push_back(text);
}
}  // namespace

bool Pilots::affords(double work, const std::string& what, double share) {
  const bool fits = work <= share * left();
  if (!fits) add_once(left_out_, what);
  return fits;
}

Trial Pilots::run(const Model& m, const std::string& doing, double work,
                  const std::vector<std::string>& removed, const Shake& shake,
                  const std::function<void(const Cloth&)>& look) {
  const auto& [dt, rule, gain, tolerance] = m.step;
  Key key{{}, {}, m.method, rule, dt, gain, tolerance, m.t_end};
  for (const Sheet& s : m.sheets) get<0>(key).push_back(s.nodes);
  for (const std::string& part : removed)
    if (!goes_with_another(part, removed)) get<1>(key).push_back(part);
  std::ranges::sort(get<1>(key));
  const bool keeps = shake.size == 0;
  const auto known =
      std::ranges::find(done_, key, &std::pair<Key, Trial>::first);
  if (keeps && !look && known != done_.end()) return known->second;
  const double before = spent_;
  spent_ += work;
  const std::string text = known_.empty() ? doing : doing + "; " + known_;
  int steps = 0;
  Trial t;
  auto is_impossible = [&](const std::exception& e) {
    t.failure = e.what();
    add_once(impossible_, *t.failure);
  };
  try {
    t = try_out(
        m, shake, look ? look : [](const Cloth&) {},
        [&](Scene& scene) {
          if (steps++ % 16 == 0)
            tell_(text, std::min(1.0, (before + work * scene.time() / m.t_end) /
                                          budget_));
        });
  } catch (const SceneError& e) {
    is_impossible(e);
  } catch (const std::invalid_argument& e) {
    is_impossible(e);
  }
  if (keeps) done_.emplace_back(key, t);
  return t;
}

/** The warnings before a run of @a m. */
static std::vector<std::string> warnings_of(const Model& m) {
  const Scene scene(m);
  return warnings(m, scene.mesh().mesh, scene.cloth(), scene.dt());
}

std::string Pilots::warning_of(const Model& m, const Model& scene,
                               double work) {
  const auto [known, is_new] = warnings_.try_emplace(as_options(m));
  std::string& said = known->second;
  if (!is_new) return said;
  spent_ += 3 * work;
  Model printed = m;  // numbers have fewer digits there
  for (const Field& f : fields_of(printed))
    if (const auto words = f.values(); !words.empty() && words[0] != "")
      set_field(printed, f.name, words);
  if (const auto all = warnings_of(printed);
      !all.empty() && all.size() > warnings_of(scene).size())
    return said = all.back();
  Scene run(printed);
  Observer observer(run);
  run.watch(printed.t_end);
  tell_("what its run would warn of", std::min(1., spent_ / budget_));
  if (!run.run_to(printed.t_end, observer.after_steps()))
    return said = text_of(run.failure());
  if (run.watched().count() > 0) return said = run.missed_text();
  const Verdict& verdict = run.witness()->verdict(&observer);
  if (!verdict.fine())
    said = verdict.wrong() ? verdict.wrong_text() : verdict.difference();
  return said;
}

}  // namespace lab
