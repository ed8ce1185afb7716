#include "lab/advice/Advice.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <set>
#include <sstream>

#include "CME212/Util.hpp"
#include "lab/methods/Method.hpp"
#include "lab/scenes/Compose.hpp"
#include "lab/scenes/SceneFile.hpp"

namespace lab {

std::string with_unit(double x, Measure measure) {
  return CME212::two_digits(x) + (*unit_of(measure) ? " " : "") +
         unit_of(measure);
}

namespace {

/** @a words, quoted so that a shell reads them as one word. */
std::string for_shell(const std::string& words) {
  if (!words.empty() &&
      words.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUV"
                              "WXYZ0123456789-_./:") == std::string::npos)
    return words;
  std::string text = "'";
  for (char c : words)
    text += c == '\'' ? std::string("'\\''") : std::string{c};
  return text + '\'';
}

/** The lines of a scene file without comments. */
std::vector<std::string> settings(const Model& m) {
  std::vector<std::string> all;
  std::istringstream in(to_scene_file(m));
  for (std::string line; std::getline(in, line);)
    if (!line.starts_with('#')) all.push_back(line);
  return all;
}

/** A column of a table. */
struct Column {
  std::string title;
  std::vector<std::string> cells;
};
/** Columns as wide as their cells; all but the first are right-aligned. */
std::string table(const std::vector<Column>& columns) {
  std::string text = "\n";
  for (std::size_t row = 0; row <= columns[0].cells.size(); ++row) {
    for (const Column& c : columns) {
      auto cell = [&](std::size_t k) {
        return k == 0 ? c.title : c.cells[k - 1];
      };
      std::size_t width = 0;
      for (std::size_t k = 0; k <= c.cells.size(); ++k)
        width = std::max(width, cell(k).size());
      const std::string space(width - cell(row).size(), ' ');
      text += &c == &columns[0] ? cell(row) + space : "  " + space + cell(row);
    }
    text += '\n';
  }
  return text;
}

/** A count rounded to two digits, without an exponent. */
std::string count(double x) {
  char text[40];
  std::snprintf(text, sizeof text, "%.0f",
                std::strtod(CME212::two_digits(x).c_str(), nullptr));
  return text;
}
std::string number(double x) {
  return !std::isfinite(x) ? "failed"
         : x >= 100        ? count(x)
                           : CME212::two_digits(x);
}

/** The parts of @a m that are active by default. */
std::string by_default(const Model& m) {
  std::string all;
  auto add = [&](bool acts, const std::string& what) {
    if (acts) all += (all.empty() ? "" : ", ") + what;
  };
  add(m.gravity == grav, "gravity " + CME212::short_text(grav) + " m/s^2");
  add(m.edges.diagonals, "springs along diagonals");
  add(!m.material.density, "a total mass of 1 kg");
  add(!m.material.modulus, "the same K in each spring");
  return all;
}

/** The numbers of @a answer, or nothing if they are many. */
std::string numbers(const Answer& answer, Measure measure) {
  std::string text;
  if (answer.size() <= 3)
    for (double x : answer) text += ' ' + CME212::short_text(x);
  const std::string unit = unit_of(measure);
  return text.empty() || unit.empty() ? text : text + ' ' + unit;
}

/** The limit of the grids, which is an answer itself. */
std::string extrapolated(const Advice& a) {
  if (a.grids.size() < 4) return "";
  const std::string name = name_of(a.measure);
  return "  " + name +
         " on ever finer grids:" + numbers(a.grids.limit(), a.measure) +
         " +- " + with_unit(a.grids.uncertainty(), a.measure) + " (95 %), " +
         (a.grids.asymptotic()
              ? "observed order " + CME212::two_digits(a.grids.order()) +
                    ": the grids are in the asymptotic range"
              : "no order observed: the grids are not in the asymptotic "
                "range") +
         '\n';
}

/** The advised scene, its command and its error. */
std::string recommendation(const Advice& a) {
  using CME212::short_text;
  std::string removed;
  for (const PartReport& p : a.parts)
    if (!p.needed) removed += (removed.empty() ? "" : "; ") + p.part;
  std::string text =
      "advice: " + std::to_string(mesh_of(a.model).points.size()) + " nodes, " +
      a.model.method->info.name + ", dt " + short_text(a.model.step.dt) +
      " s: error of " + name_of(a.measure) + ' ' +
      with_unit(a.error, a.measure) + " +- " +
      with_unit(a.uncertainty, a.measure) +
      " (asked: " + with_unit(a.tolerance, a.measure) +
      (a.error + a.uncertainty > a.tolerance ? "; it may be more" : "") + ")\n";
  text += "  ./cloth " + as_options(a.model) + " --headless\n";
  if (!a.answer.empty() && a.answer.size() <= 3)
    text += "  " + std::string(name_of(a.measure)) +
            " by this run:" + numbers(a.answer, a.measure) + '\n';
  text += extrapolated(a);
  if (!removed.empty()) text += "  not needed for that: " + removed + '\n';
  if (a.model.t_end < a.t_end)
    text += "  it ends at " + number(a.model.t_end) + " s instead of " +
            number(a.t_end) + " s: after that " + name_of(a.measure) +
            " changes by less than " + with_unit(a.tolerance / 10, a.measure) +
            '\n';
  auto finer = [&](const std::optional<double>& error, const char* what) {
    return (error ? with_unit(*error, a.measure) : std::string("not run")) +
           what;
  };
  if (a.checked)
    text += "  checked: error " +
            finer(a.robustness.half_step, " by half the step") +
            (a.model.sheets.empty()
                 ? "; the error of the mesh itself is unknown"
                 : ", " + finer(a.robustness.finer_grid,
                                " on twice the cells along each side")) +
            '\n';
  else
    text += "  not run: predicted from " + std::to_string(a.grids.size()) +
            " coarser grids\n";
  if (a.of_stable > 0)
    text += "  dt is " + CME212::two_digits(a.of_stable) +
            " of the largest stable step\n";
  return text;
}

/** Words of a part that is all default, as nobody would type ''. */
std::string named_default(const std::string& key) {
  return key == "sheet"                     ? "'nodes 20 20'"
         : key == "plane"                   ? "'at 0 0 -0.75'"
         : key == "tear" || key == "sphere" ? "'radius 0.15'"
                                            : "''";
}

}  // namespace

