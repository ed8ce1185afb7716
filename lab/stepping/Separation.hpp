#pragma once
/** @file Separation.hpp
 * The distance of two runs that should agree: it shows chaos, and estimates the
 * error of a run. */
#include <cstddef>
#include <vector>

#include "lab/scenes/Model.hpp"

namespace lab {

class Scene;  // lab/stepping/Scene.hpp

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

}  // namespace lab
