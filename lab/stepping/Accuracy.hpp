#pragma once
/** @file Accuracy.hpp
 * Finds the inner steps by which positions stay within a tolerance, and
 * measures the error. */
#include <functional>
#include <string>

#include "lab/scenes/Model.hpp"

namespace lab {

/** The measured accuracy of a run with error control. */
struct Accuracy {
  double asked = 0;    ///< the tolerance [m]
  TimeStep step;       ///< the run should use it
  double t_end = 0;    ///< [s]
  double horizon = 0;  ///< how long the RMS error stays within asked [s]
  /** The largest error at any time [m]: RMS over the nodes, and of one node;
   * infinite if the runs remove different nodes. */
  double rms = 0, largest = 0;
  /** Two runs with the same steps that begin a thousandth of asked apart
   * separate exponentially: no step helps for long. */
  bool chaotic = false;
  std::string unknown;  ///< why no error could be measured; else empty

  bool kept() const { return unknown.empty() && horizon >= t_end; }
  /** The verdict in one sentence. */
  std::string text() const;
};

/** Find inner steps with which the RMS error of the positions of @a m stays
 * within @a asked [m] until the end, and measure that error.
 *
 * Local errors within m.step.tolerance do not bound the error at the end: where
 * a cloth buckles or touches something, nearby trajectories separate. So the
 * scene is run twice, the second time with a tenth of that tolerance and half
 * of dt. The distance of the two runs, times a known factor, is the error of
 * the first. If it exceeds @a asked, both runs are repeated with a smaller
 * tolerance, down to about 1000 times round-off. If that is not enough either,
 * two more runs show whether the motion is chaotic.
 * If it is far below @a asked, a larger tolerance is tried once.
 *
 * A method with fixed steps begins with safe_share of its limit; its steps are
 * shortened as tolerances are, to a thousandth at most.
 *
 * @pre m.method is adaptive, m.step.fixed(), m.step.tolerance > 0; or it has a
 * stability limit here
 * @param tell called with a text and the finished share of the present run
 * Throws InputError, SceneError, Interrupted.
 * Complexity: 2.4 times the run for a smooth motion by rkn64, up to 20 times
 * for a chaotic one. */
Accuracy find_accuracy(
    const Model& m, double asked,
    const std::function<void(const std::string&, double)>& tell);

}  // namespace lab
