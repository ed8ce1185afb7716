#pragma once
/** @file Film.hpp
 * Film: when a run without a window is drawn, into a film and a picture. */
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "lab/run/Options.hpp"
#include "lab/viewer/Screen.hpp"

namespace lab {

class Run;
class Scene;

/** Show on @a screen the motion beyond the failure of @a scene, until a node
 * has moved by a third of the cloth's extent; at most 60 steps. As slow motion
 * it takes Film::failure_seconds: shown(k) is called after each picture, which
 * stays for k frames of the film; false ends it.
 * @pre scene.failure(), and it was shown; @a shown may then change it
 * only if it returns false */
void show_beyond(const Scene& scene, Screen& screen,
                 const std::function<bool(int)>& shown);

/** What came of @a run, with its warnings, in lines for Screen::show_card().
 * @param nodes How many it had at first */
std::vector<std::string> outcome(const Run& run, unsigned nodes);

/** The picture and the film of one run.
 *
 * A film has 30 frames for each second of simulated time. Each shows the state
 * after the step that is closest to the frame's time. With slow motion there
 * are more frames, by that factor, while nodes first touch a ball or the floor,
 * and while the cloth tears. The first frames have a card with the title,
 * unless the run continues from a checkpoint; the end has one with the result,
 * for at most a ninth of the film or, if there is a warning to be read, for
 * failure_seconds. The film of a failed run ends with the motion beyond the
 * failure and with the reason. The picture of a failure shows
 * the cloth some steps later, when a node has moved by a tenth of the cloth's
 * extent. */
class Film {
 public:
  static constexpr double title_seconds = 1.5, failure_seconds = 2;
  /** How long an event is slow after it was seen [s], simulated. */
  static constexpr double slow_seconds = 0.08;

  /** Keeps references.  Throws NoDisplay, std::runtime_error "FILE: why". */
  Film(const Scene& scene, Run& run, const Options& o);

  /** Draw what is due; call it before the first step and after each.
   * Throws std::runtime_error "FILE: why". */
  void draw();
  /** Complete the files and tell of them.  Throws as draw() */
  void finish();

 private:
  const Scene& scene_;
  Run& run_;
  const Options& o_;
  std::unique_ptr<Screen> screen_;
  double next_ = 0;        // when the next frame is due [s]
  double slow_until_ = 0;  // [s]
  bool shot_;              // the picture was taken, or none is wanted
  unsigned nodes_, edges_, first_nodes_;  // at the last frame, at first
  int frames_ = 0;                        // of motion
  std::vector<char> touched_;             // of each obstacle

  void save_picture();
  double frame_time();
  bool event();
  std::vector<std::string> title() const;
};

}  // namespace lab
