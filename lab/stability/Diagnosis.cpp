#include "lab/stability/Diagnosis.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <string_view>
#include <vector>

#include "CME212/Util.hpp"
#include "lab/methods/ImplicitMethods.hpp"
#include "lab/methods/Methods.hpp"
#include "lab/methods/Xpbd.hpp"

namespace lab {

WorstPlace::WorstPlace(const Cloth& g) {
  double highest = -1;
  for (Node n : g.nodes()) {
    double v = norm(n.value().vel);
    if (!std::isfinite(v + norm(n.position()))) v = no_limit;
    if (v > highest) highest = v, node = n;
  }
  if (!g.has_node(node)) return;
  speed = highest;
  double longest = -1;
  for (Edge e : node.edges())
    if (double l = e.length(); !(l <= longest)) longest = l, spring = e;
  index = node.index();
  if (!g.has_edge(spring)) return;
  length = std::isfinite(longest) ? longest : no_limit;
  rest = spring.value().L, other = spring.node2().index();
}

std::string WorstPlace::text() const {
  if (index < 0) return "no node is left";
  std::ostringstream out;
  out.precision(3);
  out << "node " << index;
  if (std::isfinite(speed))
    out << " moves at " << speed << " m/s";
  else
    out << " has a position or a velocity that is not finite";
  if (other < 0) return out.str();
  out << ", its spring to node " << other << " is ";
  if (!std::isfinite(length))
    out << "too long to be represented";
  else if (rest > 0)
    out << length / rest << " times its rest length of " << rest << " m";
  else
    out << length << " m long";
  return out.str();
}

std::string Failure::what() const {
  switch (kind) {
    case Kind::start:
      return "the energy at the start is not finite";
    case Kind::diverged:
      return "diverged";
    case Kind::refused:
      break;
  }
  return "failed (" + reason + ')';
}

std::string Failure::where() const {
  if (kind == Kind::start) return place.text();
  std::ostringstream out;
  out.precision(3);
  out << "step " << step << " with dt = " << dt << " s, method " << method
      << ": " << place.text() << "; the last good state is that of t = " << time
      << " s";
  return out.str();
}

std::string Failure::text() const {
  return what() + (kind == Kind::start ? ": " : " in ") + where();
}

std::string Cure::options(const MethodEntry& before) const {
  const std::string step = "--dt " + CME212::short_text(dt);
  const bool same = method.info.name == before.info.name;
  // --dt alone would replace an adaptive method that --tolerance chose.
  return same && !before.info.adaptive
             ? step
             : "--method " + std::string(method.info.name) + ' ' + step;
}

std::string Cure::in_words(const MethodEntry&) const {
  return std::string(method.info.name) + " with a step of " +
         CME212::short_text(1e3 * dt) + " ms";
}

bool is_flat(const Cloth& g) {
  const auto nodes = g.nodes();
  if (g.num_nodes() == 0) return false;
  const Point a = g.node(0).position();
  Point side, normal;  // the farthest from a; the farthest from that line
  for (Node n : nodes)
    if (const Point d = n.position() - a; normSq(d) > normSq(side)) side = d;
  for (Node n : nodes)
    if (const Point c = cross(side, n.position() - a);
        normSq(c) > normSq(normal))
      normal = c;
  const double most = 1e-9 * norm(side) * norm(normal);
  return std::ranges::all_of(nodes, [&](Node n) {
    return std::abs(dot(normal, n.position() - a)) <= most;
  });
}

namespace {

/** Why a method without a stability limit fails. */
Cause cause_without_limit(const FailedRun& run) {
  const auto is = [&](const MethodInfo& m) {
    return run.method.info.name == m.name;
  };
  if (run.rigid) return Cause::error;
  if (is(ImplicitEuler::info)) return run.flat ? Cause::flat : Cause::linear;
  if (is(Xpbd::info)) return Cause::rounds;
  if (is(ImplicitMidpoint::info) && run.dt > run.verlet) return Cause::waves;
  return Cause::error;
}

Cause cause_of(const FailedRun& run) {
  const MethodInfo& info = run.method.info;
  if (!std::isfinite(run.time)) return Cause::start;
  if (run.solver) return Cause::solver;
  if (info.limit == no_limit || info.adaptive) return cause_without_limit(run);
  if (run.safe == 0) return Cause::no_step;
  if (run.dt > 0.97 * run.safe && run.safe < 0.97 * run.safe_without_drag)
    return Cause::drag;
  // Sharp limits come from below, by up to 2 %.
  if (run.dt > 0.97 * run.sharp || run.dt > run.safe) return Cause::step;
  return Cause::nonlinear;
}

}  // namespace

std::string Diagnosis::cause_text() const {
  const MethodInfo& info = run.method.info;
  std::ostringstream out;
  out.precision(3);
  auto limit = [&](double seconds) {
    out << "dt is " << run.dt / seconds << " times the stability limit ("
        << seconds << " s";
  };
  auto in_verlets = [&] {
    if (std::isfinite(run.verlet))
      out << " (dt is " << run.dt / run.verlet
          << " times verlet's stability limit)";
  };
  switch (cause) {
    case Cause::step:
      limit(run.safe);
      out << ", " << info.name
          << "): the fastest waves in the springs grow in every step";
      break;
    case Cause::drag:
      out << "drag makes the stability limit shorter: ";
      limit(run.safe);
      out << ", " << info.name << "; without drag " << run.safe_without_drag
          << " s), as " << info.name
          << " treats drag as a force, and a step removes too much velocity";
      break;
    case Cause::no_step:
      out << info.name << " has no stable step: it fails with "
          << info.fails_when;
      break;
    case Cause::nonlinear:
      out << "the motion is large or fast, or nodes are held or moved: ";
      if (std::isfinite(run.safe))
        out << "dt is " << CME212::percent(run.dt / run.safe)
            << " of the stability limit (" << run.safe << " s, " << info.name
            << "), which holds for small oscillations only";
      else
        out << "there is no stability limit";
      break;
    case Cause::flat:
      out << "the cloth is flat: across it springs have no stiffness yet, so "
          << "the one linear solve of a step of " << info.name
          << " sees none, and nodes that leave the plane go too far";
      in_verlets();
      break;
    case Cause::linear:
      out << "the one linear solve of a step of " << info.name
          << " takes the stiffness at its start, and springs turn or stretch "
          << "too far in a step";
      in_verlets();
      break;
    case Cause::rounds:
      out << "the rounds of " << info.name
          << " over the springs do not solve the equations of a step";
      in_verlets();
      break;
    case Cause::waves:
      out << "fast waves grow, as in a cloth that buckles: a step of "
          << info.name << " neither resolves nor damps them";
      in_verlets();
      break;
    case Cause::error:
      out << "the error of a step of " << info.name << " is too large";
      in_verlets();
      break;
    case Cause::solver:
      out << "this step could not be computed";
      in_verlets();
      break;
    case Cause::start:
      out << "the initial state fails with every method and step";
  }
  return out.str();
}

std::string Diagnosis::remedy_text(CureName name) const {
  std::ostringstream out;
  out.precision(3);
  const auto list = [&](const std::vector<Cure>& cures) {
    for (const Cure& c : cures)
      out << (&c == &cures[0] ? "" : ", ") << (c.*name)(run.method);
  };
  if (cure) {
    out << ((*cure).*name)(run.method)
        << " works: a trial to t = " << trial.time
        << " s passed, and half of that step gives the same energy";
    if (!run.asked.empty())
      out << " and " << run.asked;
    else if (trial.apart == no_limit)
      out << ", but other nodes are removed";
    else if (trial.apart > Attempt::same_place)
      out << ", but positions that differ by up to "
          << CME212::percent(trial.apart) << " of the size of the cloth";
    else
      out << " and positions";
  } else if (grows) {
    out << "shorter steps do not help: trials of ";
    list(failed);
    out << " have positions that differ as much, and the energy of half of "
           "their step";
  } else if (failed.empty() && stopped.empty()) {
    out << "check its values";
  } else {
    out << "no remedy was found: ";
    if (!failed.empty())
      out << "trials of ", list(failed), out << " failed, too";
    if (!stopped.empty()) {
      out << (failed.empty() ? "" : "; ") << "trials of ", list(stopped);
      out << " were stopped before the time of the failure";
    }
  }
  return out.str();
}

namespace {

/** @a dt rounded down to three digits: the step that is tried is printed. */
double in_three_digits(double dt) {
  const double unit = std::pow(10, std::floor(std::log10(dt)) - 2);
  // Read its decimal digits, as if the user had typed them.
  return std::stod(
      CME212::short_text(std::floor(dt / unit * (1 + 1e-9)) * unit));
}

/** Cures to try, the most promising first. */
std::vector<Cure> candidates(Cause cause, const FailedRun& run) {
  std::vector<Cure> all;
  auto add = [&](const MethodEntry& method, double dt) {
    if (dt > 0 && std::isfinite(dt)) all.push_back({method, dt});
  };
  auto shorter = [&](double dt) {
    if (std::isfinite(dt))
      add(run.method, in_three_digits(std::min(dt, run.dt)));
  };
  const MethodEntry &verlet = table::verlet, &tr_bdf2 = table::tr_bdf2;
  auto by_verlet = [&](double share) {
    if (std::isfinite(run.verlet))
      add(verlet, in_three_digits(std::min(share * run.verlet, run.dt)));
  };
  switch (cause) {
    case Cause::step:
      if (run.safe < 0.01 * run.verlet ||  // that would take too long
          (run.method.info.multirate && run.safe <= run.verlet))
        by_verlet(safe_share);  // nothing is stiff: it is Verlet
      shorter(safe_share * run.safe);
      by_verlet(safe_share);
      shorter(safe_share / 4 * run.safe);
      break;
    case Cause::drag:
      by_verlet(safe_share);
      shorter(safe_share * run.safe);
      break;
    case Cause::no_step:
      by_verlet(safe_share);
      break;
    case Cause::nonlinear:
      shorter(run.dt / 2);
      shorter(run.dt / 4);
      shorter(run.dt / 16);
      shorter(run.dt / 64);
      break;
    case Cause::flat:
    case Cause::linear:
    case Cause::rounds:
    case Cause::waves:
    case Cause::error:
      // An implicit step costs 40 to 200 of Verlet's.
      if (run.dt < 100 * run.verlet) by_verlet(safe_share);
      // Order 1 fails by its error, which falls with the step; order 2 by fast
      // waves that it does not damp.
      if (run.method.info.order > 1 && run.dt > run.verlet)
        add(tr_bdf2, in_three_digits(run.dt));
      if (run.method.info.order > 1) by_verlet(safe_share);
      shorter(run.dt / 4);
      shorter(run.dt / 16);
      by_verlet(safe_share);
      break;
    case Cause::solver:
      // Error control has already tried shorter steps.
      if (!run.method.info.adaptive) {
        shorter(run.dt / 4);
        shorter(run.dt / 16);
      }
      by_verlet(safe_share);
      break;
    case Cause::start:
      return {};
  }
  by_verlet(safe_share / 4);
  by_verlet(safe_share / 16);
  add(tr_bdf2, in_three_digits(run.dt));
  add(tr_bdf2, in_three_digits(run.dt / 4));
  add(tr_bdf2, in_three_digits(run.dt / 16));
  return all;
}

bool same(const Cure& a, const Cure& b) {
  return a.dt == b.dt && a.method.info.name == b.method.info.name;
}

}  // namespace

Diagnosis diagnose(const FailedRun& run, const TryOut& try_out) {
  constexpr std::size_t most = 10;
  Diagnosis d = {run, cause_of(run)};
  std::size_t as_far = 0;  // trials with right energy and wrong positions
  for (const Cure& cure : candidates(d.cause, run)) {
    auto tried = [&](const Cure& other) { return same(cure, other); };
    if (d.failed.size() + d.stopped.size() == most) break;
    if (std::ranges::any_of(d.failed, tried) ||
        std::ranges::any_of(d.stopped, tried) || tried({run.method, run.dt}))
      continue;
    const Attempt trial = try_out(cure);
    if (trial.passed && trial.time < run.time) {
      d.stopped.push_back(cure);
    } else if (!trial.passed || trial.is_no_better(run)) {
      d.failed.push_back(cure);
      as_far += trial.passed && run.asked.empty();
      d.grows = as_far == 2 && d.failed.size() == 2;
      if (d.grows) break;
    } else {
      d.cure = cure, d.trial = trial;
      break;
    }
  }
  return d;
}

Explanation::Explanation(const Failure& failure, const Diagnosis* diagnosis)
    : cause(failure.what()), remedy(interrupted), place(failure.where()) {
  if (!diagnosis) return;
  cause += ": " + diagnosis->cause_text();
  remedy = diagnosis->remedy_text();
}

}  // namespace lab
