#pragma once
/** @file Recording.hpp
 * A recording: all requests of a run as a file, and the replay of it. Each line
 * is Live::calls() and a request, such as "120 gravity 3". A request for a
 * scene continues with the lines of its file, each after a bar. lab/README.md
 */
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "lab/live/Live.hpp"

namespace lab {

/** The first line of a recording. */
inline constexpr const char* recording_begin = "mass_spring input 1";

/** The content of a request for a scene. */
struct SceneRequest {
  Model model;
  std::uint64_t cloth = 0;  ///< checksum_of() the cloth as made; 0: not known
};
std::string scene_request(const Model& m, std::uint64_t cloth = 0);
/** @param line of @a file where the request stands, for messages
 * Throws InputError, SceneFileError: "FILE:LINE: what, expected what" */
SceneRequest read_scene(const std::string& request,
                        const std::string& file = "scene",
                        std::size_t line = 1);

/** Runs a recording again: to the same bits on the same kind of machine. */
class Replay {
 public:
  /** At its start.
   * Throws as read_scene() and Live(): a file that is no recording. */
  explicit Replay(const std::string& file);
  Live& live() { return *live_; }
  std::size_t requests() const { return requests_.size() - 1; }

  /** Apply the requests that are due, then step.
   * @return false at its end, and no step was made
   * Throws InputError: a request that can't be met, a scene whose files have
   * changed, or steps beyond the end of a scene. */
  bool step();

 private:
  struct Timed {
    long long calls;   // Live::calls()
    std::size_t line;  // of the file
    std::string request;
  };
  std::string file_;
  std::vector<Timed> requests_;  // the last one is "end"
  std::size_t next_ = 1;
  std::unique_ptr<Live> live_;

  void apply(const Timed& t);
};

}  // namespace lab
