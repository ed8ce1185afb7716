/** @file picture.cpp
 * The assignment's program, drawn at given times instead of in a window:
 *   picture OUT TITLE WIDTH HEIGHT LOW NODES TETS DT TIME...
 * writes OUT-0.png, OUT-1.png, ... of WIDTH x HEIGHT pixels, which show the
 * room from the cloth's first place down to z = LOW [m]. draw.py builds it in
 * front of mass_spring.cpp as that is, or with a mistake put into it. */
#include <condition_variable>
#include <deque>
#include <functional>
#include <iostream>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "CME212/SDLViewer.hpp"

namespace {

/** What main() was told. */
struct Order {
  std::string out, title;
  std::deque<double> times;   // [s], those still to be drawn
  double dt = 0;              // [s]
  int width = 0, height = 0;  // [pixels]
  double low = 0;             // [m]
} order;

}  // namespace

namespace CME212 {

/** An SDLViewer for the program: without a window, and it draws only at the
 * times ordered. The program steps in a thread of its own, which waits here
 * while the main thread draws. */
class Film {
 public:
  Film() : viewer_(options()) {
    viewer_.set_view(Point(1, -0.8, 0.4),
                     {Point(0, -0.4, order.low), Point(1, 0.8, 0)});
  }

  void add_sphere(const Point& center, double radius) {
    viewer_.add_sphere(center, radius);
  }
  void add_plane(double z) { viewer_.add_plane(z); }
  template <typename G>
  void add_faces(const G& g, const std::vector<Quad>& quads) {
    viewer_.add_faces(g, quads);
  }

  // Called by the thread that steps.
  bool wants_frame() const { return true; }
  template <typename G>
  void draw_graph(const G& g) {
    build_ = [this, &g] { viewer_.draw_graph(g); };
  }
  void set_label(double t) { t_ = t; }
  void set_message(const std::vector<std::string>& /*why*/) { end(); }
  bool wait_while_paused(const std::function<void()>& /*show*/) {
    if (t_ < order.times.front() - order.dt / 2) return true;
    char label[64];
    std::snprintf(label, sizeof label, "   t = %.3f s", t_);
    viewer_.set_label(order.title + label);
    build_();
    std::unique_lock lock(mutex_);
    wanted_ = true;
    changed_.notify_all();
    changed_.wait(lock, [this] { return !wanted_; });
    order.times.pop_front();
    if (!order.times.empty()) return true;
    over_ = true;
    changed_.notify_all();
    return false;
  }

  /** Called by the main thread. */
  void event_loop() {
    std::unique_lock lock(mutex_);
    for (int number = 0;; ++number) {
      changed_.wait(lock, [this] { return wanted_ || over_; });
      if (!wanted_) return;
      write_png(order.out + '-' + std::to_string(number) + ".png",
                viewer_.snapshot());
      wanted_ = false;
      changed_.notify_all();
    }
  }

 private:
  static SDLViewer::Options options() {
    SDLViewer::Options o;
    o.width = order.width;
    o.height = order.height;
    o.offscreen = true;
    return o;
  }
  void end() {
    std::lock_guard lock(mutex_);
    over_ = true;
    changed_.notify_all();
  }

  SDLViewer viewer_;
  std::function<void()> build_;
  double t_ = 0;  // [s]
  std::mutex mutex_;
  std::condition_variable changed_;
  bool wanted_ = false;  // a picture
  bool over_ = false;
};

}  // namespace CME212

// The program as it is, but for these two names.
#define SDLViewer Film
#define main assignment
#include "mass_spring.cpp"
#undef main
#undef SDLViewer

int main(int argc, char** argv) {
  if (argc < 10) {
    std::cerr << "usage: picture OUT TITLE WIDTH HEIGHT LOW NODES TETS DT "
                 "TIME...\n";
    return 2;
  }
  order.out = argv[1];
  order.title = argv[2];
  order.width = std::stoi(argv[3]);
  order.height = std::stoi(argv[4]);
  order.low = std::stod(argv[5]);
  order.dt = std::stod(argv[8]);
  for (int i = 9; i < argc; ++i) order.times.push_back(std::stod(argv[i]));
  std::string end = std::to_string(order.times.back() + 2 * order.dt);
  char* arguments[] = {argv[0], argv[6], argv[7], argv[8], end.data(), nullptr};
  return assignment(5, arguments);
}
