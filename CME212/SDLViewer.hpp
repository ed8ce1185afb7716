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
#include "CME212/Color.hpp"
#include "CME212/Point.hpp"
#include "CME212/viewer/Image.hpp"
#include "CME212/viewer/NoDisplay.hpp"
#include "CME212/viewer/SceneBuilder.hpp"
#ifndef MASS_SPRING_VIEWER
#include "CME212/viewer/NoViewer.hpp"
#endif

namespace CME212 {

#ifndef MASS_SPRING_VIEWER  // built with VIEWER=0

using SDLViewer = NoViewer;

#else

/** Shows the nodes and edges of a graph, which SceneBuilder collects.
 *
 * Threads: the constructor, the destructor, event_loop(), launch(), snapshot()
 * and has_display() are for the main thread. Any thread may call all others,
 * also while the window is open.
 *
 * A program simulates in a thread of its own and ends its main thread with
 * event_loop(); or, as in 2016, it calls launch() and simulates in its main
 * thread. Not both.
 *
 * Mouse: left button turns, right button moves, wheel zooms. Keys: space
 * pauses, n makes one step, r restarts, s colors by strain, c centers, q or
 * Esc quits, ? hides the list of keys; f, w and d change the Look: faces,
 * wires, nodes. Pause, step, restart and coloring need the simulation's help:
 * wait_while_paused(), take_restart(), strain_colors().
 */
class SDLViewer : public SceneBuilder {
 public:
  struct Options {
    /** Of window and snapshots [pixels]; 0: a window of three quarters of the
     * screen, snapshots of 1024 x 768. */
    int width = 0, height = 0;
    std::string title = "mass_spring";
    bool offscreen = false;  ///< draw without a display, never show a window
    /** The program handles the keys r and s: take_restart(), strain_colors().
     * Otherwise they do nothing, and the help does not name them. */
    bool restarts = false, colors = false;
    /** If no window can be shown, draw without a display, for this file:
     * write_picture(). */
    std::string picture = {};
  };

  /** Make a window; it appears with event_loop() or launch(). One viewer at a
   * time.
   * @pre width and height > 0, or both are 0
   * Throws NoDisplay if there is no display, unless @a o.offscreen or
   * @a o.picture, or no OpenGL 3.3. A program that does not catch it prints the
   * reason and ends with status 4. */
  explicit SDLViewer(const Options& o);
  SDLViewer() : SDLViewer(Options()) {}
  /** After launch() it waits until the window is closed.
   * @pre no other thread uses the viewer */
  ~SDLViewer();

  /** True if a window can be shown: DISPLAY or WAYLAND_DISPLAY names a display
   * that answers. Takes some milliseconds.  @pre there is no viewer */
  static bool has_display();

  // -------------------------------------------------------------- Appearance

  /** Show all nodes and spheres, from the next frame on. */
  void center_view();
  /** Look at @a box [m] from @a eye_direction, independent of the scene: the
   * view is the same in all pictures.  @pre norm(eye_direction) > 0 */
  void set_view(const Point& eye_direction, const BoundingBox& box);

  /** Write @a label into the title bar of the window, and at the top of
   * snapshots: a text, or a number. */
  void set_label(const std::string& label);
  template <typename T>
  requires std::is_arithmetic_v<T>
  void set_label(T number) {
    std::ostringstream s;
    s << number;
    set_label(s.str());
  }

  /** Show paragraphs over the picture, the first two in bright letters, beside
   * a bar of color @a bar: why the run stopped, its outcome, the title of a
   * film. Empty: none. */
  void set_message(std::vector<std::string> paragraphs,
                   const Color& bar = Color::make_mark());

  /** Mark these places only. The marks do not move with nodes. */
  void set_marks(std::vector<Mark> marks);

  /** Label the color scale, drawn while strain_colors(). */
  void set_scale(const StrainScale& scale);

  /** Which parts of the cloth are drawn. The user may change that, too. */
  void set_look(const Look& look);

  // ----------------------------------------------------------------- Control

  /** True once the window was closed. */
  bool closed() const;
  /** Close the window, as the user can: event_loop() and all waits return. */
  void close();

  /** Pause or resume, as the space key does. */
  void set_paused(bool on);
  /** Wait while paused. Calls @a show() on this thread before it waits, and
   * when strain_colors() changes: so a paused window shows the latest scene.
   * @return true if the program may make one step: not paused, or the user
   *         pressed n; false, without waiting, if closed() or the user asked to
   *         restart.
   * If a program never calls it, the help does not name the pause. */
  bool wait_while_paused(const std::function<void()>& show = [] {});
  /** True if the user asked to restart since the last call. */
  bool take_restart();

  /** True while nodes should be colored by strain; then the scale is drawn. */
  bool strain_colors() const;
  void set_strain_colors(bool on);

  // ----------------------------------------------------- On the main thread

  /** Show the window and handle its events until it is closed. If it draws for
   * Options::picture, return at once.
   * @pre launch() was not called: one thread handles the events
   * @post closed(), unless it draws for a picture */
  void event_loop();

  /** True if it was made for a window, not to draw without a display. */
  bool in_window() const;

  /** If it draws for Options::picture, write this file, and say so: a PNG of
   * the scene as it is now.  @pre as snapshot()
   * Throws std::runtime_error "FILE: why" */
  void write_picture();

  /** Show the window and return; a thread of the viewer handles its events
   * until it is closed, see closed(). The destructor waits for that. That
   * thread makes a new window, since SDL reads events in the thread that made
   * the window. (On macOS that must be the main thread: use event_loop()
   * there.)
   * @pre neither launch() nor event_loop() was called
   * Throws NoDisplay if it can't be made. */
  void launch();

  /** Draw the scene into a picture of the size in the options. It needs no
   * event_loop(). The picture has the label and the scale, but no help, so the
   * same scene gives the same picture. Edges that were not added yet are
   * missing.
   * @pre launch() was not called: its thread has the window
   * Throws std::runtime_error if the driver has no memory for it. */
  Image snapshot();

 private:
  // SDLViewer.cpp has all that needs SDL or OpenGL, so programs that include
  // this header compile without them.
  class Display;
  std::unique_ptr<Display> display_;
};

#endif

}  // namespace CME212
