#include "lab/advice/Pilots.hpp"

#include <algorithm>
#include <cmath>

#include "lab/methods/Costs.hpp"
#include "lab/methods/Methods.hpp"
#include "lab/methods/StiffSplit.hpp"
#include "lab/scenes/SceneFile.hpp"
#include "lab/stepping/Trial.hpp"

namespace lab {

namespace {
// Work of a step with linear solves, measured on cloths of 36 to 1681 nodes
// with 1 to 3000 times Verlet's limit: it grows by this power of the step, and
// is at most so many force evaluations for each node along a side, with which
// Newton's iterations by sparse factorizations are cheaper.
constexpr double more_iterations = 0.6, of_factor = 10;
}  // namespace

StepCosts::StepCosts(const Model& m) {
  Model first = m;
  first.step = {.dt = 1};
  const Scene scene(first);
  springs_ = double(scene.cloth().num_edges());
  factor_ = of_factor * std::sqrt(double(scene.cloth().num_nodes()));
  verlet_ = scene.safe_limit(table::verlet);
  multirate_ = scene.safe_limit(table::mollified_impulse);
  const CombinedConstraints constraint = constraint_of(m, scene.cloth());
  const StiffSplit split = split_springs(scene.cloth(), 1, constraint);
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
  const auto cost =
      std::ranges::find(method_costs, info.name, &MethodCost::method);
  const bool solves = info.limit == no_limit || info.adaptive;
  if (!solves || cost == method_costs.end()) return springs * info.sweeps;
  if (!(cost->at_ten > 0)) return springs * cost->at_limit;
  const double limits = std::max(1.0, dt * finer / verlet_);
  const double grows = cost->at_ten / cost->at_limit;
  double by_step = cost->at_limit * std::pow(grows, std::log10(limits));
  if (limits > 10)
    by_step = cost->at_ten *
              (grows > 1.1 ? std::pow(limits / 10, more_iterations) : 1);
  return springs * std::min(by_step, factor_ * finer);
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
                  const Shake& shake,
                  const std::function<void(const Cloth&)>& look,
                  const std::function<void(Scene&)>& after) {
  const std::string key =
      shake.size > 0 || (after && !look) ? "" : to_scene_file(m);
  if (const auto known = done_.find(key); !look && known != done_.end())
    return known->second;
  const double before = spent_;
  spent_ += work;
  const std::string text = known_.empty() ? doing : doing + "; " + known_;
  int steps = 0;
  try {
    const Trial t = try_out(
        m, shake, look ? look : [](const Cloth&) {},
        [&](Scene& scene) {
          if (after) after(scene);
          if (steps++ % 16 == 0)
            tell_(text, std::min(1.0, (before + work * scene.time() / m.t_end) /
                                          budget_));
        });
    if (!key.empty()) done_.emplace(key, t);
    return t;
  } catch (const std::exception& e) {
    Trial failed;
    failed.failure = e.what();
    return failed;
  }
}

}  // namespace lab
