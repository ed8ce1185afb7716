/** @file RunReplay.cpp
 * ./cloth --replay FILE */
#include <iostream>
#include <optional>
#include <string>

#include "CME212/Util.hpp"
#include "lab/live/Recording.hpp"
#include "lab/run/Options.hpp"
#include "lab/run/Run.hpp"
#include "lab/run/Window.hpp"
#include "lab/scenes/Interrupt.hpp"
#include "lab/stepping/Scene.hpp"
#include "lab/viewer/Screen.hpp"

namespace lab {

namespace {

/** A film of a replay. Its time goes on, also when the user restarted the scene
 * or loaded another one. */
class ReplayFilm {
 public:
  ReplayFilm(Screen& screen, const std::string& file) : screen_(screen) {
    screen_.start_film(file);
  }
  /** Frames for the time that @a scene has gone on since the last call. */
  void add(const Live& live) {
    const Scene& scene = live.scene();
    if (scene.time() > last_) due_ += scene.time() - last_;
    last_ = scene.time();
    if (due_ < 0) return;
    screen_.show(scene, live.rival());
    do {
      screen_.add_to_film(1);
      due_ -= 1 / Screen::frames_per_second;
    } while (due_ >= 0 && !interrupted());
  }

 private:
  Screen& screen_;
  double last_ = 0, due_ = 0;  // [s]
};

/** The replay in a window. */
class ReplayRun : public WindowRun {
 public:
  ReplayRun(const std::string& file, std::optional<Replay>& replay)
      : file_(file), replay_(replay) {}
  void restart() override { replay_.emplace(file_), ended_ = false; }
  void advance() override { ended_ = !replay_->step(); }
  void check() override { replay_->live().check(); }
  bool done() const override { return ended_ || interrupted(); }
  const Scene& scene() const override { return replay_->live().scene(); }
  const Scene* rival() const override { return replay_->live().rival(); }

 private:
  const std::string& file_;
  std::optional<Replay>& replay_;
  bool ended_ = false;
};

}  // namespace

int run_replay(const Options& o) {
  std::optional<Replay> replay(o.replay);
  const auto screen =
      o.window        ? Screen::open(Screen::Kind::window)
      : !o.pictures() ? nullptr
                      : Screen::open(o.video.empty() ? Screen::Kind::pictures
                                                     : Screen::Kind::film,
                                     o.pixels);
  if (screen) screen->show_strain(o.strain);
  std::optional<ReplayFilm> film;
  if (!o.video.empty()) film.emplace(*screen, o.video);
  if (o.window) {
    screen->set_paused(o.paused);
    ReplayRun run(o.replay, replay);
    show_in_window(run, *screen, o.speed);
  }
  while (!o.window && !interrupted() && replay->step()) {
    if (!film) continue;
    replay->live().check();
    film->add(replay->live());
  }
  Live& live = replay->live();
  live.check();
  const auto wrote = [&o](const std::string& what, const std::string& file) {
    if (!o.quiet) std::cout << what << ": " << file << '\n';
  };
  if (film) screen->end_film(), wrote("film", o.video);
  if (!o.screenshot.empty()) {
    screen->show(live.scene(), live.rival());
    screen->save_picture(o.screenshot);
    wrote("picture", o.screenshot);
  }
  if (!o.out.empty()) MeshOutput(o.out).write(live.scene());
  const Readings r = live.readings(false);
  using CME212::short_text;
  if (!o.quiet)
    std::cout << CME212::count_of(replay->requests(), "request") << ", "
              << CME212::count_of(std::size_t(live.calls()), "step")
              << " to t = " << short_text(r.time) << " s; energy "
              << short_text(r.energy.total()) << " J; " << r.nodes
              << " nodes and " << r.edges << " edges left\n";
  if (r.failure) std::cerr << "cloth: " << r.failure->text() << '\n';
  if (interrupted() && !r.failure) {
    std::cerr << "cloth: " << name_of_interrupt()
              << " ended the replay at t = " << short_text(r.time) << " s\n";
    return 128 + interrupted();
  }
  return r.failure ? 3 : 0;
}

}  // namespace lab
