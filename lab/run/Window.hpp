#pragma once
/** @file Window.hpp
 * Runs in a window. */
#include <memory>
#include <string>

namespace lab {

class Run;
class Scene;
class Screen;
class Live;

/** A run that a window shows. */
class WindowRun {
 public:
  virtual ~WindowRun() = default;
  /** Back to the start. */
  virtual void restart() = 0;
  /** One step.  @pre !done() */
  virtual void advance() = 0;
  /** Check the state, which is to be shown; report it if it failed. */
  virtual void check() = 0;
  virtual bool done() const = 0;
  virtual const Scene& scene() const = 0;
  /** A second cloth beside it, or null. */
  virtual const Scene* rival() const { return nullptr; }
};

/** Step @a run in a thread of its own, at most @a speed times as fast as the
 * clock (0: without bound), until the window is closed or a signal ends the
 * run. Its outcome stays on the screen until then, or until the user restarts
 * it; of a failure, first the motion beyond it.  Main thread.
 * Throws what the run throws. */
void show_in_window(WindowRun& run, Screen& screen, double speed);

/** As above, a run that writes files. */
void show_in_window(Scene& scene, Run& run, Screen& screen, double speed);

}  // namespace lab
