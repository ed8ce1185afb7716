#include "lab/charts/Failure.hpp"

#include <algorithm>
#include <array>
#include <ostream>
#include <sstream>
#include <string>

#include "CME212/Util.hpp"
#include "lab/charts/Report.hpp"
#include "lab/methods/FastMassSpring.hpp"
#include "lab/methods/Methods.hpp"
#include "lab/methods/Xpbd.hpp"

namespace lab {

namespace {

using report::cell;

const char* axis_of(Plotted q) {
  constexpr std::array names = {
      "total energy [J]", "center of mass over its start [m]",
      "largest stretch, l/L - 1", "distance from the true motion [m]"};
  return names[static_cast<std::size_t>(q)];
}

const char* unit_of(Plotted q) {
  return q == Plotted::energy ? " J" : q == Plotted::stretch ? "" : " m";
}

/** The role of run @a k in the picture. */
const char* role_of(const Failure& f, std::size_t k) {
  if (f.runs[k].method.empty()) return "true";
  return k == 0 ? "fails" : k + 1 == f.size() ? "cure" : "other";
}

/** The label of a run's curve. */
std::string text_of(const FailureRun& r, const Trace& trace) {
  std::string label = r.label;
  if (auto at = label.find('#'); at != std::string::npos)
    label.replace(at, 1, std::to_string(trace.sweeps));
  return label;
}

/** How a run ended; empty if well. */
const char* status_of(const Trace& trace) {
  constexpr std::array names = {"", "diverged", "failed"};
  return names[static_cast<std::size_t>(trace.status)];
}

/** The measured numbers of the run @a r of @a f, in one line. */
std::string in_words(const Failure& f, const FailureRun& r,
                     const Trace& trace) {
  using CME212::short_text;
  std::string text(r.method);
  text += ", dt = " + short_text(r.dt) + " s";
  if (r.setting > 0 && r.method == Xpbd::info.name)
    text += ", substeps " + short_text(r.setting);
  else if (r.setting > 0 && r.method == FastMassSpring::info.name)
    text += ", rounds " + short_text(r.setting);
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
    const std::string name = m->info.name;
    if (!failure_of(name)) continue;
    const Failure& f = *failure_of(name);
    out << "# title " << name << ": " << f.title << "\n# caption " << name
        << ": " << f.caption << "\n# axis " << name << ": " << f.t_end << ' '
        << f.axis.low << ' ' << f.axis.high << ' ' << f.axis.log << ' '
        << axis_of(f.quantity) << '\n';
    for (std::size_t k = 0; k < f.size(); ++k) {
      const FailureRun& r = f.runs[k];
      const Trace trace = lab::trace(f, r);
      if (!r.method.empty()) {
        out << "# measured " << name << ": " << in_words(f, r, trace) << '\n';
        if (said) *said << (k ? "  " : "") << in_words(f, r, trace) << '\n';
      }
      const auto& samples = trace.samples;
      const std::size_t every = samples.size() / drawn + 1;
      const std::size_t label_at =
          std::size_t(std::min(r.place.t / r.dt, double(samples.size() - 1)));
      for (std::size_t n = 0; n < samples.size(); ++n) {
        const bool last = n + 1 == samples.size(), at_label = n == label_at;
        if (n % every != 0 && !last && !at_label) continue;
        rows << name << ',' << r.method << ',' << role_of(f, k) << ',' << k
             << ',' << cell(samples[n].t) << ',' << cell(samples[n].value)
             << ',' << (at_label ? cell(text_of(r, trace)) : "") << ','
             << (at_label ? cell(r.place.up) : "") << ','
             << (last ? status_of(trace) : "") << '\n';
      }
    }
  }
  out << "failure,method,role,run,t [s],value,label,label up,status\n"
      << rows.str();
}

}  // namespace lab
