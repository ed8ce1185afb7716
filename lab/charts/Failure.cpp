#include "lab/charts/Failure.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

#include "lab/methods/Methods.hpp"
#include "lab/stability/Guard.hpp"
#include "lab/stability/Spectrum.hpp"

namespace lab {

namespace {

/** Verlet's limit on the 5 x 5 cloth [s], 2/omega with omega^2 = 12 K N, and
 * that on the 9 x 9 cloth. */
constexpr double cloth_limit = 0.011547, drape_limit = 0.0064150;
Problem cloth() { return grid_problem("", "", 5, 5); }
Problem free_cloth() {
  Problem p = cloth();
  p.gamma = 0;
  return p;
}
Problem fine_cloth() { return grid_problem("", "", 5, 9); }
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

/** The same with one spring of 10000 N/m: the frequencies of the springs are
 * 100 1/s and 10 1/s. */
Problem stiff_oscillator() {
  Problem p = oscillator();
  p.build = [build = p.build](Cloth& g) {
    build(g);
    g.edge(0).value().K = 1e4;
  };
  p.exact = {};
  return p;
}
constexpr double half_period = 0.031415927;  // [s], of the stiff spring

/** The chain of 20, with a little of its highest mode; and with a slow, a
 * middling and a fast mode. */
Problem chain() {
  return chain_problem("", "", 5, {.modes = {{1, 1e-3}, {20, 1e-6}}});
}
constexpr double chain_limit = 0.022423380;  // [s], Verlet's
Problem three_modes() {
  return chain_problem(
      "", "", 5, {.rest = 1, .modes = {{1, 0.02}, {5, 0.01}, {15, 0.005}}});
}

constexpr std::array table = [] {
  using enum Quantity;
  return std::array{
      Failure{.title = "a smaller step only takes longer to blow up",
              .caption =
                  "5 x 5 cloth without drag; steps as parts of verlet's limit",
              .scene = free_cloth,
              .t_end = 2.5,
              .quantity = energy,
              .fails = 5,
              .cured = 0.1,
              .runs = {{{"forward-euler", cloth_limit / 4},
                        {"forward-euler", cloth_limit / 16},
                        {"forward-euler", cloth_limit / 64},
                        {"verlet", cloth_limit / 2}}}},
      Failure{
          .title = "oscillates about the right energy, verlet stays with it",
          .caption = "5 x 5 cloth without drag, half of verlet's limit",
          .scene = free_cloth,
          .t_end = 2,
          .quantity = energy,
          .fails = 0.08,
          .cured = 0.03,
          .runs = {{{"symplectic-euler", cloth_limit / 2},
                    {"verlet", cloth_limit / 2}}}},
      Failure{.title = "5 % beyond its limit the fastest mode explodes",
              .caption = "chain of 20 masses; steps as parts of verlet's limit",
              .scene = chain,
              .t_end = 1,
              .quantity = error,
              .fails = 0.02,
              .cured = 1e-4,
              .runs = {{{"verlet", 1.05 * chain_limit},
                        {"verlet", 0.97 * chain_limit}}}},
      Failure{.title = "without drag, a stiff spring of half period dt grows",
              .caption = "one mass between a stiff and a soft spring",
              .scene = stiff_oscillator,
              .t_end = 3,
              .quantity = energy,
              .fails = 1,
              .cured = 0.1,
              .runs = {{{"respa", 0.986 * half_period},
                        {"respa", 0.9 * half_period}}}},
      Failure{.title = "hundreds of times the error of pefrl for equal work",
              .caption = "5 x 5 cloth with drag",
              .scene = cloth,
              .t_end = 5,
              .quantity = error,
              .fails = 5e-4,
              .cured = 1e-5,
              .runs = {{{"yoshida4", 0.6 * cloth_limit},
                        {"pefrl", 0.8 * cloth_limit}}}},
      Failure{.title = "its lead over verlet ends at the first touch",
              .caption = "9 x 9 cloth falling on a ball; error of center of "
                         "mass and energy",
              .scene = drape,
              .t_end = 0.45,
              .quantity = error,
              .fails = 3e-3,
              .cured = 2e-3,
              .runs = {{{"pefrl", drape_limit}, {"verlet", drape_limit / 4}}}},
      Failure{.title = "without drag, a frequency near 3.16/dt grows",
              .caption = "one mass between two springs",
              .scene = oscillator,
              .t_end = 200,
              .quantity = energy,
              .fails = 0.1,
              .cured = 1e-3,
              .runs = {{{"srkn6b", 3.16599 / oscillator_omega},
                        {"srkn6b", 3.07 / oscillator_omega}}}},
      Failure{.title = "without drag, a frequency of pi/dt grows",
              .caption = "one mass between two springs",
              .scene = oscillator,
              .t_end = 1000,
              .quantity = energy,
              .fails = 0.1,
              .cured = 1e-3,
              .runs = {{{"srkn11b", 3.141953 / oscillator_omega},
                        {"srkn11b", 3.05 / oscillator_omega}}}},
      Failure{
          .title = "loses energy that pefrl keeps, at the same step and cost",
          .caption = "5 x 5 cloth without drag, verlet's limit",
          .scene = free_cloth,
          .t_end = 5,
          .quantity = energy,
          .fails = 0.4,
          .cured = 0.02,
          .runs = {{{"rk4", cloth_limit}, {"pefrl", cloth_limit}}}},
      Failure{.title = "its energy drifts, and it costs more than pefrl",
              .caption = "5 x 5 cloth without drag",
              .scene = free_cloth,
              .t_end = 20,
              .quantity = energy,
              .fails = 1,
              .cured = 0.1,
              .runs = {{{"dormand-prince", 0.02, 1e-2},
                        {"dormand-prince", 0.02, 1e-4},
                        {"pefrl", cloth_limit}}}},
      Failure{.title = "at a loose tolerance its energy drifts",
              .caption = "5 x 5 cloth without drag",
              .scene = free_cloth,
              .t_end = 20,
              .quantity = energy,
              .fails = 0.5,
              .cured = 0.05,
              .runs = {{{"dop853", 0.1, 1e-2}, {"dop853", 0.1, 1e-4}}}},
      Failure{.title = "the cloth stops swinging as if in honey",
              .caption = "5 x 5 cloth without drag, dt = 1/30 s",
              .scene = free_cloth,
              .t_end = 2.5,
              .quantity = height,
              .fails = 0.2,
              .cured = 0.1,
              .runs = {{{"implicit-euler", 1 / 30.0},
                        {"", 0.01},
                        {"tr-bdf2", 1 / 30.0}}}},
      Failure{.title = "a buckling cloth gains energy without bound",
              .caption = "5 x 5 cloth without drag, dt = 0.08 s",
              .scene = free_cloth,
              .t_end = 5,
              .quantity = energy,
              .fails = 2,
              .cured = 0.3,
              .runs = {{{"implicit-midpoint", 0.08},
                        {"tr-bdf2", 0.08},
                        {"implicit-midpoint", 0.01}}}},
      Failure{.title = "damps the fast modes that implicit-midpoint keeps",
              .caption = "chain of 20 masses without drag, dt = 0.02 s",
              .scene = three_modes,
              .t_end = 5,
              .quantity = energy,
              .fails = 0.03,
              .cured = 1e-6,
              .runs = {{{"tr-bdf2", 0.02}, {"implicit-midpoint", 0.02}}}},
      Failure{.title = "falls late, as if it were heavier",
              .caption = "5 x 5 cloth with drag, 10 times verlet's limit",
              .scene = cloth,
              .t_end = 3,
              .quantity = height,
              .fails = 0.15,
              .cured = 0.06,
              .runs = {{{"augmented-verlet", 10 * cloth_limit},
                        {"", 0.01},
                        {"tr-bdf2", 10 * cloth_limit}}}},
      Failure{.title = "with few substeps the springs are rubber",
              .caption = "9 x 9 cloth with drag, dt = 1/60 s",
              .scene = fine_cloth,
              .t_end = 3,
              .quantity = stretch,
              .fails = 0.3,
              .cured = 0.1,
              .runs = {{{"xpbd", 1 / 60.0, 1},
                        {"xpbd", 1 / 60.0, 2},
                        {"", 0.01},
                        {"xpbd", 1 / 60.0, 20}}}}};
}();

static_assert(std::ranges::equal(table, methods, {}, &Failure::method,
                                 [](const MethodEntry& m) {
                                   return std::string_view(m.info.name);
                                 }));

}  // namespace

constinit const std::array<Failure, methods.size()> failures = table;

const Failure& failure_of(std::string_view name) {
  return *std::ranges::find(failures, name, &Failure::method);
}

namespace {

std::unique_ptr<Method> make(const FailureRun& r) {
  if (r.method.empty()) return nullptr;
  if (r.method == Xpbd::info.name && r.setting > 0)
    return std::make_unique<Xpbd>(static_cast<int>(r.setting));
  auto method = find_method(r.method)->make();
  if (r.setting > 0) method->set_tolerance(r.setting);
  return method;
}

/** @pre q is not Quantity::error */
double look(Quantity q, const Start& s) {
  if (q == Quantity::energy) return s.energy();
  if (q == Quantity::height) return center_of_mass(s.cloth).z;
  double largest = 0;
  for (Edge e : s.cloth.edges())
    largest = std::max(largest, e.length() / e.value().L - 1);
  return largest;
}

/** The true motion, beside a run: exact; or by srkn11b at small steps; or, as
 * contact leaves no method more than order 2, by Verlet at smaller ones. */
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
  const bool energy = f.quantity == Quantity::energy;
  const double at_start = energy ? look(f.quantity, s) : 0;
  Trace out;
  auto add = [&](double t) {
    Trace::Sample a = {t, 0, at_start};
    if (f.quantity == Quantity::error) {
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
      // To be seen on the chart: as far as it can be drawn.
      if (!guard.accept(s.cloth) &&
          (out.deviation > f.fails || !std::isfinite(kinetic_energy(s.cloth))))
        out.status = Outcome::Status::diverged;
    } catch (const StepError&) {
      out.status = Outcome::Status::failed;
    }
  }
  out.sweeps = s.counter.sweeps();
  return out;
}

}  // namespace lab
