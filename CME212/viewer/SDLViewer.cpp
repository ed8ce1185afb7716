/** @file SDLViewer.cpp
 * The drawing thread, and the events that it handles. */
#include "CME212/SDLViewer.hpp"

#include <algorithm>
#include <atomic>
#include <cassert>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <exception>
#include <filesystem>
#include <future>
#include <iostream>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

#include "CME212/viewer/GLCamera.hpp"
#include "CME212/viewer/GLOverlay.hpp"
#include "CME212/viewer/GLScene.hpp"
#include "CME212/viewer/GLTools.hpp"
#include "CME212/viewer/SDLWindow.hpp"

namespace CME212 {

/** The settings of the program and of its user, and the window. */
class SDLViewer::Display {
 public:
  // Settings, which any thread may change.
  std::mutex mutex;  // of all of them
  std::condition_variable control;
  OverlayText text;
  GLCamera camera;
  std::optional<BoundingBox> look_at = GLCamera::usual_box();  // empty: all
  Look look;
  std::vector<Mark> marks;
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
    change([this, on] { paused = on, steps = 0; });
  }

  const Options options;

  Display(SceneBuilder& builder, const Options& o)
      : options(o), builder_(builder), canvas_(std::in_place, o) {}
  ~Display() {
    if (launched()) thread_.join();
  }

  /** True if a thread of the viewer has the window. */
  bool launched() const { return thread_.joinable(); }
  void launch();
  /** Show the window and handle its events until it is closed. */
  void serve();
  Image snapshot();

 private:
  using clock = std::chrono::steady_clock;
  using ms = std::chrono::milliseconds;
  static constexpr ms frame_time{16};  // between frames, at least

  /** The window and its OpenGL objects: one thread makes, uses and destroys
   * them. */
  struct Canvas {
    SDLWindow window;
    GLScene scene;
    GLOverlay overlay;
    std::optional<GLFrame> frame;
    explicit Canvas(const Options& o)
        : window(o.title, o.width, o.height, o.offscreen) {}
  };

  SceneBuilder& builder_;
  std::thread thread_;  // of launch()
  // For the main thread only, or for that of launch():
  std::optional<Canvas> canvas_;
  clock::time_point last_frame_;

  bool needs_frame() const {
    return (redraw || builder_.has_new()) && !canvas_->window.minimized();
  }
  void draw(int width, int height, double scale, bool in_window);
  std::vector<std::string> keys() const;
  void show_frame();
  void handle(const SDL_Event& e);
  void turn(const SDL_MouseMotionEvent& e);
  void press(SDL_Keycode key);
};

// -------------------------------------------------------------------- Drawing

