#pragma once
/** @file Options.hpp
 * Options: the command line of ./cloth. */
#include <array>
#include <string>
#include <vector>

#include "lab/scenes/SceneFile.hpp"

namespace lab {

/** The options of a run; see ./cloth --help. */
struct Options {
  Model model;
  Origins origins;     ///< of the model's parts
  std::string config;  ///< the scene file
  double at = -1;      ///< time of the screenshot [s]; the end if negative
  double speed = 1;
  double slow_motion = 1;  ///< factor by which events of a film are slower
  long long every = 10;
  int threads = 0;  ///< of a large cloth; 0: one a processor
  bool headless = false, window = false, paused = false, strain = false;
  bool quiet = false;
  bool rest = false;  ///< the equilibrium, instead of a run
  bool advise = false, automatic = false, assess = false;
  double advise_work = 0;       ///< spring evaluations; 0: AdviceRules::budget
  bool bounds_error = false;    ///< of the positions, by model.tolerance
  bool chooses_method = false;  ///< for that; else it is given
  /** Fields that a file with this scene leaves out: whoever names them asks for
   * another run. */
  std::vector<std::string> unnamed;
  bool keeps_method = false, keeps_step = false;  ///< advice keeps this option
  std::string screenshot, video, csv, out, size;
  std::array<int, 2> pixels{};  ///< what size says; 0: Screen's own size
  std::string vtp, ply;         ///< folders
  double frame_rate = 30;       ///< of those [1/s]
  std::string advised;          ///< file for the scene, or the advised one
  std::string json;             ///< file for the advice
  std::string checkpoint, restart;
  double every_seconds = 60;  ///< between two checkpoints [s] of the clock

  std::vector<std::string> words;  ///< the command line
  bool verbose = false;
  /** True if advice comes before the run, or instead of it. */
  bool asks_advice() const { return advise || automatic || assess; }
  bool pictures() const { return !screenshot.empty() || !video.empty(); }
};

/** Read the scene file, if there is one, and then the command line, which
 * wins. Prints what is asked for (help, version, methods, the scene), and what
 * is wrong with the words of the command line.
 * @return the exit status to end with, or -1: go on
 * Throws SceneError, SceneFileError */
int parse(int argc, char** argv, Options& o);

}  // namespace lab
