#pragma once
/** @file Advice.hpp
 * What was found out about the needs of a scene, as data and as tables. */
#include <algorithm>
#include <cmath>
#include <cstdio>
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
  double floor = 0;     ///< what the answer makes of a start moved by 1e-6 m
  std::string refusal;  ///< why there is no advice; empty: there is
  Model model;          ///< the cheapest that was found
  double error = 0;     ///< predicted, in the unit of the measure
  double doubt = 0;     ///< of that: the error is at most that much larger
  double seconds = 0;   ///< predicted, of this machine
  double spent = 0;     ///< by the pilots [s]
};

/** @a x to two digits with the unit of @a measure, if it has one. */
inline std::string with_unit(double x, Measure measure) {
  return CME212::two_digits(x) + (*unit_of(measure) ? " " : "") +
         unit_of(measure);
}

/** @a a as tables, and what it comes to, for people. */
inline std::string in_words(const Advice& a) {
  using CME212::short_text;
  std::string text;
  char line[200];
  const std::string unit =
      *unit_of(a.measure) ? std::string(" [") + unit_of(a.measure) + ']' : "";
  auto add = [&](const char* format, auto... values) {
    std::snprintf(line, sizeof line, format, values...);
    text += line;
  };
  auto number = [](double x) {
    return std::isfinite(x) ? CME212::two_digits(x) : std::string("-");
  };
  add("asked: %s%s to %s\n", name_of(a.measure), unit.c_str(),
      short_text(a.tolerance).c_str());
  if (a.grids.size() > 1) {
    add("\n%-44s %10s %10s\n", "nodes", "error", "time [s]");
    for (const GridReport& g : a.grids)
      add("%-44zu %10s %10s\n", g.nodes, number(g.error).c_str(),
          number(g.trial.seconds).c_str());
  }
  if (!a.parts.empty()) {
    add("\n%-44s %10s %10s\n", "part", "changes", "costs");
    for (const PartReport& p : a.parts)
      add("%-44.44s %10s %9.0f%%  %s\n", p.part.c_str(),
          number(p.change).c_str(), 100 * std::max(0.0, p.cost),
          p.needed ? "needed" : "not needed");
  }
  if (!a.steps.empty()) {
    add("\n%-30s %13s %10s %10s\n", "method", "dt [s]", "error", "time [s]");
    for (const StepReport& s : a.steps)
      add("%-30s %13s %10s %10s\n", s.method.c_str(), number(s.dt).c_str(),
          number(s.error).c_str(), number(s.seconds).c_str());
  }
  if (a.floor > 0)
    add("\na start that is off by 1e-6 m changes the answer by %s\n",
        number(a.floor).c_str());
  if (!a.refusal.empty()) return text + "\nno advice: " + a.refusal + '\n';
  add("\nadvice: %zu nodes, %s, dt = %s s: error %s, give or take %s; %s s; "
      "finding out took %s s\n",
      mesh_of(a.model).points.size(), a.model.method.c_str(),
      short_text(a.model.with.dt).c_str(),
      with_unit(a.error, a.measure).c_str(), number(a.doubt).c_str(),
      number(a.seconds).c_str(), number(a.spent).c_str());
  return text;
}

}  // namespace lab
