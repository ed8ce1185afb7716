#pragma once
/** @file Xpbd.hpp
 * Extended position-based dynamics: each spring in turn moves its two ends to
 * where it would have them. */
#include <stdexcept>
#include <string>
#include <vector>

#include "lab/methods/ImplicitStage.hpp"
#include "lab/methods/Method.hpp"

namespace lab {

/** Extended position-based dynamics in n substeps of h = dt/n, each with one
 * round over the springs (Gauss-Seidel, in the order of the edges' ids):
 *   v += h F/m;  v *= e^(-c h/m);  x += h v;
 *   each spring of compliance 1/K:  x_i += w_i d n,  x_j -= w_j d n,
 *     d = (l - L)/(w_i + w_j + 1/(K h^2)),  w = 1/m, n from i to j;
 *   v = (x - x before)/h.
 * F is all forces but springs and drag, taken once a step, at its start. Held
 * nodes weigh infinitely: w = 0. For one spring this is implicit Euler. Linear
 * momentum is kept to round-off; angular momentum is not.
 *
 * The springs are those of the cloth's edges. So the force must consist of
 * MassSpringForce, once, and of others without stiffness; or it has no
 * stiffness at all, and then there are no springs. Any other is refused.
 * Source: M. Macklin, M. Mueller, N. Chentanez, "XPBD", MIG 2016; M. Macklin et
 * al., "Small steps in physics simulation", SCA 2019. */
class Xpbd : public Method {
 public:
  // Besides the sweep: one more over the springs, to leave them out of it, and
  // n rounds, each as dear as 2 sweeps.
  static constexpr MethodInfo info = {
      "xpbd",
      1,
      1,
      no_limit,
      "Macklin et al. 2016, 2019",
      "looks; springs that hardly give, K to infinity",
      "accuracy counts; few substeps: one round is no solution"};

  /** @param substeps n > 0 in each step */
  explicit Xpbd(int substeps = 10) : substeps_(substeps) {
    assert(substeps > 0);
  }

  double step(Cloth& g, double t, double dt, const ForcePlan& force,
              const ConstraintPlan& constraint) override {
    const bool springs = check_springs(g, force);
    implicit_detail::find_fixed(g, constraint, fixed_);
    stop_held(g, constraint);
    find_forces(g, t, force, springs);
    const double h = dt / substeps_, c = force.drag();
    auto x = g.positions();
    auto node = g.node_values();
    const unsigned n = g.node_slots();
    for (int k = 0; k < substeps_; ++k) {
      for (unsigned i = 0; i < n; ++i) {
        if (fixed_[i]) continue;
        const double m = node[i].mass;
        const double decay = c == 0 ? 1 : std::exp(-c / m * h);
        node[i].vel = decay * (node[i].vel + (h / m) * force_[i]);
        x[i] += h * node[i].vel;
      }
      if (!springs) continue;
      // v = (x - x before)/h, without the round-off of that difference.
      free_.assign(x.begin(), x.end());
      pull_together(g, h);
      for (unsigned i = 0; i < n; ++i)
        if (!fixed_[i]) node[i].vel += (x[i] - free_[i]) / h;
    }
    return implicit_detail::finish(g, t + dt, constraint);
  }

 private:
  int substeps_;
  Sweep sweep_;
  std::vector<char> fixed_;  // by node id, as all that follows
  std::vector<Point> free_, force_, pull_;

  /** Are the edges of @a g all that has a stiffness?  @return false if nothing
   * has.  Throws std::invalid_argument if something else has. */
  static bool check_springs(const Cloth& g, const ForcePlan& force) {
    struct {
      const Cloth& g;
      unsigned edge, seen;
      bool other;
    } look = {g, 0, 0, false};
    implicit_detail::add_stiffness(
        info.name, force, g,
        [&look](unsigned i, unsigned j, const Stiffness& B) {
          while (look.edge < look.g.edge_slots() &&
                 !look.g.edge_in_use(look.edge))
            ++look.edge;
          ++look.seen;
          if (look.edge == look.g.edge_slots() ||
              look.g.edge_ends()[look.edge] != std::array{i, j} ||
              look.g.edge_values()[look.edge].K != B.along)
            look.other = true;
          else
            ++look.edge;
        });
    if (look.seen == 0) return false;
    if (look.other || look.seen != g.num_edges())
      throw std::invalid_argument(
          std::string(info.name) +
          ": the force has a stiffness besides that of the cloth's edges, "
          "each taken once (MassSpringForce)");
    return true;
  }

  /** All forces but the springs and drag. */
  void find_forces(const Cloth& g, double t, const ForcePlan& force,
                   bool springs) {
    sweep_without_drag(sweep_, g, t, force, force_);
    if (!springs) return;
    sweep_(g, t, MassSpringForce(), pull_);
    for (std::size_t i = 0; i < pull_.size(); ++i) force_[i] -= pull_[i];
  }

  /** One round over the springs. */
  void pull_together(Cloth& g, double h) const {
    auto x = g.positions();
    auto node = g.node_values();
    for (unsigned e = 0; e < g.edge_slots(); ++e) {
      if (!g.edge_in_use(e)) continue;
      const EdgeData& spring = g.edge_values()[e];
      auto [i, j] = g.edge_ends()[e];
      const double wi = fixed_[i] ? 0 : 1 / node[i].mass;
      const double wj = fixed_[j] ? 0 : 1 / node[j].mass;
      const Point u = x[j] - x[i];
      const double l = norm(u);
      if (l == 0 || wi + wj == 0 || spring.K == 0) continue;
      const double d = (l - spring.L) / (wi + wj + 1 / (spring.K * h * h));
      x[i] += (wi * d / l) * u;
      x[j] -= (wj * d / l) * u;
    }
  }
};

}  // namespace lab
