#include "lab/charts/Failure.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

#include "lab/methods/Methods.hpp"
#include "lab/stability/Guard.hpp"
#include "lab/stability/Spectrum.hpp"

namespace lab {

namespace {

/** Verlet's limits on the 5 x 5 cloth and on the 9 x 9 cloth [s]: 2/omega with
 * omega^2 = 12 K N. */
constexpr double cloth_limit = 0.011547, drape_limit = 0.0064150;
Problem cloth() { return grid_problem("", "", 5, 5); }
Problem free_cloth() {
  Problem p = cloth();
  p.gamma = 0;
  return p;
}
Problem fine_cloth() { return grid_problem("", "", 5, 9); }
Problem stiff_cloth() { return grid_problem("", "", 5, 9, 1e5); }
Problem drape() {
  Problem p = fine_cloth();
  p.constraint = on_a_ball;
  p.norm = Norm::functionals;
  return p;
}

/** One mass between two springs; its frequency is 14.1 1/s. */
Problem oscillator() {
  return chain_problem("", "", 5, {.n = 1, .rest = 1, .modes = {{1, 0.01}}});
}
constexpr double oscillator_omega = 14.142135623730951;

/** A 9 x 9 cloth without drag that is thrown about, with seven springs of 1e6
 * N/m; and the limit of the others [s]. */
Problem thrown_cloth() {
  Problem p = fine_cloth();
  p.gamma = 0;
  p.build = [build = p.build](Cloth& g) {
    build(g);
    for (unsigned e = 20; e < g.num_edges(); e += 40) g.edge(e).value().K = 1e6;
    for (Node n : g.nodes()) {
      const double i = n.index();
      n.value().vel =
          2 * Point(std::sin(7 * i), std::sin(11 * i), std::sin(13 * i));
    }
  };
  return p;
}
constexpr double thrown_limit = 0.0065828;

/** The chain of 20 nodes, with a small amplitude of its highest mode; and with
 * a slow, a medium and a fast mode. */
Problem chain() {
  return chain_problem("", "", 5, {.modes = {{1, 1e-3}, {20, 1e-6}}});
}
constexpr double chain_limit = 0.022423380;  // [s], Verlet's
Problem three_modes() {
  return chain_problem(
      "", "", 5, {.rest = 1, .modes = {{1, 0.02}, {5, 0.01}, {15, 0.005}}});
}

constexpr std::array table = [] {
  using enum Plotted;
  using Run = FailureRun;
  return std::array{
      Failure("a smaller step only takes longer to blow up",
              "5 x 5 cloth without drag; steps as parts of verlet's limit",
              free_cloth, 2.5, energy, 5, 0.1, {-1, 6},
              Run("forward-euler", cloth_limit / 4, "limit/4", {0.535, 0}),
              Run("forward-euler", cloth_limit / 16, "limit/16", {1.56, -0.5}),
              Run("forward-euler", cloth_limit / 64, "limit/64", {2.0, 1.6}),
              Run("verlet", cloth_limit / 2, "verlet at limit/2", {1.0, -1})),
      Failure("oscillates about the right energy, verlet stays with it",
              "5 x 5 cloth without drag, half of verlet's limit", free_cloth, 2,
              energy, 0.08, 0.03, {-0.15, 0.15},
              Run("symplectic-euler", cloth_limit / 2, "symplectic-euler",
                  {0.36, 1}),
              Run("verlet", cloth_limit / 2, "verlet", {1.1, -1})),
      Failure(
          "5 % beyond its limit the fastest mode explodes",
          "chain of 20 masses; steps as parts of verlet's limit", chain, 1,
          error, 0.02, 1e-4, {1e-7, 1, true},
          Run("verlet", 1.05 * chain_limit, "1.05 of the limit", {0.3, -0.9}),
          Run("verlet", 0.97 * chain_limit, "0.97 of the limit", {0.6, 1.6})),
      Failure("near its limit fast motion heats the stiff springs",
              "9 x 9 cloth without drag, seven stiff springs, thrown about",
              thrown_cloth, 4, energy, 3, 0.5, {0, 10},
              Run("mollified-impulse", 0.9 * thrown_limit, "0.9 of the limit",
                  {1.2, 1.4}),
              Run("mollified-impulse", 0.45 * thrown_limit, "0.45 of the limit",
                  {2.4, -1.6})),
      Failure("hundreds of times the error of pefrl for equal work",
              "5 x 5 cloth with drag", cloth, 5, error, 5e-4, 1e-5,
              {1e-8, 1e-2, true},
              Run("yoshida4", 0.6 * cloth_limit, "yoshida4: # evaluations",
                  {1.6, 1.4}),
              Run("pefrl", 0.8 * cloth_limit, "pefrl: # evaluations", {2, -1})),
      Failure(
          "its lead over verlet ends at the first touch",
          "9 x 9 cloth falling on a ball; error of center of mass and energy",
          drape, 0.45, error, 3e-3, 2e-3, {1e-10, 1, true},
          Run("pefrl", drape_limit, "pefrl: # evaluations", {0.12, -1.2}),
          Run("verlet", drape_limit / 4, "verlet: # evaluations", {0.04, 2.2})),
      Failure(
          "without drag, a frequency near 3.16/dt grows",
          "one mass between two springs", oscillator, 200, energy, 0.1, 1e-3,
          {1e-3, 1, true},
          Run("srkn6b", 3.16599 / oscillator_omega, "dt omega = 3.166",
              {95, -0.9}),
          Run("srkn6b", 3.07 / oscillator_omega, "dt omega = 3.07", {120, -1})),
      Failure("without drag, a frequency of pi/dt grows",
              "one mass between two springs", oscillator, 1000, energy, 0.1,
              1e-3, {1e-3, 1, true},
              Run("srkn11b", 3.141953 / oscillator_omega, "dt omega = 3.142",
                  {480, -0.8}),
              Run("srkn11b", 3.05 / oscillator_omega, "dt omega = 3.05",
                  {600, -1})),
      Failure("loses energy that pefrl keeps, at the same step and cost",
              "5 x 5 cloth without drag, verlet's limit", free_cloth, 5, energy,
              0.4, 0.02, {-1, 0.4}, Run("rk4", cloth_limit, "rk4", {3.5, 1}),
              Run("pefrl", cloth_limit, "pefrl", {3, 1})),
      Failure(
          "a tolerance of 1e-5 m is lost at the first touch",
          "9 x 9 cloth falling on a ball; error of center of mass and energy",
          drape, 0.45, error, 2e-3, 1.5e-3, {1e-10, 1, true},
          Run("rkn64", 0.0125, "rkn64: # evaluations", {0.12, -1.2}, 1e-5),
          Run("verlet", drape_limit / 4, "verlet: # evaluations", {0.04, 2.2})),
      Failure("the cloth stops swinging as if in honey",
              "5 x 5 cloth without drag, dt = 1/30 s", free_cloth, 2.5, height,
              0.2, 0.1, {-0.7, 0.1},
              Run("implicit-euler", 1 / 30.0, "implicit-euler", {0.85, -1.2}),
              Run("", 0.01, "true motion", {1.14, 0.7}),
              Run("tr-bdf2", 1 / 30.0, "tr-bdf2", {2.15, 1})),
      Failure("a buckling cloth gains energy without bound",
              "5 x 5 cloth without drag, dt = 0.08 s", free_cloth, 5, energy, 2,
              0.3, {-3, 10},
              Run("implicit-midpoint", 0.08, "implicit-midpoint", {2.48, -0.8}),
              Run("tr-bdf2", 0.08, "tr-bdf2", {3, 0.9}),
              Run("implicit-midpoint", 0.01, "at dt = 0.01 s", {3, 0.9})),
      Failure("damps the fast modes that implicit-midpoint keeps",
              "chain of 20 masses without drag, dt = 0.02 s", three_modes, 5,
              energy, 0.03, 1e-6, {0, 0.1},
              Run("tr-bdf2", 0.02, "tr-bdf2", {2, 1}),
              Run("implicit-midpoint", 0.02, "implicit-midpoint", {2, 1})),
      Failure("falls late, as if it were heavier",
              "5 x 5 cloth with drag, 10 times verlet's limit", cloth, 3,
              height, 0.15, 0.06, {-0.7, 0.1},
              Run("augmented-verlet", 10 * cloth_limit, "augmented-verlet",
                  {0.3, 0.5}),
              Run("", 0.01, "true motion", {0.62, -0.9}),
              Run("tr-bdf2", 10 * cloth_limit, "tr-bdf2", {1.1, 1})),
      Failure("on a very stiff cloth ten rounds are too few: it falls late",
              "9 x 9 cloth with drag, K = 1e5 N/m, dt = 1/60 s", stiff_cloth,
              1.5, height, 0.2, 0.1, {-0.7, 0.1},
              Run("fast-mass-spring", 1 / 60.0, "10 rounds", {0.25, 1.6}, 10),
              Run("", 0.01, "true motion", {0.95, 1}),
              Run("fast-mass-spring", 1 / 60.0, "100 rounds", {0.5, -1}, 100)),
      Failure("with few substeps the springs are rubber",
              "9 x 9 cloth with drag, dt = 1/60 s", fine_cloth, 3, stretch, 0.3,
              0.1, {0, 1}, Run("xpbd", 1 / 60.0, "1 substep", {0.72, 0.3}, 1),
              Run("xpbd", 1 / 60.0, "2 substeps", {2, 1.4}, 2),
              Run("", 0.01, "true motion", {1.3, -1.5}),
              Run("xpbd", 1 / 60.0, "20 substeps", {1.85, -0.9}, 20))};
}();

}  // namespace

constinit const std::span<const Failure> failures = table;

const Failure* failure_of(std::string_view name) {
  const auto f = std::ranges::find(failures, name, &Failure::method);
  return f == failures.end() ? nullptr : &*f;
}

namespace {

std::unique_ptr<Method> make(const FailureRun& r) {
  if (r.method.empty()) return nullptr;
  if (r.method == Xpbd::info.name && r.setting > 0)
    return std::make_unique<Xpbd>(static_cast<int>(r.setting));
  if (r.method == FastMassSpring::info.name && r.setting > 0)
    return std::make_unique<FastMassSpring>(static_cast<int>(r.setting));
  auto method = find_method(r.method)->make();
  if (r.setting > 0) method->set_tolerance(r.setting);
  return method;
}

/** @pre q is not Plotted::error */
double look(Plotted q, const Start& s) {
  if (q == Plotted::energy) return s.energy();
  if (q == Plotted::height) return center_of_mass(s.cloth).z;
  double largest = 0;
  for (Edge e : s.cloth.edges())
    largest = std::max(largest, e.length() / e.value().L - 1);
  return largest;
}

/** The true motion at the times of a run: exact, or by srkn11b with small
 * steps. With contact, where every method has at most order 2, by Verlet with
 * smaller steps. */
class Truth {
 public:
  explicit Truth(const Problem& p) : p_(p), s_(p) {
    const double omega = omega_safe(s_.cloth, s_.force, s_.constraint);
    if (p.norm == Norm::functionals) {
      method_ = std::make_unique<Verlet>();
      longest_ = Verlet::info.limit / omega / 64;
    } else {
      method_ = std::make_unique<Srkn11b>();
      longest_ = Srkn11b::info.limit / omega / 8;
    }
  }
  void step(double t, double dt) {
    if (p_.exact) return;
    const double parts = std::ceil(dt / longest_);
    for (double k = 0; k < parts; ++k)
      method_->step(s_.cloth, t + k * dt / parts, dt / parts, s_.force,
                    s_.constraint);
  }
  double distance_of(const Start& s, double t) const {
    End right;
    if (p_.exact)
      right.positions = p_.exact(t);
    else
      right = end_of(s_);
    return distance(p_, end_of(s), right);
  }
  const Start& start() const { return s_; }

