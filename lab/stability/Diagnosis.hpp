#pragma once
/** @file Diagnosis.hpp
 * Where a run failed, why, and what works instead. */
#include <string>

#include "lab/stability/StepLimit.hpp"

namespace lab {

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
