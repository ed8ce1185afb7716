#include "lab/methods/AugmentedVerlet.hpp"

#include <cmath>
#include <span>
#include <utility>
#include "lab/fast/GraphArrays.hpp"

namespace lab {

double AugmentedVerlet::step(Cloth& g, double t, double dt,
                             const ForcePlan& force,
                             const ConstraintPlan& constraint) {
  const bool loaded = std::exchange(loaded_dt_, 0) == dt;
  const LaplacianFactor::Scales scales = {0, dt * dt / 4};
  const bool same =
      factor_.find(info.name, g, scales, force, constraint) || loaded;
  dt_ = dt;
  flow_.begin(g, force, true);
  // The same time, however the caller rounds it.
  if (!same || kept_for_ != &g || std::abs(kept_time_ - t) > 1e-6 * dt)
    accelerate(t);
  const std::size_t version = arrays(g).version();
  flow_.run({.t = t + dt,
             .first_kick = dt / 2,
             .drift = dt,
             .held = &constraint,
             .project = &constraint,
             .last = &constraint});
  if (arrays(g).version() != version) {
    flow_.end();  // a stiffness may depend on positions
    factor_.find(info.name, g, scales, force, constraint);
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
  double dt = loaded_dt_ > 0 ? loaded_dt_ : dt_;
  a(acceleration_)(kept_time_)(dt).require(dt > 0 && std::isfinite(dt));
  if (!a.loads()) return;
  flow_.set_kept(g, acceleration_);
  kept_for_ = &g, loaded_dt_ = dt;
}

/** The accelerations (M + (dt^2/4) L)^-1 F of the present state. */
void AugmentedVerlet::accelerate(double t) {
  flow_.run({.t = t, .kick = 0, .keep = true});
  const std::span<const double> mass = factor_.diagonal();
  acceleration_.resize(mass.size());
  for (unsigned i = 0; i < mass.size(); ++i)
    acceleration_[i] = mass[i] * flow_.acceleration(i);
  factor_.solve(acceleration_);
  for (unsigned i = 0; i < mass.size(); ++i)
    flow_.cloth().set_acceleration(i, acceleration_[i]);
}

}  // namespace lab
