#pragma once
/** @file Accuracy.hpp
 * A tolerance for the positions of a run: the inner steps that keep it, found
 * by runs, and what they keep. */
#include <functional>
#include <string>

#include "lab/scenes/Model.hpp"

namespace lab {

/** What a run by error control keeps, as measured. */
struct Accuracy {
  double asked = 0;    ///< [m]
  TimeStep step;       ///< by which the run is to be made
  double t_end = 0;    ///< [s]
  double horizon = 0;  ///< until when the RMS error stays within asked [s]
  /** The largest error at any time [m]: RMS over the nodes, and of a node;
   * infinite if runs tear off different nodes. */
  double rms = 0, largest = 0;
  std::string unknown;  ///< why it could not be measured; else empty

  bool kept() const { return unknown.empty() && horizon >= t_end; }
  /** The verdict in one sentence. */
  std::string text() const;
};

/** Find out by which inner steps the scene @a m keeps its positions, RMS over
 * the nodes, within @a asked [m] until its end, and what it keeps.
 *
 * Local errors within m.step.tolerance do not bound the error at the end: where
 * a cloth buckles or touches something, nearby motions separate. So the run is
 * made twice, the second time with a tenth of that tolerance and half of dt;
 * the distance between them is the error of the first, up to a factor that is
 * taken into account. If it exceeds @a asked, both are made again with a
 * smaller tolerance, down to some 1000 times round-off. If that does not do
 * either the motion is chaotic, and the positions are predictable up to the
 * horizon only.
 *
 * @pre m.method is adaptive, m.step.fixed(), m.step.tolerance > 0
 * @param tell what is being done, and its share that is done; now and then
 * Throws InputError, SceneError, Interrupted.
 * Complexity: 2.4 times the run for a smooth motion by dop853, up to 20 times
 * for a chaotic one. */
Accuracy find_accuracy(
    const Model& m, double asked,
    const std::function<void(const std::string&, double)>& tell);

}  // namespace lab
