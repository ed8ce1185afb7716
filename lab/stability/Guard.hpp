#pragma once
/** @file Guard.hpp
 * DivergenceGuard: stops a run that gains energy from nothing. */
#include <vector>

#include "mass_spring.hpp"

namespace lab {

/** Watches the energy of a run and keeps the last state that was good.
 *
 * Gravity and springs can't raise the energy of a cloth; a method that is
 * unstable does so without bound. A state is good while it is finite and
 *   kinetic + elastic + gravitational energy
 *     <=  total energy at the start + 3 S,
 * S = kinetic and elastic energy at the start + total weight times the
 * diagonal of the cloth + the energy of all springs stretched by 10 %. The
 * margin is for what a stable method does: its energy oscillates, and a
 * constraint that moves a node stretches springs. */
class DivergenceGuard {
 public:
  /** @param g The cloth at the start   @param gravity [m/s^2] */
  DivergenceGuard(const Cloth& g, double gravity);

  /** True if the state of @a g is good; then it is kept. Elastic energy, which
   * costs a sweep over the springs, is checked in every fourth call.
   * O(N + springs/4) */
  bool accept(const Cloth& g);
  /** True if the state of @a g is good.
   * @param elastic whether elastic energy counts */
  bool good(const Cloth& g, bool elastic = true) const;
  /** Keep the state of @a g, good or not.  O(N) */
  void keep(const Cloth& g);

  /** Give @a g the positions and velocities of the last good state. Nodes added
   * since stay as they are, nodes removed since stay removed. */
  void restore(Cloth& g) const;

 private:
  double gravity_, top_ = 0, limit_ = 0;
  long checks_ = 0;
  std::vector<Point> position_;
  std::vector<NodeData> value_;

  /** Gravitational energy [J], zero at the top of the cloth at the start, so
   * that removing a node that hangs below takes little energy away. */
  double heights_energy(const Cloth& g) const;
};

}  // namespace lab
