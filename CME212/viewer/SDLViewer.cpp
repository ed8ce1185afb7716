/** @file SDLViewer.cpp
 * The drawing thread, and the events that it handles. */
#include "CME212/SDLViewer.hpp"

#include <algorithm>
#include <cassert>
#include <chrono>
#include <cmath>
#include <exception>
#include <future>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

#include "CME212/viewer/GLCamera.hpp"
#include "CME212/viewer/GLOverlay.hpp"
#include "CME212/viewer/GLScene.hpp"
#include "CME212/viewer/GLTools.hpp"
#include "CME212/viewer/MouseTool.hpp"
#include "CME212/viewer/SDLSettings.hpp"
#include "CME212/viewer/SDLWindow.hpp"

namespace CME212 {

/** The settings, and the window. */
class SDLViewer::Display : public SDLSettings {
 public:
  Display(SceneBuilder& builder, const Options& o)
      : builder_(builder), options_(o), canvas_(std::in_place, o) {}
  ~Display() {
    if (thread_.joinable()) thread_.join();
  }

  /** True if a thread of the viewer has the window. */
  bool launched() const { return thread_.joinable(); }
  // Set before the window's events are handled:
  std::function<double()> panels;
  std::function<void(const Touch&)> touch;
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
    ~Canvas() { window.make_current(); }
  };

  SceneBuilder& builder_;
  const Options options_;
  std::thread thread_;  // of launch()
  // For the main thread only, or for that of launch():
  std::optional<Canvas> canvas_;
  clock::time_point last_frame_;
  double frame_period_ = 0;  // [s]
  MouseTool mouse_tool_;
  Picture picture_;                // drawn last
  std::array<double, 2> mouse_{};  // in it
  double unit_ = 1;                // pixels to a unit of the mouse
  double scale_ = 1;               // pixels to a unit of length
  int unsettled_ = 0;              // frames until panels show the user's input

  bool needs_frame() const {
    return (redraw || builder_.has_new() || unsettled_ > 0 ||
            canvas_->overlay.input.waits()) &&
           !canvas_->window.minimized();
  }
  void draw(int width, int height, double scale, bool interactive);
  double interact();
  void add_state(OverlayText& shown) const;
  void show_frame();
  void handle(const SDL_Event& e);
  void on_picture(const SDL_Event& e);
  void point_at(const SDL_Event& e);
  void press(SDL_Keycode key);
  void type(char key);
};

// -------------------------------------------------------------------- Drawing

void SDLViewer::Display::launch() {
  canvas_.reset();
  builder_.take_again();  // the new window has no scene yet
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
  const auto [width, height] = options_.width > 0
                                   ? std::array{options_.width, options_.height}
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
  GLOverlay& overlay = canvas_->overlay;
  overlay.start(width, height, scale);
  const double left = interactive ? interact() : 0;
  builder_.take([&](const SceneData& s, bool edges_changed) {
    canvas_->scene.upload(s, edges_changed);
    if (touch) mouse_tool_.look(s, edges_changed);
  });
  OverlayText shown;
  GLCamera eye;
  Look what;
  {
    std::lock_guard lock(mutex);
    camera.set_hidden_left(left / width);
    if (look_at)
      camera.fit(look_at->empty() ? canvas_->scene.box() : *look_at,
                 double(width) / height);
    look_at.reset();
    redraw = false;
    eye = camera;
    what = look;
    shown = text;
    shown.has_scale = strain_colors;
    if (interactive) add_state(shown);
  }
  picture_ = {eye, double(width), double(height)};
  if (interactive) {
    shown.ring = mouse_tool_.ring(picture_);
    shown.line = mouse_tool_.stroke();
    if (shown.ring && mouse_tool_.holds())
      shown.line = {*shown.ring, {float(mouse_[0]), float(mouse_[1])}};
  }
  canvas_->scene.draw(eye, width, height, scale, what, shown.has_scale);
  overlay.finish(shown, left);
}

/** Handle input in the frame that is open.
 * @return the width that panels take at the left [pixels] */
double SDLViewer::Display::interact() {
  GLOverlay& overlay = canvas_->overlay;
  const auto events = overlay.open(unit_);
  unsettled_ = events.empty() ? std::max(unsettled_ - 1, 0) : 2;
  for (const SDL_Event& e : events) {
    point_at(e);
    const bool held = mouse_tool_.holds() || mouse_tool_.cuts();
    if (held || !overlay.panels_want_mouse()) on_picture(e);
    if (overlay.panels_want_mouse() && !held) mouse_tool_.leave();
  }
  return panels && panels_shown ? panels() : 0;
}

