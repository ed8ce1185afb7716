#pragma once
/** @file MollifiedImpulse.hpp
 * The mollified impulse method: for stiff springs in a soft cloth. */
#include <cstdint>
#include <memory>
#include <vector>

#include "lab/fast/FlatFlow.hpp"
#include "lab/methods/ImplicitStage.hpp"
#include "lab/methods/Splitting.hpp"
#include "lab/methods/StiffSplit.hpp"

namespace lab {

class StiffPlaces;

/** Half a kick by the soft forces, which are all but the stiff springs; n
 * Verlet steps of dt/n by the stiff springs alone; half a kick. Only nodes at
 * stiff springs move in these inner steps, all others drift once. So a step
 * takes one force evaluation.
 *
 * Without more, this is the impulse method (r-RESPA), which resonates where dt
 * is near a multiple of half the period of a stiff spring. So the soft forces
 * are taken at averaged positions, and filtered:
 *   a = P M^-1 F(x'),   x' = x + P M^-1 (dt/2)^2 F_s(x),
 *   P = (1 + (dt/2)^2 M^-1 H)^-1,
 * where F is the soft force, F_s that of the stiff springs and H >= 0 their
 * stiffness at x. P leaves motions that are slow compared to dt as they are,
 * and divides one of frequency omega by 1 + (dt omega/2)^2. It takes one sparse
 * factor a step.
 *
 * split_springs() chooses the stiff springs from K/m; an inner step is at most
 * half of Verlet's limit for them. If none is stiff, the method is Verlet, bit
 * by bit. A change of a mass or of K takes effect after restart().
 *
 * Symmetric, drag exact. Conserves linear momentum. Symplectic, and exact in
 * angular momentum, only where H is constant. dt is bounded by the soft part:
 * dt omega < 2 for its frequencies, see soft_stiffness(). Narrow windows of
 * resonance remain, which drag or large motion close: README.md.
 * Source: B. Garcia-Archilla, J. M. Sanz-Serna, R. D. Skeel, SIAM J. Sci.
 * Comput. 20 (1998) 930, doi:10.1137/S1064827596313851; the impulse method: M.
 * Tuckerman, B. J. Berne, G. J. Martyna, J. Chem. Phys. 97 (1992) 1990,
 * doi:10.1063/1.463137. */
class MollifiedImpulse : public BatchMethod {
 public:
  static constexpr MethodInfo info = {
      .name = "mollified-impulse",
      .family = "splitting",
      .color = "#009E73",
      .order = 2,
      .sweeps = 1,
      .limit = 2,
      .multirate = true,
      .cost = {0.996},
      .source = "Garcia-Archilla et al. 1998",
      .good_for = "some stiff springs in a soft cloth: dt by the soft ones",
      .fails_when = "fast motion near its limit; resonance in narrow windows"};
  static constexpr auto* bounding = soft_stiffness;

  MollifiedImpulse();
  int steps(Cloth& g, const StepTimes& times, int count, const ForcePlan& force,
            const ConstraintPlan& constraint) override;
  void restart() override {
    kept_for_ = nullptr, loaded_ = false;
    verlet_.restart();
  }
  void archive(Archive& a, const Cloth& g) override;

  const StiffSplit& split() const { return split_; }
  Work work() const override;

 private:
  Verlet verlet_;  // if there is nothing to split
  FlatFlow flow_;  // its accelerations are by the soft forces, without drag
  StiffSplit split_;
  Cloth stiff_;  // the stiff springs alone; its nodes are split_.nodes
  ForcePlan springs_ = MassSpringForce();
  ForcePlan stiff_force_ = springs_;     // with the drag of these nodes
  std::shared_ptr<StiffPlaces> places_;  // of the held ones
  ConstraintPlan held_;                  // by places_
  Verlet inner_;
  implicit_detail::ImplicitStage stage_;  // of stiff_: has the factor
  std::vector<Point> at_, f_;             // of stiff_, by id
  Drag drag_;
  int multiplicity_ = 0;
  long long inner_done_ = 0;
  const Cloth* kept_for_ = nullptr;  // to which split_ and they belong
  std::uint64_t kept_version_ = 0;
  double kept_time_ = 0, kept_dt_ = 0;
  bool loaded_ = false;  // only the accelerations, kept_time_ and kept_dt_ are

  void find_split(const Cloth& g, const ForcePlan& force,
                  const ConstraintPlan& constraint);
  void one_step(Cloth& g, double t, double dt, bool kept,
                const ForcePlan& force, const ConstraintPlan& constraint);
  void move_stiff(double t, double dt, int count);
  void find_soft(double t, double dt);
  void find_stiff();
};

}  // namespace lab
