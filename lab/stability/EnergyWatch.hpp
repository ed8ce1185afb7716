#pragma once
/** @file EnergyWatch.hpp
 * EnergyWatch: how far a run is off in an energy that nothing changes. */
#include "lab/Archive.hpp"
#include "lab/stability/Guard.hpp"

namespace lab {

/** Follows the energy of a cloth on which nothing does work and from which
 * nothing takes any: no drag, no contact, nothing that moves or tears. So what
 * the energy changes by is the method's error.
 *
 * As StepControl it counts gains from the least of the start and of the means
 * of rounds of 8 looks: the energy of an oscillation by a symplectic method
 * swings by O((dt omega)^2) of it. */
class EnergyWatch {
 public:
  static constexpr int round = 8;  ///< looks

  /** @param start the energy [J] at the start, with a step of @a dt [s]
   * @param guard at the start: what is next to nothing */
  EnergyWatch(const Energies& start, double dt, const DivergenceGuard& guard);

  void look(const Energies& e);

  /** What the energy is off by now [J]: gained if positive. */
  double off() const { return off_; }
  /** The same as a share of the largest internal energy; 0 if that has stayed
   * next to nothing, as of a cloth that falls freely. */
  double share() const;
  /** The most that it has gained from nothing [J]. */
  double gain() const { return gain_; }
  /** What StepControl would let it gain [J]. */
  double tolerance() const;

  void archive(Archive& a);

 private:
  double dt_, start_, floor_, round_off_;
  double largest_, fall_ = 0;  // internal energy; see StepControl::State [J]
  double off_ = 0, sum_ = 0;   // sum_: of this round's
  double least_ = 0, gain_ = 0;
  int looks_ = 0;
};

}  // namespace lab
