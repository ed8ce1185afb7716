#pragma once
/** @file SDLSettings.hpp
 * SDLSettings: what the program and the user have set in a viewer. */
#include <atomic>
#include <condition_variable>
#include <mutex>
#include <optional>

#include "CME212/BoundingBox.hpp"
#include "CME212/viewer/GLCamera.hpp"
#include "CME212/viewer/GLOverlay.hpp"
#include "CME212/viewer/Look.hpp"

namespace CME212 {

/** The settings; any thread may change them. */
struct SDLSettings {
  std::mutex mutex;  // of all below
  std::condition_variable control;
  OverlayText text;
  GLCamera camera;
  std::optional<BoundingBox> look_at = GLCamera::usual_box();  // empty: all
  Look look;
  int steps = 0;         // to be made while paused
  bool pauses = false;   // the program calls wait_while_paused()
  bool restart = false;  // not yet taken
  bool help = true;      // shown
  // Written under the lock only, read without:
  std::atomic<bool> paused = false, closed = false, strain_colors = false;
  std::atomic<bool> redraw = true;

  /** Change something that is drawn or waited for. */
  template <typename F>
  void change(F f) {
    std::lock_guard lock(mutex);
    f();
    redraw = true;
    control.notify_all();
  }
  void close() {
    change([this] { closed = true; });
  }
  void set_paused(bool on) {
    change([this, on] {
      paused = on;
      steps = 0;
    });
  }
  void step_once() {
    change([this] {
      paused = true;
      ++steps;
    });
  }
  void ask_restart() {
    change([this] {
      restart = true;
      steps = 0;
    });
  }
};

}  // namespace CME212
