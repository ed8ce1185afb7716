#pragma once
/** @file Guard.hpp
 * DivergenceGuard: stops a run that gains energy from nothing, and says where
 * and why it failed. */
#include <string>
#include <vector>

#include "lab/stability/StepLimit.hpp"

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

/** The place where the state of a cloth is worst: the first node that is not
 * finite, or else the fastest one, and the most stretched spring there. */
struct WorstPlace {
  Node node;          ///< not valid if the cloth has none
  Edge spring;        ///< not valid if the node has none
  double speed = 0;   ///< of the node [m/s]; infinite if it has no number
  double length = 0;  ///< of the spring [m]; the same

  explicit WorstPlace(const Cloth& g);
  /** The same in words. */
  std::string text(const Cloth& g) const;
};

/** Why a run with this step failed, and what would do instead; in words.
 * @param sharp the stability limit [s] in the last good configuration
 * @param safe the limit in any   @param verlet that of Verlet, in any */
std::string why_it_failed(const MethodInfo& info, double dt, double sharp,
                          double safe, double verlet);

}  // namespace lab