std::string as_options(const Model& m) {
  const std::vector<std::string> usual = settings(Model());
  const std::set<std::string> left_out(usual.begin(), usual.end());
  std::string all;
  for (const std::string& line : settings(m)) {
    const auto equals = line.find(" = ");
    const std::string key = line.substr(0, equals);
    // A run by the advised method has no use for the tolerance.
    if ((left_out.contains(line) && key != "edges") || key == "tolerance")
      continue;
    std::string value = line.substr(equals + 3), text;
    auto add = [&](const std::string& words) {
      all += (all.empty() ? "--" : " --") + key + ' ' +
             (words.empty() ? named_default(key) : for_shell(words));
    };
    if (value.find('"') == std::string::npos) {
      add(value);
      continue;
    }
    for (std::size_t k = 0, inside = 0; k < value.size(); ++k) {
      if (value[k] == '"') {
        if (inside) add(text);
        inside = !inside, text.clear();
      } else if (inside) {
        if (value[k] == '\\') ++k;
        text += value[k];
      }
    }
  }
  return all;
}

std::string in_words(const Advice& a) {
  const std::string unit =
      *unit_of(a.measure) ? std::string(" [") + unit_of(a.measure) + ']' : "";
  std::string text = a.refusal.empty()
                         ? recommendation(a)
                         : "no advice: " + a.refusal + '\n' + extrapolated(a);
  if (!a.trivial.empty()) text += "  trivial: " + a.trivial + '\n';
  if (!a.left_out.empty() && a.refusal.empty()) {
    text += "  not run for lack of budget: ";
    for (const std::string& what : a.left_out)
      text += (&what == &a.left_out[0] ? "" : ", ") + what;
    text += "; --advise-work " + CME212::two_digits(4 * a.budget) +
            " would allow more\n";
  }
  if (!a.parts.empty()) {
    Column part{"part, on " + std::to_string(a.tried_on) + " nodes", {}},
        effect{"change of " + std::string(name_of(a.measure)) + " without it" +
                   unit,
               {}},
        springs{"springs saved", {}}, step{"step can grow", {}}, kept{"", {}};
    for (const PartReport& p : a.parts) {
      part.cells.push_back(p.part);
      effect.cells.push_back(p.tried ? number(p.change) : "not tried");
      springs.cells.push_back(CME212::short_text(p.springs));
      step.cells.push_back(p.step > 1.01 ? number(p.step) + " times" : "");
      kept.cells.push_back(p.needed ? "kept" : "dropped");
    }
    std::vector<Column> all = {part, effect, springs, step};
    if (a.refusal.empty()) all.push_back(kept);
    text += table(all);
  }
  if (a.grids.size() > 0) {
    Column nodes{"grid of nodes", {}}, error{"estimated error" + unit, {}},
        evaluations{"force evaluations", {}}, time{"time [s]", {}},
        which{"", {}};
    const std::size_t own =
        a.refusal.empty() ? mesh_of(a.model).points.size() : 0;
    auto row = [&](std::size_t n, const std::string& off, double work,
                   double seconds, const char* what) {
      nodes.cells.push_back(std::to_string(n));
      error.cells.push_back(off);
      evaluations.cells.push_back(count(work));
      time.cells.push_back(seconds > 0 ? number(seconds) : "not run");
      which.cells.push_back(what);
    };
    auto advised = [&] {
      row(own, number(a.error), a.evaluations, a.seconds, "advised");
    };
    bool told = !a.refusal.empty();
    for (std::size_t k = 0; k < a.grids.size(); ++k) {
      const GridReport& g = a.grids[k];
      if (!told && g.nodes >= own) advised(), told = true;
      row(g.nodes, a.grids.size() < 3 ? "unknown" : number(g.error),
          g.evaluations, g.trial.seconds, "");
    }
    if (!told) advised();
    text += table({nodes, error, evaluations, time, which});
  }
  if (!a.choices.empty()) {
    Column nodes{"nodes tried", {}}, method{"method", {}}, dt{"dt [s]", {}},
        error{"error" + unit, {}}, work{"spring evaluations", {}};
    const std::size_t most = 12;  // the last ones
    for (std::size_t k = a.choices.size() - std::min(a.choices.size(), most);
         k < a.choices.size(); ++k) {
      const ChoiceReport& c = a.choices[k];
      nodes.cells.push_back(std::to_string(c.nodes));
      method.cells.push_back(c.method);
      dt.cells.push_back(number(c.dt));
      error.cells.push_back(number(c.error));
      work.cells.push_back(CME212::two_digits(c.work));
    }
    text += table({nodes, method, dt, error, work});
  }
  if (a.perturbed > 0)
    text += "\n" + std::to_string(a.perturbed) +
            (a.perturbed > 1 ? " runs" : " run") +
            " that should agree (start moved by 1e-6 m, or a slightly shorter "
            "step) differ by up to " +
            with_unit(a.scatter, a.measure) + '\n';
  if (a.floats && 10 * *a.floats <= a.tolerance / 10)
    text += "single precision would do: it changes the answer by " +
            with_unit(*a.floats, a.measure) +
            "; make cloth REAL=float halves the memory and, at 10000 nodes, "
            "the time\n";
  if (a.refusal.empty()) {
    if (const std::string acts = by_default(a.model); !acts.empty())
      text += "active by default: " + acts + '\n';
    text += "the advised run takes " +
            (a.seconds > 0 ? number(a.seconds) + " s, " : "") +
            CME212::two_digits(a.work) + " spring evaluations; ";
  }
  return text + "the pilots took " + number(a.spent) + " s, " +
         CME212::two_digits(a.spent_work) +
         " spring evaluations of a budget of " + CME212::two_digits(a.budget) +
         '\n';
}

}  // namespace lab
