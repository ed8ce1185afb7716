#pragma once
/** @file RestReport.hpp
 * What ./cloth --rest says of a scene that was put to rest. */
#include <array>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "lab/stepping/Scene.hpp"

namespace lab {

/** Throws SceneError: why @a m has no rest that does not depend on motion. */
void check_has_rest(const Model& m);

/** How far a scene is at rest, whether it stays there, what its pins carry. */
struct RestReport : Rest {
  /** The ten lowest, or all; first those that grow, then those that no energy
   * holds: at least one of these, and the scene is not stable. */
  std::vector<Mode> modes;
  std::size_t growing = 0, loose = 0;               ///< number of such modes
  std::vector<std::pair<std::string, Point>> pins;  ///< what each holds [N]
  /** The ends of the cables and struts that do not act, by index, as listed. */
  std::vector<std::array<unsigned, 2>> slack;

  /** @pre scene.rest(), no node was removed
   * Throws Interrupted.  Complexity: Equilibrium::modes(10) */
  explicit RestReport(Scene& scene);

  bool stable() const { return growing + loose == 0; }
  /** Nodes that take part in the fastest growth, or that may move freely. */
  std::vector<unsigned> growing_nodes() const;
  std::vector<unsigned> loose_nodes() const;
  /** Those of the modes that do not grow [Hz], rising. */
  std::vector<double> frequencies() const;
  /** All of it, in lines, and what it means for methods and drag. */
  std::string text() const;

 private:
  std::vector<unsigned> number_;  // of each node id
  std::string steps_;             // the largest stable ones, by method

  std::vector<unsigned> nodes_of(std::span<const Mode> some) const;
};

}  // namespace lab
