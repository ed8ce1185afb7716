#include "lab/methods/FlatFlow.hpp"

#include <algorithm>
#include <functional>
#include <limits>
#include <utility>

#include "lab/fast/Sweep.hpp"

namespace lab {

void FlatFlow::begin(Cloth& g, const ForcePlan& force, bool exact) {
  g_ = &g, force_ = &force, exact_ = exact;
  by_graph_ = force.has_others();
  cloth_.take(g, force.springs(), force.drag());
  prepare();
}

/** What depends on the topology, and the drag of the nodes. */
void FlatFlow::prepare() {
  drag_.clear();
  if (exact_ && !force_->drag().none()) find_drag();
  if (version_ == cloth_.version() && rings_.size() >= Sweep::threads()) return;
  version_ = cloth_.version();
  rings_.resize(std::max(rings_.size(), Sweep::threads()));
  constexpr unsigned tile = FlatCloth::tile;
  for (Rings& r : rings_) {
    r.rings.clear();
    std::size_t all = 0;
    for (const auto& row : cloth_.rows()) {
      const unsigned size = (row.offset + 2 * tile - 1) / tile * tile;
      r.rings.push_back({row.offset, size, 0, cloth_.K() + row.first,
                         cloth_.L() + row.first, nullptr});
      all += 3 * r.rings.back().stride();
    }
    r.numbers.resize(all);
    Real* at = r.numbers.data();
    for (auto& ring : r.rings) ring.kept = at, at += 3 * ring.stride();
    r.others.resize(Sweep::part_size);
  }
}

void FlatFlow::find_drag() {
  const NodeData* node = g_->node_values().data();
  const Drag& c = force_->drag();
  for (unsigned i = 0; i < cloth_.slots(); ++i) {
    const double gamma = c[i] / node[i].mass;
    if (drag_.empty() || !DragFlow::is_same(gamma, drag_.back().gamma))
      drag_.push_back({i, gamma});
    drag_.back().last = i + 1;
  }
}

void FlatFlow::run(const FlatStage& stage) {
  stage_ = stage;
  if (stage.drift)
    for (DragRun& run : drag_) {
      const DragFlow flow(run.gamma, *stage.drift);
      run.way = Real(flow.way), run.decay = Real(flow.decay);
    }
  held_.clear();
  const auto take_place = [this](Node n, const Place& place) {
    held_.push_back({n.id(), held_.size(), place.at});
  };
  if (stage.held) stage.held->each_place(*g_, stage.t, std::ref(take_place));
  std::ranges::sort(held_, [](const Held& a, const Held& b) {
    return std::pair(a.id, a.order) < std::pair(b.id, b.order);
  });
  for (Rings& r : rings_) r.next = std::numeric_limits<unsigned>::max();
  if (stage.kick) force_->begin(stage.t);
  const auto move_part = [this](unsigned a, unsigned b) { move(a, b); };
  const auto kick_part = [this](unsigned a, unsigned b) { kick(a, b); };
  const auto nothing = [](unsigned, unsigned) {};
  const auto go = [&](int halo, const Sweep::IdVisitor& first,
                      const Sweep::IdVisitor& then) {
    Sweep::in_turn(cloth_.slots(), halo, first, then);
  };
  if (stage.project && !stage.project->nodewise()) {
    go(0, std::ref(move_part), nothing);
    stage.project->apply_flat(cloth_, *g_, stage.t);
    if (version_ != cloth_.version()) prepare();
    if (by_graph_ && stage.kick) cloth_.write(*g_);
    if (stage.kick) go(0, nothing, std::ref(kick_part));
  } else if (stage.kick) {
    go(Sweep::halo_of(*force_, cloth_.reach()), std::ref(move_part),
       std::ref(kick_part));
  } else {
    go(0, std::ref(move_part), nothing);
  }
}

/** All of a stage but its forces. */
void FlatFlow::move(unsigned first, unsigned last) {
  const auto drift = [&](unsigned from, unsigned to, Real way, Real decay) {
    lanes::run<kernels::DriftNodes>(&cloth_, from, to, Real(stage_->first_kick),
                                    way, decay);
  };
  if (stage_->drift && drag_.empty()) {
    drift(first, last, Real(*stage_->drift), Real(1));
  } else if (stage_->drift) {
    auto run = std::ranges::upper_bound(drag_, first, {}, &DragRun::last);
    for (unsigned i = first; i < last; ++run) {
      const unsigned end = std::min(run->last, last);
      drift(i, end, run->way, run->decay);
      i = end;
    }
  }
  auto held = std::ranges::lower_bound(held_, first, {}, &Held::id);
  for (; held != held_.end() && held->id < last; ++held) {
    cloth_.set_position(held->id, held->at);
    cloth_.set_velocity(held->id, Point());
  }
  if (stage_->project && stage_->project->nodewise())
    stage_->project->project_flat(cloth_, *g_, stage_->t, first, last);
  if (by_graph_) cloth_.write(*g_, first, last);
}

/** The forces of a stage, and its kick. */
void FlatFlow::kick(unsigned first, unsigned last) {
  Rings& mine = rings_[Sweep::thread()];
  if (mine.next != first) find_rings(mine, first);
  mine.next = last;
  if (by_graph_) {
    std::ranges::fill(mine.others, Point());
    force_->add_others({*g_, nullptr, first, last}, stage_->t, mine.others);
  }
  const kernels::KickTask task = {cloth_,
                                  mine.rings.data(),
                                  force_->springs() > 0 ? mine.rings.size() : 0,
                                  by_graph_ ? mine.others.data() : nullptr,
                                  !exact_ && !force_->drag().none(),
                                  stage_->keep,
                                  Real(force_->gravity()),
                                  Real(*stage_->kick)};
  lanes::run<kernels::KickTiles>(task, first, last);
}

/** The rings as they are when a part begins with id @a first: with the springs
 * of as many nodes before it as a far end may be away. */
void FlatFlow::find_rings(Rings& r, unsigned first) {
  constexpr unsigned tile = FlatCloth::tile;
  for (auto& ring : r.rings) {
    ring.at = 0;
    for (int c = 0; c < 3; ++c) {  // no node has an id below 0
      Real* end = ring.kept + c * ring.stride() + ring.size;
      std::fill(end - ring.offset, end, Real(0));
    }
    const unsigned before = (ring.offset + tile - 1) / tile * tile;
    lanes::run<kernels::NearTiles>(&cloth_, &ring,
                                   first - std::min(before, first), first);
  }
}

void FlatFlow::set_held_velocities(const ConstraintPlan& constraint, double t) {
  constraint.each_place(*g_, t, [this](Node n, const Place& place) {
    cloth_.set_velocity(n.id(), place.velocity);
  });
}

void FlatFlow::end() { cloth_.write(*g_); }

std::vector<Point> FlatFlow::kept() const {
  std::vector<Point> a(cloth_.slots());
  for (unsigned i = 0; i < a.size(); ++i) a[i] = cloth_.acceleration(i);
  return a;
}

void FlatFlow::set_kept(const Cloth& g, const std::vector<Point>& a) {
  const Drag none;
  cloth_.take(g, 0, none);
  for (unsigned i = 0; i < a.size(); ++i) cloth_.set_acceleration(i, a[i]);
}

}  // namespace lab
