#pragma once
/** @file SymplecticEuler.hpp
 * The assignment's step as a method. */
#include "lab/fast/FlatFlow.hpp"
#include "lab/methods/Method.hpp"

namespace lab {

/** The assignment's step as a method, for speed: all forces in one sweep.
 * Equal to symp_euler_step() with a constraint, to round-off: as there, drag is
 * a force like others, and force and constraint are called with t. */
class SymplecticEuler : public BatchMethod {
 public:
  static constexpr MethodInfo info = {
      .name = "symplectic-euler",
      .family = "splitting",
      .color = "#000000",
      .order = 1,
      .sweeps = 1,
      .limit = 2,
      .cost = {0.967},
      .first_steps = {0.5, 0.5, 1, 0.5, 1},
      .source = "the assignment",
      .good_for = "a first look; energy stays bounded",
      .fails_when = "accuracy: verlet costs the same"};

  int steps(Cloth& g, const StepTimes& times, int count, const ForcePlan& force,
            const ConstraintPlan& constraint) override;

 private:
  FlatFlow flow_;
  std::vector<FlatStage> stages_;  // of a batch
};

}  // namespace lab
