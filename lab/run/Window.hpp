#pragma once
/** @file Window.hpp
 * Runs in a window. */
namespace lab {

class Run;
class Screen;

/** Step @a run in a thread of its own, at most @a speed times as fast as the
 * clock (0: without bound), until the window is closed or a signal ends the
 * run. Its outcome stays on the screen until then, or until the user restarts
 * it; of a failure, first the motion beyond it.  Main thread.
 * Throws what the run throws. */
void show_in_window(Run& run, Screen& screen, double speed);

}  // namespace lab
