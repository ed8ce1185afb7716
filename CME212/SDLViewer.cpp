/** @file SDLViewer.cpp
 * The drawing thread, and the events that it serves. */
#include "CME212/SDLViewer.hpp"

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
#include <thread>
#include <utility>

#include "CME212/GLCamera.hpp"
#include "CME212/GLOverlay.hpp"
#include "CME212/GLScene.hpp"
#include "CME212/GLTools.hpp"
#include "CME212/SDLWindow.hpp"

namespace CME212 {

namespace {

/** What the program and the user set, from any thread. */
struct Settings {
  std::mutex mutex;  // of all below
  std::condition_variable control;
  OverlayText text;
  GLCamera camera;
  std::optional<BoundingBox> look_at = GLCamera::usual_box();  // empty: all
  int steps = 0;         // to be made while paused
  bool pauses = false;   // the program calls wait_while_paused()
  bool restart = false;  // not yet taken
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
};

}  // namespace

/** The settings, and what they are drawn on. */
class SDLViewer::Display : public Settings {
 public:
  Display(SceneBuilder& builder, const Options& o)
      : builder_(builder), options_(o), canvas_(std::in_place, o) {}
  ~Display() {
    if (thread_.joinable()) thread_.join();
  }

  /** True if a thread of the viewer has the window. */
  bool launched() const { return thread_.joinable(); }
  void launch();
  /** Show the window and serve the user until closed. */
  void serve();
  Image snapshot();

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

  SceneBuilder& builder_;
  const Options options_;
  std::thread thread_;  // of launch()
  // Of the main thread, or of the one of launch():
  std::optional<Canvas> canvas_;
  clock::time_point last_frame_;
  double frame_period_ = 0;  // [s]

