#include "lab/stepping/StepLimits.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>

#include "lab/fast/GraphArrays.hpp"

namespace lab {

double StepLimits::chosen(const MethodEntry& method, StepRule rule) const {
  const std::string name(method.info.name);
  if (method.info.adaptive)
    throw std::invalid_argument(name +
                                " chooses its inner steps by their error: omit "
                                "--dt and give --tolerance");
  double dt = safe_share * safe(method);
  // A cloth released flat becomes 40 % stiffer before StepControl looks again,
  // so the safe limit is never exceeded.
  if (rule == StepRule::sharp)
    dt = std::min(sharp_share * sharp(method, 15), safe(method));
  if (!(dt > 0 && std::isfinite(dt)))
    throw std::invalid_argument(
        name +
        (dt > 0 ? " has no stability limit here" : " has no stable step") +
        ", so no step can be chosen: give --dt a number");
  return dt;
}

double StepLimits::safe(const MethodEntry& method) const {
  return step_limit(method, with_hand(safe_omega(method)),
                    largest_gamma(cloth_, force_->drag()));
}

double StepLimits::safe_without_drag(const MethodEntry& method) const {
  return step_limit(method, safe_omega(method));
}

double StepLimits::sharp(const MethodEntry& method, int products) const {
  return step_limit(
      method,
      with_hand(sharp_(cloth_, bounding(method), constraint_, products)),
      largest_gamma(cloth_, force_->drag()));
}

double StepLimits::mild(const MethodEntry& method, const Drag& drag, double dt,
                        double share) const {
  if (drag.none() || method.bounding) return no_limit;
  return mild_step(method, dt, with_hand(safe_omega(method)),
                   largest_gamma(cloth_, drag), share);
}

double StepLimits::safe_omega(const MethodEntry& method) const {
  if (method.bounding) return omega_safe(cloth_, bounding(method), constraint_);
  if (safe_omega_ < 0) safe_omega_ = omega_safe(cloth_, *force_, constraint_);
  return safe_omega_;
}

/** A bound of omega [1/s] with the hand, where @a omega is one without. */
double StepLimits::with_hand(double omega) const {
  if (!hand_ || !arrays(cloth_).node_in_use(hand_->node())) return omega;
  const double m = arrays(cloth_).node_values()[hand_->node()].mass;
  return std::sqrt(omega * omega + hand_->stiffness() / m);
}

/** The force whose stiffness bounds the step of @a method. */
ForcePlan StepLimits::bounding(const MethodEntry& method) const {
  return method.bounding ? method.bounding(cloth_, *force_, constraint_)
                         : *force_;
}

}  // namespace lab
