#include "lab/run/Window.hpp"

#include <exception>
#include <thread>

#include "CME212/Util.hpp"
#include "lab/run/Film.hpp"
#include "lab/run/Run.hpp"
#include "lab/scenes/Interrupt.hpp"
#include "lab/stepping/Scene.hpp"
#include "lab/viewer/Screen.hpp"

namespace lab {

namespace {

/** Steps and shows a run; all in the thread of play(). */
class Player {
 public:
  Player(Run& run, Screen& screen, double speed)
      : run_(run),
        screen_(screen),
        speed_(speed),
        nodes_(run.scene().cloth().num_nodes()) {}

  void play() {
    show();
    while (!screen_.closed()) {
      if (screen_.take_restart()) restart();
      if (run_.done()) {
        if (screen_.coloring_changed()) show();
        CME212::sleep(0.01);
        continue;
      }
      if (!screen_.wait_while_paused([this] { show(); })) continue;
      run_.advance();
      if (screen_.wants_frame() || run_.done()) show();
      keep_time();
    }
  }

 private:
  Run& run_;
  Screen& screen_;
  const double speed_;
  const unsigned nodes_;  // at first
  CME212::Clock clock_;
  double ahead_ = 0;       // simulated before the clock started [s]
  bool exploded_ = false;  // the motion beyond the failure was shown

  double time() const { return run_.scene().time(); }
  void restart() {
    run_.restart();
    exploded_ = false;
    show();
  }
  void show() {
    run_.check();
    const Scene& scene = run_.scene();
    const bool failed = scene.failure().has_value();
    screen_.show_card({});
    if (run_.done() && !failed) {
      screen_.show(scene);  // judging may take seconds
      run_.judge();
      screen_.show_card(outcome(run_, nodes_));
    }
    screen_.show(scene);
    if (!failed || exploded_ || interrupted()) return;
    exploded_ = true;
    bool again = false;
    show_beyond(scene, screen_, [&](int frames) {
      for (; frames > 0 && !again && !screen_.closed(); --frames) {
        CME212::sleep(1 / Screen::frames_per_second);
        again = screen_.take_restart();
      }
      return !again && !screen_.closed();
    });
    again ? restart() : screen_.show(scene);
  }
  void keep_time() {
    if (speed_ <= 0) return;
    const double early = (time() - ahead_) / speed_ - clock_.seconds();
    if (early > 0 && early < 1)
      CME212::sleep(early);
    else if (early != 0)  // late, paused or restarted: count anew
      clock_.start(), ahead_ = time();
  }
};

}  // namespace

void show_in_window(Run& run, Screen& screen, double speed) {
  std::exception_ptr error;
  std::thread simulation([&] {
    try {
      Player(run, screen, speed).play();
    } catch (...) {
      error = std::current_exception();
      screen.close();
    }
  });
  // A paused simulation waits for the screen only.
  std::thread watch([&screen] {
    for (; !screen.closed(); CME212::sleep(0.02))
      if (interrupted()) screen.close();
  });
  screen.event_loop();
  simulation.join();
  watch.join();
  if (error) std::rethrow_exception(error);
}

}  // namespace lab
