#pragma once
/** @file Failure.hpp
 * How each method fails, and a cure: a table of runs, and the making of them.
 * Pictures, documents and tests take it from here. */
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "lab/charts/Problem.hpp"

namespace lab {

/** What is looked at in a run, against time. */
enum class Quantity {
  energy,   ///< kinetic, of springs and of gravity [J]
  height,   ///< of the center of mass [m]
  stretch,  ///< of the spring for which it is largest
  error     ///< distance() from the true motion [m]
};
constexpr const char* name_of(Quantity q) {
  constexpr std::array names = {
      "total energy [J]", "height of the center of mass [m]",
      "largest stretch, l/L - 1", "distance from the true motion [m]"};
  return names[static_cast<std::size_t>(q)];
}

constexpr const char* unit_of(Quantity q) {
  return q == Quantity::energy ? " J" : q == Quantity::stretch ? "" : " m";
}

/** A run in the picture of a failure. */
struct FailureRun {
  std::string_view method;  ///< empty: the true motion itself
  double dt;                ///< [s]
  const char* label;        ///< at its curve; # stands for its sweeps
  double label_at;          ///< where: time [s]
  double label_up;          ///< lines of text above the curve
  double setting = 0;  ///< tolerance [m] of dormand-prince, substeps of xpbd
};

/** How a method fails, and a cure: runs[0] fails, the last one with a label
 * does not, those in between are for comparison.
 *
 * The deviation of a run is the largest distance of what is looked at from what
 * is right: an energy from that at the start (there is no drag), a height or a
 * stretch from that of the true motion, an error from 0. */
struct Failure {
  const char* title;    ///< what is seen
  const char* caption;  ///< on what
  Problem (*scene)();
  double t_end;  ///< [s]
  Quantity quantity;
  double low, high;  ///< ends of the axis
  bool log;
  double fails;  ///< the deviation of runs[0] is more
  double cured;  ///< and that of the last run less
  std::array<FailureRun, 4> runs;

