#pragma once
/** @file Implicit.hpp
 * Methods that solve a system of equations in each step, and so are stable on
 * linear springs for every dt: implicit Euler, implicit midpoint, TR-BDF2 and
 * mass-augmented Verlet. They refuse a force that does not know its stiffness.
 */
#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "Cholesky.hpp"
#include "ImplicitStage.hpp"

/** Linearly implicit Euler: v += dt F(x + dt v)/m with F linearized at x, then
 * x += dt v. One linear system a step, by conjugate gradients.
 * Source: D. Baraff, A. Witkin, SIGGRAPH 1998, "Large steps in cloth
 * simulation", with compressed springs taken as having no stiffness across. */
class ImplicitEuler : public Method {
 public:
  // Besides the sweep: about dt omega products with the matrix, each as dear
  // as a sweep.
  static constexpr MethodInfo info = {
      "implicit-euler",
      1,
      1,
      no_limit,
      "Baraff, Witkin 1998",
      "stiff cloth that shall come to rest, at any dt",
      "motion counts: it damps as a drag of dt omega^2 would"};

  /** @param tolerance > 0, of the linear system: see
   *        ImplicitStage::solve_linearized() */
  explicit ImplicitEuler(double tolerance = 1e-8) : stage_(tolerance, 0) {}

  double step(Cloth& g, double t, double dt, const ZeroForce& force,
              const ZeroConstraint& constraint) override {
    stage_.begin(info.name, dt, g, constraint);
    stage_.solve_linearized(g, t + dt, dt, force);
    auto node = g.node_values();
    for (unsigned i = 0; i < g.node_slots(); ++i) node[i].vel = stage_.w[i];
    return implicit_detail::finish(g, t + dt, constraint);
  }

 private:
  implicit_detail::ImplicitStage stage_;
};

/** The base of the methods that solve the equations of motion as they are, by
 * Newton's method. The force must be the slope of its energy(), but for drag.
 *
 * A step that folds the cloth many times over may need more iterations than
 * there are: a sheet of 50 x 50 nodes, stirred by 1 m/s at random, can't make
 * steps of 0.2 s (170 times verlet's limit), one of K = 10000 N/m none of
 * 0.02 s by the midpoint rule. A shorter step can be made. */
class NewtonMethod : public Method {
 public:
  /** @param tolerance [m/s^2] > 0, of each stage: what is left over does as an
   *        acceleration of that size would, see ImplicitStage::solve_newton()
   * @param max_iterations of Newton in each stage; then StepError
   * @param line_search false to see what it is good for */
  explicit NewtonMethod(double tolerance = 1e-9, int max_iterations = 100,
                        bool line_search = true)
      : stage_(tolerance, max_iterations, line_search) {}

 protected:
  implicit_detail::ImplicitStage stage_;
};

/** v1 = v0 + dt F(x, v)/m, x1 = x0 + dt v, at x = (x0 + x1)/2 and v = (v0 +
 * v1)/2. Symmetric and symplectic; linear and angular momentum are kept.
 * Source: E. Hairer, C. Lubich, G. Wanner, Geometric Numerical Integration,
 * II.1.3. */
class ImplicitMidpoint : public NewtonMethod {
 public:
  // The sweeps are those of a linear force. Any other takes one more for each
  // further iteration of Newton: on a cloth 4 to 6 in all, and more the more
  // it buckles in a step. Each iteration takes about dt omega products with
  // the matrix, each as dear as a sweep.
  static constexpr MethodInfo info = {
      "implicit-midpoint",
      2,
      2,
      no_limit,
      "Hairer, Lubich, Wanner 2006, II.1.3",
      "stiff springs that swing without loss, as in a chain",
      "buckling cloth at large dt: nothing damps what it stirs up"};

  using NewtonMethod::NewtonMethod;

  double step(Cloth& g, double t, double dt, const ZeroForce& force,
              const ZeroConstraint& constraint) override {
    stage_.begin(info.name, dt, g, constraint);
    stage_.solve_newton(g, t + dt / 2, dt / 2, force);
    auto x = g.positions();
    auto node = g.node_values();
    for (unsigned i = 0; i < g.node_slots(); ++i) {
      if (stage_.fixed(i)) continue;
      x[i] = stage_.p[i] + dt * stage_.w[i];
      node[i].vel = 2 * stage_.w[i] - stage_.q[i];
    }
    return implicit_detail::finish(g, t + dt, constraint);
  }
};

/** The trapezoidal rule up to t + gamma dt, then the backward differentiation
 * formula of order 2 over both parts, gamma = 2 - sqrt 2. L-stable: what is
 * too fast for dt dies out at once.
 * Source: R. E. Bank et al., IEEE Trans. Electron Devices 32 (1985) 1992. */
