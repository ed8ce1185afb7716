#pragma once
/** @file Accuracy.hpp
 * Finds the inner steps by which positions stay within a tolerance, and
 * measures the error by the distance of two runs that should agree. */
#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "lab/scenes/Model.hpp"

namespace lab {

class Scene;

/** The positions of a run at some times. */
class Track {
 public:
  /** Keeps the first state of a run at or after each of 64 equally spaced times
   * up to @a t_end [s]. Fewer if there are many @a nodes: 20 for a million
   * nodes, which take 500 MB. */
  Track(double t_end, std::size_t nodes);
  /** An empty track with the same times, for a run to compare with this. */
  Track beside() const;

  /** Keep the state of @a scene if it is due. Call it after each step.
   * O(1), or O(N) if it is due */
  void look(const Scene& scene);

 private:
  struct State {
    double time;           // [s]
    std::vector<Point> x;  // by node id [m]; infinite if it was removed
  };
  std::vector<double> due_;  // [s]; the last one is t_end
  std::size_t next_ = 0;     // index in due_
  Track() = default;
  double round_off() const { return due_.empty() ? 0 : 1e-9 * due_.back(); }
  std::vector<State> states_;

  friend class Separation;
};

/** The distance of two runs [m] at each time that both tracks have. */
class Separation {
 public:
  struct At {
    double time;  ///< [s]
    double rms;   ///< over the nodes; infinite if different nodes are removed
    double largest;  ///< of any node
  };

  Separation(const Track& a, const Track& b);

  /** In the order of time. */
  const std::vector<At>& all() const { return all_; }
  /** How long rms stays within @a tolerance [s]; 0: never. */
  double horizon(double tolerance) const;
  /** The largest factor by which rms grows while the time doubles. */
  double growth() const;
  /** The largest rms and the largest distance at any time [m]. */
  At most() const;

 private:
  std::vector<At> all_;
};

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
