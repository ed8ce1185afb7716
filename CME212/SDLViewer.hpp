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
#include "CME212/Point.hpp"
#include "CME212/viewer/Image.hpp"
#include "CME212/viewer/Look.hpp"
#include "CME212/viewer/MouseTool.hpp"
#include "CME212/viewer/NoDisplay.hpp"
#include "CME212/viewer/SceneBuilder.hpp"

namespace CME212 {

/** Shows the nodes and edges of a graph. SceneBuilder collects them, and
 * ensures that no half built scene is drawn.
 *
 * Threads: constructor, event_loop() or launch(), snapshot(), has_display() and
 * destructor, set_panels() and set_touch() belong to the main thread. All else
 * may be called by any thread,
 * also while the window is open.
 *
 * A program simulates in a thread of its own and ends its main thread with
 * event_loop(); or, as in 2016, it calls launch() and simulates in its main
 * thread. Not both.
 *
 * Mouse: left button turns, right button moves, wheel zooms. Keys: space
 * pauses, n makes one step, r restarts, s colors by strain, c centers, q or
 * Esc quits, + and - size the text, ? shows the keys; f, w, d and k change the
 * Look: faces, wires, nodes, pieces. The simulation serves pause, step, restart
 * and coloring: see wait_while_paused(), take_restart(), strain_colors(). With
 * panels, Tab hides them; with a program that serves touches the left button
 * grabs the cloth, Ctrl and drag cuts, p pins: see set_panels(), set_touch().
 */
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

  /** True if a window can be shown: DISPLAY or WAYLAND_DISPLAY names a display
   * that answers. Takes some milliseconds.  @pre there is no viewer */
  static bool has_display();

  // ------------------------------------------------------------ How it looks

  /** Look at all nodes and spheres, as they are when drawn next. */
  void center_view();
  /** Look at @a box [m] from @a eye_direction, independent of the scene: the
   * view is the same in all pictures.  @pre norm(eye_direction) > 0 */
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

  /** Show a message in a panel: why the run stopped. Empty: no panel. */
  void set_message(std::vector<std::string> paragraphs);

  /** Write lines over the middle of the picture, the first one large: the title
   * of a film, or its end. Empty: no card. */
  void set_card(std::vector<std::string> lines);

  /** Label the color scale, drawn while strain_colors(). */
  void set_scale(ColorScale scale);

  /** What of the cloth is drawn; the user changes it as well. */
  Look look() const;
  void set_look(const Look& look);

  // ----------------------------------------------------------------- Control

  /** True from the time the user closed the window. */
  bool closed() const;
  /** Close the window, as the user does: event_loop() and every wait return. */
  void close();

  /** Pause or resume, as the user does with the space bar; make one step, as
   * with n; restart, as with r. */
  void set_paused(bool on);
  void step_once();
  void ask_restart();
  bool paused() const;
  /** Wait while paused.
   * @return true if the program may make one step: not paused, or the user
   *         pressed n; false at once if closed(), the user asked to restart,
   *         or wake() was called.
   * If a program never calls it, the help names no pause. */
  bool wait_while_paused();
  /** As above. Calls @a show() on this thread before it waits and whenever
   * strain_colors() changes: a paused window shows the latest scene in the
   * right colors. */
  bool wait_while_paused(const std::function<void()>& show);
  /** Let wait_while_paused() return false, now or when called next: there is
   * something else to do. */
  void wake();
  /** True if the user asked to restart since the last call. */
  bool take_restart();

  /** True while nodes should be colored by strain; then the scale is drawn. */
  bool strain_colors() const;
  void set_strain_colors(bool on);

  // -------------------------------------------------------- Panels and mouse

  /** Let @a draw make the program's own panels with Dear ImGui, over the
   * picture: it is called in every frame, on the thread that draws, with a
   * frame of Dear ImGui open, and returns the width that panels take at the
   * left [pixels]. The scene is centered in the rest. A snapshot has none.
   * Text is 14 pixels high, times ImGui::GetFontSize() / 14 of that frame.
   * @pre neither launch() nor event_loop() was called */
  void set_panels(std::function<double()> draw);

  /** Let @a serve know what the user does to nodes and edges with the mouse
   * where no panel is. It is called on the thread that draws and shall return
   * at once.  @pre as set_panels() */
  void set_touch(std::function<void(const Touch&)> serve);

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
  // All that names SDL or OpenGL, in SDLViewer.cpp: programs that include this
  // header compile without them.
  class Display;
  std::unique_ptr<Display> display_;
};

}  // namespace CME212
