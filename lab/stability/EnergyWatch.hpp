#pragma once
/** @file EnergyWatch.hpp
 * EnergyWatch: the error of an energy that should be conserved. */
#include "lab/fast/Archive.hpp"
#include "lab/stability/Guard.hpp"

namespace lab {

/** Follows the energy of a cloth that should conserve it: one without drag,
 * contact, tearing and moving pins. So any change is the method's error.
 *
 * With a symplectic method the energy of an oscillation swings by a share of
 * O((dt omega)^2). So gains are measured, as in StepControl, from the least of
 * the initial energy and of the means of all rounds of 8 looks. */
class EnergyWatch {
 public:
  static constexpr int round = 8;  ///< calls of look()

  /** @param start the energy [J] at the start, with a step of @a dt [s]
   * @param guard for its floor() and round_off() */
  EnergyWatch(const Energies& start, double dt, const DivergenceGuard& guard);

  /** Take the energies @a e after some steps into account. */
  void look(const Energies& e);

  /** The error of the energy now [J]; positive if gained. */
  double off() const { return off_; }
  /** off() as a share of the largest internal energy; 0 if that energy has
   * stayed below round_off(), as in a free fall. */
  double share() const;
  /** The largest gain so far [J]. */
  double gain() const { return gain_; }
  /** The gain that StepControl would tolerate [J]. */
  double tolerance() const;

  void archive(Archive& a);

 private:
  double dt_, start_, floor_, round_off_;
  double largest_, fall_ = 0;  // internal energy; see StepControl::State [J]
  double off_ = 0, sum_ = 0;   // sum_: off_ over this round
  double least_ = 0, gain_ = 0;
  int looks_ = 0;
};

}  // namespace lab
