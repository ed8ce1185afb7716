#include "lab/advice/Advice.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "CME212/Util.hpp"
#include "lab/methods/Method.hpp"
#include "lab/scenes/Compose.hpp"

namespace lab {

std::string with_unit(double x, Measure measure) {
  return CME212::two_digits(x) + (*unit_of(measure) ? " " : "") +
         unit_of(measure);
}

std::string in_words(const Advice& a) {
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
  add("\nadvice: %zu nodes, %s, dt = %s s: error %s +- %s; %s s; finding out "
      "took %s s\n",
      mesh_of(a.model).points.size(), a.model.method->info.name,
      short_text(a.model.step.dt).c_str(),
      with_unit(a.error, a.measure).c_str(), number(a.uncertainty).c_str(),
      number(a.seconds).c_str(), number(a.spent).c_str());
  return text;
}

}  // namespace lab
