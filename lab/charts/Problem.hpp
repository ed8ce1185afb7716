#pragma once
/** @file Problem.hpp
 * Problems that methods are compared on: a cloth, its forces and constraints,
 * an end time, and what the right answer there is. */
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <numbers>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "CME212/Util.hpp"
#include "lab/methods/Methods.hpp"
#include "lab/stability/Guard.hpp"

namespace lab {

/** A force of nothing that counts how often it is asked for. As one part of a
 * sum it counts the force sweeps of a method, and hides no other part. Copies
 * count together. */
class CountingForce : public SweptForce {
 public:
  void add_to(const Part& part, double, std::span<Point>) const override {
    if (part.first == 0) ++*sweeps_;
  }
  bool add_stiffness(const Cloth&, const StiffnessVisitor&) const override {
    return true;  // it has none
  }
  std::optional<int> spring_multiplicity() const override { return 0; }
  long long sweeps() const { return *sweeps_; }

 private:
  std::shared_ptr<long long> sweeps_ = std::make_shared<long long>(0);
};

/** Calls another constraint and counts the calls: the steps that a method with
 * error control makes. */
class CountingConstraint : public SweptConstraint {
 public:
  explicit CountingConstraint(ConstraintPlan c) : c_(std::move(c)) {}
  void operator()(Cloth& g, double t) const override { ++calls_, c_(g, t); }
  bool nodewise() const override { return c_.nodewise(); }
  void project(Cloth& g, double t, unsigned first,
               unsigned last) const override {
    if (first == 0) ++calls_;  // one thread has that part
    c_.project(g, t, first, last);
  }
  void each_held(const Cloth& g, const NodeVisitor& use) const override {
    c_.each_held(g, use);
  }
  long long calls() const { return calls_; }

 private:
  ConstraintPlan c_;
  mutable long long calls_ = 0;
};

/** How two ends of a run are compared; both give a length [m].
 * positions    RMS over the nodes of the distance between their positions
 * functionals  sqrt(|dc|^2 + (dE/(M g))^2): distance of the centers of mass,
 *              and the difference of energies as a height. For contact, which
 *              positions are too sensitive to. */
enum class Norm { positions, functionals };
constexpr const char* name_of(Norm norm) {
  return norm == Norm::positions ? "rms position"
                                 : "center of mass and energy/(M g)";
}

/** A problem for methods. */
struct Problem {
  std::string name;
  std::string about;  ///< for the title of a chart
  double t_end;       ///< [s]
  Norm norm = Norm::positions;
  double gravity = grav;  ///< [m/s^2]
  double gamma = 0;       ///< drag [1/s]: c = gamma/N
  /** Make the cloth as it is at t = 0. */
  std::function<void(Cloth&)> build;
  std::function<CombinedConstraints(const Cloth&)> constraint;
  /** The exact positions at a time [s], by node id; empty if not known.
   * Without drag, so that the energy stays what it is at the start. */
  std::function<std::vector<Point>(double)> exact = {};
};

/** A problem at t = 0, ready to run. Its pins hold handles into the cloth, so
 * it stays where it was made. */
struct Start {
  Cloth cloth;
  CountingForce counter;
  ForcePlan force;
  CountingConstraint counted;
  ConstraintPlan constraint;

  explicit Start(const Problem& p)
      : force(force_of(p)), counted(p.constraint(cloth)), constraint(counted) {}
  Start(const Start&) = delete;
  Start& operator=(const Start&) = delete;

