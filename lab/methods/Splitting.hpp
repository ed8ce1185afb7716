#pragma once
/** @file Splitting.hpp
 * Splitting methods: Verlet, Pefrl and Srkn11b are their schemes. A new
 * scheme needs a line at the end of Splitting.cpp. */
#include <array>
#include <cstdint>
#include <vector>

#include "lab/fast/FlatFlow.hpp"
#include "lab/methods/Method.hpp"

namespace lab {

/** A splitting method: alternates two flows over fractions of dt. A moves the
 * positions and applies drag, exactly; B kicks the velocities. Time advances in
 * A. Symmetric and, without drag, symplectic: so the error of the energy stays
 * bounded, and a run can be reversed.
 *
 * @tparam Scheme has the fractions, a static std::array `steps`, kicks_first
 *         (whether they begin and end with B) and info. A scheme that begins
 *         with B saves one force evaluation: the last kick and the first kick
 *         of the next step use the same force. */
template <typename Scheme>
class Splitting : public BatchMethod {
 public:
  static constexpr MethodInfo info = Scheme::info;

  int steps(Cloth& g, const StepTimes& times, int count, const ForcePlan& force,
            const ConstraintPlan& constraint) override;
  void restart() override { kept_for_ = nullptr; }
  void archive(Archive& a, const Cloth& g) override;

 private:
  static constexpr std::size_t first_drift = Scheme::kicks_first ? 1 : 0,
                               stages_a_step =
                                   (Scheme::steps.size() - first_drift + 1) / 2;
  std::vector<FlatStage> stages_;    // of a batch
  FlatFlow flow_;                    // its accelerations are without drag
  const Cloth* kept_for_ = nullptr;  // the cloth to which they belong
  std::uint64_t kept_version_ = 0;
  double kept_time_ = 0;

  bool kept(const Cloth& g, double t, double dt) const;
  void add_step(double t, double dt, bool kept,
                const ConstraintPlan& constraint);
};

/** Half a kick, a drift, half a kick. Symplectic Euler is this method with
 * half a kick missing at the start.
 * Source: L. Verlet, Phys. Rev. 159 (1967) 98. */
struct VerletScheme {
  static constexpr MethodInfo info = {
      "verlet",
      2,
      1,
      2,
      "Verlet 1967",
      "contact, tearing, tolerances down to 1e-3",
      "high accuracy; stiff cloth"};
  static constexpr bool kicks_first = true;
  static constexpr std::array steps = {0.5, 1.0, 0.5};
};
extern template class Splitting<VerletScheme>;
using Verlet = Splitting<VerletScheme>;

/** pefrl_step() of methods.hpp. */
struct PefrlScheme {
  static constexpr MethodInfo info = {
      "pefrl",
      4,
      4,
      2.9894,
      "Omelyan, Mryglod, Folk 2002",
      "smooth motion, errors from 1e-3 to 1e-8",
      "contact and tearing: no better than verlet, at 4 times the cost"};
  static constexpr bool kicks_first = false;
  static const std::array<double, 9> steps;
};
extern template class Splitting<PefrlScheme>;
using Pefrl = Splitting<PefrlScheme>;

/** srkn11b_step() of methods.hpp. */
struct Srkn11bScheme {
  static constexpr MethodInfo info = {
      "srkn11b",
      6,
      11,
      9.0736,
      "Blanes, Moan 2002",
      "references: errors below 1e-8",
      "contact and tearing; near dt omega = pi, 2 pi without drag"};
  static constexpr bool kicks_first = true;
  static const std::array<double, 23> steps;
};
extern template class Splitting<Srkn11bScheme>;
using Srkn11b = Splitting<Srkn11bScheme>;

}  // namespace lab
