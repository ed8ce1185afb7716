#pragma once
/** @file AugmentedVerlet.hpp
 * Mass-augmented Verlet: explicit, with one prefactored system a step. */
#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "lab/fast/Sweep.hpp"
#include "lab/methods/Cholesky.hpp"
#include "lab/methods/ImplicitStage.hpp"

namespace lab {

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

  double step(Cloth& g, double t, double dt, const ForcePlan& force,
              const ConstraintPlan& constraint) override {
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
  bool unchanged(const Cloth& g, double dt, const ForcePlan& force,
                 const ConstraintPlan& constraint) {
    held_.clear();
    constraint.each_held(g, [this](Node n) { held_.push_back(n.id()); });
    if (dt != key_.dt || !source_.springs ||
        force.spring_multiplicity() != source_.springs || &g != source_.cloth ||
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
  bool find_factor(const Cloth& g, double dt, const ForcePlan& force,
                   const ConstraintPlan& constraint) {
    if (unchanged(g, dt, force, constraint)) return true;
    source_.springs = force.spring_multiplicity();
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
  void accelerate(const Cloth& g, double t, const ForcePlan& force) {
    sweep_without_drag(sweep_, g, t, force, acceleration_);
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

}  // namespace lab
