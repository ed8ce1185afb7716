#pragma once
/** @file Screen.hpp
 * Screen: what ./cloth draws on, a window or pictures in memory. */
#include <array>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "CME212/viewer/NoDisplay.hpp"

namespace lab {

class Scene;

using CME212::NoDisplay;

/** Draws scenes, in a window or into pictures of 1024 x 768 pixels, 800 x 600
 * for a film.
 *
 * Threads: open(), the destructor, event_loop(), save_picture() and the film
 * belong to the main thread, all else to the thread that steps the scene. */
class Screen {
 public:
  enum class Kind { window, pictures, film };
  static constexpr double frames_per_second = 30;  ///< of a film

  /** False if built with VIEWER=0: then no screen opens. */
  static bool can_draw();
  /** True if a window could be shown here.  @pre no screen is open */
  static bool has_display();

  /** One at a time.
   * @param pixels Width and height; 0: as above
   * Throws NoDisplay: no display for a window, no OpenGL 3.3, no viewer. */
  static std::unique_ptr<Screen> open(Kind kind,
                                      std::array<int, 2> pixels = {});
  virtual ~Screen() = default;

  /** Whether to color the nodes by the mean l/L - 1 of their springs.
   * In a window the user switches it as well. */
  virtual void show_strain(bool on) = 0;

  /** Show the present state of @a scene. If it failed, this is its last good
   * state, with a mark where it failed, and the reason. */
  virtual void show(const Scene& scene) = 0;

  /** Write what was shown last to a file, in the format of its ending.
   * Throws std::runtime_error "FILE: why". */
  virtual void save_picture(const std::string& file) = 0;

  /** Write @a lines at the bottom left: a title, or a result. */
  virtual void show_card(const std::vector<std::string>& lines) = 0;

  /** Begin a film, add what was shown last to it so many times, end it.
   * Throw std::runtime_error "FILE: why". */
  virtual void start_film(const std::string& file) = 0;
  virtual void add_to_film(int times) = 0;
  virtual void end_film() = 0;

  // The window; see SDLViewer.
  virtual void event_loop() = 0;
  virtual void close() = 0;
  virtual void set_paused(bool on) = 0;
  virtual bool closed() const = 0;
  virtual bool take_restart() = 0;
  virtual bool wants_frame() const = 0;
  /** True if the user has switched the coloring since the last show(). */
  virtual bool coloring_changed() const = 0;
  /** Wait while paused, with a call of @a show() before and whenever the
   * coloring changes.
   * @return true if one step may be made now; false if the user closed the
   * window or asked to restart */
  virtual bool wait_while_paused(const std::function<void()>& show) = 0;
};

}  // namespace lab