void SDLViewer::Display::launch() {
  canvas_.reset();
  builder_.take_again();  // the new window has no scene yet
  std::promise<void> promise;
  auto made = promise.get_future();
  thread_ = std::thread([this, promise = std::move(promise)]() mutable {
    try {
      canvas_.emplace(options);
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
  const auto [width, height] = options.width > 0
                                   ? std::array{options.width, options.height}
                                   : SDLWindow::usual_size;
  if (!frame) frame.emplace(width, height);
  frame->bind();
  draw(width, height, std::max(0.75, height / 768.0), false);
  return frame->read();
}

void SDLViewer::Display::serve() {
  canvas_->window.make_current();
  canvas_->window.show();
  auto next = clock::now();  // no frame before
  while (!closed) {
    // Look for a new scene often while scenes come, seldom otherwise.
    const auto now = clock::now();
    const ms poll(now - last_frame_ < ms(200) ? 2 : 8);
    const auto rest = std::chrono::ceil<ms>(next - now);
    const auto wait = std::max(rest, needs_frame() ? ms(0) : poll);
    // Not SDL_WaitEventTimeout(): under X11 it wakes itself by a message over a
    // second connection, an error if the window is destroyed before it arrives.
    std::this_thread::sleep_for(wait);
    for (SDL_Event e; SDL_PollEvent(&e);) handle(e);
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
                              bool in_window) {
  builder_.take([&](const SceneData& s, bool edges_changed) {
    canvas_->scene.upload(s, edges_changed);
  });
  OverlayText shown;
  GLCamera eye;
  Look what;
  {
    std::lock_guard lock(mutex);
    if (look_at)
      camera.fit(look_at->empty() ? canvas_->scene.box() : *look_at,
                 double(width) / height);
    look_at.reset();
    redraw = false;
    eye = camera;
    what = look;
    shown = text;
    shown.has_scale = strain_colors;
    for (const Mark& m : marks)
      shown.marks.push_back({camera.pixel(m.from, width, height),
                             camera.pixel(m.to, width, height)});
    if (in_window) {
      std::string title = options.title;
      for (const auto& part :
           {shown.label, std::string(paused ? "paused" : "")})
        if (!part.empty()) title += "   " + part;
      canvas_->window.set_title(title);
      shown.label.clear();
      shown.help = keys();
    }
  }
  canvas_->scene.draw(eye, width, height, scale, what, shown.has_scale);
  canvas_->overlay.draw(shown, width, height, scale);
}

/** The lines that name the keys. */
std::vector<std::string> SDLViewer::Display::keys() const {
  if (!help) return {};
  std::string control;
  if (pauses) control += "space pause   n step   ";
  if (options.restarts) control += "r restart   ";
  if (options.colors) control += "s strain   ";
  std::string parts = "c center   ";
  if (canvas_->scene.has_faces()) parts += "f faces   w wires   d nodes   ";
  return {control + parts + "q quit",
          "drag to turn, right drag to move, wheel to zoom   ? hides this"};
}

void SDLViewer::Display::show_frame() {
  const auto [width, height] = canvas_->window.pixels();
  const auto [wide, high] = canvas_->window.size();
  // Text is larger in a large window, and fits into a small one.
  const double fit = std::min(wide / 1024.0, high / 768.0);
  draw(width, height, double(height) / high * std::max(fit, 0.75), true);
  canvas_->window.swap();
  last_frame_ = clock::now();
}

// --------------------------------------------------------------------- Events

void SDLViewer::Display::handle(const SDL_Event& e) {
  switch (e.type) {
    case SDL_QUIT:
      return close();
    case SDL_WINDOWEVENT:
      if (e.window.event == SDL_WINDOWEVENT_CLOSE) return close();
      return change([] {});
    case SDL_MOUSEMOTION:
      return turn(e.motion);
    case SDL_MOUSEWHEEL:
      return change([&] { camera.zoom(std::pow(1.1, e.wheel.preciseY)); });
    case SDL_KEYDOWN:
      if (!e.key.repeat) press(e.key.keysym.sym);
      return;
    case SDL_TEXTINPUT:  // the place of ? depends on the keyboard
      if (e.text.text[0] == '?') change([&] { help = !help; });
      return;
  }
}

/** Move the camera as the mouse moves with a button pressed. */
void SDLViewer::Display::turn(const SDL_MouseMotionEvent& e) {
  const auto [width, height] = canvas_->window.size();
  const double unit = 1.0 / std::min(width, height);
  const double right = e.xrel * unit, up = -e.yrel * unit;
  if (e.state & SDL_BUTTON_LMASK)
    change([&] { camera.rotate(3 * right, 3 * up); });
  else if (e.state & SDL_BUTTON_RMASK)
    change([&] { camera.pan(right, up); });
}

void SDLViewer::Display::press(SDL_Keycode key) {
  switch (key) {
    case SDLK_SPACE:
      return set_paused(!paused);
    case SDLK_n:
      return change([&] { paused = true, ++steps; });
    case SDLK_r:
      if (!options.restarts) return;
      return change([&] { restart = true, steps = 0; });
    case SDLK_s:
      if (!options.colors) return;
      return change([&] { strain_colors = !strain_colors; });
    case SDLK_f:
      return change([&] { look.faces = !look.faces; });
    case SDLK_w:
      return change([&] { look.wires = !look.wires; });
    case SDLK_d:
      return change([&] { look.nodes = !look.nodes; });
    case SDLK_c:
      return change([&] { look_at = BoundingBox(); });
    case SDLK_q:
    case SDLK_ESCAPE:
      return close();
  }
}

// ------------------------------------------------------ What the program calls

SDLViewer::SDLViewer(const Options& o) {
  end_by_no_display();
  Options options = o;
  if (!o.picture.empty() && !has_display()) options.offscreen = true;
  display_ = std::make_unique<Display>(*this, options);
}
SDLViewer::~SDLViewer() = default;  // Display is complete here

bool SDLViewer::has_display() {
  try {
    return SDLVideo(false).has_display();
  } catch (const NoDisplay&) {
    return false;
  }
}

void SDLViewer::center_view() {
  display_->change([&] { display_->look_at = BoundingBox(); });
}

void SDLViewer::set_view(const Point& eye_direction, const BoundingBox& box) {
  display_->change([&] {
    display_->camera.look_from(eye_direction);
    display_->look_at = box;
  });
}

void SDLViewer::set_label(const std::string& label) {
  display_->change([&] { display_->text.label = label; });
}

void SDLViewer::set_message(std::vector<std::string> paragraphs,
                            const Color& bar) {
  display_->change([&] {
    display_->text.message = std::move(paragraphs);
    display_->text.bar = bar;
  });
}

void SDLViewer::set_marks(std::vector<Mark> marks) {
  display_->change([&] { display_->marks = std::move(marks); });
}

void SDLViewer::set_scale(const StrainScale& scale) {
  display_->change([&] { display_->text.scale = scale; });
}

void SDLViewer::set_look(const Look& look) {
  display_->change([&] { display_->look = look; });
}

bool SDLViewer::closed() const { return display_->closed; }
void SDLViewer::close() { display_->close(); }
void SDLViewer::set_paused(bool on) { display_->set_paused(on); }

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
  display_->change([&] { display_->strain_colors = on; });
}

void SDLViewer::event_loop() {
  assert(!display_->launched() && "launch() has a thread that does this");
  if (in_window() || display_->options.picture.empty()) display_->serve();
}

bool SDLViewer::in_window() const { return !display_->options.offscreen; }

void SDLViewer::write_picture() {
  const std::string& file = display_->options.picture;
  if (in_window() || file.empty()) return;
  std::filesystem::create_directories(
      std::filesystem::absolute(file).parent_path());
  write_png(file, snapshot());
  std::cout << "no display; a picture of the last state: " << file << '\n';
}

void SDLViewer::launch() {
  assert(!display_->launched() && "launch() is called twice");
  display_->launch();
}

Image SDLViewer::snapshot() {
  assert(!display_->launched() && "a thread of launch() draws");
  complete();
  return display_->snapshot();
}

}  // namespace CME212
