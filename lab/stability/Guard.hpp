#pragma once
/** @file Guard.hpp
 * DivergenceGuard: stops a run that gains energy from nothing. */
#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "lab/stability/EnergyBalance.hpp"

namespace lab {

/** Are all numbers finite, and all masses above 0? */
bool are_nodes(std::span<const Point> positions,
               std::span<const NodeData> values);

/** A copy of the positions and values of all nodes, by id. */
class NodeStates {
 public:
  /** Copy the nodes of @a g.  O(N) */
  void keep(const Cloth& g);
  /** Give @a g the copied positions and values. Nodes added since keep theirs,
   * nodes removed since stay removed.  O(N) */
  void restore(Cloth& g) const;
  void archive(Archive& a);
  std::span<const Point> positions() const { return position_; }
  std::span<const NodeData> values() const { return value_; }

 private:
  std::vector<Point> position_;
  std::vector<NodeData> value_;
};

/** A cheap alarm: checks the energy of a run and keeps the last good state.
 *
 * The energy of a cloth is the initial one, the work of gravity and of loads,
 * and that of moving pins and obstacles. So a state is good if its energy is
 * finite, and
 *   internal <= margin (available + floor)
 * internal: elastic energy, and kinetic energy relative to the held nodes, or
 *   to the center of mass of a loose cloth: Energies::internal()
 * available: the largest value so far of initial energy + released
 *   gravitational energy + work, also of wind - kinetic energy of the cloth as
 *   a whole
 * floor: the energy of a free fall during one step, since speed may grow one
 *   step before height falls, and of springs strained by round-off */
class DivergenceGuard {
 public:
  /** Even a stable method may exceed the available energy. With Verlet at y
   * times the stability limit, the energy of an oscillation rises to
   * 1/(1 - y^2) times the initial one: 4 times at y = 0.87. With longer steps
   * a stable run is stopped if all its energy is in the fastest waves. */
  static constexpr double margin = 4;

  /** @param g The cloth at the start
   * @param dt the longest step of the run [s]
   * @param flow until now; accept() gets later values of the same sums */
  DivergenceGuard(const Cloth& g, const Potential& potential, double dt,
                  const EnergyFlow& flow = {});

  /** True if the state of @a g is good; then it is kept.  O(N + springs)
   * @param flow as EnergyBalance::flow() */
  bool accept(const Cloth& g, const EnergyFlow& flow = {}) {
    return accept(g, energies(g, potential_, flow), flow);
  }
  /** The same if @a e = energies(g, potential, flow) is known. */
  bool accept(const Cloth& g, const Energies& e, const EnergyFlow& flow);
  /** Keep the state of @a g, good or not.  O(N) */
  void keep(const Cloth& g) { kept_.keep(g); }
  /** The state of @a g has this internal energy [J] for a good reason: then
   * it is available.  O(N) */
  void allow(const Cloth& g, double internal) {
    available_ = std::max(available_, internal);
    keep(g);
  }

  /** A negligible energy [J]: that of a free fall during one step, and of
   * springs strained by round-off. */
  double floor() const { return floor_; }
  /** The second part of floor(): springs strained by round-off [J]. */
  double round_off() const { return round_off_; }

  /** Give @a g the last good state, as NodeStates::restore().  O(N) */
  void restore(Cloth& g) const { kept_.restore(g); }

  /** Save or load the last good state and the available energy. */
  void archive(Archive& a) {
    a(available_)(kept_).require(std::isfinite(available_));
  }

 private:
  Potential potential_;
  double dt_;         // [s]
  double start_ = 0;  // the balance at the start [J]
  double drag_ = 0;   // flow.drag then [J]
  double floor_ = 0, round_off_ = 0, available_ = 0;  // the most so far [J]
  NodeStates kept_;
};

}  // namespace lab