 private:
  CombinedForces force_of(const Problem& p) {
    p.build(cloth);
    if (p.gamma == 0)
      return make_combined_force(GravityForce(p.gravity), MassSpringForce(),
                                 counter);
    return make_combined_force(GravityForce(p.gravity), MassSpringForce(),
                               DampingForce(p.gamma / cloth.num_nodes()),
                               counter);
  }
};

/** What is looked at when a run ends. */
struct End {
  std::vector<Point> positions;  // [m], by node id
  Point center;                  // [m]
  double energy = 0;             // [J]
};
inline End end_of(const Start& s) {
  auto x = s.cloth.positions();
  return {{x.begin(), x.end()},
          center_of_mass(s.cloth),
          kinetic_energy(s.cloth) + s.force.energy(s.cloth)};
}

/** The distance [m] of two ends of @a p.
 * @pre for Norm::positions: no node was removed in either */
inline double distance(const Problem& p, const End& a, const End& b) {
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

// -------------------------------------------------------------------- Running

/** How a run ended. */
struct Outcome {
  enum class Status { ok, diverged, failed } status = Status::ok;
  std::string reason;  // empty if ok
  long long steps = 0, sweeps = 0;
  double seconds = 0;
  End end;

  bool ok() const { return status == Status::ok; }
};

/** Take @a p to its end in @a steps steps of equal length.
 * @param guarded stop when the energy leaves its bounds; else only the end is
 *        looked at, and nothing but the method takes time
 * @pre steps > 0 */
inline Outcome run(const Problem& p, Method& method, long long steps,
                   bool guarded = true) {
  using CME212::short_text;
  Start s(p);
  std::unique_ptr<DivergenceGuard> guard;
  if (guarded) guard = std::make_unique<DivergenceGuard>(s.cloth, p.gravity);
  const double dt = p.t_end / double(steps);
  Outcome out;
  method.restart();
  CME212::Clock clock;
  try {
    double t = 0;  // as the method counts it, or it forgets the force it kept
    for (long long n = 0; n < steps; ++n) {
      t = method.step(s.cloth, t, dt, s.force, s.constraint);
      if (!guard || guard->accept(s.cloth)) continue;
      out.status = Outcome::Status::diverged;
      out.reason = "energy out of bounds at t = " + short_text(t) + " s";
      break;
    }
  } catch (const std::exception& e) {  // StepError, or a force it can't take
    out.status = Outcome::Status::failed;
    out.reason = e.what();
  }
  out.seconds = clock.seconds();
  out.steps = s.counted.calls();
  out.sweeps = s.counter.sweeps();
  out.end = end_of(s);
  return out;
}

/** The answer to a problem, and how far it can be trusted. */
struct Reference {
  End end;
  double floor;           ///< [m]: how far two independent answers are apart
  std::string made = {};  ///< the two, as "pefrl 120 steps, verlet 90 steps"
};

/** An answer and another one: the exact solution and srkn11b; or srkn11b and
 * srkn6b; or, where contact leaves no method more than order 2, Verlet and
 * pefrl. So the two differ in order and in step, and in where in a step their
 * constraint acts.
 * @param fineness steps are shorter than the stable ones by this factor; by
 *        more for the lower orders, and with contact
 * Throws std::runtime_error if one of the runs does not reach the end. */
inline Reference reference(const Problem& p, double fineness = 16) {
  Start start(p);
  const double omega = omega_safe(start.cloth, start.force, start.constraint);
  Reference r;
  auto by = [&](Method&& method, const MethodInfo& info, double finer) {
    const auto steps =
        static_cast<long long>(std::ceil(p.t_end * omega / info.limit * finer));
    Outcome out = run(p, method, steps);
    if (!out.ok())
      throw std::runtime_error(p.name + ": no reference: " + out.reason);
    r.made += r.made.empty() ? "" : ", ";
    r.made += info.name + (" " + std::to_string(steps)) + " steps";
    return out.end;
  };
  End other;
  if (p.exact) {
    auto x = p.exact(p.t_end);
    r.end.energy = end_of(start).energy;
    std::copy(x.begin(), x.end(), start.cloth.positions().begin());
    r.end.center = center_of_mass(start.cloth);
    r.end.positions = std::move(x);
    r.made = "exact";
    other = by(Srkn11b(), Srkn11b::info, fineness);
  } else if (p.norm == Norm::functionals) {
    r.end = by(Verlet(), Verlet::info, 16 * fineness);
    other = by(Pefrl(), Pefrl::info, 16 * fineness);
  } else {
    r.end = by(Srkn11b(), Srkn11b::info, fineness);
    other = by(Srkn6b(), Srkn6b::info, 5 * fineness);
  }
  r.floor = std::max(distance(p, r.end, other), 1e-16);
  return r;
}

// ------------------------------------------------------------------- Problems

namespace problem_detail {

using std::numbers::pi;

/** @a n masses of 1/n kg in a row along x, between two walls 1 m apart,
 * springs of K = 100 N/m longer than at rest, so that they stay straight. Some
 * modes at once, let go at rest. */
struct Chain {
  struct Mode {
    unsigned k;        // half waves between the walls
    double amplitude;  // [m]
  };
  unsigned n = 20;
  double K = 100;
  double rest = 0.5;  // rest length of a spring, as a share of its length
  std::vector<Mode> modes = {{1, 0.02}, {2, 0.01}, {5, 0.005}};

  double omega(unsigned k) const {  // [1/s]
    return 2 * std::sqrt(K * n) * std::sin(k * pi / (n + 1) / 2);
  }
  std::vector<Point> exact(double t) const {
    std::vector<Point> x;
    for (unsigned j = 0; j < n + 2; ++j) {
      Point& p = x.emplace_back(j / double(n + 1), 0, 0);
      if (j == 0 || j == n + 1) continue;
      for (const Mode& m : modes)
        p.x += m.amplitude * std::sin(m.k * pi / (n + 1) * j) *
               std::cos(omega(m.k) * t);
    }
    return x;
  }
  void build(Cloth& g) const {
    for (const Point& p : exact(0)) g.add_node(p, {Point(), Real(1.0 / n)});
    for (unsigned j = 0; j <= n; ++j)
      g.add_edge(g.node(j), g.node(j + 1), {Real(K), Real(rest / (n + 1))});
  }
  CombinedConstraints pins(const Cloth& g) const {
    const std::array ends = {g.node(0), g.node(n + 1)};
    return make_combined_constraints(PinConstraint(std::span(ends)));
  }
};

/** A square cloth of n x n nodes, plain mesh, that hangs from its whole upper
 * row, and is let go unstretched: each column is a chain of its own. */
struct Curtain {
  unsigned n = 16;
  double K = 100;

  std::vector<Point> exact(double t) const {
    const double m = 1.0 / (n * n), width = 1.0 / (n - 1);
    std::vector<double> hangs(n);  // at rest, below the unstretched place [m]
    for (unsigned j = 1; j < n; ++j)
      hangs[j] = hangs[j - 1] + (n - j) * m * grav / K;
    std::vector<double> z(n);
    for (unsigned j = 0; j < n; ++j) z[j] = -(j * width) - hangs[j];
    for (unsigned k = 1; k < n; ++k) {
      double angle = (2 * k - 1) * pi / (2 * n - 1), amplitude = 0;
      for (unsigned j = 1; j < n; ++j)
        amplitude += 4.0 / (2 * n - 1) * hangs[j] * std::sin(angle * j);
      double omega = 2 * std::sqrt(K / m) * std::sin(angle / 2);
      for (unsigned j = 1; j < n; ++j)
        z[j] += amplitude * std::sin(angle * j) * std::cos(omega * t);
    }
    std::vector<Point> x;
    for (unsigned i = 0; i < n; ++i)
      for (unsigned j = 0; j < n; ++j) x.emplace_back(i * width, 0, z[j]);
    return x;
  }
  void build(Cloth& g) const {
    auto points = grid_points(n);
    for (Point& p : points) p = Point(p.x, 0, -p.y);
    build_cloth(g, points, grid_quads(n), Mesh::plain, K);
  }
  CombinedConstraints pins(const Cloth& g) const {
    std::vector<Node> row;
    for (unsigned i = 0; i < n; ++i) row.push_back(g.node(i * n));
    return make_combined_constraints(PinConstraint(row));
  }
};

inline CombinedConstraints pinned(const Cloth& g) {
  return make_combined_constraints(PinConstraint(g));
}
inline CombinedConstraints on_a_ball(const Cloth& g) {
  return make_combined_constraints(PinConstraint(g), PlaneConstraint(),
                                   SphereConstraint());
}
inline CombinedConstraints torn_by_a_ball(const Cloth& g) {
  return make_combined_constraints(PinConstraint(g), PlaneConstraint(),
                                   TearConstraint());
}

}  // namespace problem_detail

/** The assignment's cloth on a mesh: diagonals, K [N/m], pinned at its
 * corners, drag c = 1/N. */
inline Problem cloth_problem(std::string name, std::string about, double t_end,
                             std::vector<Point> points, std::vector<Quad> quads,
                             double K = 100) {
  return {
      .name = std::move(name),
      .about = std::move(about),
      .t_end = t_end,
      .gamma = 1,
      .build =
          [points = std::move(points), quads = std::move(quads), K](Cloth& g) {
            build_cloth(g, points, quads, Mesh::diagonals, K);
          },
      .constraint = problem_detail::pinned};
}
/** The same on a square grid of side x side nodes. */
inline Problem grid_problem(std::string name, std::string about, double t_end,
                            unsigned side, double K = 100) {
  return cloth_problem(std::move(name), std::move(about), t_end,
                       grid_points(side), grid_quads(side), K);
}

/** Masses in a row, without gravity and drag. */
inline Problem chain_problem(std::string name, std::string about, double t_end,
                             problem_detail::Chain chain = {}) {
  return {
      .name = std::move(name),
      .about = std::move(about),
      .t_end = t_end,
      .gravity = 0,
      .build = [chain](Cloth& g) { chain.build(g); },
      .constraint = [chain](const Cloth& g) { return chain.pins(g); },
      .exact = [chain](double t) { return chain.exact(t); },
  };
}

/** All problems. */
inline std::vector<Problem> make_problems() {
  namespace d = problem_detail;
  std::vector<Problem> all;
  all.push_back(chain_problem(
      "chain", "20 masses between two walls, to 0.8 s; exact", 0.8));
  d::Curtain curtain;
  all.push_back({.name = "curtain",
                 .about = "16 x 16 curtain let go, to 1 s; exact",
                 .t_end = 1,
                 .build = [=](Cloth& g) { curtain.build(g); },
                 .constraint = [=](const Cloth& g) { return curtain.pins(g); },
                 .exact = [=](double t) { return curtain.exact(t); }});
  all.push_back(grid_problem("grid0", "5 x 5 cloth with drag, to 5 s", 5, 5));
  all.push_back(
      grid_problem("grid1", "25 x 25 cloth with drag, to 0.5 s", 0.5, 25));
  all.push_back(grid_problem("grid1-short",
                             "25 x 25 cloth with drag, to 0.25 s", 0.25, 25));
  all.push_back(grid_problem("stiff", "25 x 25 cloth, K = 10000 N/m, to 0.25 s",
                             0.25, 25, 1e4));
  all.push_back(grid_problem(
      "drape", "25 x 25 cloth falling on a ball, to 0.4 s", 0.4, 25));
  all.back().constraint = d::on_a_ball;
  all.back().norm = Norm::functionals;
  all.push_back(
      grid_problem("tear", "25 x 25 cloth torn by a ball, to 0.4 s", 0.4, 25));
  all.back().constraint = d::torn_by_a_ball;
  all.back().norm = Norm::functionals;
  return all;
}

}  // namespace lab
