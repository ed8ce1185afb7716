#pragma once
/** @file Panel.hpp
 * Panel: what a user sees of a running scene in numbers and curves, and the
 * controls that change it. */
#include <array>
#include <atomic>
#include <functional>
#include <map>
#include <mutex>
#include <string>
#include <vector>

#include "CME212/Util.hpp"
#include "lab/live/Live.hpp"

namespace lab {

/** What a panel asks of its window. Called by the thread that draws. */
struct Player {
  std::function<bool()> paused;
  std::function<void(bool)> set_paused;
  std::function<void()> step, restart;
  std::function<void()> wake;  ///< there are new requests
};

/** A panel at the left of a window.
 *
 * Threads: tell() belongs to the thread that steps, draw() to the one that
 * draws, all else to any. Neither thread waits
 * for more than the other's copying of some numbers. */
class Panel {
 public:
  /** Requests of the user go to @a requests; both must outlive the panel.
   * @param speed Simulated seconds a second, at most; 0: without bound */
  Panel(RequestQueue& requests, Player player, double speed);

  /** Show @a live as it is now.  As Live::readings(), sharp 4 times a second */
  void tell(Live& live);
  /** A request could not be met, for this reason. */
  void refuse(const std::string& why);

  /** Draw it, in a frame of Dear ImGui that is open.
   * @return its width [pixels] */
  double draw();

  /** As the user wants it: simulated seconds a second, at most; 0: without
   * bound. And a second cloth beside the first, not over it. */
  double speed() const { return speed_; }
  bool side_by_side() const { return side_by_side_; }

  /** The middle of a control in the picture [pixels], as it was drawn last:
   * for those who point at it. {0, 0} if it was not drawn or is scrolled out
   * of sight. */
  std::array<double, 2> place_of(const std::string& control) const;

 private:
  enum Column {
    time,
    kinetic,
    elastic,
    gravitational,
    total,
    safe,
    sharp,
    one,
    apart,
    error,
    rival_error,
    columns
  };
  /** What the simulation tells. */
  struct State {
    Readings now;
    Model model, first;  // the present one, and that of the start
    std::string refusal;
    double real_time = 0;                          // simulated seconds a second
    std::array<std::vector<float>, columns> past;  // of the last frames
  };

  RequestQueue& requests_;
  const Player player_;
  std::atomic<double> speed_;
  std::atomic<bool> side_by_side_ = false;
  mutable std::mutex mutex_;  // of the next two
  State told_;
  std::map<std::string, std::array<double, 2>> places_;
  CME212::Clock sharp_clock_, rate_clock_;  // of the thread that steps
  double rate_from_ = 0;                    // simulated time then [s]
  bool begun_ = false;
  // Of the thread that draws:
  State shown_;
  const MethodEntry* rival_ = nullptr;
  double rival_share_ = 0.5;
  Compare::At at_ = Compare::At::equal_time;
  std::vector<std::string> scenes_;  // files
  float unit_ = 1;                   // [pixels]

  void ask(Request r);
  void mark(const char* control);
  bool button(const char* label, float width);
  bool slider(const char* label, double& value, double low, double high,
              const char* format, bool log = true);
  bool choose_method(const char* label, const MethodEntry*& method);
  void draw_player();
  void draw_controls();
  void draw_numbers();
  void draw_plots();
  void draw_comparison();
  void draw_scenes();
  void load(const std::string& file);
  void remember(const Readings& r);
};

}  // namespace lab