  bool needs_frame() const {
    return (redraw || builder_.has_new()) && !canvas_->window.minimized();
  }
  void draw(int width, int height, double scale, bool interactive);
  void add_state(OverlayText& shown) const;
  void show_frame();
  void handle(const SDL_Event& e);
  void press(SDL_Keycode key);
};

// -------------------------------------------------------------------- Drawing

void SDLViewer::Display::launch() {
  canvas_.reset();
  builder_.take_again();  // the new one was shown nothing
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

Image SDLViewer::Display::snapshot() {
  canvas_->window.make_current();
  auto& frame = canvas_->frame;
  if (!frame) frame.emplace(options_.width, options_.height);
  frame->bind();
  draw(options_.width, options_.height, std::max(0.75, options_.height / 768.0),
       false);
  return frame->read();
}

void SDLViewer::Display::serve() {
  canvas_->window.make_current();
  canvas_->window.show();
  auto next = clock::now();  // no frame before
  while (!closed) {
    // Look for a new scene often while they come, seldom when none does.
    const auto now = clock::now();
    const ms poll(now - last_frame_ < ms(200) ? 2 : 8);
    const auto rest = std::chrono::ceil<ms>(next - now);
    const auto wait = std::max(rest, needs_frame() ? ms(0) : poll);
    SDL_Event e;
    if (SDL_WaitEventTimeout(&e, int(wait.count()))) do
        handle(e);
      while (SDL_PollEvent(&e));
    builder_.complete_if_quiet();
    const auto start = clock::now();
    if (closed || start < next || !needs_frame()) continue;
    show_frame();
    next = start + frame_time;
  }
  canvas_->window.hide();
}

/** Draw into the current frame buffer.
 * @param scale Pixels to a unit of length of the desktop */
void SDLViewer::Display::draw(int width, int height, double scale,
                              bool interactive) {
  builder_.take([&](const SceneData& s, bool edges_changed) {
    canvas_->scene.upload(s, edges_changed);
  });
  OverlayText shown;
  GLCamera eye;
  {
    std::lock_guard lock(mutex);
    if (look_at)
      camera.fit(look_at->empty() ? canvas_->scene.box() : *look_at,
                 double(width) / height);
    look_at.reset();
    redraw = false;
    eye = camera;
    shown = text;
    shown.has_scale = strain_colors;
    if (interactive) add_state(shown);
  }
  canvas_->scene.draw(eye, width, height, scale);
  canvas_->overlay.draw(shown, width, height, scale);
}

void SDLViewer::Display::add_state(OverlayText& shown) const {
  const double rate = frame_period_ > 0 ? 1 / frame_period_ : 0;
  shown.state = pauses && paused
                    ? "paused"
                    : std::to_string(std::lround(rate)) + " frames/s";
  if (!shown.message.empty())
    shown.state =
        options_.restarts ? "stopped: r restarts, q quits" : "stopped: q quits";
  std::string keys;
  if (pauses) keys += "space pause   n step   ";
  if (options_.restarts) keys += "r restart   ";
  if (options_.colors) keys += "s strain   ";
  shown.help = {keys + "c center",
                "drag turn   right drag move   wheel zoom   q quit"};
}

void SDLViewer::Display::show_frame() {
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

// --------------------------------------------------------------------- Events

void SDLViewer::Display::handle(const SDL_Event& e) {
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
        change([&] { camera.rotate(3 * x, 3 * y); });
      else if (e.motion.state & SDL_BUTTON_RMASK)
        change([&] { camera.pan(x, y); });
      return;
    }
    case SDL_MOUSEWHEEL:
      return change([&] { camera.zoom(std::pow(1.1, e.wheel.preciseY)); });
  }
}

void SDLViewer::Display::press(SDL_Keycode key) {
  switch (key) {
    case SDLK_SPACE:
      return set_paused(!paused);
    case SDLK_n:  // pauses, too
      return change([&] {
        paused = true;
        ++steps;
      });
    case SDLK_r:
      if (!options_.restarts) return;
      return change([&] {
        restart = true;
        steps = 0;
      });
    case SDLK_s:
      if (!options_.colors) return;
      return change([&] { strain_colors = !strain_colors; });
    case SDLK_c:
      return change([&] { look_at = BoundingBox(); });
    case SDLK_q:
    case SDLK_ESCAPE:
      return close();
  }
}

// ------------------------------------------------------ What the program calls

SDLViewer::SDLViewer(const Options& o)
    : display_(std::make_unique<Display>(*this, o)) {}
SDLViewer::~SDLViewer() = default;  // Display is complete here

bool SDLViewer::has_display() {
  try {
    return SDLVideo(false).has_display();
  } catch (const NoDisplay&) {
    return false;
  }
}

void SDLViewer::center_view() {
  Display& d = *display_;
  complete_without_edges();
  d.change([&] { d.look_at = BoundingBox(); });
}

void SDLViewer::set_view(const Point& eye_direction, const BoundingBox& box) {
  Display& d = *display_;
  d.change([&] {
    d.camera.look_from(eye_direction);
    d.look_at = box;
  });
}

void SDLViewer::set_label(const std::string& label) {
  Display& d = *display_;
  complete_without_edges();
  d.change([&] { d.text.label = label; });
}

void SDLViewer::set_message(std::vector<std::string> paragraphs) {
  Display& d = *display_;
  d.change([&] { d.text.message = std::move(paragraphs); });
}

void SDLViewer::set_scale(std::string title, double low, double high,
                          std::string unit) {
  Display& d = *display_;
  d.change([&] {
    d.text.scale = {std::move(title), low, high, std::move(unit)};
  });
}

bool SDLViewer::closed() const { return display_->closed; }
void SDLViewer::close() { display_->close(); }
void SDLViewer::set_paused(bool on) { display_->set_paused(on); }

bool SDLViewer::wait_while_paused() {
  return wait_while_paused([] {});
}
bool SDLViewer::wait_while_paused(const std::function<void()>& show) {
  Display& d = *display_;
  std::unique_lock lock(d.mutex);
  std::optional<bool> shown_colors;
  d.pauses = true;
  while (!d.closed && !d.restart && d.paused && d.steps == 0) {
    if (shown_colors == d.strain_colors) {
      d.control.wait(lock);
      continue;
    }
    shown_colors = d.strain_colors;
    lock.unlock();
    show();
    lock.lock();
  }
  if (d.closed || d.restart) return false;
  if (d.paused) --d.steps;
  return true;
}

bool SDLViewer::take_restart() {
  Display& d = *display_;
  std::lock_guard lock(d.mutex);
  return std::exchange(d.restart, false);
}

bool SDLViewer::strain_colors() const { return display_->strain_colors; }
void SDLViewer::set_strain_colors(bool on) {
  Display& d = *display_;
  d.change([&] { d.strain_colors = on; });
}

void SDLViewer::event_loop() {
  assert(!display_->launched() && "launch() has a thread that does this");
  display_->serve();
}

void SDLViewer::launch() {
  assert(!display_->launched() && "launch() is called twice");
  display_->launch();
}

Image SDLViewer::snapshot() {
  assert(!display_->launched() && "a thread of launch() draws");
  complete_own();
  return display_->snapshot();
}

}  // namespace CME212