void SDLViewer::Display::add_state(OverlayText& shown) const {
  const double rate = frame_period_ > 0 ? 1 / frame_period_ : 0;
  shown.state = pauses && paused
                    ? "paused"
                    : std::to_string(std::lround(rate)) + " frames/s";
  if (!shown.message.empty())
    shown.state =
        options_.restarts ? "stopped: r restarts, q quits" : "stopped: q quits";
  if (!help.value_or(!panels)) {
    shown.help = {"? keys"};
    return;
  }
  std::string keys;
  if (pauses) keys += "space pause   n step   ";
  if (options_.restarts) keys += "r restart   ";
  if (options_.colors) keys += "s strain   ";
  shown.help = {keys + "c center"};
  if (canvas_->scene.has_faces())
    shown.help.push_back("f faces   w wires   d nodes");
  if (touch)
    shown.help.push_back("drag the cloth   Ctrl-drag cut   p pin or unpin");
  if (panels) shown.help.push_back("Tab panels   + - size   ? keys");
  shown.help.push_back("drag turn   right drag move   wheel zoom   q quit");
}

void SDLViewer::Display::show_frame() {
  const auto [width, height] = canvas_->window.pixels();
  const auto [wide, high] = canvas_->window.size();
  unit_ = double(height) / high;
  // Text and panels are larger in a large window, and fit into a small one.
  const double fit = std::min(wide / 1024.0, high / 768.0);
  scale_ = unit_ * text_scale * std::max(fit, 0.75);
  draw(width, height, scale_, true);
  canvas_->window.swap();
  const auto now = clock::now();
  const double period =
      std::chrono::duration<double>(now - last_frame_).count();
  last_frame_ = now;
  // Smoothed over some 20 frames; a pause does not count.
  if (period < 0.5)
    frame_period_ += (period - frame_period_) / (frame_period_ > 0 ? 20 : 1);
}

// --------------------------------------------------------------------- Events

void SDLViewer::Display::handle(const SDL_Event& e) {
  switch (e.type) {
    case SDL_QUIT:
      return close();
    case SDL_WINDOWEVENT:
      if (e.window.event == SDL_WINDOWEVENT_CLOSE) return close();
      change([] {});
      break;
    case SDL_KEYDOWN:
      if (!e.key.repeat && !canvas_->overlay.panels_want_keys())
        press(e.key.keysym.sym);
      break;
    case SDL_TEXTINPUT:
      if (!canvas_->overlay.panels_want_keys()) type(e.text.text[0]);
      break;
  }
  if (panels || touch)
    canvas_->overlay.input.add(e);
  else
    on_picture(e);
}

/** Keep the position of the mouse. */
void SDLViewer::Display::point_at(const SDL_Event& e) {
  if (e.type == SDL_MOUSEMOTION)
    mouse_ = {e.motion.x * unit_, e.motion.y * unit_};
  if (e.type == SDL_MOUSEBUTTONDOWN || e.type == SDL_MOUSEBUTTONUP)
    mouse_ = {e.button.x * unit_, e.button.y * unit_};
}

/** The mouse outside of panels. */
void SDLViewer::Display::on_picture(const SDL_Event& e) {
  const auto [width, height] = canvas_->window.size();
  const double unit = 1.0 / std::min(width, height);
  const auto [x, y] = mouse_;
  const double near = 12 * scale_;  // [pixels]
  const bool left = e.button.button == SDL_BUTTON_LEFT;
  switch (e.type) {
    case SDL_MOUSEBUTTONDOWN:
      if (!touch || !left) return;
      if (ImGui::GetIO().KeyCtrl) return mouse_tool_.start_cut(x, y);
      if (const auto t = mouse_tool_.grab(picture_, x, y, near)) touch(*t);
      return;
    case SDL_MOUSEBUTTONUP:
      if (!left) return;
      if (mouse_tool_.holds()) touch(mouse_tool_.release());
      return mouse_tool_.end_cut();
    case SDL_MOUSEMOTION: {
      if (mouse_tool_.holds()) return touch(mouse_tool_.move(picture_, x, y));
      if (mouse_tool_.cuts()) return touch(mouse_tool_.cut(picture_, x, y));
      const double right = e.motion.xrel * unit, up = -e.motion.yrel * unit;
      if (e.motion.state & SDL_BUTTON_LMASK)
        change([&] { camera.rotate(3 * right, 3 * up); });
      else if (e.motion.state & SDL_BUTTON_RMASK)
        change([&] { camera.pan(right, up); });
      else if (touch)
        mouse_tool_.hover(picture_, x, y, near);
      return;
    }
    case SDL_MOUSEWHEEL:
      return change([&] { camera.zoom(std::pow(1.1, e.wheel.preciseY)); });
    case SDL_KEYDOWN:
      if (!touch || e.key.keysym.sym != SDLK_p || e.key.repeat) return;
      if (const auto node = mouse_tool_.node_at(picture_, x, y, near))
        touch({Touch::Kind::pin, *node});
      return;
  }
}

