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

std::string with_unit(double x, const Measure& measure) {
  return CME212::two_digits(x) + (*unit_of(measure) ? " " : "") +
         unit_of(measure);
}

std::string asked(const Advice& a) {
  return "(asked: " + (a.share.empty() ? "" : a.share + ", ") +
         with_unit(a.tolerance, a.measure) + ')';
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

using Row = std::vector<std::string>;
/** Rows of cells, the titles first, in columns as wide as their cells; all but
 * the first are right-aligned. */
std::string table(const std::vector<Row>& rows) {
  std::string text = "\n";
  for (const Row& row : rows) {
    for (std::size_t c = 0; c < row.size(); ++c) {
      std::size_t width = 0;
      for (const Row& other : rows) width = std::max(width, other[c].size());
      const std::string space(width - row[c].size(), ' ');
      text += c == 0 ? row[c] + space : "  " + space + row[c];
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
std::string numbers(const Answer& answer, const Measure& measure) {
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
      with_unit(a.uncertainty, a.measure) + " " + asked(a) +
      (a.error + a.uncertainty > a.tolerance ? "; it may be more\n" : "\n");
  text += "  ./cloth " + as_options(a.model) + " --headless\n";
  if (!a.answer.empty() && a.answer.size() <= 3)
    text += "  " + name_of(a.measure) +
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

/** The errors of the scene's own run, and its best step. */
std::string assessment(const Advice& a) {
  const Assessment& own = *a.own;
  const bool from_files = own.model.sheets.empty();
  const double u = from_files ? 0 : a.grids.uncertainty();
  auto size = [&](double error) {
    return std::isfinite(error) ? with_unit(error, a.measure) : "unknown";
  };
  std::string text =
      "assessment: error of " + name_of(a.measure) + ' ' + size(own.total) +
      (from_files ? " by its step" : " +- " + with_unit(u, a.measure)) + ' ' +
      asked(a) +
      (own.total + u <= a.tolerance  ? ": this run meets it\n"
       : own.total - u > a.tolerance ? ": this run does not meet it\n"
                                     : ": the uncertainty decides\n");
  if (a.refusal.empty())
    text += "  the largest step that meets it: ./cloth " + as_options(a.model) +
            " --headless\n";
  else
    text += "  " + a.refusal + '\n';
  const Model& m = own.model;
  return text + extrapolated(a) +
         table({{"part of this run", "error", ""},
                {"grid of " + std::to_string(own.nodes) + " nodes",
                 size(own.grid), ""},
                {"step of " + CME212::short_text(m.step.dt) + " s by " +
                     m.method->info.name,
                 size(own.step),
                 own.of_stable > 0 ? CME212::two_digits(own.of_stable) +
                                         " of the largest stable step"
                                   : ""},
                {"both", size(from_files ? no_limit : own.total),
                 "+- " + size(from_files ? no_limit : u)}});
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
  std::string text = a.own ? assessment(a)
                     : a.refusal.empty()
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
  std::vector<Row> rows = {
      {"part, on " + std::to_string(a.tried_on) + " nodes",
       "change of " + name_of(a.measure) + " without it" + unit,
       "springs saved", "step can grow", ""}};
  for (const PartReport& p : a.parts)
    rows.push_back({p.part, p.tried ? number(p.change) : "not tried",
                    CME212::short_text(p.springs),
                    p.step > 1.01 ? number(p.step) + " times" : "",
                    !a.refusal.empty() ? ""
                    : p.needed         ? "kept"
                                       : "dropped"});
  if (!a.parts.empty()) text += table(rows);
  rows = {{"grid of nodes", "estimated error" + unit, "force evaluations",
           "time [s]", ""}};
  auto row = [&](std::size_t n, const std::string& off, double work,
                 double seconds, const char* what) {
    rows.push_back({std::to_string(n), off, count(work),
                    seconds > 0 ? number(seconds) : "not run", what});
  };
  bool told = !a.refusal.empty();
  const std::size_t own = told ? 0 : mesh_of(a.model).points.size();
  auto advised = [&] {
    if (!told) row(own, number(a.error), a.evaluations, a.seconds, "advised");
    told = true;
  };
  for (std::size_t k = 0; k < a.grids.size(); ++k) {
    const GridReport& g = a.grids[k];
    if (g.nodes >= own) advised();
    row(g.nodes, a.grids.size() < 3 ? "unknown" : number(g.error),
        g.evaluations, g.trial.seconds, "");
  }
  advised();
  if (!a.grids.empty()) text += table(rows);
  rows = {{"nodes tried", "method", "dt [s]", "error" + unit,
           "spring evaluations"}};
  const std::size_t most = 12;  // the last ones
  for (std::size_t k = a.choices.size() - std::min(a.choices.size(), most);
       k < a.choices.size(); ++k) {
    const ChoiceReport& c = a.choices[k];
    rows.push_back({std::to_string(c.nodes), c.method, number(c.dt),
                    number(c.error), CME212::two_digits(c.work)});
  }
  if (!a.choices.empty()) text += table(rows);
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

std::string as_json(const Advice& a) {
  std::string text = "{";
  auto add = [&](const std::string& name, const std::string& value) {
    text += (text == "{" ? "\n  \"" : ",\n  \"") + name + "\": " + value;
  };
  auto quoted = [&](const std::string& name, const std::string& value) {
    std::string all = "\"";
    for (char c : value)
      all += c == '"' || c == '\\' ? std::string{'\\', c}
             : c < ' '             ? std::string{' '}
                                   : std::string{c};
    add(name, all + '"');
  };
  auto number = [&](const std::string& name, double x) {
    add(name, std::isfinite(x) ? CME212::to_text(x) : "null");
  };
  auto list = [&](const std::string& name, const Answer& all) {
    std::string value;
    for (double x : all)
      value += (value.empty() ? "" : ", ") + CME212::to_text(x);
    add(name, '[' + value + ']');
  };
  quoted("measure", name_of(a.measure));
  quoted("unit", unit_of(a.measure));
  number("tolerance", a.tolerance);
  quoted("refusal", a.refusal), quoted("trivial", a.trivial);
  if (a.grids.size() > 2) {
    list("limit", a.grids.limit());
    number("limit_uncertainty", a.grids.uncertainty());
    number("observed_order", a.grids.asymptotic() ? a.grids.order() : no_limit);
  }
  if (a.own) {
    number("own_error", a.own->total), number("own_grid_error", a.own->grid);
    number("own_step_error", a.own->step),
        number("own_dt_s", a.own->model.step.dt);
    number("own_dt_over_stable", a.own->of_stable);
  }
  if (a.refusal.empty()) {
    quoted("options", as_options(a.model));
    number("nodes", double(mesh_of(a.model).points.size()));
    quoted("method", a.model.method->info.name);
    number("dt_s", a.model.step.dt), number("t_end_s", a.model.t_end);
    number("error", a.error), number("uncertainty", a.uncertainty);
    list("answer", a.answer);
    number("work_spring_evaluations", a.work);
  }
  number("spent_spring_evaluations", a.spent_work);
  return text + "\n}\n";
}

}  // namespace lab