class TrBdf2 : public NewtonMethod {
 public:
  // The sweeps are those of a linear force: one at the start and two a stage.
  // On a cloth 9 to 12; besides, as ImplicitMidpoint in each stage.
  static constexpr MethodInfo info = {
      "tr-bdf2",
      2,
      5,
      no_limit,
      "Bank et al. 1985",
      "stiff cloth that moves on large scales, at large dt",
      "energy must not be lost; verlet's limit is not far"};

  using NewtonMethod::NewtonMethod;

  double step(Cloth& g, double t, double dt, const ZeroForce& force,
              const ZeroConstraint& constraint) override {
    constexpr double root = 1.4142135623730951;
    constexpr double gamma = 2 - root, beyond = (root - 1) / 2;
    const double s = gamma / 2 * dt;  // the same in both stages
    stage_.begin(info.name, dt, g, constraint);
    auto x = g.positions();
    auto node = g.node_values();
    const unsigned n = g.node_slots();
    x0_.assign(x.begin(), x.end());
    sweep_(g, t, force, force_);
    for (unsigned i = 0; i < n; ++i) {
      if (stage_.fixed(i)) force_[i] = Point();
      stage_.p[i] = x[i] + s * node[i].vel;
      stage_.q[i] = node[i].vel + (s / node[i].mass) * force_[i];
    }
    stage_.solve_newton(g, t + gamma * dt, s, force);
    for (unsigned i = 0; i < n; ++i) {
      stage_.p[i] = x[i] + beyond * (x[i] - x0_[i]);
      stage_.q[i] = stage_.w[i] + beyond * (stage_.w[i] - node[i].vel);
    }
    stage_.solve_newton(g, t + dt, s, force);
    for (unsigned i = 0; i < n; ++i) node[i].vel = stage_.w[i];
    return implicit_detail::finish(g, t + dt, constraint);
  }

 private:
  Sweep sweep_;
  std::vector<Point> x0_, force_;  // by node id
};

/** Verlet with the mass M + (dt^2/4) L in place of M, where
 *   (L x)_i = sum over the springs at i of K (x_i - x_j).
 * No spring is stiffer than K in any direction, so no frequency reaches the
 * limit 2/dt, in whatever configuration: linearized there, it is bounded. (A
 * cloth that buckles can still gain energy at large dt, unless drag takes it.)
 * Springs without rest length swing as by the implicit midpoint rule. Linear
 * momentum is kept to round-off, and so is the angular momentum of the heavier
 * mass, sum x_i x (M v + dt^2/4 L v)_i. Drag as in Splitting: by the true mass.
 *
 * The matrix is that of the nodes that move, N x N for the three coordinates
 * alike. Its Cholesky factor is kept until dt, a mass, a spring's K or ends, or
 * what is held has changed.
 * Source: A. Stern, E. Grinspun, Multiscale Model. Simul. 7 (2009) 1779. */
class AugmentedVerlet : public Method {
 public:
  // Besides the sweep: one look at all springs, to see whether they are those
  // of the factor, and one solution with it: 20 to 60 nonzeros a node. A new
  // factor costs as much as 25 to 50 steps at 1e4 nodes, 100 to 200 at 1e6.
  static constexpr MethodInfo info = {
      "augmented-verlet",
      2,
      1,
      no_limit,
      "Stern, Grinspun 2009",
      "large N with some drag, at 10 times verlet's dt",
      "dt omega > 1 for what is looked at; 10 times the dt without drag"};

  double step(Cloth& g, double t, double dt, const ZeroForce& force,
              const ZeroConstraint& constraint) override {
    using namespace integrator_detail;
    bool same = find_factor(g, dt, force, constraint);
    stop_held(g, constraint);
    // The same time, however the caller rounds it.
    if (!same || kept_for_ != &g || std::abs(kept_time_ - t) > 1e-6 * dt)
      accelerate(g, t, force);
    kick(g, dt / 2);
    sweep_.parts(g,
                 [&](const Part& part) { drift(g, part, dt, force.drag()); });
    const std::size_t version = g.version();
    constraint(g, t + dt);
    stop_held(g, constraint);
    if (g.version() != version) find_factor(g, dt, force, constraint);
    accelerate(g, t + dt, force);
    kick(g, dt / 2);
    kept_for_ = &g, kept_time_ = t + dt;
    return t + dt;
  }
  void restart() override { kept_for_ = nullptr, source_.cloth = nullptr; }

  /** How often the matrix was factored since this method was made. */
  int factorizations() const { return factorizations_; }

