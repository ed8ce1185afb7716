#pragma once
/** @file Advice.hpp
 * What was found out about the needs of a scene, as data and as tables. */
#include <string>
#include <vector>

#include "lab/advice/Refinement.hpp"

namespace lab {

/** A part, tried by leaving it out. */
struct PartReport {
  std::string part;
  double change = 0;  ///< of the answer, in its unit; infinite: the run failed
  double cost = 0;    ///< what the part takes: of the time of a run with it
  bool needed = true;
};

/** A method and a step, tried on one grid. */
struct StepReport {
  std::string method;
  double dt = 0;     ///< there [s]
  double error = 0;  ///< of the answer; infinite: the run failed
  double seconds = 0;
};

/** What was found. */
struct Advice {
  Measure measure = Measure::com;
  double tolerance = 0;
  Refinement grids;
  std::vector<PartReport> parts;
  std::vector<StepReport> steps;
  double floor = 0;        ///< what the answer makes of a start moved by 1e-6 m
  std::string refusal;     ///< why there is no advice; empty: there is
  Model model;             ///< the cheapest that was found
  double error = 0;        ///< predicted, in the unit of the measure
  double uncertainty = 0;  ///< the error is at most that much larger
  double seconds = 0;      ///< predicted, of this machine
  double spent = 0;        ///< by the pilots [s]
};

/** @a x to two digits with the unit of @a measure, if it has one. */
std::string with_unit(double x, Measure measure);

/** @a a as tables, and what it comes to, for people.
 * Throws InputError, if there is advice on a mesh that can't be read again. */
std::string in_words(const Advice& a);

}  // namespace lab
