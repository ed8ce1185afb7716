#pragma once
/** @file Recording.hpp
 * What a user asked of a running scene, as a file, and the same run again. A
 * line a request: Live::calls() at that time, a word, its values. Of a scene
 * the lines of its file follow, each behind a bar. lab/README.md */
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "lab/live/Live.hpp"

namespace lab {

/** A request and when it was made. */
struct Recorded {
  long long calls;  ///< Live::calls()
  Request request;
  /** Of LoadScene: checksum_of() the cloth as it is made; 0: not known. */
  std::uint64_t cloth = 0;
  std::size_t line = 0;  ///< of the file
};

/** The parts of such a file. */
std::string begin_recording();
std::string recorded(const Recorded& r);
std::string end_recording(long long calls);

/** A recording that was read. */
struct Recording {
  std::string file;
  std::vector<Recorded> requests;  ///< the first one: LoadScene at 0 calls
  long long calls = 0;             ///< Live::calls() at its end
  std::size_t last_line = 0;
};
/** Throws InputError, SceneFileError: "FILE:LINE: what, expected what". */
Recording read_recording(const std::string& file);

/** Write Live::recording() to @a file.
 * Throws std::runtime_error "FILE: why" */
void write_recording(const Live& live, const std::string& file);

/** Runs a recording again: to the same bits on the same kind of machine. */
class Replay {
 public:
  /** At its start.  Throws as read_recording() and Live(). */
  explicit Replay(const std::string& file);
  Live& live() { return *live_; }
  std::size_t requests() const { return recording_.requests.size(); }

  /** Make the requests that are due, and then a step.
   * @return false at its end, and no step was made
   * Throws InputError: a request that can't be met, a scene whose files have
   * changed, or steps beyond the end of a scene. */
  bool step();

 private:
  Recording recording_;
  std::size_t next_ = 1;  // request
  std::unique_ptr<Live> live_;

  void make(const Recorded& r);
};

}  // namespace lab
