/** @file Screen.cpp
 * Screen on SDLViewer; the only file of the laboratory that draws. */
#include "lab/viewer/Screen.hpp"

#ifdef MASS_SPRING_VIEWER

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <map>
#include <optional>
#include <vector>

#include "CME212/Image.hpp"
#include "CME212/SDLViewer.hpp"
#include "lab/scenes/Scene.hpp"

namespace lab {
namespace {

/** The mean l/L - 1 of the springs at @a n: more than 0 if it is taut, less if
 * it is slack; 0 without springs. */
double strain_at(const Node& n) {
  double strain = 0;
  for (Edge e : n.edges())
    if (double L = e.value().L; L > 0) strain += e.length() / L - 1;
  return n.degree() > 0 ? strain / n.degree() : 0;
}

class SDLScreen : public Screen {
 public:
  explicit SDLScreen(Kind kind)
      : kind_(kind),
        viewer_({.title = "cloth",
                 .offscreen = kind == Kind::pictures,
                 .restarts = true,
                 .colors = true}) {}

  void show_strain(bool on) override { viewer_.set_strain_colors(on); }

  void show(const Scene& scene) override {
    const Cloth& g = scene.cloth();
    show_failure(scene);
    if (!shown_) set_view(scene);
    if (!shown_ || moving_) add_obstacles(scene);
    const bool strain = colored_ = viewer_.strain_colors();
    if (strain) set_scale(g);
    auto color = [&](Node n) {
      return strain ? CME212::Color::make_strain(
                          float(std::clamp(strain_at(n) / scale_, -1.0, 1.0)))
                    : CME212::Color(1);
    };
    viewer_.set_label(label(scene));
    if (shown_ && version_ == g.version()) {
      viewer_.add_nodes(g.node_begin(), g.node_end(), color, nodes_);
      return;
    }
    viewer_.clear();
    nodes_.clear();
    viewer_.add_nodes(g.node_begin(), g.node_end(), color, nodes_);
    const auto faces = faces_of(scene);
    viewer_.add_faces(faces.begin(), faces.end(), nodes_);
    viewer_.add_edges(g.edge_begin(), g.edge_end(), nodes_);
    version_ = g.version();
    shown_ = true;
  }

  void save_picture(const std::string& file) override {
    CME212::write_image(file, viewer_.snapshot());
  }
  void start_film(const std::string& file) override {
    auto picture = viewer_.snapshot();
    film_.emplace(file, picture.width, picture.height, frames_per_second);
  }
  void add_to_film() override { film_->add(viewer_.snapshot()); }
  std::string end_film() override {
    film_->finish();
    return film_->wrote();
  }

  void event_loop() override { viewer_.event_loop(); }
  void close() override { viewer_.close(); }
  void set_paused(bool on) override { viewer_.set_paused(on); }
  bool closed() const override { return viewer_.closed(); }
  bool take_restart() override { return viewer_.take_restart(); }
  bool wants_frame() const override { return viewer_.wants_frame(); }
  bool coloring_changed() const override {
    return viewer_.strain_colors() != colored_;
  }
  bool wait_while_paused(const Scene& scene) override {
    return viewer_.wait_while_paused([&] { show(scene); });
  }

 private:
  Kind kind_;
  CME212::SDLViewer viewer_;
  std::map<Node, unsigned> nodes_;
  std::optional<CME212::Video> film_;
  bool shown_ = false, colored_ = false;
  bool moving_ = false;      // whether an obstacle is
  std::size_t version_ = 0;  // of the cloth, when its edges were shown
  double scale_ = 0.01;      // the strain of the brightest color
  std::string failure_;      // that is shown
  CME212::Clock clock_;
  long long steps_ = 0;  // when clock_ was started
  double rate_ = 0;      // [steps/s]

