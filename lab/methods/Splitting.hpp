#pragma once
/** @file Splitting.hpp
 * Splitting methods: Verlet, Pefrl and Srkn11b are their schemes. */
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "lab/fast/FlatFlow.hpp"
#include "lab/methods/Method.hpp"

namespace lab {

/** A splitting method: alternates two flows over fractions of dt. A moves the
 * positions and applies drag, exactly; B kicks the velocities. Time advances in
 * A. Symmetric and, without drag, symplectic: so the error of the energy stays
 * bounded, and a run can be reversed. */
class Splitting : public BatchMethod {
 public:
  /** @param fractions of dt, in turn of A and B; they outlive this method
   * @param kicks_first whether they begin and end with B: that saves one force
   *        evaluation, as the last kick and the first kick of the next step use
   *        the same force */
  Splitting(std::span<const double> fractions, bool kicks_first)
      : fractions_(fractions), kicks_first_(kicks_first) {}
  int steps(Cloth& g, const StepTimes& times, int count, const ForcePlan& force,
            const ConstraintPlan& constraint) override;
  void restart() override { kept_for_ = nullptr; }
  void archive(Archive& a, const Cloth& g) override;

 private:
  std::span<const double> fractions_;
  bool kicks_first_;
  std::vector<FlatStage> stages_;    // of a batch
  FlatFlow flow_;                    // its accelerations are without drag
  const Cloth* kept_for_ = nullptr;  // the cloth to which they belong
  std::uint64_t kept_version_ = 0;
  double kept_time_ = 0;

  bool kept(const Cloth& g, double t, double dt) const;
  void add_step(double t, double dt, bool kept,
                const ConstraintPlan& constraint);
};
/** @tparam Scheme has info, kicks_first and a static std::array `steps` */
template <typename Scheme>
struct SplittingBy : Splitting {
  static constexpr MethodInfo info = Scheme::info;
  SplittingBy() : Splitting(Scheme::steps, Scheme::kicks_first) {}
};

/** Half a kick, a drift, half a kick. Symplectic Euler is this method with
 * half a kick missing at the start.
 * Source: L. Verlet, Phys. Rev. 159 (1967) 98. */
struct VerletScheme {
  static constexpr MethodInfo info = {
      .name = "verlet",
      .family = "splitting",
      .color = "#0072B2",
      .order = 2,
      .sweeps = 1,
      .limit = 2,
      .cost = {1},
      .source = "Verlet 1967",
      .good_for = "contact, tearing, tolerances down to 1e-3",
      .fails_when = "high accuracy; stiff cloth"};
  static constexpr bool kicks_first = true;
  static constexpr std::array steps = {0.5, 1.0, 0.5};
};
using Verlet = SplittingBy<VerletScheme>;

/** pefrl_step() of methods.hpp. */
struct PefrlScheme {
  static constexpr MethodInfo info = {
      .name = "pefrl",
      .family = "splitting",
      .color = "#D55E00",
      .order = 4,
      .sweeps = 4,
      .limit = 2.9894,
      .cost = {3.07},
      .first_steps = {1.2, 1.2, 1.2, 1.2, 1.2},
      .source = "Omelyan, Mryglod, Folk 2002",
      .good_for = "smooth motion, errors from 1e-3 to 1e-8",
      .fails_when =
          "contact and tearing: no better than verlet, at 4 times the cost"};
  static constexpr bool kicks_first = false;
  static const std::array<double, 9> steps;
};
using Pefrl = SplittingBy<PefrlScheme>;

/** srkn11b_step() of methods.hpp. */
struct Srkn11bScheme {
  static constexpr MethodInfo info = {
      .name = "srkn11b",
      .family = "runge-kutta",
      .color = "#6A8D00",
      .order = 6,
      .sweeps = 11,
      .limit = 9.0736,
      .cost = {7.85},
      .first_steps = {1.8, 2.5, 2.8, 1.8, 2},
      .source = "Blanes, Moan 2002",
      .good_for = "references: errors below 1e-8",
      .fails_when =
          "contact and tearing; near dt omega = pi, 2 pi without drag"};
  static constexpr bool kicks_first = true;
  static const std::array<double, 23> steps;
};
using Srkn11b = SplittingBy<Srkn11bScheme>;

}  // namespace lab
