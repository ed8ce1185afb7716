#pragma once
/** @file Separation.hpp
 * How far two runs get apart that should be the same: the test for chaos, and
 * the error of a run. */
#include <cstddef>
#include <vector>

#include "lab/scenes/Model.hpp"

namespace lab {

class Scene;  // lab/scenes/Scene.hpp

/** The positions that a run has at some times. */
class Track {
 public:
  /** Of a run of @a nodes nodes to @a t_end [s]: its states after the first
   * step at or behind each of 64 equal parts of it; of a million nodes, of 20,
   * which take 500 MB. */
  Track(double t_end, std::size_t nodes);
  /** An empty one of a run to be held against this: at the same times. */
  Track beside() const;

  /** Keep the state of @a scene if it is due. To be called after each step.
   * O(1), or O(N) */
  void look(const Scene& scene);

 private:
  struct State {
    double time;           // [s]
    std::vector<Point> x;  // by id [m]; infinite: the node was removed
  };
  std::vector<double> due_;  // [s]; the last one is t_end
  std::size_t next_ = 0;     // of due_
  Track() = default;
  double round_off() const { return due_.empty() ? 0 : 1e-9 * due_.back(); }
  std::vector<State> states_;

  friend class Separation;
};

/** The distance of two runs [m] at each time that both have kept. */
class Separation {
 public:
  struct At {
    double time;  ///< [s]
    double rms;   ///< over the nodes; infinite once other nodes were torn off
    double largest;  ///< of a node
  };

  Separation(const Track& a, const Track& b);

  /** By time. */
  const std::vector<At>& all() const { return all_; }
  /** Until when the RMS has stayed within @a tolerance [s]; 0: never. */
  double horizon(double tolerance) const;
  /** The largest that each has been at any time [m]. */
  At most() const;

 private:
  std::vector<At> all_;
};

}  // namespace lab