void SDLViewer::Display::press(SDL_Keycode key) {
  switch (key) {
    case SDLK_SPACE:
      return set_paused(!paused);
    case SDLK_n:  // pauses, too
      return step_once();
    case SDLK_r:
      if (options_.restarts) ask_restart();
      return;
    case SDLK_s:
      if (!options_.colors) return;
      return change([&] { strain_colors = !strain_colors; });
    case SDLK_f:
      return change([&] { look.faces = !look.faces; });
    case SDLK_w:
      return change([&] { look.wires = !look.wires; });
    case SDLK_d:
      return change([&] { look.nodes = next(look.nodes); });
    case SDLK_c:
      return change([&] { look_at = BoundingBox(); });
    case SDLK_TAB:
      return change([&] { panels_shown = !panels_shown; });
    case SDLK_q:
    case SDLK_ESCAPE:
      return close();
  }
}

/** Keys whose place depends on the keyboard: by the text that they give. */
void SDLViewer::Display::type(char key) {
  change([&] {
    if (key == '?') help = !help.value_or(!panels);
    if (key == '+') text_scale = std::min(text_scale * 1.1, 4.0);
    if (key == '-') text_scale = std::max(text_scale / 1.1, 0.5);
  });
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
  complete_without_edges();
  display_->change([&] { display_->look_at = BoundingBox(); });
}

void SDLViewer::set_view(const Point& eye_direction, const BoundingBox& box) {
  display_->change([&] {
    display_->camera.look_from(eye_direction);
    display_->look_at = box;
  });
}

void SDLViewer::set_label(const std::string& label) {
  complete_without_edges();
  display_->change([&] { display_->text.label = label; });
}

void SDLViewer::set_message(std::vector<std::string> paragraphs) {
  display_->change([&] { display_->text.message = std::move(paragraphs); });
}

void SDLViewer::set_card(std::vector<std::string> lines) {
  display_->change([&] { display_->text.card = std::move(lines); });
}

void SDLViewer::set_scale(ColorScale scale) {
  display_->change([&] { display_->text.scale = std::move(scale); });
}

Look SDLViewer::look() const {
  std::lock_guard lock(display_->mutex);
  return display_->look;
}
void SDLViewer::set_look(const Look& look) {
  display_->change([&] { display_->look = look; });
}

bool SDLViewer::closed() const { return display_->closed; }
void SDLViewer::close() { display_->close(); }
void SDLViewer::set_paused(bool on) { display_->set_paused(on); }

bool SDLViewer::paused() const { return display_->paused; }
void SDLViewer::step_once() { display_->step_once(); }
void SDLViewer::ask_restart() { display_->ask_restart(); }
void SDLViewer::wake() {
  display_->change([&] { display_->woken = true; });
}

void SDLViewer::set_panels(std::function<double()> draw) {
  display_->panels = std::move(draw);
}
void SDLViewer::set_touch(std::function<void(const Touch&)> serve) {
  display_->touch = std::move(serve);
}

bool SDLViewer::wait_while_paused() {
  return wait_while_paused([] {});
}
bool SDLViewer::wait_while_paused(const std::function<void()>& show) {
  Display& d = *display_;
  std::unique_lock lock(d.mutex);
  std::optional<bool> shown_colors;
  d.pauses = true;
  while (!d.closed && !d.restart && !d.woken && d.paused && d.steps == 0) {
    if (shown_colors == d.strain_colors) {
      d.control.wait(lock);
      continue;
    }
    shown_colors = d.strain_colors;
    lock.unlock();
    show();
    lock.lock();
  }
  if (std::exchange(d.woken, false) || d.closed || d.restart) return false;
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
