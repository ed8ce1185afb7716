#pragma once
/** @file SDLViewer.hpp
 * SDLViewer: shows a graph in a window, or draws it into pictures without
 * one, while a simulation changes it in another thread. */
#include <SDL.h>

#include <algorithm>
#include <atomic>
#include <cassert>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <exception>
#include <future>
#include <mutex>
#include <optional>
#include <sstream>
#include <string>
#include <thread>
#include <type_traits>
#include <utility>
#include <vector>

#include "CME212/BoundingBox.hpp"
#include "CME212/GLCamera.hpp"
#include "CME212/GLOverlay.hpp"
#include "CME212/GLScene.hpp"
#include "CME212/Image.hpp"
#include "CME212/Point.hpp"
#include "CME212/SDLWindow.hpp"
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
  explicit SDLViewer(const Options& o)
      : options_(o), canvas_(std::in_place, o) {}
  SDLViewer() : SDLViewer(Options()) {}
  /** After launch() it waits until the window is closed.
   * @pre no thread of the program uses the viewer any more */
  ~SDLViewer() {
    if (thread_.joinable()) thread_.join();
  }

  /** True if a window can be shown here: DISPLAY or WAYLAND_DISPLAY is set,
   * and leads somewhere. Takes some milliseconds.  @pre there is no viewer */
  static bool has_display() {
    try {
      return SDLVideo(false).has_display();
    } catch (const NoDisplay&) {
      return false;
    }
  }

  // ------------------------------------------------------------ How it looks

  /** Look at all nodes and spheres, as they are when drawn next. */
  void center_view() {
    complete_without_edges();
    change([&] { look_at_ = BoundingBox(); });
  }
  /** Look at @a box [m] from @a eye_direction, whatever the scene holds: the
   * same view in picture after picture.  @pre norm(eye_direction) > 0 */
  void set_view(const Point& eye_direction, const BoundingBox& box) {
    change([&] {
      camera_.look_from(eye_direction);
      look_at_ = box;
    });
  }

  /** Write @a label at the top of the picture: a text, or a number. */
  void set_label(const std::string& label) {
    complete_without_edges();
    change([&] { text_.label = label; });
  }
  template <typename T>
  requires std::is_arithmetic_v<T>
  void set_label(T number) {
    std::ostringstream s;
    s << number;
    set_label(s.str());
  }

  /** Say why nothing moves any more, in a panel; with no paragraphs it goes. */
  void set_message(std::vector<std::string> paragraphs) {
    change([&] { text_.message = std::move(paragraphs); });
  }

  /** Say what the colors mean; drawn while strain_colors().
   * @param low,high What Color::make_strain() of 0 and 1 stand for [@a unit]
   */
  void set_scale(std::string title, double low, double high, std::string unit) {
    change([&] {
      text_.scale = {std::move(title), low, high, std::move(unit)};
    });
  }

  // ----------------------------------------------------------------- Control

  /** True once the user has closed the window; it stays so. */
  bool closed() const { return closed_; }
  /** Close the window, as the user does: event_loop() returns, nothing waits.
   */
  void close() {
    change([&] { closed_ = true; });
  }

  /** Pause, or go on, as the user does by the space bar. */
  void set_paused(bool on) {
    change([&] {
      paused_ = on;
      steps_ = 0;
    });
  }
  /** Wait while paused.
   * @return true if one step may be made now: not paused, or step was pressed;
   *         false at once if closed() or a restart was asked for.
   * Whoever never calls it has no pause, and the help names none. */
  bool wait_while_paused() {
    return wait_while_paused([] {});
  }
  /** As above, and call @a show() on this thread before it waits and each time
   * that strain_colors() changed meanwhile: a paused scene is the latest one,
   * in the right colors. */
  template <typename F>
  bool wait_while_paused(F show) {
    std::unique_lock lock(mutex_);
    std::optional<bool> shown_colors;
    pauses_ = true;
    while (!closed_ && !restart_ && paused_ && steps_ == 0) {
      if (shown_colors == strain_colors_) {
        control_.wait(lock);
        continue;
      }
      shown_colors = strain_colors_;
      lock.unlock();
      show();
      lock.lock();
    }
    if (closed_ || restart_) return false;
    if (paused_) --steps_;
    return true;
  }
  /** True once after the user asked for a restart. */
  bool take_restart() {
    std::lock_guard lock(mutex_);
    return std::exchange(restart_, false);
  }

  /** True while nodes should be colored by strain; then the scale is drawn. */
  bool strain_colors() const { return strain_colors_; }
  void set_strain_colors(bool on) {
    change([&] { strain_colors_ = on; });
  }

  // ----------------------------------------------------- On the main thread

  /** Show the window and serve the user until the window is closed.
   * @pre launch() was not called: one thread serves a window
   * @post closed() */
  void event_loop() {
    assert(!thread_.joinable() && "launch() has a thread that does this");
    serve();
  }

  /** Show the window and let a thread of the viewer serve the user until the
   * window is closed. Returns when the window is there; the destructor waits
   * until it is closed, the program goes on meanwhile: see closed().
   * That thread makes the window anew, since SDL wants a window made and its
   * events read in one thread. (On macOS that is the main one: use
   * event_loop() there.)
   * @pre neither launch() nor event_loop() was called
   * Throws NoDisplay if it can't be made again. */
  void launch() {
    assert(!thread_.joinable() && "launch() is called twice");
    canvas_.reset();
    take_again();  // the new one was shown nothing
    std::promise<void> promise;
    auto made = promise.get_future();
    thread_ = std::thread([this, promise = std::move(promise)]() mutable {
      try {
        canvas_.emplace(options_);
      } catch (...) {
        return promise.set_exception(std::current_exception());
      }
      promise.set_value();
      serve();
      canvas_.reset();
    });
    made.get();
  }

  /** Draw the scene into a picture of the size in the options; needs no
   * event_loop(). With label and scale, without help and frame rate: the same
   * scene gives the same picture. A scene under construction is completed if
   * this thread builds it, and left out if another does.
   * @pre launch() was not called: its thread has the window
   * Throws std::runtime_error if the driver has no memory for it. */
  Image snapshot() {
    assert(!thread_.joinable() && "a thread of launch() draws");
    complete_own();
    canvas_->window.make_current();
    auto& frame = canvas_->frame;
    if (!frame) frame.emplace(options_.width, options_.height);
    frame->bind();
    draw(options_.width, options_.height,
         std::max(0.75, options_.height / 768.0), false);
    return frame->read();
  }

 private:
  using clock = std::chrono::steady_clock;
  using ms = std::chrono::milliseconds;
  static constexpr ms frame_time{16};  // between frames, at least

  /** What is drawn on, made, used and destroyed by one thread. */
  struct Canvas {
    SDLWindow window;
    GLScene scene;
    GLOverlay overlay;
    std::optional<GLFrame> frame;
    explicit Canvas(const Options& o)
        : window(o.title, o.width, o.height, o.offscreen) {}
    ~Canvas() { window.make_current(); }
  };

  const Options options_;
  std::thread thread_;  // of launch()
  // Of the main thread, or of the one of launch():
  std::optional<Canvas> canvas_;
  clock::time_point last_frame_;
  double frame_period_ = 0;  // [s]

  std::mutex mutex_;  // of all below
  std::condition_variable control_;
  OverlayText text_;
  GLCamera camera_;
  std::optional<BoundingBox> look_at_ = GLCamera::usual_box();  // empty: all
  int steps_ = 0;        // to be made while paused
  bool pauses_ = false;  // whether the program asks
  bool restart_ = false;
  // Written under the lock only, read without:
  std::atomic<bool> paused_ = false, closed_ = false, strain_colors_ = false;
  std::atomic<bool> redraw_ = true;

  /** Change something that is seen or waited for. */
  template <typename F>
  void change(F f) {
    std::lock_guard lock(mutex_);
    f();
    redraw_ = true;
    control_.notify_all();
  }

  /** Show the window and serve the user until closed(). */
  void serve() {
    canvas_->window.make_current();
    canvas_->window.show();
    auto next = clock::now();  // no frame before
    while (!closed_) {
      // Look for a new scene often while they come, seldom when none does.
      const auto now = clock::now();
      const ms poll(now - last_frame_ < ms(200) ? 2 : 8);
      const auto rest = std::chrono::ceil<ms>(next - now);
      const auto wait = std::max(rest, needs_frame() ? ms(0) : poll);
      SDL_Event e;
      if (SDL_WaitEventTimeout(&e, int(wait.count()))) do
          handle(e);
        while (SDL_PollEvent(&e));
      complete_if_quiet();
      const auto start = clock::now();
      if (closed_ || start < next || !needs_frame()) continue;
      show_frame();
      next = start + frame_time;
    }
    canvas_->window.hide();
  }

  bool needs_frame() const {
    return (redraw_ || has_new()) && !canvas_->window.minimized();
  }

  /** Draw into the current frame buffer.
   * @param scale Pixels to a unit of length of the desktop */
  void draw(int width, int height, double scale, bool interactive) {
    take([&](const SceneData& s, bool edges_changed) {
      canvas_->scene.upload(s, edges_changed);
    });
    OverlayText text;
    GLCamera camera;
    {
      std::lock_guard lock(mutex_);
      if (look_at_)
        camera_.fit(look_at_->empty() ? canvas_->scene.box() : *look_at_,
                    double(width) / height);
      look_at_.reset();
      redraw_ = false;
      camera = camera_;
      text = text_;
      text.has_scale = strain_colors_;
      if (interactive) add_state(text);
    }
    canvas_->scene.draw(camera, width, height, scale);
    canvas_->overlay.draw(text, width, height, scale);
  }

  void add_state(OverlayText& text) const {
    const double rate = frame_period_ > 0 ? 1 / frame_period_ : 0;
    text.state = pauses_ && paused_
                     ? "paused"
                     : std::to_string(std::lround(rate)) + " frames/s";
    if (!text.message.empty())
      text.state = options_.restarts ? "stopped: r restarts, q quits"
                                     : "stopped: q quits";
    std::string keys;
    if (pauses_) keys += "space pause   n step   ";
    if (options_.restarts) keys += "r restart   ";
    if (options_.colors) keys += "s strain   ";
    text.help = {keys + "c center",
                 "drag turn   right drag move   wheel zoom   q quit"};
  }

  void show_frame() {
    const auto [width, height] = canvas_->window.pixels();
    draw(width, height, double(height) / canvas_->window.size()[1], true);
    canvas_->window.swap();
    const auto now = clock::now();
    const double period =
        std::chrono::duration<double>(now - last_frame_).count();
    last_frame_ = now;
    // Smoothed over some 20 frames; a pause is no frame.
    if (period < 0.5)
      frame_period_ += (period - frame_period_) / (frame_period_ > 0 ? 20 : 1);
  }

  // ------------------------------------------------------------------ Events

  void handle(const SDL_Event& e) {
    const auto [width, height] = canvas_->window.size();
    const double unit = 1.0 / std::min(width, height);
    switch (e.type) {
      case SDL_QUIT:
        return close();
      case SDL_WINDOWEVENT:
        if (e.window.event == SDL_WINDOWEVENT_CLOSE) return close();
        return change([] {});
      case SDL_KEYDOWN:
        if (!e.key.repeat) press(e.key.keysym.sym);
        return;
      case SDL_MOUSEMOTION: {
        const double x = e.motion.xrel * unit, y = -e.motion.yrel * unit;
        if (e.motion.state & SDL_BUTTON_LMASK)
          change([&] { camera_.rotate(3 * x, 3 * y); });
        else if (e.motion.state & SDL_BUTTON_RMASK)
          change([&] { camera_.pan(x, y); });
        return;
      }
      case SDL_MOUSEWHEEL:
        return change([&] { camera_.zoom(std::pow(1.1, e.wheel.preciseY)); });
    }
  }

  void press(SDL_Keycode key) {
    switch (key) {
      case SDLK_SPACE:
        return set_paused(!paused_);
      case SDLK_n:  // pauses, too
        return change([&] {
          paused_ = true;
          ++steps_;
        });
      case SDLK_r:
        if (!options_.restarts) return;
        return change([&] {
          restart_ = true;
          steps_ = 0;
        });
      case SDLK_s:
        if (!options_.colors) return;
        return change([&] { strain_colors_ = !strain_colors_; });
      case SDLK_c:
        return change([&] { look_at_ = BoundingBox(); });
      case SDLK_q:
      case SDLK_ESCAPE:
        return close();
    }
  }
};

}  // namespace CME212
