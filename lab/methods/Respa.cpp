#include "lab/methods/Respa.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>

#include "CME212/Util.hpp"
#include "lab/methods/Flow.hpp"

namespace lab {

double Respa::step(Cloth& g, double t, double dt, const ForcePlan& force,
                   const ConstraintPlan& constraint) {
  const bool same = kept_for_ == &g && kept_version_ == g.version() &&
                    multiplicity_ == force.springs();
  if (!same) find_split(g, force, constraint);
  inner_steps_ = 1;
  if (split_.empty()) return verlet_.step(g, t, dt, force, constraint);
  // The same time, however the caller rounds it.
  if (!(same || loaded_) || std::abs(t - kept_time_) > 1e-6 * dt)
    find_soft_forces(g, t, force);
  loaded_ = false;
  const auto kick_all = [&](const Part& part) {
    kick(g, part, dt / 2, std::span(soft_).subspan(part.first));
  };
  const double most = Verlet::info.limit / inner_steps_at_limit / split_.omega;
  if (!(dt / most < 1e6))
    throw StepError(std::string(info.name) +
                    ": the stiff springs need more than a million inner steps "
                    "a step; dt = " +
                    CME212::short_text(dt) + " s");
  inner_steps_ = std::max(1, int(std::ceil(dt / most)));
  sweep_.parts(g, kick_all);
  take_stiff_nodes(g, t + dt, dt, force.drag(), constraint);
  move_stiff_nodes(g, dt / inner_steps_);
  constraint.place_held_at_rest(g, t + dt);
  sweep_.parts(g, [&](const Part& part) { drift(g, part, dt, force.drag()); });
  for (std::size_t k = 0; k < stiff_.size(); ++k)
    if (stiff_[k].per_mass > 0) {
      g.positions()[split_.nodes[k]] = stiff_[k].x;
      g.node_values()[split_.nodes[k]].vel = stiff_[k].v;
    }
  constraint(g, t + dt);
  if (g.version() != kept_version_) find_split(g, force, constraint);
  find_soft_forces(g, t + dt, force);
  sweep_.parts(g, kick_all);
  constraint.set_held_velocities(g, t + dt);
  kept_time_ = t + dt;
  return t + dt;
}

void Respa::archive(CME212::Archive& a, const Cloth& g) {
  verlet_.archive(a, g);
  bool has = !split_.empty() && kept_for_ == &g && kept_version_ == g.version();
  a(has);
  if (a.loads()) kept_for_ = nullptr, loaded_ = has;
  if (has) a(soft_)(kept_time_);
}

void Respa::find_split(const Cloth& g, const ForcePlan& force,
                       const ConstraintPlan& constraint) {
  multiplicity_ = force.springs();
  split_ = split_springs(g, multiplicity_, constraint);
  stiff_.resize(split_.nodes.size());
  kept_for_ = &g, kept_version_ = g.version();
}

/** All forces but the stiff springs and drag. */
void Respa::find_soft_forces(const Cloth& g, double t, const ForcePlan& force) {
  sweep_without_drag(sweep_, g, t, force, soft_);
  const auto x = g.positions();
  for (const auto& s : split_.springs) {
    const unsigned i = split_.nodes[s.i], j = split_.nodes[s.j];
    const Point f =
        multiplicity_ * spring_force(x[j] - x[i], g.edge_values()[s.edge]);
    soft_[i] -= f;
    soft_[j] += f;
  }
}

/** The nodes at stiff springs as they are, for inner steps that end after
 * @a dt at time @a end: until then held ones go straight to their place. */
void Respa::take_stiff_nodes(const Cloth& g, double end, double dt,
                             const Drag& c, const ConstraintPlan& constraint) {
  const double h = dt / inner_steps_;
  for (std::size_t k = 0; k < stiff_.size(); ++k) {
    const unsigned id = split_.nodes[k];
    const NodeData& node = g.node_values()[id];
    const double gamma = c[id] / node.mass;
    stiff_[k] = {g.positions()[id],
                 node.vel,
                 Point(),
                 1 / double(node.mass),
                 gamma > 0 ? -std::expm1(-gamma * h) / gamma : h,
                 std::exp(-gamma * h)};
  }
  const auto take_held = [&](Node n, const Place& place) {
    const auto found = std::ranges::lower_bound(split_.nodes, n.id());
    if (found == split_.nodes.end() || *found != n.id()) return;
    StiffNode& s = stiff_[std::size_t(found - split_.nodes.begin())];
    s.v = (place.at - s.x) / dt;
    s.per_mass = 0, s.way = h, s.decay = 1;
  };
  constraint.each_place(g, end, std::ref(take_held));  // nothing on the heap
}

/** inner_steps_ steps of @a h by Verlet. */
void Respa::move_stiff_nodes(const Cloth& g, double h) {
  const auto spring = g.edge_values();
  const auto kick_by = [&](double by) {
    for (const auto& s : split_.springs) {
      StiffNode &a = stiff_[s.i], &b = stiff_[s.j];
      const Point f = multiplicity_ * spring_force(b.x - a.x, spring[s.edge]);
      a.f += f;
      b.f -= f;
    }
    for (StiffNode& s : stiff_) {
      s.v += (by * s.per_mass) * s.f;
      s.f = Point();
    }
  };
  kick_by(h / 2);
  for (int k = 1; k <= inner_steps_; ++k) {
    for (StiffNode& s : stiff_) {
      s.x += s.way * s.v;
      s.v *= s.decay;
    }
    kick_by(k < inner_steps_ ? h : h / 2);
  }
}

}  // namespace lab
