#pragma once
/** @file Advice.hpp
 * Advice: the result of advise(), and its text with tables. */
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "lab/advice/Refinement.hpp"

namespace lab {

/** What leaving out one part of the scene changes. */
struct PartReport {
  std::string part;
  double change = 0;   ///< of the answer, in its unit; infinite: the run failed
  double springs = 0;  ///< spring evaluations per step saved without the part
  double step = 1;     ///< stable step without the part / with it
  bool tried = true;   ///< false: no budget was left to try it
  bool needed = true;
};

/** The error of the scene's own run, in the unit of the measure, and its
 * parts: infinite if not known. */
struct Assessment {
  double total = 0;
  double grid = 0, step = 0;
  double of_stable = 0;  ///< its step / the largest stable one; 0: no limit
  Model model;           ///< with its step as a number
};

/** A run that may be advised. */
struct AdvisedRun {
  Model model;
  double work = 0;  ///< spring evaluations
  /** In the unit of the measure; infinite: the run failed. */
  double error = std::numeric_limits<double>::infinity();
  double uncertainty = 0;  ///< the error may be that much larger
  double seconds = 0;      ///< its time on this machine
  Answer answer = {};
  /** The errors by half the step, and by half the step on a grid of twice the
   * cells; nullopt: not run. */
  std::optional<double> half_step = {}, finer_grid = {};
};

/** The advised run is the cheapest one found. */
struct Advice : AdvisedRun {
  Measure measure = Measure::com;
  double tolerance = 0;           ///< in the unit of the measure
  std::string share;              ///< what it is a share of, in words; or empty
  std::optional<Assessment> own;  ///< of assess()
  bool from_files = false;        ///< then grids are steps on that mesh
  Refinement grids;
  std::vector<PartReport> parts;
  std::size_t tried_on = 0;         ///< nodes of the grid of parts and steps
  std::vector<AdvisedRun> choices;  ///< that were run
  double scatter = 0;               ///< of the answers of perturbed runs
  int perturbed = 0;                ///< how many perturbed runs were made
  std::string refusal;  ///< why no advice is given; empty: advice is given
  std::string trivial;  ///< why nothing has to be computed; or empty
  std::string at_rest;  ///< why the cloth is at rest at its end; or empty
  std::string buckles;  ///< a motion in a plane that would leave it; or empty
  std::vector<std::string> left_out;    ///< runs that the budget did not allow
  std::vector<std::string> impossible;  ///< why runs could not be made
  double t_end = 0;  ///< [s] of the question; model may end earlier, at rest
  double evaluations = 0;  ///< force evaluations of the advised run
  double of_stable = 0;    ///< its step / the largest stable one; 0: no limit
  double spent = 0;        ///< time of all pilots [s]
  double spent_work = 0, budget = 0;  ///< of the pilots, in spring evaluations
};

/** @a x to two digits with the unit of @a measure, if it has one. */
std::string with_unit(double x, const Measure& measure);

/** The tolerance in words: "(asked: 0.01 m)". */
std::string asked(const Advice& a);

/** The options with which ./cloth runs @a m. */
std::string as_options(const Model& m);

/** @a a as text: the recommendation, a command to paste, then tables.
 * Throws InputError if the mesh of the advised scene cannot be read again. */
std::string in_words(const Advice& a);

/** @a a as a JSON object: README.md has its members.  Throws as in_words() */
std::string as_json(const Advice& a);

}  // namespace lab