  void show_failure(const Scene& scene) {
    if (scene.failure() == failure_) return;
    failure_ = scene.failure();
    std::vector<CME212::SceneData::Mark> marks;
    if (const auto& at = scene.failed_at()) {
      const Cloth& g = scene.cloth();
      if (g.has_node(at->node))
        marks.push_back({at->node.position(), at->node.position()});
      if (g.has_edge(at->spring))
        marks.push_back(
            {at->spring.node1().position(), at->spring.node2().position()});
    }
    viewer_.set_marks(std::move(marks));
    std::vector<std::string> paragraphs;
    const std::string text = failure_.empty() ? "" : scene.explanation();
    for (std::size_t from = 0, to; from < text.size(); from = to + 2) {
      to = std::min(text.find("; ", from), text.size());
      paragraphs.push_back(text.substr(from, to - from));
    }
    viewer_.set_message(std::move(paragraphs));
  }

  /** Make the scale end at the |strain| that one node in fifty exceeds: what
   * is beyond has the color of the end, since the few nodes at the corners
   * would leave no colors for the others. It only grows, so that a color goes
   * on meaning the same. */
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
    viewer_.set_scale({.title = "strain l/L - 1",
                       .limit = 100 * scale_,
                       .unit = "%",
                       .above = high > scale_,
                       .below = low < -scale_});
  }

  /** The nodes of the quads that are left. */
  static std::vector<std::array<Node, 4>> faces_of(const Scene& scene) {
    std::vector<std::array<Node, 4>> faces;
    const auto& built = scene.recipe().built;
    if (!built) return faces;
    const Cloth& g = scene.cloth();
    auto node = [&](unsigned i) { return g.node_with_id(built->ids[i]); };
    for (const Quad& q : quads_left(g, *built))
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

  /** Time and size; the step rate only in a window, since pictures of the
   * same state shall be the same. */
  std::string label(const Scene& scene) {
    char time[32];
    std::snprintf(time, sizeof time, "t = %.3f s", scene.time());
    std::string text =
        time + ("   " + std::to_string(scene.cloth().num_nodes())) + " nodes";
    if (kind_ == Kind::pictures) return text;
    if (scene.steps() < steps_ || clock_.seconds() > 0.5) {
      rate_ = double(std::max(0LL, scene.steps() - steps_)) / clock_.seconds();
      steps_ = scene.steps();
      clock_.start();
    }
    return text + "   " + std::to_string(std::llround(rate_)) + " steps/s";
  }

  /** Look at the room that the scene names; else at the cloth as it is now and
   * at what it may fall on, and at the start below it as well. */
  void set_view(const Scene& scene) {
    CME212::BoundingBox room;
    for (const Point& p : scene.recipe().room) room |= p;
    if (room.empty()) {
      for (Node n : scene.cloth().nodes()) room |= n.position();
      for (const Obstacle& o : scene.recipe().obstacles) {
        if (o.kind == Obstacle::Kind::floor) continue;
        const Point reach(o.radius, o.radius, o.radius);
        room |= o.at - reach;
        room |= o.at + reach;
      }
      if (scene.time() == 0 && !room.empty())
        room |= room.min() - Point(0, 0, room.diagonal() / 2);
    }
    viewer_.set_view(Point(0.75, -1, 0.4), room);
  }

  /** Show what the cloth falls on where it is now, and nothing else. */
  void add_obstacles(const Scene& scene) {
    viewer_.clear_shapes();
    for (const Obstacle& o : scene.recipe().obstacles) {
      const Point at = o.at + o.motion.way(scene.time());
      moving_ = moving_ || o.motion.velocity != Point();
      if (o.kind == Obstacle::Kind::floor)
        viewer_.add_plane(at.z);
      else
        viewer_.add_sphere(at, o.radius,
                           o.kind == Obstacle::Kind::tearing_ball
                               ? CME212::Color(0.80f, 0.33f, 0.0f)
                               : CME212::Color(0.0f, 0.45f, 0.70f));
    }
  }
};

}  // namespace

bool Screen::can_draw() { return true; }
bool Screen::has_display() { return CME212::SDLViewer::has_display(); }
std::unique_ptr<Screen> Screen::open(Kind kind) {
  return std::make_unique<SDLScreen>(kind);
}

}  // namespace lab

#else  // built with VIEWER=0

namespace lab {

bool Screen::can_draw() { return false; }
bool Screen::has_display() { return false; }
std::unique_ptr<Screen> Screen::open(Kind) {
  throw NoDisplay("built without a viewer, VIEWER=0");
}

}  // namespace lab

#endif