  constexpr std::string_view method() const { return runs[0].method; }
  constexpr std::size_t size() const {
    std::size_t n = 0;
    while (n < runs.size() && runs[n].label) ++n;
    return n;
  }
};

namespace failure_detail {

/** Verlet's limit on the 5 x 5 cloth [s], 2/omega with omega^2 = 12 K N, and
 * that on the 9 x 9 cloth. */
inline constexpr double cloth_limit = 0.011547, drape_limit = 0.0064150;
inline Problem cloth() { return grid_problem("", "", 5, 5); }
inline Problem free_cloth() {
  Problem p = cloth();
  p.gamma = 0;
  return p;
}
inline Problem fine_cloth() { return grid_problem("", "", 5, 9); }
inline Problem drape() {
  Problem p = fine_cloth();
  p.constraint = problem_detail::on_a_ball;
  p.norm = Norm::functionals;
  return p;
}

/** One mass between two springs; its frequency is 14.1 1/s. */
inline Problem oscillator() {
  return chain_problem("", "", 5, {.n = 1, .rest = 1, .modes = {{1, 0.01}}});
}
inline constexpr double oscillator_omega = 14.142135623730951;

/** The chain of 20, with a little of its highest mode; and with a slow, a
 * middling and a fast mode. */
inline Problem chain() {
  return chain_problem("", "", 5, {.modes = {{1, 1e-3}, {20, 1e-6}}});
}
inline constexpr double chain_limit = 0.022423380;  // [s], Verlet's
inline Problem three_modes() {
  return chain_problem(
      "", "", 5, {.rest = 1, .modes = {{1, 0.02}, {5, 0.01}, {15, 0.005}}});
}

}  // namespace failure_detail

/** One failure for each method, in the order of `methods`. */
inline constexpr std::array failures = [] {
  using namespace failure_detail;
  using enum Quantity;
  return std::array{
      Failure{
          .title = "a smaller step only takes longer to blow up",
          .caption =
              "5 x 5 cloth without drag; steps as parts of verlet's limit",
          .scene = free_cloth,
          .t_end = 2.5,
          .quantity = energy,
          .low = -1,
          .high = 6,
          .log = false,
          .fails = 5,
          .cured = 0.1,
          .runs = {{{"forward-euler", cloth_limit / 4, "limit/4", 0.535, 0},
                    {"forward-euler", cloth_limit / 16, "limit/16", 1.56, -0.5},
                    {"forward-euler", cloth_limit / 64, "limit/64", 2.0, 1.6},
                    {"verlet", cloth_limit / 2, "verlet at limit/2", 1.0,
                     -1}}}},
      Failure{.title = "swings about the right energy, verlet stays with it",
              .caption = "5 x 5 cloth without drag, half of verlet's limit",
              .scene = free_cloth,
              .t_end = 2,
              .quantity = energy,
              .low = -0.15,
              .high = 0.15,
              .log = false,
              .fails = 0.08,
              .cured = 0.03,
              .runs = {{{"symplectic-euler", cloth_limit / 2,
                         "symplectic-euler", 0.36, 1},
                        {"verlet", cloth_limit / 2, "verlet", 1.1, -1}}}},
      Failure{.title = "5 % beyond its limit the fastest mode explodes",
              .caption = "chain of 20 masses; distance from the exact solution",
              .scene = chain,
              .t_end = 1,
              .quantity = error,
              .low = 1e-7,
              .high = 1,
              .log = true,
              .fails = 0.02,
              .cured = 1e-4,
              .runs = {{{"verlet", 1.05 * chain_limit, "1.05 of the limit",
                         0.18, -0.5},
                        {"verlet", 0.97 * chain_limit, "0.97 of the limit", 0.6,
                         1.6}}}},
      Failure{
          .title = "hundreds of times the error of pefrl for equal work",
          .caption = "5 x 5 cloth with drag",
          .scene = cloth,
          .t_end = 5,
          .quantity = error,
          .low = 1e-8,
          .high = 1e-2,
          .log = true,
          .fails = 5e-4,
          .cured = 1e-5,
          .runs = {{{"yoshida4", 0.6 * cloth_limit, "yoshida4: # sweeps", 1.6,
                     1.4},
                    {"pefrl", 0.8 * cloth_limit, "pefrl: # sweeps", 2, -1}}}},
      Failure{.title = "its lead over verlet ends at the first touch",
              .caption = "9 x 9 cloth falling on a ball; error of center of "
                         "mass and energy",
              .scene = drape,
              .t_end = 0.45,
              .quantity = error,
              .low = 1e-10,
              .high = 1,
              .log = true,
              .fails = 3e-3,
              .cured = 2e-3,
              .runs = {{{"pefrl", drape_limit, "pefrl: # sweeps", 0.12, -1.2},
                        {"verlet", drape_limit / 4, "verlet: # sweeps", 0.04,
                         2.2}}}},
      Failure{.title = "without drag, a frequency near 3.16/dt grows",
              .caption = "one mass between two springs",
              .scene = oscillator,
              .t_end = 200,
              .quantity = energy,
              .low = 1e-3,
              .high = 1,
              .log = true,
              .fails = 0.1,
              .cured = 1e-3,
              .runs = {{{"srkn6b", 3.16599 / oscillator_omega,
                         "dt omega = 3.166", 95, -0.9},
                        {"srkn6b", 3.07 / oscillator_omega, "dt omega = 3.07",
                         120, -1}}}},
      Failure{.title = "without drag, a frequency of pi/dt grows",
              .caption = "one mass between two springs",
              .scene = oscillator,
              .t_end = 1000,
              .quantity = energy,
              .low = 1e-3,
              .high = 1,
              .log = true,
              .fails = 0.1,
              .cured = 1e-3,
              .runs = {{{"srkn11b", 3.141953 / oscillator_omega,
                         "dt omega = 3.142", 480, -0.8},
                        {"srkn11b", 3.05 / oscillator_omega, "dt omega = 3.05",
                         600, -1}}}},
      Failure{
          .title = "eats energy that pefrl keeps, at the same step and cost",
          .caption = "5 x 5 cloth without drag, verlet's limit",
          .scene = free_cloth,
          .t_end = 5,
          .quantity = energy,
          .low = -1,
          .high = 0.4,
          .log = false,
          .fails = 0.4,
          .cured = 0.02,
          .runs = {{{"rk4", cloth_limit, "rk4", 3.5, 1},
                    {"pefrl", cloth_limit, "pefrl", 3, 1}}}},
      Failure{.title = "its energy drifts, and it costs more than pefrl",
              .caption = "5 x 5 cloth without drag",
              .scene = free_cloth,
              .t_end = 20,
              .quantity = energy,
              .low = -1,
              .high = 4,
              .log = false,
              .fails = 1,
              .cured = 0.1,
              .runs = {{{"dormand-prince", 0.02, "tolerance 0.01 m: # sweeps",
                         8, -0.8, 1e-2},
                        {"dormand-prince", 0.02, "tolerance 0.0001 m: # sweeps",
                         8, 0.9, 1e-4},
                        {"pefrl", cloth_limit, "pefrl: # sweeps", 8, -0.9}}}},
      Failure{
          .title = "the cloth stops swinging as if in honey",
          .caption = "5 x 5 cloth without drag, dt = 1/30 s",
          .scene = free_cloth,
          .t_end = 2.5,
          .quantity = height,
          .low = -0.7,
          .high = 0.1,
          .log = false,
          .fails = 0.2,
          .cured = 0.1,
          .runs = {{{"implicit-euler", 1 / 30.0, "implicit-euler", 0.85, -1.2},
                    {"", 0.01, "true motion", 1.14, 0.7},
                    {"tr-bdf2", 1 / 30.0, "tr-bdf2", 2.15, 1}}}},
      Failure{
          .title = "a buckling cloth gains energy without bound",
          .caption = "5 x 5 cloth without drag, dt = 0.08 s",
          .scene = free_cloth,
          .t_end = 5,
          .quantity = energy,
          .low = -3,
          .high = 10,
          .log = false,
          .fails = 2,
          .cured = 0.3,
          .runs = {{{"implicit-midpoint", 0.08, "implicit-midpoint", 2.48,
                     -0.8},
                    {"tr-bdf2", 0.08, "tr-bdf2", 3, 0.9},
                    {"implicit-midpoint", 0.01, "at dt = 0.01 s", 3, 0.9}}}},
      Failure{
          .title = "eats the fast modes that implicit-midpoint keeps",
          .caption = "chain of 20 masses without drag, dt = 0.02 s",
          .scene = three_modes,
          .t_end = 5,
          .quantity = energy,
          .low = 0,
          .high = 0.1,
          .log = false,
          .fails = 0.03,
          .cured = 1e-6,
          .runs = {{{"tr-bdf2", 0.02, "tr-bdf2", 2, 1},
                    {"implicit-midpoint", 0.02, "implicit-midpoint", 2, 1}}}},
      Failure{.title = "falls late, as if it were heavier",
              .caption = "5 x 5 cloth with drag, 10 times verlet's limit",
              .scene = cloth,
              .t_end = 3,
              .quantity = height,
              .low = -0.7,
              .high = 0.1,
              .log = false,
              .fails = 0.15,
              .cured = 0.06,
              .runs = {{{"augmented-verlet", 10 * cloth_limit,
                         "augmented-verlet", 0.3, 0.5},
                        {"", 0.01, "true motion", 0.62, -0.9},
                        {"tr-bdf2", 10 * cloth_limit, "tr-bdf2", 1.1, 1}}}},
      Failure{.title = "with few substeps the springs are rubber",
              .caption = "9 x 9 cloth with drag, dt = 1/60 s",
              .scene = fine_cloth,
              .t_end = 3,
              .quantity = stretch,
              .low = 0,
              .high = 1,
              .log = false,
              .fails = 0.3,
              .cured = 0.1,
              .runs = {{{"xpbd", 1 / 60.0, "1 substep", 0.72, 0.3, 1},
                        {"xpbd", 1 / 60.0, "2 substeps", 2, 2.1, 2},
                        {"", 0.01, "true motion", 1.3, -1.5},
                        {"xpbd", 1 / 60.0, "20 substeps", 1.85, -0.9, 20}}}}};
}();
/** @pre there is a method called @a name */
constexpr const Failure& failure_of(std::string_view name) {
  return *std::ranges::find(failures, name, &Failure::method);
}
static_assert(std::ranges::equal(failures, methods, {}, &Failure::method,
                                 [](const MethodEntry& m) {
                                   return std::string_view(m.info.name);
                                 }));

/** What the run @a k is in the picture. */
constexpr const char* role_of(const Failure& f, std::size_t k) {
  if (f.runs[k].method.empty()) return "true";
  return k == 0 ? "fails" : k + 1 == f.size() ? "cure" : "other";
}

/** A run against time. */
struct Trace {
  struct Sample {
    double t;             // [s]
    double value, right;  // in the unit of the failure's quantity
  };
  std::vector<Sample> samples;  // at the start, and after each step
  Outcome::Status status = Outcome::Status::ok;
  long long sweeps = 0;
  double deviation = 0;
};

namespace failure_detail {

inline std::unique_ptr<Method> make(const FailureRun& r) {
  if (r.method.empty()) return nullptr;
  if (r.method == Xpbd::info.name && r.setting > 0)
    return std::make_unique<Xpbd>(static_cast<int>(r.setting));
  if (r.method == DormandPrince::info.name && r.setting > 0)
    return std::make_unique<DormandPrince>(r.setting);
  return find_method(r.method)->make();
}

/** @pre q is not Quantity::error */
inline double look(Quantity q, const Start& s) {
  if (q == Quantity::energy)
    return kinetic_energy(s.cloth) + s.force.energy(s.cloth);
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

}  // namespace failure_detail

/** Make the run @a r of @a f, until its end or until it fails. */
inline Trace trace(const Failure& f, const FailureRun& r) {
  using namespace failure_detail;
  const Problem p = f.scene();
  Start s(p);
  Truth truth(p);
  DivergenceGuard guard(s.cloth, p.gravity);
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
      if (!guard.accept(s.cloth)) out.status = Outcome::Status::diverged;
    } catch (const StepError&) {
      out.status = Outcome::Status::failed;
    }
  }
  out.sweeps = s.counter.sweeps();
  return out;
}

