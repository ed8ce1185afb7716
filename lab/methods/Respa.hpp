#pragma once
/** @file Respa.hpp
 * r-RESPA: a multirate method, for a few stiff springs in a soft cloth. */
#include <cstdint>
#include <vector>

#include "lab/methods/FlatFlow.hpp"
#include "lab/methods/StiffSplit.hpp"
#include "lab/methods/Verlet.hpp"

namespace lab {

/** The reversible reference system propagator algorithm, or impulse method:
 * half a kick by all forces but the stiff springs; n Verlet steps of dt/n by
 * the stiff springs alone; half a kick. Only nodes at stiff springs move in the
 * inner steps, all others drift once. So a step takes one force evaluation.
 *
 * split_springs() chooses the stiff springs from K/m; n is the least number for
 * which dt/n is at most a quarter of Verlet's limit for them. If all springs
 * are alike, none is stiff, and the method is Verlet, bit by bit. A change of K
 * takes effect after restart().
 *
 * Symmetric, symplectic, drag exact, as Splitting. dt is bounded by the soft
 * part: dt omega < 2 for its frequencies, see soft_stiffness(). Below that it
 * has resonances with the stiff springs: Resonance.hpp.
 * Source: M. Tuckerman, B. J. Berne, G. J. Martyna, J. Chem. Phys. 97 (1992)
 * 1990, doi:10.1063/1.463137; the resonances: J. A. Izaguirre, S. Reich, R. D.
 * Skeel, J. Chem. Phys. 110 (1999) 9853, doi:10.1063/1.478995. */
class Respa : public BatchMethod {
 public:
  static constexpr MethodInfo info = {
      "respa",
      2,
      1,
      2,
      "Tuckerman, Berne, Martyna 1992",
      "a few stiff springs in a soft cloth: dt by the soft ones",
      "resonance: dt near half periods of a stiff spring, without drag",
      false,
      true};

  int steps(Cloth& g, const StepTimes& times, int count, const ForcePlan& force,
            const ConstraintPlan& constraint) override;
  void restart() override {
    kept_for_ = nullptr, loaded_ = false;
    verlet_.restart();
  }
  void archive(Archive& a, const Cloth& g) override;

  /** The stiff springs and the n of the last step. */
  const StiffSplit& split() const { return split_; }
  int inner_steps() const { return inner_steps_; }
  Work work() const override { return {.inner = inner_done_}; }

 private:
  Verlet verlet_;  // if there is nothing to split
  FlatFlow flow_;  // its accelerations are by the soft forces, without drag
  StiffSplit split_;
  int multiplicity_ = 0, inner_steps_ = 0;
  long long inner_done_ = 0;
  const Cloth* kept_for_ = nullptr;  // to which split_ and they belong
  std::uint64_t kept_version_ = 0;
  double kept_time_ = 0;
  bool loaded_ = false;  // only the accelerations and kept_time_ are
  struct StiffNode {
    Point x, v, f;
    double per_mass;    // 1/m; 0 if held
    double way, decay;  // of a drift
  };
  std::vector<StiffNode> stiff_;  // by index in split_.nodes

  void find_split(const Cloth& g, const ForcePlan& force,
                  const ConstraintPlan& constraint);
  void one_step(Cloth& g, double t, double dt, bool kept,
                const ForcePlan& force, const ConstraintPlan& constraint);
  void leave_out_stiff(const Cloth& g);
  void take_stiff_nodes(const Cloth& g, double end, double dt, const Drag& c,
                        const ConstraintPlan& constraint);
  void move_stiff_nodes(const Cloth& g, double h);
};

}  // namespace lab
