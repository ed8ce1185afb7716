#pragma once
/** @file Run.hpp
 * Run: runs a scene to its end and writes its files. */
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "CME212/OutputFile.hpp"
#include "lab/fast/Archive.hpp"
#include "lab/run/Export.hpp"
#include "lab/run/Options.hpp"
#include "lab/run/Progress.hpp"
#include "lab/stepping/Settled.hpp"
#include "lab/stepping/Trial.hpp"

namespace lab {

class Scene;
class StepControl;

/** One run of a scene, with the files that it writes. */
class Run {
 public:
  /** Output files are opened now, so that a wrong path ends the run before it
   * starts; a checkpoint is loaded into the scene. Keeps references.
   * @pre @a scene is at t = 0
   * Throws std::runtime_error; SceneError: the checkpoint is of another scene.
   */
  Run(Scene& scene, const Options& o);

  /** Back to t = 0. */
  void restart();

  const Scene& scene() const { return scene_; }

  /** True at the end, if the run failed, or if a signal ends it. */
  bool done() const;
  /** The answer to the scene's question so far: Observer::answer(). */
  Answer answer() const { return observer_.answer(); }
  /** True if a signal ended the run before its end. */
  bool cut_short() const;

  /** Check the present state, which is to be shown; tell if it is not good. */
  void check();

  /** One step, or up to @a most if no state in between is needed. A state is
   * checked before it is written. A failure is reported immediately.
   * @pre !done() */
  void advance(int most = 1);
  /** Step until done(). Call @a after(), if there is one, after each step. */
  void to_end(const std::function<void()>& after = {});

  /** Print what acts, how long the step is, and how long it may be; warn of
   * what will go wrong, and of a run of hours. */
  void announce();
  /** Once the run is done(): warn of what half of its step shows to be wrong.
   * @return false: Verdict::wrong(), with a fixed step */
  bool judge();
  /** The warnings so far, without what is in --quiet runs. */
  const std::vector<std::string>& warned() const { return warnings_; }

  /** A file was written by others: @a what in words, as "film x.mp4". */
  void wrote(const std::string& what);

  /** Write the files and the last line; of a run that is cut short, say what
   * was kept.
   * @return the exit status; 128 + the signal that cut it short
   * Throws std::runtime_error if a file can't be written, after the others
   * have been. */
  int finish();

 private:
  Scene& scene_;
  const Options& o_;
  Progress progress_;
  Observer observer_;
  std::optional<CME212::OutputFile> csv_;
  std::optional<CME212::OutputFile> out_, quads_;  // the mesh; its quads
  Export frames_;
  Settled<std::string> rows_;
  long long written_ = 0;       // rows
  std::uint64_t csv_sum_ = 0;   // checksum of what csv_ has
  long long first_step_ = 0;    // where a checkpoint was
  Archive scene_as_made_;       // with which every checkpoint begins
  double next_checkpoint_ = 0;  // [s] of progress_
  std::string kept_;            // in words
  double seconds_ = 0;          // until the last step
  bool missed_ = false, told_ = false;
  bool judged_ = false;
  std::vector<std::string> warnings_;

  int steps_to_write() const;
  void start();
  void look();
  void add_row();
  void show_progress();
  void tell_failure();
  void tell(const std::string& what, const std::string& remedy) const;
  void tell_interrupt() const;
  void print_summary() const;
  void add_frame();
  void write_mesh();
  void begin_csv();
  void write_csv(const std::string& text);
  void archive(Archive& a);
  void save();
  void load();
  void go_on_with_csv(std::uint64_t length, std::uint64_t sum);
  const Verdict* verdict() const;
  void tell_steps(const StepControl& c) const;
  void tell_work() const;
  void warn(const std::string& text);
  void warn_of_length();
};

}  // namespace lab
