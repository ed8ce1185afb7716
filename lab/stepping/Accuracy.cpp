#include "lab/stepping/Accuracy.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "CME212/Util.hpp"
#include "lab/stepping/Scene.hpp"
#include "lab/stepping/Separation.hpp"

namespace lab {

namespace {

using CME212::two_digits;

/** The tolerance of a run divided by that of its second run. */
constexpr double finer = 10;
/** The smallest useful tolerance [m], some hundred times round-off. */
constexpr double least = 450 * std::numeric_limits<double>::epsilon();
constexpr int most_pairs = 6;

struct Pilot {
  Track track;
  long long evaluations;
  std::string failure;
};

/** @param other the run to compare it with, or null
 * @param shift of every other node at the start, along all axes [m] */
Pilot run_pilot(const Model& m, const Track* other, const std::string& doing,
                const std::function<void(const std::string&, double)>& tell,
                double shift) {
  Scene scene(m);
  if (shift > 0) {
    for (Node n : scene.cloth().nodes())
      n.position() += n.index() % 2 * Point(shift, shift, shift);
    scene.change_method(*m.method, m.step);  // the guard starts anew
  }
  Pilot p = {
      other ? other->beside() : Track(m.t_end, scene.cloth().num_nodes()),
      0,
      {}};
  scene.run_to(m.t_end, [&] {
    tell(doing, scene.time() / m.t_end);
    p.track.look(scene);
  });
  p.evaluations = scene.evaluations();
  p.failure = text_of(scene.failure());
  return p;
}

}  // namespace

Accuracy find_accuracy(
    const Model& m, double asked,
    const std::function<void(const std::string&, double)>& tell) {
  Model coarse = m;
  const bool adaptive = m.method->info.adaptive;
  double TimeStep::*const knob =
      adaptive ? &TimeStep::tolerance : &TimeStep::dt;  // errors fall with it
  if (!adaptive)
    coarse.step = {
        .dt = std::min(safe_share * Scene(m).least_limit().limit, m.t_end)};
  const double smallest = adaptive ? least * finer : coarse.step.dt / 1024;
  Accuracy best = {asked, coarse.step, m.t_end, -1, 0, 0, false, {}};
  std::optional<Pilot> a;
  int runs = 0;
  const auto run = [&](const Model& pilot, const Track* other,
                       double shift = 0) {
    return run_pilot(pilot, other,
                     "measuring the error, run " + std::to_string(++runs), tell,
                     shift);
  };
  // A smooth motion needs less than the first tolerance: if its error is far
  // below, measure that of a larger one by the run that there is.
  const auto try_larger = [&](const Pilot& exact, double factor) {
    constexpr double far = 20, margin = 3, most = 1e4;
    if (far * best.rms > asked) return;
    Model larger = coarse;
    larger.step.tolerance *= std::min(most, asked / (margin * best.rms));
    const Pilot c = run(larger, &exact.track);
    if (!c.failure.empty() || 0.9 * exact.evaluations < c.evaluations) return;
    const Separation apart(c.track, exact.track);
    const double rms = factor * apart.most().rms + best.rms;
    if (!(rms <= asked)) return;
    best.step = larger.step, best.rms = rms;
    best.largest = factor * apart.most().largest + best.largest;
  };
  for (int pair = 1; pair <= most_pairs; ++pair) {
    if (!a) a = run(coarse, nullptr);
    Model fine = coarse;
    fine.step.tolerance /= finer;
    fine.step.dt /= 2;
    Pilot b = a->failure.empty() ? run(fine, &a->track) : *a;
    if (!b.failure.empty()) {
      if (best.horizon < 0) best.unknown = b.failure;
      break;
    }
    // If the first run has the error e, the second one has e/ratio. At contacts
    // the error is of first order in the step.
    const double ratio = m.has_contact() || !adaptive
                             ? double(b.evaluations) / double(a->evaluations)
                             : finer;
    const double factor = 1 / (1 - 1 / std::max(ratio, 1.1));
    const Separation apart(a->track, b.track);
    const Accuracy now = {asked,
                          coarse.step,
                          m.t_end,
                          apart.horizon(asked / factor),
                          factor * apart.most().rms,
                          factor * apart.most().largest,
                          false,
                          {}};
    if (now.horizon <= best.horizon) break;  // round-off decides
    const double before = best.horizon, step_before = best.step.*knob;
    best = now;
    if (now.kept()) {
      if (pair == 1 && adaptive) try_larger(*a, factor);
      break;
    }
    // Small errors are proportional to the tolerance. If they have saturated,
    // the horizon grows with the logarithm of the tolerance.
    const double last = coarse.step.*knob;
    double share = std::max(1e-4, asked / (3 * now.rms));
    if (before >= 0)
      share =
          std::min(share, std::max(1e-3, std::pow(last / step_before,
                                                  (m.t_end - now.horizon) /
                                                      (now.horizon - before))));
    const double next = std::max(share * last, smallest);
    if (next > last / 2) break;
    if (next >= fine.step.*knob / 2) {
      a = std::move(b), coarse = fine;
    } else {
      a.reset(), coarse.step.*knob = next;
    }
  }
  best.horizon = std::max(best.horizon, 0.);
  if (best.kept() || !best.unknown.empty()) return best;
  coarse.step = best.step;
  const Pilot here = run(coarse, nullptr);
  const Pilot beside = run(coarse, &here.track, 1e-3 * asked);
  constexpr double power = 32;  // t^5
  best.chaotic = Separation(here.track, beside.track).growth() > power;
  return best;
}

std::string Accuracy::text() const {
  using CME212::short_text;
  const std::string to = "to " + short_text(asked) + " m";
  if (!unknown.empty()) return "positions " + to + ": not measured: " + unknown;
  const std::string size = two_digits(rms) + " m (RMS over the nodes), " +
                           two_digits(largest) + " m at the worst node";
  if (kept()) return "positions " + to + ": kept; measured error " + size;
  return "positions " + to + (chaotic ? ": predictable to " : ": kept to ") +
         short_text(horizon) +
         " s; after that two runs of different accuracy differ by " +
         (std::isfinite(rms) ? size : "the nodes that are removed");
}

}  // namespace lab
