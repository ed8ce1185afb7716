/** @file Screen.cpp
 * Screen on SDLViewer; the only file of the laboratory that draws. */
#include "lab/viewer/Screen.hpp"

#ifdef MASS_SPRING_VIEWER

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <map>
#include <new>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

#include "CME212/SDLViewer.hpp"
#include "CME212/viewer/Image.hpp"
#include "lab/fast/GraphArrays.hpp"
#include "lab/scenes/Measure.hpp"
#include "lab/scenes/Memory.hpp"
#include "lab/stepping/Scene.hpp"

namespace lab {
namespace {

class SDLScreen : public Screen {
 public:
  SDLScreen(Kind kind, std::array<int, 2> pixels)
      : kind_(kind),
        viewer_({.width = pixels[0],
                 .height = pixels[1],
                 .title = "cloth",
                 .offscreen = kind != Kind::window,
                 .restarts = true,
                 .colors = true}) {
    viewer_.set_look({.wires = kind != Kind::film});
  }

  void show_strain(bool on) override { viewer_.set_strain_colors(on); }

  void show(const Scene& scene) override {
    const Cloth& g = scene.cloth();
    show_failure(scene);
    const bool strain = colored_ = viewer_.strain_colors();
    if (strain) set_scale(g);
    const auto color = [this, strain](Node n) {
      return strain ? CME212::Color::make_strain(
                          float(std::clamp(strain_at(n) / scale_, -1.0, 1.0)))
                    : CME212::Color(1);
    };
    viewer_.set_label(label(scene));
    if (!shown_ || moving_) add_obstacles(scene);
    if (!shown_) set_view(scene);
    if (kind_ == Kind::film) follow(g);
    const bool same = shown_ && version_ == arrays(g).version();
    if (!same) viewer_.clear(), nodes_.clear();
    viewer_.add_nodes(g.node_begin(), g.node_end(), color, nodes_);
    if (same) return;
    const auto faces = faces_of(scene);
    viewer_.add_faces(faces.begin(), faces.end(), nodes_);
    viewer_.add_edges(g.edge_begin(), g.edge_end(), nodes_);
    version_ = arrays(g).version();
    shown_ = true;
  }

  void show_card(const std::vector<std::string>& lines) override {
    card_ = lines;
    if (failure_.empty()) viewer_.set_message(card_, CME212::Color(0.7f));
  }
  void save_picture(const std::string& file) override {
    CME212::write_png(file, viewer_.snapshot());
  }
  void start_film(const std::string& file) override {
    auto picture = viewer_.snapshot();
    film_.emplace(file, picture.width, picture.height, frames_per_second);
  }
  void add_to_film(int times) override {
    const auto picture = viewer_.snapshot();
    for (; times > 0; --times) film_->add(picture);
  }
  void end_film() override { film_->finish(); }

  void event_loop() override { viewer_.event_loop(); }
  void close() override { viewer_.close(); }
  void set_paused(bool on) override { viewer_.set_paused(on); }
  bool closed() const override { return viewer_.closed(); }
  bool take_restart() override { return viewer_.take_restart(); }
  bool wants_frame() const override { return viewer_.wants_frame(); }
  bool coloring_changed() const override {
    return viewer_.strain_colors() != colored_;
  }
  bool wait_while_paused(const std::function<void()>& show) override {
    return viewer_.wait_while_paused(show);
  }

 private:
  static constexpr Point eye{1, -0.8, 0.4};  // its direction

  Kind kind_;
  CME212::SDLViewer viewer_;
  std::map<Node, unsigned> nodes_;
  std::optional<CME212::Video> film_;
  CME212::BoundingBox room_;  // looked at, and as much as it may become
  CME212::BoundingBox widest_;
  bool shown_ = false, colored_ = false;
  bool moving_ = false;            // whether an obstacle is
  std::size_t version_ = 0;        // of the cloth, when its edges were shown
  double scale_ = 0.01;            // the strain of the brightest color
  std::string failure_;            // that is shown, in words
  std::vector<std::string> card_;  // that is shown if nothing has failed
  CME212::Clock clock_;
  long long steps_ = 0;  // when clock_ was started
  double rate_ = 0;      // [steps/s]

  void show_failure(const Scene& scene) {
    const auto& failure = scene.failure();
    const std::string text = text_of(failure);
    if (text == failure_) return;
    failure_ = text;
    std::vector<CME212::Mark> marks;
    std::vector<std::string> paragraphs;
    if (failure) {
      const Cloth& g = scene.cloth();
      const auto& [node, spring] =
          std::pair(failure->place.node, failure->place.spring);
      if (g.has_node(node)) marks.push_back({node.position(), node.position()});
      if (g.has_edge(spring))
        marks.push_back({spring.node1().position(), spring.node2().position()});
      const Explanation why = scene.explanation();
      paragraphs = {why.cause, why.remedy, why.place};
    }
    viewer_.set_marks(std::move(marks));
    if (failure_.empty()) return show_card(card_);
    viewer_.set_message(std::move(paragraphs));
  }

