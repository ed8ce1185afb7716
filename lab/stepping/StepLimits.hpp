#pragma once
/** @file StepLimits.hpp
 * StepLimits: which steps a method can take on a cloth. */
#include <cmath>
#include <optional>

#include "lab/methods/Method.hpp"
#include "lab/scenes/HandForce.hpp"
#include "lab/scenes/Model.hpp"
#include "lab/stability/StepLimit.hpp"

namespace lab {

/** The limits of the step for a cloth in its present state. Keeps references to
 * all arguments of the constructor. The hand adds at most its stiffness,
 * divided by the mass of its node, to omega^2. */
class StepLimits {
 public:
  StepLimits(const Cloth& g, const std::optional<ForcePlan>& force,
             const ConstraintPlan& constraint,
             const std::optional<HandForce>& hand)
      : cloth_(g), force_(force), constraint_(constraint), hand_(hand) {}

  /** The stability limit [s] of @a method for small oscillations about any
   * configuration of the cloth;
   * no_limit if there is none, 0 if no step is stable.
   * Complexity: the first call as omega_safe() */
  double safe(const MethodEntry& method) const;
  /** The same without drag and hand. */
  double safe_without_drag(const MethodEntry& method) const;
  /** The same in the present configuration, by so many @a products of
   * SharpOmega. */
  double sharp(const MethodEntry& method, int products) const;
  /** The longest step with which @a method itself damps little compared to
   * @a drag: mild_step(). */
  double mild(const MethodEntry& method, const Drag& drag, double dt,
              double share) const;
  /** The first step by @a rule, which is not StepRule::fixed.
   * Throws std::invalid_argument if nothing bounds it. */
  double chosen(const MethodEntry& method, StepRule rule) const;

  /** To call after masses, stiffnesses or held nodes have changed. */
  void forget() { safe_omega_ = -1; }
  void archive(Archive& a) {
    a(safe_omega_).require(std::isfinite(safe_omega_));
  }

 private:
  const Cloth& cloth_;
  const std::optional<ForcePlan>& force_;
  const ConstraintPlan& constraint_;
  const std::optional<HandForce>& hand_;
  mutable double safe_omega_ = -1;  // [1/s]; negative: not known yet
  mutable SharpOmega sharp_;

  double safe_omega(const MethodEntry& method) const;
  double with_hand(double omega) const;
  ForcePlan bounding(const MethodEntry& method) const;
};

}  // namespace lab
