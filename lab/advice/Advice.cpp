#include "lab/advice/Advice.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "CME212/Util.hpp"
#include "lab/methods/Method.hpp"
#include "lab/scenes/Compose.hpp"
#include "lab/scenes/Fields.hpp"
#include "lab/scenes/Json.hpp"

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

std::size_t nodes_of(const AdvisedRun& run) {
  return mesh_of(run.model).points.size();
}

/** @a words in a list. */
std::string joined(const std::vector<std::string>& words, const char* between) {
  std::string all;
  for (const std::string& w : words) all += (all.empty() ? "" : between) + w;
  return all;
}

using Row = std::vector<std::string>;
/** Rows of cells, the titles first, in columns as wide as their cells; all but
 * the first are right-aligned. Nothing if there are but titles. */
std::string in_columns(const std::vector<Row>& rows) {
  if (rows.size() == 1) return "";
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
  std::vector<std::string> all;
  auto add = [&](bool acts, const std::string& what) {
    if (acts) all.push_back(what);
  };
  add(m.gravity == grav, "gravity " + CME212::short_text(grav) + " m/s^2");
  add(m.edges.diagonals, "springs along diagonals");
  add(!m.material.density, "a total mass of 1 kg");
  add(!m.material.modulus, "the same K in each spring");
  return joined(all, ", ");
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
         (a.from_files ? " by ever smaller steps:" : " on ever finer grids:") +
         numbers(a.grids.limit(), a.measure) + " +- " +
         with_unit(a.grids.uncertainty(), a.measure) + " (95 %), " +
         (a.grids.slow()
              ? "by order 1/2, as a pin holds one node\n"
              : (a.grids.asymptotic()
                     ? "observed order " + CME212::two_digits(a.grids.order()) +
                           ": "
                     : "no order observed: ") +
                    (a.from_files ? "the steps are " : "the grids are ") +
                    (a.grids.asymptotic() ? "" : "not ") +
                    "in the asymptotic range\n");
}

/** The advised scene, its command and its error. */
std::string recommendation(const Advice& a) {
  using CME212::short_text;
  const bool rests = !a.at_rest.empty();
  std::vector<std::string> removed;
  for (const PartReport& p : a.parts)
    if (!p.needed) removed.push_back(p.part);
  std::string text =
      "advice: " + std::to_string(nodes_of(a)) + " nodes" +
      (rests ? " at rest"
             : ", " + std::string(a.model.method->info.name) + ", dt " +
                   short_text(a.model.step.dt) + " s") +
      ": error of " + name_of(a.measure) + ' ' + with_unit(a.error, a.measure) +
      " +- " + with_unit(a.uncertainty, a.measure) + " " + asked(a) +
      (a.error + a.uncertainty > a.tolerance ? "; it may be more" : "") +
      (a.from_files ? "; the mesh's own error is not known\n" : "\n");
  text += "  ./cloth " + as_options(a.model) + (rests ? "\n" : " --headless\n");
  if (!a.answer.empty() && a.answer.size() <= 3)
    text += "  " + name_of(a.measure) +
            " by this run:" + numbers(a.answer, a.measure) + '\n';
  text += extrapolated(a);
  if (!removed.empty())
    text += "  not needed for that: " + joined(removed, "; ") + '\n';
  if (a.model.t_end < a.t_end && !rests)
    text += "  it ends at " + number(a.model.t_end) + " s instead of " +
            number(a.t_end) + " s: after that " + name_of(a.measure) +
            " changes by less than " + with_unit(a.tolerance / 10, a.measure) +
            '\n';
  auto finer = [&](const std::optional<double>& error, const char* what) {
    return (error ? with_unit(*error, a.measure) : std::string("not run")) +
           what;
  };
  text += "  checked: error " +
          (rests ? "" : finer(a.half_step, " by half the step")) +
          (rests || a.from_files ? "" : ", ") +
          (a.from_files
               ? ""
               : finer(a.finer_grid, " on twice the cells along each side")) +
          '\n';
  if (rests) text += "  at rest: " + a.at_rest + '\n';
  if (a.of_stable > 0)
    text += "  dt is " + CME212::two_digits(a.of_stable) +
            " of the largest stable step\n";
  return text;
}

