#pragma once
/** @file Progress.hpp
 * Progress: how far a program is, on the standard error. */
#include <string>

#include "CME212/Util.hpp"

namespace lab {

/** Shows a bar on a terminal, and lines elsewhere.
 *
 *     while (work) progress.tell("t = 3 of 5 s", 0.6);
 *     progress.end(); */
class Progress {
 public:
  /** @param quiet show nothing */
  explicit Progress(bool quiet = false);

  /** True now and then: every 0.1 s on a terminal, else every 5 s, from the
   * first second on. For a loop of many short steps. */
  bool due();
  /** Show @a text and the time that is left. Without a terminal, a text that
   * was shown last is not shown again.
   * @param done share of the work that is done, from 0 to 1 */
  void show(const std::string& text, double done);
  /** show() if due(). */
  void tell(const std::string& text, double done) {
    if (due()) show(text, done);
  }
  /** Clear the bar. */
  void end() const;
  /** Time since the start [s]. */
  double seconds() const { return clock_.seconds(); }

 private:
  bool on_, terminal_;
  double next_ = 1;  // when it is due again [s]
  std::string text_;
  CME212::Clock clock_;
};

}  // namespace lab
