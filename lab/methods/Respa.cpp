#include "lab/methods/Respa.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>

#include "CME212/Util.hpp"

namespace lab {

int Respa::steps(Cloth& g, const StepTimes& times, int count,
                 const ForcePlan& force, const ConstraintPlan& constraint) {
  const auto version = g.version();
  const bool same = kept_for_ == &g && kept_version_ == version &&
                    multiplicity_ == force.springs();
  if (!same) find_split(g, force, constraint);
  inner_steps_ = 1;
  if (split_.empty()) return verlet_.steps(g, times, count, force, constraint);
  // The same time, however the caller rounds it.
  bool kept =
      (same || loaded_) && !(std::abs(times(0) - kept_time_) > 1e-6 * times.dt);
  loaded_ = false;
  flow_.begin(g, force, true);
  int k = 0;
  do {
    one_step(g, times(k), times.dt, kept, force, constraint);
    kept = true;
  } while (++k < count && g.version() == version);
  flow_.end();
  kept_time_ = times(k - 1) + times.dt;
  return k;
}

/** @param kept whether the accelerations at the start are */
void Respa::one_step(Cloth& g, double t, double dt, bool kept,
                     const ForcePlan& force, const ConstraintPlan& constraint) {
  if (!kept) {
    flow_.run({.t = t, .kick = 0, .keep = true});
    leave_out_stiff(g);
  }
  if (!(dt / split_.inner_step() < 1e6))
    throw StepError(std::string(info.name) +
                    ": the stiff springs need more than a million inner steps "
                    "a step; dt = " +
                    CME212::short_text(dt) + " s");
  inner_steps_ = split_.inner_steps(dt);
  inner_done_ += inner_steps_;
  take_stiff_nodes(g, t + dt, dt, force.drag(), constraint);
  move_stiff_nodes(g, dt / inner_steps_);
  flow_.run(
      {.t = t + dt, .first_kick = dt / 2, .drift = dt, .held = &constraint});
  for (std::size_t k = 0; k < stiff_.size(); ++k)
    if (stiff_[k].per_mass > 0) {
      flow_.cloth().set_position(split_.nodes[k], stiff_[k].x);
      flow_.cloth().set_velocity(split_.nodes[k], stiff_[k].v);
    }
  flow_.run({.t = t + dt, .project = &constraint, .kick = 0, .keep = true});
  if (g.version() != kept_version_) find_split(g, force, constraint);
  leave_out_stiff(g);
  flow_.run({.t = t + dt, .first_kick = dt / 2, .last = &constraint});
}

void Respa::archive(Archive& a, const Cloth& g) {
  verlet_.archive(a, g);
  bool has = !split_.empty() && kept_for_ == &g && kept_version_ == g.version();
  a(has);
  if (a.loads()) kept_for_ = nullptr, loaded_ = has;
  if (!has) return;
  auto accelerations = a.loads() ? std::vector<Point>() : flow_.kept();
  a(accelerations)(kept_time_);
  if (a.loads()) flow_.set_kept(g, accelerations);
}

void Respa::find_split(const Cloth& g, const ForcePlan& force,
                       const ConstraintPlan& constraint) {
  multiplicity_ = force.springs();
  split_ = split_springs(g, multiplicity_, constraint);
  stiff_.resize(split_.nodes.size());
  kept_for_ = &g, kept_version_ = g.version();
}

/** Take the stiff springs out of the accelerations. */
void Respa::leave_out_stiff(const Cloth& g) {
  FlatCloth& c = flow_.cloth();
  const auto add = [&](unsigned id, const Point& f) {
    c.set_acceleration(
        id, c.acceleration(id) + f / double(g.node_values()[id].mass));
  };
  for (const auto& s : split_.springs) {
    const unsigned i = split_.nodes[s.i], j = split_.nodes[s.j];
    const Point u = c.position(j) - c.position(i);
    const Point f = multiplicity_ * spring_force(u, g.edge_values()[s.edge]);
    add(i, -f), add(j, f);
  }
}

/** The nodes at stiff springs as they are after the first kick, for inner steps
 * that end after @a dt at time @a end: until then held ones go straight to
 * their place. */
void Respa::take_stiff_nodes(const Cloth& g, double end, double dt,
                             const Drag& c, const ConstraintPlan& constraint) {
  const double h = dt / inner_steps_;
  for (std::size_t k = 0; k < stiff_.size(); ++k) {
    const unsigned id = split_.nodes[k];
    const NodeData& node = g.node_values()[id];
    const DragFlow flow(c[id] / node.mass, h);
    const FlatCloth& flat = flow_.cloth();
    stiff_[k] = {
        flat.position(id), flat.velocity(id) + dt / 2 * flat.acceleration(id),
        Point(),           1 / double(node.mass),
        flow.way,          flow.decay};
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