 private:
  const Problem& p_;
  Start s_;
  std::unique_ptr<Method> method_;
  double longest_;  // step [s]
};

}  // namespace

Trace trace(const Failure& f, const FailureRun& r) {
  const Problem p = f.scene();
  Start s(p);
  Truth truth(p);
  DivergenceGuard guard(s.cloth, p.gravity, r.dt);
  auto method = make(r);
  const Start& seen = method ? s : truth.start();
  const bool energy = f.quantity == Plotted::energy;
  const double at_start = energy ? look(f.quantity, s) : 0;
  Trace out;
  auto add = [&](double t) {
    Trace::Sample a = {t, 0, at_start};
    if (f.quantity == Plotted::error) {
      a.value = truth.distance_of(seen, t);
    } else {
      a.value = look(f.quantity, seen);
      if (!energy) a.right = look(f.quantity, truth.start());
    }
    if (!std::isfinite(a.value)) return;
    out.samples.push_back(a);
    out.deviation = std::max(out.deviation, std::abs(a.value - a.right));
  };
  add(0);
  const auto steps = static_cast<long long>(f.t_end / r.dt * (1 + 1e-9));
  for (long long n = 0; n < steps && out.status == Outcome::Status::ok; ++n) {
    const double t = double(n) * r.dt;
    try {
      if (method) method->step(s.cloth, t, r.dt, s.force, s.constraint);
      if (!energy) truth.step(t, r.dt);
      add(t + r.dt);
      // As large as the chart can show.
      if (!guard.accept(s.cloth) &&
          (out.deviation > f.fails || !std::isfinite(kinetic_energy(s.cloth))))
        out.status = Outcome::Status::diverged;
    } catch (const StepError&) {
      out.status = Outcome::Status::failed;
    }
  }
  out.sweeps = s.force.evaluations();
  return out;
}

}  // namespace lab
