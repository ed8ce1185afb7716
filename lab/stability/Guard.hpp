#pragma once
/** @file Guard.hpp
 * DivergenceGuard: stops a run that gains energy from nothing. */
#include <cmath>
#include <span>
#include <vector>

#include "lab/stability/EnergyBalance.hpp"

namespace lab {

/** Are all numbers finite, and all masses above 0? */
bool are_nodes(std::span<const Point> positions,
               std::span<const NodeData> values);

/** What nodes had at some time, by id. */
class NodeStates {
 public:
  /** Those of @a g.  O(N) */
  void keep(const Cloth& g);
  /** Give @a g the positions and values that were kept. Nodes added since stay
   * as they are, nodes removed since stay removed.  O(N) */
  void restore(Cloth& g) const;
  void archive(Archive& a);

 private:
  std::vector<Point> position_;
  std::vector<NodeData> value_;
};

/** Watches the energy of a run and keeps the last state that was good.
 *
 * Kinetic and elastic energy of a cloth come from its start, from its weight
 * as it falls, and from what moves it: together they are what is available. A
 * method that is unstable gains energy from nothing, without bound. What
 * carries the cloth is left out: its internal energy is elastic, and kinetic as
 * seen from the nodes that are held, or from the center of mass of a loose
 * cloth. A state is good while its energy is finite and internal  <=  margin
 * (available + floor), available = the most so far of what it started with +
 * gravitational energy released + work - kinetic energy of the carried cloth as
 * a whole; floor = the energy of a free fall of one step, which is counted as
 * speed before it is counted as height, and that of springs strained by
 * round-off. Nothing in it grows with K or the size of the cloth. */
class DivergenceGuard {
 public:
  /** What a stable method's energy may exceed the available one by: an
   * oscillation by Verlet reaches 1/(1 - y^2) times its start, at y times the
   * stability limit, which is 4 at 0.87. Beyond that a cloth all of whose
   * energy is in its fastest waves is stopped, too. */
  static constexpr double margin = 4;

  /** @param g The cloth at the start   @param gravity [m/s^2]
   * @param dt the longest step of the run [s]
   * @param flow into its energy until now, of which accept() gets more */
  DivergenceGuard(const Cloth& g, double gravity, double dt,
                  const EnergyFlow& flow = {});

  /** True if the state of @a g is good; then it is kept.  O(N + springs)
   * @param flow into its energy since the start */
  bool accept(const Cloth& g, const EnergyFlow& flow = {}) {
    return accept(g, energies(g, gravity_, flow), flow);
  }
  /** The same of one whose energy @a e with that flow is known. */
  bool accept(const Cloth& g, const Energies& e, const EnergyFlow& flow);
  /** Keep the state of @a g, good or not.  O(N) */
  void keep(const Cloth& g) { kept_.keep(g); }

  /** An energy that is next to nothing [J]: that of a free fall of one step,
   * and of springs strained by round-off. */
  double floor() const { return floor_; }
  /** Of that, the energy of springs strained by round-off [J]. */
  double round_off() const { return round_off_; }

  /** Give @a g the last good state: NodeStates::restore(). */
  void restore(Cloth& g) const { kept_.restore(g); }

  /** Save or load the last good state, and what was available. */
  void archive(Archive& a) {
    a(available_)(kept_).require(std::isfinite(available_));
  }

 private:
  double gravity_, height_ = 0;  // height_: gravitational and removed [J]
  double dt_;                    // [s]
  double start_ = 0, floor_ = 0, round_off_ = 0;  // start_: without work [J]
  double available_ = 0;                          // the most so far [J]
  NodeStates kept_;
};

}  // namespace lab
