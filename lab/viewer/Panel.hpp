#pragma once
/** @file Panel.hpp
 * Panel: numbers and curves of a running scene, and the controls that change
 * it. A control sends a request: Live.hpp. */
#include <array>
#include <atomic>
#include <map>
#include <mutex>
#include <string>
#include <vector>

#include "CME212/SDLViewer.hpp"
#include "CME212/Util.hpp"
#include "lab/live/Live.hpp"
#include "lab/viewer/Plot.hpp"

namespace lab {

/** A panel at the left of a window.
 *
 * Threads: only the thread that steps calls tell(), only the one that draws
 * calls draw(); any thread may call the other functions. Each waits for the
 * other no longer than it takes to copy some numbers. */
class Panel {
 public:
  /** Of @a viewer. Requests of the user go to @a requests. Both must outlive
   * the panel.
   * @param speed Simulated seconds a second, at most; 0: without bound */
  Panel(RequestQueue& requests, CME212::SDLViewer& viewer, double speed);

  /** Show @a live as it is now.  As Live::readings(), sharp 4 times a second */
  void tell(Live& live);
  /** A request could not be met, for this reason. */
  void refuse(const std::string& why);

  /** Draw it, in a frame of Dear ImGui that is open.
   * @return its width [pixels] */
  double draw();

  /** What the user chose: simulated seconds a second, at most (0: without
   * bound); and whether a second cloth is beside the first, not over it. */
  double speed() const { return speed_; }
  bool side_by_side() const { return side_by_side_; }

  /** The middle of a control in the last picture [pixels], for a test's mouse.
   * {0, 0} if it was not drawn or is scrolled out of sight. */
  std::array<double, 2> place_of(const std::string& control) const;

 private:
  /** The readings that tell() passes to draw(). */
  struct State {
    Readings now;
    Model model, first;             // the present one, and that of the start
    std::vector<std::string> cure;  // requests that mend a failure, if known
    std::string refusal;
    double real_time = 0;  // simulated seconds a second
    // Of the last frames, what is plotted, by its name.
    std::map<std::string, std::vector<float>> past;
  };

  RequestQueue& requests_;
  CME212::SDLViewer& viewer_;
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
  const MethodEntry* rival_;
  double rival_share_ = 0.5;
  bool equal_work_ = false;
  float unit_ = 1;  // [pixels]

  void ask(std::string request);
  void mark(const char* control);
  bool button(const char* label, float width);
  bool slider(const char* label, double& value, double low, double high,
              const char* format, bool log = true);
  bool choose_method(const char* label, const MethodEntry*& method);
  void draw_player();
  void draw_controls();
  void draw_numbers();
  Curve curve(const char* name, PanelColor color);
  void draw_plots();
  void draw_comparison();
  void draw_scenes();
  void load(Model m);
  void remember(const Readings& r);
};

}  // namespace lab