/** The errors of the scene's own run, and its best step. */
std::string assessment(const Advice& a) {
  const Assessment& own = *a.own;
  const double u = a.grids.uncertainty();
  auto size = [&](double error) {
    return std::isfinite(error) ? with_unit(error, a.measure) : "unknown";
  };
  std::string text =
      "assessment: error of " + name_of(a.measure) + ' ' + size(own.total) +
      (a.from_files ? " by its step" : "") + " +- " + with_unit(u, a.measure) +
      ' ' + asked(a) +
      (own.total + u <= a.tolerance  ? ": this run meets it\n"
       : own.total - u > a.tolerance ? ": this run does not meet it\n"
                                     : ": the uncertainty decides\n");
  if (a.refusal.empty())
    text += "  the largest step that meets it: ./cloth " + as_options(a.model) +
            " --headless\n";
  else
    text += "  " + a.refusal + '\n';
  const Model& m = own.model;
  return text + extrapolated(a) + "  of that error: by a grid of " +
         std::to_string(mesh_of(m).points.size()) + " nodes " + size(own.grid) +
         ", by a step of " + CME212::short_text(m.step.dt) + " s (" +
         std::string(m.method->info.name) +
         (own.of_stable > 0 ? ", " + CME212::two_digits(own.of_stable) +
                                  " of the largest stable step"
                            : "") +
         ") " + size(own.step) + '\n';
}

std::string notes(const Advice& a) {
  std::string text;
  if (!a.trivial.empty()) text += "  trivial: " + a.trivial + '\n';
  if (!a.buckles.empty()) text += "  note: " + a.buckles + '\n';
  if (!a.impossible.empty())
    text += "  could not be run: " + joined(a.impossible, "; ") + '\n';
  if (!a.left_out.empty() && a.refusal.empty())
    text += "  not run for lack of budget: " + joined(a.left_out, ", ") +
            "; --advise-work " + CME212::two_digits(4 * a.budget) +
            " would allow more\n";
  return text;
}

std::string in_brackets(const Measure& measure) {
  return *unit_of(measure) ? std::string(" [") + unit_of(measure) + ']' : "";
}

std::string table_of_parts(const Advice& a) {
  std::vector<Row> rows = {{"part, on " + std::to_string(a.tried_on) + " nodes",
                            "change of " + name_of(a.measure) + " without it" +
                                in_brackets(a.measure),
                            "springs saved", "step can grow", ""}};
  for (const PartReport& p : a.parts)
    rows.push_back({p.part, p.tried ? number(p.change) : "not tried",
                    CME212::short_text(p.springs),
                    p.step > 1.01 ? number(p.step) + " times" : "",
                    !a.refusal.empty() ? ""
                    : p.needed         ? "kept"
                                       : "dropped"});
  return in_columns(rows);
}

std::string table_of_grids(const Advice& a) {
  std::vector<Row> rows = {{a.from_files ? "step [s]" : "grid of nodes",
                            "estimated error" + in_brackets(a.measure),
                            "force evaluations", "time [s]", ""}};
  for (std::size_t k = 0; k < a.grids.size(); ++k) {
    const GridReport& g = a.grids[k];
    rows.push_back({a.from_files ? number(g.trial.dt) : std::to_string(g.nodes),
                    a.grids.size() < 3 ? "unknown" : number(g.error),
                    count(g.evaluations), number(g.trial.seconds), ""});
  }
  if (a.refusal.empty())
    rows.push_back(
        {a.from_files ? number(a.model.step.dt) : std::to_string(nodes_of(a)),
         number(a.error), count(a.evaluations), number(a.seconds), "advised"});
  return in_columns(rows);
}

