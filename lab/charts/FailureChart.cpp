#include "lab/charts/FailureChart.hpp"

#include <algorithm>
#include <array>
#include <ostream>
#include <sstream>
#include <string>

#include "CME212/Util.hpp"
#include "lab/charts/Failure.hpp"
#include "lab/charts/Report.hpp"
#include "lab/methods/DormandPrince.hpp"
#include "lab/methods/Methods.hpp"
#include "lab/methods/Xpbd.hpp"

namespace lab {

namespace {

using report::cell;

/** The text at the curve of a run. */
struct Label {
  const char* text;  // # stands for the force evaluations
  double at;         // where: time [s]
  double up;         // lines of text above the curve
};

/** How the picture of a failure looks. */
struct Layout {
  std::string_view method;
  double low, high;  // ends of the axis
  bool log;
  std::array<Label, 4> labels;  // of the runs
};

/** In the order of `failures`. */
constexpr std::array layouts = {
    Layout{"forward-euler",
           -1,
           6,
           false,
           {{{"limit/4", 0.535, 0},
             {"limit/16", 1.56, -0.5},
             {"limit/64", 2.0, 1.6},
             {"verlet at limit/2", 1.0, -1}}}},
    Layout{"symplectic-euler",
           -0.15,
           0.15,
           false,
           {{{"symplectic-euler", 0.36, 1}, {"verlet", 1.1, -1}}}},
    Layout{
        "verlet",
        1e-7,
        1,
        true,
        {{{"1.05 of the limit", 0.3, -0.9}, {"0.97 of the limit", 0.6, 1.6}}}},
    Layout{"respa",
           0,
           6,
           false,
           {{{"dt = 0.986 half periods", 1.3, 2.5},
             {"dt = 0.9 half periods", 2, 1.2}}}},
    Layout{"yoshida4",
           1e-8,
           1e-2,
           true,
           {{{"yoshida4: # evaluations", 1.6, 1.4},
             {"pefrl: # evaluations", 2, -1}}}},
    Layout{"pefrl",
           1e-10,
           1,
           true,
           {{{"pefrl: # evaluations", 0.12, -1.2},
             {"verlet: # evaluations", 0.04, 2.2}}}},
    Layout{"srkn6b",
           1e-3,
           1,
           true,
           {{{"dt omega = 3.166", 95, -0.9}, {"dt omega = 3.07", 120, -1}}}},
    Layout{"srkn11b",
           1e-3,
           1,
           true,
           {{{"dt omega = 3.142", 480, -0.8}, {"dt omega = 3.05", 600, -1}}}},
    Layout{"rk4", -1, 0.4, false, {{{"rk4", 3.5, 1}, {"pefrl", 3, 1}}}},
    Layout{"dormand-prince",
           -1,
           4,
           false,
           {{{"tolerance 0.01 m: # evaluations", 8, -0.8},
             {"tolerance 0.0001 m: # evaluations", 8, 0.9},
             {"pefrl: # evaluations", 8, -0.9}}}},
    Layout{"dop853",
           -1.4,
           0.4,
           false,
           {{{"tolerance 0.01 m: # evaluations", 2, -3.5},
             {"tolerance 0.0001 m: # evaluations", 5, 1.2}}}},
    Layout{"implicit-euler",
           -0.7,
           0.1,
           false,
           {{{"implicit-euler", 0.85, -1.2},
             {"true motion", 1.14, 0.7},
             {"tr-bdf2", 2.15, 1}}}},
    Layout{"implicit-midpoint",
           -3,
           10,
           false,
           {{{"implicit-midpoint", 2.48, -0.8},
             {"tr-bdf2", 3, 0.9},
             {"at dt = 0.01 s", 3, 0.9}}}},
    Layout{"tr-bdf2",
           0,
           0.1,
           false,
           {{{"tr-bdf2", 2, 1}, {"implicit-midpoint", 2, 1}}}},
    Layout{"augmented-verlet",
           -0.7,
           0.1,
           false,
           {{{"augmented-verlet", 0.3, 0.5},
             {"true motion", 0.62, -0.9},
             {"tr-bdf2", 1.1, 1}}}},
    Layout{"xpbd",
           0,
           1,
           false,
           {{{"1 substep", 0.72, 0.3},
             {"2 substeps", 2, 0.9},
             {"true motion", 1.3, -1.5},
             {"20 substeps", 1.85, -0.9}}}}};
static_assert(std::ranges::equal(layouts, methods, {}, &Layout::method,
                                 [](const MethodEntry& m) {
                                   return std::string_view(m.info.name);
                                 }));

const char* axis_of(Quantity q) {
  constexpr std::array names = {
      "total energy [J]", "center of mass over its start [m]",
      "largest stretch, l/L - 1", "distance from the true motion [m]"};
  return names[static_cast<std::size_t>(q)];
}

const char* unit_of(Quantity q) {
  return q == Quantity::energy ? " J" : q == Quantity::stretch ? "" : " m";
}

/** What the run @a k is in the picture. */
const char* role_of(const Failure& f, std::size_t k) {
  if (f.runs[k].method.empty()) return "true";
  return k == 0 ? "fails" : k + 1 == f.size() ? "cure" : "other";
}

/** The text at a run's curve. */
std::string text_of(const Label& l, const Trace& trace) {
  std::string label = l.text;
  if (auto at = label.find('#'); at != std::string::npos)
    label.replace(at, 1, std::to_string(trace.sweeps));
  return label;
}

/** How a run ended; nothing if well. */
const char* status_of(const Trace& trace) {
  constexpr std::array names = {"", "diverged", "failed"};
  return names[static_cast<std::size_t>(trace.status)];
}

/** What was measured in the run @a r of @a f, in one line. */
std::string in_words(const Failure& f, const FailureRun& r,
                     const Trace& trace) {
  using CME212::short_text;
  std::string text(r.method);
  text += ", dt = " + short_text(r.dt) + " s";
  if (r.setting > 0 && r.method == Xpbd::info.name)
    text += ", substeps " + short_text(r.setting);
  else if (r.setting > 0)
    text += ", tolerance " + short_text(r.setting) + " m";
  text += ": off by " + short_text(trace.deviation) + unit_of(f.quantity) +
          ", " + std::to_string(trace.sweeps) + " force evaluations";
  if (trace.status != Outcome::Status::ok)
    text += std::string(", ") + status_of(trace) +
            " at t = " + short_text(trace.samples.back().t) + " s";
  return text;
}

}  // namespace

void write_failures(const std::vector<const MethodEntry*>& chosen,
                    std::ostream* said, std::ostream& out) {
  constexpr std::size_t drawn = 200;  // points of a curve, about
  std::ostringstream rows;
  report::write_head(out, "how each method fails, and a cure");
  for (const MethodEntry* m : chosen) {
    const Failure& f = failure_of(m->info.name);
    const std::string name = m->info.name;
    const Layout& layout =
        *std::ranges::find(layouts, m->info.name, &Layout::method);
    out << "# title " << name << ": " << f.title << "\n# caption " << name
        << ": " << f.caption << "\n# axis " << name << ": " << f.t_end << ' '
        << layout.low << ' ' << layout.high << ' ' << layout.log << ' '
        << axis_of(f.quantity) << '\n';
    for (std::size_t k = 0; k < f.size(); ++k) {
      const FailureRun& r = f.runs[k];
      const Label& label = layout.labels[k];
      const Trace trace = lab::trace(f, r);
      if (!r.method.empty()) {
        out << "# measured " << name << ": " << in_words(f, r, trace) << '\n';
        if (said) *said << (k ? "  " : "") << in_words(f, r, trace) << '\n';
      }
      const auto& samples = trace.samples;
      const std::size_t every = samples.size() / drawn + 1;
      const std::size_t label_at =
          std::size_t(std::min(label.at / r.dt, double(samples.size() - 1)));
      for (std::size_t n = 0; n < samples.size(); ++n) {
        const bool last = n + 1 == samples.size(), at_label = n == label_at;
        if (n % every != 0 && !last && !at_label) continue;
        rows << name << ',' << r.method << ',' << role_of(f, k) << ',' << k
             << ',' << cell(samples[n].t) << ',' << cell(samples[n].value)
             << ',' << (at_label ? cell(text_of(label, trace)) : "") << ','
             << (at_label ? cell(label.up) : "") << ','
             << (last ? status_of(trace) : "") << '\n';
      }
    }
  }
  out << "failure,method,role,run,t [s],value,label,label up,status\n"
      << rows.str();
}

}  // namespace lab
