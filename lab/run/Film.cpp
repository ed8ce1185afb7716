#include "lab/run/Film.hpp"

#include <algorithm>
#include <cmath>
#include <iostream>

#include "CME212/BoundingBox.hpp"
#include "CME212/Util.hpp"
#include "lab/run/Run.hpp"
#include "lab/scenes/Interrupt.hpp"
#include "lab/stepping/Scene.hpp"

namespace lab {

using CME212::short_text;

namespace {

constexpr double rate = Screen::frames_per_second;
int frames_in(double seconds) { return int(std::lround(seconds * rate)); }

/** Is a node of @a g less than a tenth of a radius above @a o? Of a floor, less
 * than 1 cm. */
bool is_near(const Obstacle& o, const Cloth& g, double t) {
  const Point at = o.at + o.motion.way(t);
  for (Node n : g.nodes()) {
    const Point p = n.position() - at;
    if (o.kind == Obstacle::Kind::floor ? p.z < 0.01 : norm(p) < 1.1 * o.radius)
      return true;
  }
  return false;
}

/** The diagonal of the cloth's bounding box [m]. */
double extent(const Scene& scene) {
  CME212::BoundingBox box;
  for (Node n : scene.cloth().nodes()) box |= n.position();
  return box.diagonal();
}

}  // namespace

void show_beyond(const Scene& scene, Screen& screen,
                 const std::function<bool(int)>& shown) {
  const int frames = frames_in(Film::failure_seconds);
  const double end = scene.beyond_failure(extent(scene) / 3)->time();
  const int steps =
      int(std::clamp((end - scene.time()) / scene.dt(), 1.0, double(frames)));
  auto now = scene.beyond_failure(0);
  for (int k = 0; k < steps; ++k, now = now->beyond_failure(0)) {
    screen.show(*now);
    if (!shown(frames * (k + 1) / steps - frames * k / steps)) return;
  }
}

std::vector<std::string> outcome(const Run& run, unsigned nodes) {
  const Scene& scene = run.scene();
  const unsigned left = scene.cloth().num_nodes();
  std::vector<std::string> lines;
  for (const std::string& text : run.warned())
    lines.push_back("warning: " + text);
  lines.push_back("t = " + short_text(scene.time()) + " s");
  lines.push_back(std::to_string(scene.steps()) + " steps");
  if (left < nodes)
    lines.push_back(std::to_string(nodes - left) + " of " +
                    std::to_string(nodes) + " nodes removed");
  return lines;
}

Film::Film(const Scene& scene, Run& run, const Options& o)
    : scene_(scene),
      run_(run),
      o_(o),
      screen_(Screen::open(
          o.video.empty() ? Screen::Kind::pictures : Screen::Kind::film,
          o.pixels)),
      // One that goes on has the frames from there on.
      next_(std::llround(scene.time() * rate) / rate),
      shot_(o.screenshot.empty()),
      nodes_(scene.cloth().num_nodes()),
      edges_(scene.cloth().num_edges()),
      first_nodes_(nodes_),
      touched_(obstacles_of(scene.model()).size()) {
  screen_->show_strain(o.strain);
  if (o.video.empty()) return;
  constexpr double day = 86400;  // [s]
  if (o.model.t_end > day)
    throw SceneError("t-end", short_text(o.model.t_end),
                     "at most " + short_text(day) + " s (a day) for a film");
  screen_->start_film(o.video);
  if (scene.time() == 0) screen_->show_card(title());
}

void Film::draw() {
  bool failed = scene_.failure().has_value();
  // Half a step early is as good as half a step late.
  const double now = scene_.time() + scene_.dt() / 2;
  const bool frame = !o_.video.empty() && (failed || now >= next_);
  const bool picture =
      !shot_ && (failed || run_.done() || (o_.at >= 0 && now >= o_.at));
  if (!frame && !picture) return;
  run_.check();
  failed = scene_.failure().has_value();
  screen_->show(scene_);
  if (picture) save_picture();
  if (!frame) return;
  if (failed) {
    screen_->show_card({});  // the words of the failure need its place
    show_beyond(scene_, *screen_, [this](int frames) {
      screen_->add_to_film(frames);
      return !interrupted();
    });
    screen_->show(scene_);
  }
  // A failure stays: there is a reason to read.
  int times = failed ? frames_in(failure_seconds) : 0;
  for (const double time = frame_time(); now >= next_; next_ += time) ++times;
  frames_ += times;
  // At least some, as a film has pictures.
  constexpr int some = 30;
  do {
    screen_->add_to_film(std::min(times, some));
    times -= some;
  } while (times > 0 && !interrupted());
  if (frames_ >= frames_in(title_seconds)) screen_->show_card({});
}

void Film::finish() {
  if (!shot_) draw();  // cut short between two steps
  auto tell = [&](const std::string& what, const std::string& file) {
    if (!o_.quiet) std::cout << what << ": " << file << '\n';
    run_.wrote(what + ' ' + file);
  };
  if (!o_.video.empty()) {
    if (!scene_.failure()) {
      run_.judge();
      screen_->show_card(outcome(run_, first_nodes_));
      screen_->add_to_film(
          run_.warned().empty()
              ? std::clamp(frames_ / 8, 1, frames_in(title_seconds))
              : frames_in(failure_seconds));
      screen_->show_card({});
    }
    screen_->end_film();
    tell("film", o_.video);
  }
  if (!o_.screenshot.empty()) tell("picture", o_.screenshot);
}

/** A picture of the present state; after a failure, of the failed one. */
void Film::save_picture() {
  shot_ = true;
  screen_->show_card({});
  if (!scene_.failure()) return screen_->save_picture(o_.screenshot);
  screen_->show(*scene_.beyond_failure(extent(scene_) / 10));
  screen_->save_picture(o_.screenshot);
  screen_->show(scene_);
}

/** Simulated time until the frame after the next one [s]. */
double Film::frame_time() {
  if (o_.slow_motion > 1 && event()) slow_until_ = scene_.time() + slow_seconds;
  return scene_.time() < slow_until_ ? 1 / (rate * o_.slow_motion) : 1 / rate;
}

/** Has the cloth torn since the last call, or come to an obstacle?  O(nodes) */
bool Film::event() {
  const Cloth& g = scene_.cloth();
  bool is_new = g.num_nodes() < nodes_ || g.num_edges() < edges_;
  nodes_ = g.num_nodes(), edges_ = g.num_edges();
  const auto obstacles = obstacles_of(scene_.model());
  for (std::size_t k = 0; k < obstacles.size(); ++k) {
    if (touched_[k] || !is_near(obstacles[k], g, scene_.time())) continue;
    is_new = true, touched_[k] = 1;
  }
  return is_new;
}

std::vector<std::string> Film::title() const {
  const Cloth& g = scene_.cloth();
  std::vector<std::string> lines{scene_.model().name,
                                 std::to_string(g.num_nodes()) + " nodes, " +
                                     std::to_string(g.num_edges()) + " springs",
                                 std::string(scene_.method().name) + ", dt = " +
                                     short_text(scene_.dt()) + " s"};
  if (o_.slow_motion > 1)
    lines.push_back("contact and tearing " + short_text(o_.slow_motion) +
                    " times slower");
  return lines;
}

}  // namespace lab