/** The last choices that were run. */
std::string table_of_choices(const Advice& a) {
  std::vector<Row> rows = {{"nodes tried", "method", "dt [s]",
                            "error" + in_brackets(a.measure),
                            "spring evaluations"}};
  const std::size_t all = a.choices.size();
  for (std::size_t k = all - std::min<std::size_t>(all, 12); k < all; ++k) {
    const AdvisedRun& c = a.choices[k];
    rows.push_back(
        {std::to_string(nodes_of(c)), std::string(c.model.method->info.name),
         number(c.model.step.dt), number(c.error), CME212::two_digits(c.work)});
  }
  return in_columns(rows);
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
  Model copy = m, none;
  const auto all = fields_of(copy), usual = fields_of(none);
  const bool rests = m.from_rest && m.t_end == 0;  // there is no time
  std::string text;
  for (const Field& f : all) {
    const auto values = f.values();
    const std::string name = f.name;
    const bool is_flag = std::holds_alternative<bool*>(f.member),
               replaced = std::ranges::any_of(all, [&](const Field&other) {
                 return other.instead_of == name && !other.values().empty();
               });
    // A run by the advised method has no use for the tolerance.
    if (replaced || name == "tolerance" || (rests && name == "t-end") ||
        values == usual[std::size_t(&f - &all[0])].values())
      continue;
    for (const std::string& words : values)
      text += (text.empty() ? "--" : " --") +
              (rests && name == "from-rest" ? "rest"
               : is_flag                    ? name + '=' + words
                                            : name + ' ' +
                               (words.empty() ? named_default(name)
                                              : for_shell(words)));
  }
  return text;
}

std::string in_words(const Advice& a) {
  if (!a.trivial.empty() && a.grids.empty())
    return "advice: no run is needed: " + name_of(a.measure) + " is" +
           numbers(a.answer, a.measure) + "\n  ./cloth " + as_options(a.model) +
           " --headless\n  trivial: " + a.trivial + '\n';
  std::string text = a.own ? assessment(a)
                     : a.refusal.empty()
                         ? recommendation(a)
                         : "no advice: " + a.refusal + '\n' + extrapolated(a);
  text +=
      notes(a) + table_of_parts(a) + table_of_grids(a) + table_of_choices(a);
  if (a.perturbed > 0)
    text += "\n" + CME212::count_of(std::size_t(a.perturbed), "run") +
            " that should agree (start moved by 1e-6 m, or a slightly shorter "
            "step) differ by up to " +
            with_unit(a.scatter, a.measure) + '\n';
  if (a.refusal.empty()) {
    if (const std::string acts = by_default(a.model); !acts.empty())
      text += "active by default: " + acts + '\n';
    text += "the advised run takes " + number(a.seconds) + " s, " +
            CME212::two_digits(a.work) + " spring evaluations; ";
  }
  return text + "the pilots took " + number(a.spent) + " s, " +
         CME212::two_digits(a.spent_work) +
         " spring evaluations of a budget of " + CME212::two_digits(a.budget) +
         '\n';
}

std::string as_json(const Advice& a) {
  using json::list;
  std::string all = json::members("measure", name_of(a.measure), "unit",
                                  unit_of(a.measure), "tolerance", a.tolerance,
                                  "refusal", a.refusal, "trivial", a.trivial);
  auto add = [&all](const auto&... more) {
    all += ',' + json::members(more...);
  };
  if (a.grids.size() > 2)
    add("limit", list(a.grids.limit()), "limit_uncertainty",
        a.grids.uncertainty(), "observed_order",
        a.grids.asymptotic() ? a.grids.order() : no_limit);
  if (a.own)
    add("own_error", a.own->total, "own_grid_error", a.own->grid,
        "own_step_error", a.own->step, "own_dt_s", a.own->model.step.dt,
        "own_dt_over_stable", a.own->of_stable);
  if (a.refusal.empty())
    add("options", as_options(a.model), "nodes", nodes_of(a), "method",
        a.model.method->info.name, "dt_s", a.model.step.dt, "t_end_s",
        a.model.t_end, "error", a.error, "uncertainty", a.uncertainty, "answer",
        list(a.answer), "work_spring_evaluations", a.work);
  add("spent_spring_evaluations", a.spent_work);
  return '{' + all + "}\n";
}

}  // namespace lab
