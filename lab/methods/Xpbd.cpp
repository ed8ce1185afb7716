#include "lab/methods/Xpbd.hpp"

#include <array>
#include <cmath>
#include <stdexcept>
#include <string>

#include "lab/fast/GraphArrays.hpp"
#include "lab/fast/OneWaySprings.hpp"
#include "lab/methods/ImplicitStage.hpp"

namespace lab {

namespace {

/** True if the edges of @a g have stiffness, false if nothing has.
 * Throws std::invalid_argument if anything else has. */
bool check_springs(const Cloth& g, const ForcePlan& force) {
  struct {
    const Cloth& g;
    unsigned edge, seen;
    bool other, one_way;
  } look = {g, 0, 0, false, force.potential().one_way != nullptr};
  implicit_detail::add_stiffness(
      Xpbd::info.name, force, g,
      [&look](unsigned i, unsigned j, const Stiffness& B) {
        while (look.edge < arrays(look.g).edge_slots() &&
               !arrays(look.g).edge_in_use(look.edge))
          ++look.edge;
        ++look.seen;
        if (look.edge == arrays(look.g).edge_slots() ||
            arrays(look.g).edge_ends()[look.edge] != std::array{i, j} ||
            (arrays(look.g).edge_values()[look.edge].K != B.along &&
             !(look.one_way && B.along == 0)))  // slack
          look.other = true;
        else
          ++look.edge;
      });
  if (look.seen == 0) return false;
  if (look.other || look.seen != g.num_edges())
    throw std::invalid_argument(
        std::string(Xpbd::info.name) +
        ": the force has a stiffness besides that of the cloth's edges, "
        "each taken once (MassSpringForce)");
  return true;
}

}  // namespace

double Xpbd::step(Cloth& g, double t, double dt, const ForcePlan& force,
                  const ConstraintPlan& constraint) {
  const bool springs = check_springs(g, force);
  one_way_ = force.potential().one_way;
  implicit_detail::find_fixed(g, constraint, fixed_);
  constraint.place_held_at_rest(g, t);
  accelerate(g, t, force, springs);
  const double h = dt / substeps_;
  rounds_ += substeps_;
  pulls_.assign(springs ? arrays(g).edge_slots() : 0, Point());
  const Drag& c = force.drag();
  auto x = arrays(g).positions();
  auto node = arrays(g).node_values();
  const unsigned n = arrays(g).node_slots();
  for (int k = 0; k < substeps_; ++k) {
    constraint.place_held_at_rest(g, t + (k + 1) * h);
    for (unsigned i = 0; i < n; ++i) {
      if (fixed_[i]) continue;
      const double m = node[i].mass;
      const double decay = c.none() ? 1 : std::exp(-c[i] / m * h);
      node[i].vel = decay * (node[i].vel + h * acceleration_[i]);
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

/** Find the accelerations by all forces but the springs and drag. */
void Xpbd::accelerate(Cloth& g, double t, const ForcePlan& force,
                      bool springs) {
  const unsigned n = arrays(g).node_slots();
  flow_.accelerate(g, t, force, true);
  acceleration_.resize(n);
  for (unsigned i = 0; i < n; ++i) acceleration_[i] = flow_.acceleration(i);
  if (!springs) return;
  if (one_way_)
    flow_.accelerate(g, t, *one_way_, true);
  else
    flow_.accelerate(g, t, springs_, true);
  for (unsigned i = 0; i < n; ++i) acceleration_[i] -= flow_.acceleration(i);
}

/** One round over the springs. */
void Xpbd::pull_together(Cloth& g, double h) {
  auto x = arrays(g).positions();
  auto node = arrays(g).node_values();
  for (unsigned e = 0; e < arrays(g).edge_slots(); ++e) {
    if (!arrays(g).edge_in_use(e)) continue;
    const EdgeData& spring = arrays(g).edge_values()[e];
    auto [i, j] = arrays(g).edge_ends()[e];
    const double wi = fixed_[i] ? 0 : 1 / node[i].mass;
    const double wj = fixed_[j] ? 0 : 1 / node[j].mass;
    const Point u = x[j] - x[i];
    const double l = norm(u);
    if (l == 0 || wi + wj == 0 || spring.K == 0) continue;
    if (one_way_ && one_way_->is_slack(e, l, spring)) continue;
    const double d = (l - spring.L) / (wi + wj + 1 / (spring.K * h * h));
    const Point way = (d / l) * u;
    x[i] += wi * way;
    x[j] -= wj * way;
    pulls_[e] += 1 / (substeps_ * h * h) * way;
  }
}

}  // namespace lab
