#pragma once
/** @file SDLViewer.hpp
 * SDLViewer: shows a graph in a window, or draws it into pictures without
 * one, while a simulation changes it in another thread. */
#include <functional>
#include <memory>
#include <sstream>
#include <string>
#include <type_traits>
#include <vector>

#include "CME212/BoundingBox.hpp"
#include "CME212/Image.hpp"
#include "CME212/NoDisplay.hpp"
#include "CME212/Point.hpp"
#include "CME212/SceneBuilder.hpp"

namespace CME212 {

/** Shows the nodes and edges of a graph; how they get here, and that a half
 * built scene is never seen: SceneBuilder.
 *
 * Threads: constructor, event_loop() or launch(), snapshot(), has_display() and
 * destructor belong to the main thread. All else may be called by any thread,
 * also while the window is open.
 *
 * A program simulates in a thread of its own and ends its main thread with
 * event_loop(); or, as in 2016, it calls launch() and simulates in its main
 * thread. Not both.
 *
 * Mouse: left button turns, right button moves, wheel zooms. Keys: space
 * pauses, n makes one step, r restarts, s colors by strain, c centers, q or
 * Esc quits. What pause, step, restart and coloring mean is up to the
 * simulation: see wait_while_paused(), take_restart(), strain_colors(). */
class SDLViewer : public SceneBuilder {
 public:
  struct Options {
    int width = 1024, height = 768;  ///< of the window and of snapshots
    std::string title = "mass_spring";
    bool offscreen = false;  ///< draw without a display, never show a window
    /** The program serves the keys r and s: take_restart(), strain_colors().
     * Otherwise they do nothing, and the help does not name them. */
    bool restarts = false, colors = false;
  };

  /** Make a window; it appears with event_loop() or launch(). One viewer at a
   * time.
   * @pre width and height > 0
   * Throws NoDisplay if there is no display, unless @a o.offscreen, or no
   * OpenGL 3.3. */
  explicit SDLViewer(const Options& o);
  SDLViewer() : SDLViewer(Options()) {}
  /** After launch() it waits until the window is closed.
   * @pre no thread of the program uses the viewer any more */
  ~SDLViewer();

  /** True if a window can be shown here: DISPLAY or WAYLAND_DISPLAY is set,
   * and leads somewhere. Takes some milliseconds.  @pre there is no viewer */
  static bool has_display();

  // ------------------------------------------------------------ How it looks

  /** Look at all nodes and spheres, as they are when drawn next. */
  void center_view();
  /** Look at @a box [m] from @a eye_direction, whatever the scene holds: the
   * same view in picture after picture.  @pre norm(eye_direction) > 0 */
  void set_view(const Point& eye_direction, const BoundingBox& box);

  /** Write @a label at the top of the picture: a text, or a number. */
  void set_label(const std::string& label);
  template <typename T>
  requires std::is_arithmetic_v<T>
  void set_label(T number) {
    std::ostringstream s;
    s << number;
    set_label(s.str());
  }

  /** Say why nothing moves any more, in a panel; with no paragraphs it goes. */
  void set_message(std::vector<std::string> paragraphs);

  /** Say what the colors mean; drawn while strain_colors().
   * @param low,high What Color::make_strain() of 0 and 1 stand for [@a unit]
   */
  void set_scale(std::string title, double low, double high, std::string unit);

  // ----------------------------------------------------------------- Control

  /** True once the user has closed the window; it stays so. */
  bool closed() const;
  /** Close the window, as the user does: event_loop() returns, nothing waits.
   */
  void close();

  /** Pause, or go on, as the user does by the space bar. */
  void set_paused(bool on);
  /** Wait while paused.
   * @return true if one step may be made now: not paused, or step was pressed;
   *         false at once if closed() or a restart was asked for.
   * Whoever never calls it has no pause, and the help names none. */
  bool wait_while_paused();
  /** As above, and call @a show() on this thread before it waits and each time
   * that strain_colors() changed meanwhile: a paused scene is the latest one,
   * in the right colors. */
  bool wait_while_paused(const std::function<void()>& show);
  /** True once after the user asked for a restart. */
  bool take_restart();

  /** True while nodes should be colored by strain; then the scale is drawn. */
  bool strain_colors() const;
  void set_strain_colors(bool on);

  // ----------------------------------------------------- On the main thread

  /** Show the window and serve the user until the window is closed.
   * @pre launch() was not called: one thread serves a window
   * @post closed() */
  void event_loop();

  /** Show the window and let a thread of the viewer serve the user until the
   * window is closed. Returns when the window is there; the destructor waits
   * until it is closed, the program goes on meanwhile: see closed().
   * That thread makes the window anew, since SDL wants a window made and its
   * events read in one thread. (On macOS that is the main one: use
   * event_loop() there.)
   * @pre neither launch() nor event_loop() was called
   * Throws NoDisplay if it can't be made again. */
  void launch();

  /** Draw the scene into a picture of the size in the options; needs no
   * event_loop(). With label and scale, without help and frame rate: the same
   * scene gives the same picture. A scene under construction is completed if
   * this thread builds it, and left out if another does.
   * @pre launch() was not called: its thread has the window
   * Throws std::runtime_error if the driver has no memory for it. */
  Image snapshot();

 private:
  // All that needs SDL or OpenGL, so that a program that shows a graph
  // compiles without them: in SDLViewer.cpp.
  class Display;
  std::unique_ptr<Display> display_;
};

}  // namespace CME212
