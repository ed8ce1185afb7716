#include "lab/methods/MollifiedImpulse.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <utility>

#include "CME212/Util.hpp"
#include "lab/fast/GraphArrays.hpp"

namespace lab {

/** Where the held nodes of the stiff springs are during a step: on a straight
 * way between their places at its start and its end. */
class StiffPlaces final : public HoldingConstraint {
 public:
  explicit StiffPlaces(StiffSplit split) : split_(std::move(split)) {}
  /** Take the places of a step of @a dt from @a t [s]. */
  void take(const Cloth& g, double t, double dt,
            const ConstraintPlan& constraint) {
    t_ = t, dt_ = dt;
    ways_.clear();
    const auto start = [this](Node n, const Place& place) {
      if (const auto k = split_.find(n.id()); k < split_.nodes.size())
        ways_.push_back({k, place.at, place.at});
    };
    std::size_t next = 0;
    const auto end = [&](Node n, const Place& place) {
      if (split_.find(n.id()) < split_.nodes.size())
        ways_[next++].to = place.at;
    };
    constraint.each_place(g, t, std::ref(start));  // nothing on the heap
    constraint.each_place(g, t + dt, std::ref(end));
  }
  void each_place(const Cloth& stiff, double t, unsigned first, unsigned last,
                  const PlaceVisitor& use) const override {
    for (const Way& w : ways_)
      if (first <= w.node && w.node < last)
        use(stiff.node(w.node),
            {w.from + (t - t_) / dt_ * (w.to - w.from), (w.to - w.from) / dt_});
  }

