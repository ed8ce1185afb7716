#pragma once
/** @file Splitting.hpp
 * Splitting methods: Verlet, Yoshida4, Pefrl, Srkn are their schemes. A new
 * scheme needs a line at the end of Splitting.cpp. */
#include <cstdint>
#include <vector>

#include "lab/methods/FlatFlow.hpp"
#include "lab/methods/Method.hpp"

namespace lab {

/** A splitting method: A moves the positions (and lets drag slow the nodes
 * down, exactly), B kicks the velocities, in turn, by fractions of dt. Time
 * runs in A. Symmetric and symplectic (without drag), so energy is bounded and
 * a run can be taken back.
 *
 * @tparam Scheme has the fractions, `constexpr std::array steps`, kicks_first
 *         (whether they begin and end with B) and info. One that begins with B
 *         saves one force evaluation: the last kick's force is that of the
 *         next step's first kick.
 */
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
  const Cloth* kept_for_ = nullptr;  // the cloth at whose state they are
  std::uint64_t kept_version_ = 0;
  double kept_time_ = 0;

  bool kept(const Cloth& g, double t, double dt) const;
  void add_step(double t, double dt, bool kept,
                const ConstraintPlan& constraint);
};

}  // namespace lab