 private:
  /** All that the factor depends on. */
  struct Key {
    double dt = 0;
    std::vector<char> fixed;   // by node id
    std::vector<double> mass;  // [kg], by node id
    struct Spring {
      unsigned i, j;
      double K;
      bool operator==(const Spring&) const = default;
    };
    std::vector<Spring> springs;
    bool operator==(const Key&) const = default;
  };
  Key key_, next_;
  /** What key_ was made of, if its springs are those of the edges. */
  struct Source {
    std::optional<int> springs;  // nothing: of other forces, too
    const Cloth* cloth = nullptr;
    std::size_t version = 0;
    std::vector<unsigned> held;  // their ids, in the constraint's order
    std::vector<double> K;       // [N/m], by edge id
  };
  Source source_;
  std::vector<unsigned> held_;
  int factorizations_ = 0;
  SparseCholesky factor_;
  Sweep sweep_;
  std::vector<Point> acceleration_;  // [m/s^2], by node id
  const Cloth* kept_for_ = nullptr;  // at whose state acceleration_ is
  double kept_time_ = 0;

  /** Whether nothing that key_ was made of has changed: in one look at the
   * arrays, without the forces.  @post held_ are the held nodes */
  bool unchanged(const Cloth& g, double dt, const ZeroForce& force,
                 const ZeroConstraint& constraint) {
    held_.clear();
    constraint.each_held(g, [this](Node n) { held_.push_back(n.id()); });
    if (dt != key_.dt || !source_.springs ||
        force.springs() != source_.springs || &g != source_.cloth ||
        g.version() != source_.version || held_ != source_.held)
      return false;
    auto node = g.node_values();
    auto spring = g.edge_values();
    bool same = true;
    for (unsigned i = 0; i < node.size(); ++i)
      same &= node[i].mass == key_.mass[i];
    for (unsigned e = 0; e < spring.size(); ++e)
      same &= spring[e].K == source_.K[e];
    return same;
  }

  /** The factor for @a g as it is.  @return true if it was that already */
  bool find_factor(const Cloth& g, double dt, const ZeroForce& force,
                   const ZeroConstraint& constraint) {
    if (unchanged(g, dt, force, constraint)) return true;
    source_.springs = force.springs();
    source_.cloth = &g, source_.version = g.version();
    source_.held = held_;
    source_.K.clear();
    for (const EdgeData& spring : g.edge_values())
      source_.K.push_back(spring.K);
    next_.dt = dt;
    implicit_detail::find_fixed(g, constraint, next_.fixed);
    next_.mass.clear();
    for (const NodeData& node : g.node_values())
      next_.mass.push_back(node.mass);
    next_.springs.clear();
    implicit_detail::add_stiffness(
        info.name, force, g,
        [this](unsigned i, unsigned j, const Stiffness& B) {
          double K = std::max({0.0, B.along, B.across});
          if (K > 0) next_.springs.push_back({i, j, K});
        });
    if (next_ == key_) return true;
    std::swap(key_, next_);
    factorize();
    return false;
  }

  /** The lower triangle of M + (dt^2/4) L, by node id. Fixed nodes have a row,
   * too, so that no other numbers are needed: that of a 1. */
  SparseCholesky::Matrix matrix() const {
    std::vector<Eigen::Triplet<double>> entries;
    const double h2 = key_.dt * key_.dt / 4;
    auto add = [&](unsigned i, unsigned j, double a) {
      if (!key_.fixed[i] && !key_.fixed[j])
        entries.emplace_back(std::max(i, j), std::min(i, j), a);
    };
    const unsigned rows = unsigned(key_.fixed.size());
    for (unsigned i = 0; i < rows; ++i)
      entries.emplace_back(i, i, key_.fixed[i] ? 1 : key_.mass[i]);
    for (const auto& [i, j, K] : key_.springs) {
      add(i, i, h2 * K);
      add(j, j, h2 * K);
      add(i, j, -h2 * K);
    }
    SparseCholesky::Matrix a(rows, rows);
    a.setFromTriplets(entries.begin(), entries.end());
    return a;
  }

  void factorize() {
    ++factorizations_;
    if (factor_.factorize(matrix())) return;
    key_ = {}, source_ = {};
    throw StepError(std::string(info.name) +
                    ": the matrix of masses can't be factored; dt = " +
                    CME212::short_text(key_.dt) + " s");
  }

  /** acceleration_ = (M + (dt^2/4) L)^-1 F at the state of @a g. */
  void accelerate(const Cloth& g, double t, const ZeroForce& force) {
    integrator_detail::sweep_without_drag(sweep_, g, t, force, acceleration_);
    for (unsigned i = 0; i < key_.fixed.size(); ++i)
      if (key_.fixed[i]) acceleration_[i] = Point();
    factor_.solve({acceleration_.data(), factor_.rows()});
  }

  void kick(Cloth& g, double h) const {
    auto node = g.node_values();
    for (unsigned i = 0; i < g.node_slots(); ++i)
      node[i].vel += h * acceleration_[i];
  }
};
