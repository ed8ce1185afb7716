#include "lab/advice/Pilots.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>

#include "lab/advice/Variation.hpp"
#include "lab/methods/Methods.hpp"
#include "lab/methods/StiffSplit.hpp"
#include "lab/scenes/Compose.hpp"
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

double StepCosts::of_step(const MethodEntry& method, double dt,
                          double finer) const {
  const MethodInfo& info = method.info;
  const double springs = springs_ * finer * finer;
  if (info.multirate) {
    if (stiff_ == 0) return springs;
    const double stiff = stiff_ * finer * finer;
    return springs + cost_of_filter(stiff) +
           std::ceil(dt * finer / inner_) * cost_of_inner_step(stiff);
  }
  return springs * work_of_step(info, dt * finer / verlet_, side_ * finer);
}

double StepCosts::limit(const MethodInfo& method) const {
  return method.multirate               ? multirate_
         : !std::isnormal(method.limit) ? no_limit  // 0: no step is stable
                                        : verlet_ * method.limit / 2;
}

double StepCosts::step(const Model& m) const {
  if (m.step.fixed()) return m.step.dt;
  const double own = limit(m.method->info);
  return (m.step.rule == StepRule::safe ? safe_share : sharp_share) *
         (own == no_limit ? verlet_ : own);
}

double StepCosts::of_run(const Model& m) const {
  const double dt = step(m);
  return std::isfinite(dt) && dt > 0
             ? of_step(*m.method, dt) * std::ceil(m.t_end / dt)
             : no_limit;
}

double work_of_run(const Model& m) { return StepCosts(m).of_run(m); }

bool Pilots::affords(double work, const std::string& what, double share) {
  const bool fits = work <= share * left();
  if (!fits && std::ranges::find(left_out_, what) == left_out_.end())
    left_out_.push_back(what);
  return fits;
}

Trial Pilots::run(const Model& m, const std::string& doing, double work,
                  const std::vector<std::string>& removed, const Shake& shake,
                  const std::function<void(const Cloth&)>& look,
                  const std::function<void(Scene&)>& after) {
  Key key{{},
          {},
          m.method,
          {m.step.rule, m.step.dt, m.step.gain, m.step.tolerance},
          m.t_end};
  for (const Sheet& s : m.sheets) key.grid.push_back(s.nodes);
  for (const std::string& part : removed)
    if (!goes_with_another(part, removed)) key.removed.push_back(part);
  std::ranges::sort(key.removed);
  const bool keeps = shake.size == 0 && (look || !after);
  const auto known = std::ranges::find(done_, key, &Done::first);
  if (keeps && !look && known != done_.end()) return known->second;
  const double before = spent_;
  spent_ += work;
  const std::string text = known_.empty() ? doing : doing + "; " + known_;
  int steps = 0;
  Trial t;
  try {
    t = try_out(
        m, shake, look ? look : [](const Cloth&) {},
        [&](Scene& scene) {
          if (after) after(scene);
          if (steps++ % 16 == 0)
            tell_(text, std::min(1.0, (before + work * scene.time() / m.t_end) /
                                          budget_));
        });
  } catch (const SceneError& e) {
    t.failure = e.what();
  } catch (const StepError& e) {
    t.failure = e.what();
  } catch (const std::invalid_argument& e) {  // the method, for these forces
    t.failure = e.what();
  }
  if (keeps) done_.emplace_back(key, t);
  return t;
}

}  // namespace lab
