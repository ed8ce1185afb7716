#include "lab/charts/Problem.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "CME212/Util.hpp"
#include "lab/fast/GraphArrays.hpp"
#include "lab/methods/Splitting.hpp"
#include "lab/stability/Guard.hpp"
#include "lab/stability/Spectrum.hpp"

namespace lab {

bool Problem::driven() const {
  return std::ranges::any_of(pins,
                             [](const Pin& p) { return p.motion.moves(); });
}

Start::Start(const Problem& p)
    : force((p.build(cloth), force_of(p, p.mesh, cloth))),
      constraint(p.constraints(cloth)) {}

double Start::energy() const {
  return kinetic_energy(cloth) + force.energy(cloth);
}

End end_of(const Start& s) {
  auto x = arrays(s.cloth).positions();
  return {{x.begin(), x.end()}, center_of_mass(s.cloth), s.energy()};
}

double distance(const Problem& p, const End& a, const End& b) {
  if (p.norm == Norm::functionals) {
    constexpr double weight = grav;  // [N]: a cloth of 1 kg
    return std::hypot(norm(a.center - b.center),
                      (a.energy - b.energy) / weight);
  }
  double sum = 0;
  for (std::size_t i = 0; i < a.positions.size(); ++i)
    sum += normSq(a.positions[i] - b.positions[i]);
  return std::sqrt(sum / double(a.positions.size()));
}

Outcome run(const Problem& p, Method& method, long long steps, bool guarded) {
  using CME212::short_text;
  Start s(p);
  std::unique_ptr<DivergenceGuard> guard;
  const double dt = p.t_end / double(steps);
  if (guarded && !p.driven())
    guard = std::make_unique<DivergenceGuard>(s.cloth, p.gravity, dt);
  Outcome out;
  method.restart();
  CME212::Clock clock;
  try {
    double t = 0;  // as the method returns it; else it drops the force it kept
    for (long long n = 0; n < steps; ++n) {
      t = method.step(s.cloth, t, dt, s.force, s.constraint);
      ++out.steps;
      if (!guard || guard->accept(s.cloth)) continue;
      out.status = Outcome::Status::diverged;
      out.reason = "energy out of bounds at t = " + short_text(t) + " s";
      break;
    }
  } catch (const std::exception& e) {  // StepError, or a force it can't use
    out.status = Outcome::Status::failed;
    out.reason = e.what();
  }
  out.seconds = clock.seconds();
  out.sweeps = s.force.evaluations();
  out.work = method.work();
  out.end = end_of(s);
  if (out.ok() && !(std::abs(out.end.energy) < 1e6)) {  // no guard has seen it
    out.status = Outcome::Status::diverged;
    out.reason = "energy of 1e6 J or more at the end";
  }
  return out;
}

Reference reference(const Problem& p, double fineness) {
  Start start(p);
  const double omega = omega_safe(start.cloth, start.force, start.constraint);
  Reference r;
  if (p.rests) fineness /= 8;  // the way there matters little
  auto by = [&](Method&& method, const MethodInfo& info, double finer) {
    const auto steps =
        static_cast<long long>(std::ceil(p.t_end * omega / info.limit * finer));
    Outcome out = run(p, method, steps);
    if (!out.ok())
      throw std::runtime_error(p.name + ": no reference: " + out.reason);
    r.made += r.made.empty() ? "" : ", ";
    r.made += std::string(info.name) + ' ' + std::to_string(steps) + " steps";
    return out.end;
  };
  End other;
  if (p.exact) {
    auto x = p.exact(p.t_end);
    r.end.energy = end_of(start).energy;
    std::copy(x.begin(), x.end(), arrays(start.cloth).positions().begin());
    r.end.center = center_of_mass(start.cloth);
    r.end.positions = std::move(x);
    r.made = "exact";
    other = by(Srkn11b(), Srkn11b::info, fineness);
  } else if (p.norm == Norm::functionals && !p.rests) {
    r.end = by(Verlet(), Verlet::info, 16 * fineness);
    other = by(Pefrl(), Pefrl::info, 16 * fineness);
  } else {
    r.end = by(Srkn11b(), Srkn11b::info, fineness);
    other = by(Pefrl(), Pefrl::info, 5 * fineness);
  }
  r.floor = std::max(distance(p, r.end, other), 1e-16);
  return r;
}

}  // namespace lab
