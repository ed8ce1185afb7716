#pragma once
/** @file Guard.hpp
 * DivergenceGuard: stops a run that gains energy from nothing. */
#include <vector>

#include "lab/stability/EnergyBalance.hpp"

namespace lab {

/** Watches the energy of a run and keeps the last state that was good.
 *
 * Kinetic and elastic energy of a cloth come from its start, from its weight
 * as it falls, and from what moves it: together they are what is available. A
 * method that is unstable gains energy from nothing, without bound. A state is
 * good while its energy is finite and
 *   kinetic + elastic  <=  margin (start + released + work + floor),
 * start = kinetic and elastic energy at the start, released = the most
 * gravitational energy that was less than at the start, work = the most done by
 * what moves, floor = that of a free fall of one step, which is counted as
 * speed before it is counted as height, and that of springs strained by
 * round-off. Nothing in it grows with K or the size of the cloth. */
class DivergenceGuard {
 public:
  /** What a stable method's energy may exceed the available one by. That of
   * an oscillation by Verlet is up to 1/(1 - y^2) times what it starts with, at
   * y times the stability limit: 9 at 0.94. */
  static constexpr double margin = 4;

  /** @param g The cloth at the start   @param gravity [m/s^2]
   * @param dt the longest step of the run [s] */
  DivergenceGuard(const Cloth& g, double gravity, double dt);

  /** True if the state of @a g is good; then it is kept.  O(N + springs)
   * @param flow into its energy since the start */
  bool accept(const Cloth& g, const EnergyFlow& flow = {});
  /** Keep the state of @a g, good or not.  O(N) */
  void keep(const Cloth& g);

  /** An energy that is next to nothing [J]: that of a free fall of one step,
   * and of springs strained by round-off. */
  double floor() const { return floor_; }

  /** Give @a g the positions and velocities of the last good state. Nodes added
   * since stay as they are, nodes removed since stay removed. */
  void restore(Cloth& g) const;

  /** Save or load the last good state, and what was available. */
  void archive(CME212::Archive& a) { a(released_)(work_)(position_)(value_); }

 private:
  double gravity_, height_ = 0;     // height_: gravitational at the start [J]
  double start_ = 0, floor_ = 0;    // [J]
  double released_ = 0, work_ = 0;  // the most so far [J]
  std::vector<Point> position_;
  std::vector<NodeData> value_;
};

}  // namespace lab