  /** Let the scale end at the |strain| that one node in fifty exceeds, since a
   * few nodes at corners would leave no colors for the others; larger strains
   * have the color of its end. It only grows, so that a color keeps its
   * meaning. */
  void set_scale(const Cloth& g) {
    std::vector<double> strains, sizes;
    for (Node n : g.nodes()) {
      strains.push_back(strain_at(n));
      sizes.push_back(std::abs(strains.back()));
    }
    if (strains.empty()) return;
    const auto at = sizes.begin() + std::ptrdiff_t(sizes.size() * 49 / 50);
    std::nth_element(sizes.begin(), at, sizes.end());
    scale_ = std::max(scale_, round_up(*at));
    const auto [low, high] = std::ranges::minmax(strains);
    viewer_.set_scale({.limit = 100 * scale_,
                       .above = high > scale_,
                       .below = low < -scale_});
  }

  /** The nodes of the quads that are left. */
  static std::vector<std::array<Node, 4>> faces_of(const Scene& scene) {
    std::vector<std::array<Node, 4>> faces;
    const Cloth& g = scene.cloth();
    auto node = [&](unsigned i) {
      return arrays(g).node_with_id(scene.mesh().ids[i]);
    };
    for (const Quad& q : quads_left(g, scene.mesh()))
      faces.push_back({node(q[0]), node(q[1]), node(q[2]), node(q[3])});
    return faces;
  }

  /** The smallest of 0.01, 0.02, 0.05, 0.1, ... that is not below @a a. */
  static double round_up(double a) {
    double unit = 0.01;
    while (std::isfinite(a) && 10 * unit < a) unit *= 10;
    for (double digit : {1, 2, 5})
      if (a <= digit * unit) return digit * unit;
    return 10 * unit;
  }

  /** Time and size; the step rate only in a window, since pictures of the same
   * state shall be the same. */
  std::string label(const Scene& scene) {
    char time[32];
    std::snprintf(time, sizeof time, "t = %.3f s", scene.time());
    std::string text =
        time + ("   " + std::to_string(scene.cloth().num_nodes())) + " nodes";
    if (kind_ != Kind::window) return text;
    if (scene.steps() < steps_ || clock_.seconds() > 0.5) {
      rate_ = double(std::max(0LL, scene.steps() - steps_)) / clock_.seconds();
      steps_ = scene.steps();
      clock_.start();
    }
    return text + "   " + std::to_string(std::llround(rate_)) + " steps/s";
  }

  /** Look at the room that the scene names; else at the cloth as it is now, at
   * what it may fall on and, at the start, at the space below it. */
  void set_view(const Scene& scene) {
    CME212::BoundingBox room;
    if (const auto& view = scene.model().view) {
      room |= view->from;
      room |= view->to;
    }
    if (room.empty()) {
      for (Node n : scene.cloth().nodes()) room |= n.position();
      for (const Obstacle& o : obstacles_of(scene.model())) {
        if (o.kind == Obstacle::Kind::floor) continue;
        const Point reach(o.radius, o.radius, o.radius);
        room |= o.at - reach;
        room |= o.at + reach;
      }
      if (scene.time() == 0 && !room.empty())
        room |= room.min() - Point(0, 0, room.diagonal() / 2);
    }
    room_ = room;
    const Point reach(room.diagonal() / 2, room.diagonal() / 2,
                      room.diagonal() / 2);
    if (!room.empty()) widest_ = {room.min() - reach, room.max() + reach};
    viewer_.set_view(eye, room_);
  }

  /** Widen the view smoothly to where the cloth goes, but not after what flies
   * or falls away. */
  void follow(const Cloth& g) {
    CME212::BoundingBox wanted = room_;
    for (Node n : g.nodes())
      if (widest_.contains(n.position())) wanted |= n.position();
    if (room_.contains(wanted)) return;
    auto nearer = [](const Point& from, const Point& to) {
      return from + 0.15 * (to - from);
    };
    room_ = {nearer(room_.min(), wanted.min()),
             nearer(room_.max(), wanted.max())};
    viewer_.set_view(eye, room_);
  }

  /** Show what the cloth falls on where it is now, and nothing else. */
  void add_obstacles(const Scene& scene) {
    viewer_.clear_shapes();
    for (const Obstacle& o : obstacles_of(scene.model())) {
      const Point at = o.at + o.motion.way(scene.time());
      moving_ = moving_ || o.motion.velocity != Point();
      if (o.kind == Obstacle::Kind::floor)
        viewer_.add_plane(at.z, 1.5, Point(0.5, 0.5, 0));
      else
        viewer_.add_sphere(at, o.radius);
    }
  }
};

}  // namespace

bool Screen::can_draw() { return true; }
bool Screen::has_display() { return CME212::SDLViewer::has_display(); }
std::unique_ptr<Screen> Screen::open(Kind kind, std::array<int, 2> pixels) {
  // Without memory the software renderer ends the program by SIGSEGV; it took
  // 660 MB of addresses on two processors, a thread on each.
  if (available_addresses() <
      550e6 + 75e6 * std::thread::hardware_concurrency())
    throw std::bad_alloc();
  if (pixels[0] == 0 && kind == Kind::film) pixels = {800, 600};
  return std::make_unique<SDLScreen>(kind, pixels);
}

}  // namespace lab

#else  // built with VIEWER=0

namespace lab {

bool Screen::can_draw() { return false; }
bool Screen::has_display() { return false; }
std::unique_ptr<Screen> Screen::open(Kind, std::array<int, 2>) {
  throw NoDisplay("built without a viewer, VIEWER=0");
}

}  // namespace lab

#endif