/** The text at a run's curve. */
inline std::string label_of(const FailureRun& r, const Trace& trace) {
  std::string label = r.label;
  if (auto at = label.find('#'); at != std::string::npos)
    label.replace(at, 1, std::to_string(trace.sweeps));
  return label;
}

/** How a run ended; nothing if well. */
constexpr const char* status_of(const Trace& trace) {
  constexpr std::array names = {"", "diverged", "failed"};
  return names[static_cast<std::size_t>(trace.status)];
}

/** What was measured in the run @a r of @a f, in one line. */
inline std::string in_words(const Failure& f, const FailureRun& r,
                            const Trace& trace) {
  using CME212::short_text;
  std::string text(r.method);
  text += ", dt = " + short_text(r.dt) + " s";
  if (r.setting > 0 && r.method == Xpbd::info.name)
    text += ", substeps " + short_text(r.setting);
  else if (r.setting > 0)
    text += ", tolerance " + short_text(r.setting) + " m";
  text += ": off by " + short_text(trace.deviation) + unit_of(f.quantity) +
          ", " + std::to_string(trace.sweeps) + " sweeps";
  if (trace.status != Outcome::Status::ok)
    text += std::string(", ") + status_of(trace) +
            " at t = " + short_text(trace.samples.back().t) + " s";
  return text;
}

}  // namespace lab
