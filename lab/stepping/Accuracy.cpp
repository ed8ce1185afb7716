#include "lab/stepping/Accuracy.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "CME212/Util.hpp"
#include "lab/fast/GraphArrays.hpp"
#include "lab/stepping/Scene.hpp"

namespace lab {

Track::Track(double t_end, std::size_t nodes) {
  const double count =
      std::clamp(2e7 / double(std::max<std::size_t>(nodes, 1)), 8., 64.);
  for (int k = 1; k <= int(count); ++k) due_.push_back(t_end * k / int(count));
}

Track Track::beside() const {
  Track other;
  for (const State& s : states_) other.due_.push_back(s.time);
  return other;
}

void Track::look(const Scene& scene) {
  const double now = scene.time() + round_off();
  if (next_ == due_.size() || now < due_[next_]) return;
  while (next_ < due_.size() && due_[next_] <= now) ++next_;
  const Cloth& g = scene.cloth();
  const auto x = arrays(g).positions();
  State& s = states_.emplace_back(State{scene.time(), {}});
  s.x.assign(x.begin(), x.end());
  for (unsigned id = 0; id < s.x.size(); ++id)
    if (!arrays(g).node_in_use(id))
      s.x[id] = Point(no_limit, no_limit, no_limit);
}

Separation::Separation(const Track& a, const Track& b) {
  const double round_off = a.round_off();
  auto other = b.states_.begin();
  for (const Track::State& s : a.states_) {
    while (other != b.states_.end() && other->time < s.time - round_off)
      ++other;
    if (other == b.states_.end()) break;
    if (other->time > s.time + round_off) continue;
    At at = {s.time, 0, 0};
    std::size_t count = 0;
    for (std::size_t id = 0; id < std::min(s.x.size(), other->x.size()); ++id) {
      const Point &p = s.x[id], &q = other->x[id];
      const bool p_removed = std::isinf(p.x), q_removed = std::isinf(q.x);
      if (p_removed && q_removed) continue;
      const double d2 =
          p_removed || q_removed ? no_limit : double(normSq(p - q));
      ++count, at.rms += d2;
      at.largest = std::max(at.largest, std::sqrt(d2));
    }
    if (count > 0) at.rms = std::sqrt(at.rms / double(count));
    all_.push_back(at);
  }
}

double Separation::horizon(double tolerance) const {
  double last = 0;
  for (const At& at : all_) {
    if (!(at.rms <= tolerance)) break;
    last = at.time;
  }
  return last;
}

double Separation::growth() const {
  double most = 0;
  for (std::size_t k = 1; k < all_.size(); k += 2)
    if (const double before = all_[k / 2].rms;
        before > 0 && std::isfinite(all_[k].rms))
      most = std::max(most, all_[k].rms / before);
  return most;
}

Separation::At Separation::most() const {
  At most = {};
  for (const At& at : all_) {
    most.time = at.time;
    most.rms = std::max(most.rms, at.rms);
    most.largest = std::max(most.largest, at.largest);
  }
  return most;
}

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
