#include "lab/methods/AugmentedVerlet.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "CME212/Util.hpp"
#include "lab/methods/ImplicitStage.hpp"

namespace lab {

double AugmentedVerlet::step(Cloth& g, double t, double dt,
                             const ForcePlan& force,
                             const ConstraintPlan& constraint) {
  const bool loaded = std::exchange(loaded_dt_, 0) == dt;
  const bool same = find_factor(g, dt, force, constraint) || loaded;
  flow_.begin(g, force, true);
  // The same time, however the caller rounds it.
  if (!same || kept_for_ != &g || std::abs(kept_time_ - t) > 1e-6 * dt)
    accelerate(t);
  const std::size_t version = g.version();
  flow_.run({.t = t + dt,
             .first_kick = dt / 2,
             .drift = dt,
             .held = &constraint,
             .project = &constraint,
             .last = &constraint});
  if (g.version() != version) {
    flow_.end();  // a stiffness may depend on positions
    find_factor(g, dt, force, constraint);
  }
  accelerate(t + dt);
  flow_.run({.t = t + dt, .first_kick = dt / 2});
  flow_.end();
  kept_for_ = &g, kept_time_ = t + dt;
  return t + dt;
}

void AugmentedVerlet::archive(Archive& a, const Cloth& g) {
  bool has = kept_for_ == &g;
  a(has);
  if (!has) return restart();
  double dt = loaded_dt_ > 0 ? loaded_dt_ : key_.dt;
  a(acceleration_)(kept_time_)(dt).require(dt > 0 && std::isfinite(dt));
  if (!a.loads()) return;
  flow_.set_kept(g, acceleration_);
  kept_for_ = &g, loaded_dt_ = dt;
}

/** True if key_ is still right: compares arrays, without asking the forces.
 * @post held_ are the held nodes */
bool AugmentedVerlet::unchanged(const Cloth& g, double dt,
                                const ForcePlan& force,
                                const ConstraintPlan& constraint) {
  held_.clear();
  constraint.each_held(g, [this](Node n) { held_.push_back(n.id()); });
  if (dt != key_.dt || !source_.springs ||
      force.spring_multiplicity() != source_.springs || &g != source_.cloth ||
      g.version() != source_.version || held_ != source_.held)
    return false;
  auto node = g.node_values();
  auto spring = g.edge_values();
  bool same = true;
  for (unsigned i = 0; i < node.size(); ++i)
    same &= node[i].mass == key_.mass[i];
  for (unsigned e = 0; e < spring.size(); ++e)
    same &= spring[e].K == source_.K[e];
  return same;
}

/** Make factor_ that of @a g.  @return true if it was already */
bool AugmentedVerlet::find_factor(const Cloth& g, double dt,
                                  const ForcePlan& force,
                                  const ConstraintPlan& constraint) {
  if (unchanged(g, dt, force, constraint)) return true;
  source_.springs = force.spring_multiplicity();
  source_.cloth = &g, source_.version = g.version();
  source_.held = held_;
  source_.K.clear();
  for (const EdgeData& spring : g.edge_values()) source_.K.push_back(spring.K);
  next_.dt = dt;
  implicit_detail::find_fixed(g, constraint, next_.fixed);
  next_.mass.clear();
  for (const NodeData& node : g.node_values()) next_.mass.push_back(node.mass);
  next_.springs.clear();
  implicit_detail::add_stiffness(
      info.name, force, g, [this](unsigned i, unsigned j, const Stiffness& B) {
        double K = std::max({0.0, B.along, B.across});
        if (K > 0) next_.springs.push_back({i, j, K});
      });
  if (next_ == key_) return true;
  std::swap(key_, next_);
  factorize();
  return false;
}

/** Factor M + (dt^2/4) L. Its rows are node ids, so fixed nodes have rows, too:
 * those of the unit matrix. */
void AugmentedVerlet::factorize() {
  ++factorizations_;
  constexpr std::size_t most = 100'000'000;  // entries, of 24 bytes
  const double h2 = key_.dt * key_.dt / 4;
  const auto& fixed = key_.fixed;
  const auto rows = unsigned(fixed.size());
  std::vector<SparseCholesky<double>::Pair> pairs;
  for (const auto& [i, j, K] : key_.springs)
    if (!fixed[i] && !fixed[j]) pairs.push_back({i, j});
  bool good = factor_.analyze(rows, pairs, most);
  if (good) {
    factor_.clear();
    for (unsigned i = 0; i < rows; ++i)
      factor_.add_diagonal(i, fixed[i] ? 1 : key_.mass[i]);
    std::size_t pair = 0;
    for (const auto& [i, j, K] : key_.springs) {
      if (!fixed[i]) factor_.add_diagonal(i, h2 * K);
      if (!fixed[j]) factor_.add_diagonal(j, h2 * K);
      if (!fixed[i] && !fixed[j]) factor_.add(pair++, -h2 * K);
    }
    good = factor_.factorize();
  }
  if (good) return;
  key_ = {}, source_ = {};
  throw StepError(std::string(info.name) +
                  ": the matrix of masses can't be factored; dt = " +
                  CME212::short_text(key_.dt) + " s");
}

/** The accelerations (M + (dt^2/4) L)^-1 F of the present state. */
void AugmentedVerlet::accelerate(double t) {
  flow_.run({.t = t, .kick = 0, .keep = true});
  const unsigned n = unsigned(key_.fixed.size());
  acceleration_.resize(n);
  for (unsigned i = 0; i < n; ++i)
    acceleration_[i] =
        key_.fixed[i] ? Point() : key_.mass[i] * flow_.acceleration(i);
  factor_.solve({acceleration_.data(), factor_.rows()});
  for (unsigned i = 0; i < n; ++i)
    flow_.cloth().set_acceleration(i, acceleration_[i]);
}

}  // namespace lab