 private:
  struct Way {
    unsigned node;
    Point from, to;
  };
  StiffSplit split_;
  std::vector<Way> ways_;
  double t_ = 0, dt_ = 1;
};

MollifiedImpulse::MollifiedImpulse() : stage_(1, 1) {}

int MollifiedImpulse::steps(Cloth& g, const StepTimes& times, int count,
                            const ForcePlan& force,
                            const ConstraintPlan& constraint) {
  const auto version = arrays(g).version();
  const bool same = kept_for_ == &g && kept_version_ == version &&
                    multiplicity_ == force.springs() && drag_ == force.drag();
  const bool loaded = loaded_ && kept_version_ == version;
  if (!same) find_split(g, force, constraint);
  if (split_.empty()) return verlet_.steps(g, times, count, force, constraint);
  // The same time and step, however the caller rounds them.
  const double rounding = 1e-6 * times.dt;
  bool kept = (same || loaded) && std::abs(times(0) - kept_time_) <= rounding &&
              std::abs(times.dt - kept_dt_) <= rounding;
  loaded_ = false;
  kept_time_ = HUGE_VAL;  // if anything throws
  flow_.begin(g, force, true);
  int k = 0;
  do {
    one_step(g, times(k), times.dt, kept, force, constraint);
    kept = true;
  } while (++k < count && arrays(g).version() == version);
  flow_.end();
  kept_time_ = times(k - 1) + times.dt, kept_dt_ = times.dt;
  return k;
}

/** @param kept whether the accelerations at the start are */
void MollifiedImpulse::one_step(Cloth& g, double t, double dt, bool kept,
                                const ForcePlan& force,
                                const ConstraintPlan& constraint) {
  const double inner = std::ceil(dt / split_.inner_step());
  if (!(inner < 1e6))
    throw StepError(std::string(info.name) +
                    ": the stiff springs need more than a million inner steps "
                    "a step; dt = " +
                    CME212::short_text(dt) + " s");
  places_->take(g, t, dt, constraint);
  if (!kept) find_soft(t, dt);
  move_stiff(t, dt, int(inner));
  flow_.run(
      {.t = t + dt, .first_kick = dt / 2, .drift = dt, .held = &constraint});
  FlatCloth& flat = flow_.cloth();
  for (Node n : stiff_.nodes()) {
    flat.set_position(split_.nodes[n.id()], n.position());
    flat.set_velocity(split_.nodes[n.id()], n.value().vel);
  }
  flow_.run({.t = t + dt, .project = &constraint});
  if (arrays(g).version() != kept_version_) {
    find_split(g, force, constraint);
    places_->take(g, t + dt, dt, constraint);
  }
  find_soft(t + dt, dt);
  flow_.run({.t = t + dt, .first_kick = dt / 2, .last = &constraint});
}

/** Half a kick and @a count inner steps of the nodes of stiff_. */
void MollifiedImpulse::move_stiff(double t, double dt, int count) {
  const FlatCloth& flat = flow_.cloth();
  for (Node n : stiff_.nodes()) {
    const unsigned id = split_.nodes[n.id()];
    n.position() = flat.position(id);
    n.value().vel = flat.velocity(id) + dt / 2 * flat.acceleration(id);
  }
  inner_.restart();
  constexpr int at_once = 256;
  StepTimes times = {t, dt / count};
  for (int left = count; left > 0;) {
    const int some = std::min(left, at_once);
    inner_.steps(stiff_, times, some, stiff_force_, held_);
    times.done += some, left -= some;
  }
  inner_done_ += count;
}

/** Keep the accelerations by the soft forces at the averaged positions,
 * filtered. */
void MollifiedImpulse::find_soft(double t, double dt) {
  if (split_.empty()) return flow_.run({.t = t, .kick = 0, .keep = true});
  FlatCloth& flat = flow_.cloth();
  const double ss = dt * dt / 4;
  const auto x = arrays(stiff_).positions();
  for (unsigned k = 0; k < x.size(); ++k) x[k] = flat.position(split_.nodes[k]);
  at_.assign(x.begin(), x.end());
  stage_.begin(info.name, t, dt, stiff_, springs_, held_).factorize(dt / 2);
  find_stiff();
  for (Point& f : f_) f *= ss;
  stage_.solve_factored(f_);
  for (unsigned k = 0; k < x.size(); ++k) {
    x[k] += f_[k];
    flat.set_position(split_.nodes[k], x[k]);
  }
  flow_.run({.t = t, .kick = 0, .keep = true});
  find_stiff();
  for (unsigned k = 0; k < x.size(); ++k)
    f_[k] = double(arrays(stiff_).node_values()[k].mass) *
                flat.acceleration(split_.nodes[k]) -
            f_[k];
  stage_.solve_factored(f_);
  for (unsigned k = 0; k < x.size(); ++k) {
    flat.set_position(split_.nodes[k], at_[k]);
    flat.set_acceleration(split_.nodes[k], f_[k]);
  }
}

/** f_ = the forces of the stiff springs. */
void MollifiedImpulse::find_stiff() {
  const auto x = arrays(stiff_).positions();
  f_.assign(x.size(), Point());
  for (Edge e : stiff_.edges()) {
    const unsigned i = e.node1().id(), j = e.node2().id();
    const Point f = spring_force(x[j] - x[i], e.value());
    f_[i] += f, f_[j] -= f;
  }
}

Work MollifiedImpulse::work() const {
  Work w = stage_.work();
  w.inner = inner_done_;
  return w;
}

void MollifiedImpulse::archive(Archive& a, const Cloth& g) {
  verlet_.archive(a, g);
  bool has = !split_.empty() && kept_for_ == &g &&
             kept_version_ == arrays(g).version();
  a(has);
  if (a.loads())
    kept_for_ = nullptr, loaded_ = has, kept_version_ = arrays(g).version();
  if (!has) return;
  flow_.archive_kept(a, g);
  a(kept_time_)(kept_dt_);
}

void MollifiedImpulse::find_split(const Cloth& g, const ForcePlan& force,
                                  const ConstraintPlan& constraint) {
  multiplicity_ = force.springs(), drag_ = force.drag();
  split_ = split_springs(g, multiplicity_, constraint);
  kept_for_ = &g, kept_version_ = arrays(g).version();
  stiff_.clear();
  std::vector<double> c;
  for (unsigned id : split_.nodes) {
    stiff_.add_node(arrays(g).positions()[id], arrays(g).node_values()[id]);
    c.push_back(drag_[id]);
  }
  for (const auto& s : split_.springs) {
    EdgeData value = arrays(g).edge_values()[s.edge];
    value.K *= multiplicity_;
    stiff_.add_edge(stiff_.node(s.i), stiff_.node(s.j), value);
  }
  stiff_force_ = make_combined_force(MassSpringForce(), NodeDrag(c));
  places_ = std::make_shared<StiffPlaces>(split_);
  held_ = *places_;
}

}  // namespace lab
