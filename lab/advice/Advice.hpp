#pragma once
/** @file Advice.hpp
 * What was found out about the needs of a scene, as data and as tables. */
#include <optional>
#include <string>
#include <vector>

#include "lab/advice/Refinement.hpp"

namespace lab {

/** A part, tried by leaving it out. */
struct PartReport {
  std::string part;
  double change = 0;   ///< of the answer, in its unit; infinite: the run failed
  double springs = 0;  ///< of a step, that are saved without it
  double step = 1;     ///< stable without it, in those with it
  bool tried = true;   ///< else the budget left it out
  bool needed = true;
};

/** A method and a step, tried on one grid. */
struct StepReport {
  std::string method;
  double dt = 0;           ///< there [s]
  double error = 0;        ///< of the answer; infinite: the run failed
  double evaluations = 0;  ///< of all forces; a solve counts as what it takes
  double seconds = 0;
};

/** What a user finds who makes the advised run finer: the errors by half the
 * step, and by half the step on a grid of twice the cells. */
struct Robustness {
  std::optional<double> half_step, finer_grid;  ///< nullopt: not run
};

/** What was found. */
struct Advice {
  Measure measure = Measure::com;
  double tolerance = 0;
  Refinement grids;
  std::vector<PartReport> parts;
  std::size_t tried_on = 0;  ///< nodes of the grid of parts and steps
  std::vector<StepReport> steps;
  double scatter = 0;    ///< of the answer, in runs that should be the same
  int perturbed = 0;     ///< how many of these there were
  std::string refusal;   ///< why there is no advice; empty: there is
  Model model;           ///< the cheapest that was found
  bool checked = false;  ///< it was run; else what it gives is predicted
  Answer answer;         ///< of that run
  std::vector<std::string> left_out;  ///< by the budget
  double error = 0;                   ///< in the unit of the measure
  double uncertainty = 0;             ///< the error is at most that much larger
  Robustness robustness;
  double t_end = 0;  ///< [s], of the question; the run may end earlier, at rest
  /** What it changes to keep positions and velocities in single precision. */
  std::optional<double> floats;
  double work = 0, seconds = 0;  ///< of the advised run: spring evaluations,
                                 ///< and of this machine
  double evaluations = 0;        ///< of all its forces
  double of_stable = 0;  ///< its step, in largest stable ones; 0: any is
  double rate = 0;       ///< spring evaluations a second
  double spent = 0, spent_work = 0, budget = 0;  ///< by the pilots: [s], spring
                                                 ///< evaluations, of these
};

/** @a x to two digits with the unit of @a measure, if it has one. */
std::string with_unit(double x, Measure measure);

/** The options that make ./cloth run @a m, and nothing else. */
std::string as_options(const Model& m);

/** @a a for people: what it comes to, with a command to paste, then tables.
 * Throws InputError, if there is advice on a mesh that can't be read again. */
std::string in_words(const Advice& a);

}  // namespace lab
