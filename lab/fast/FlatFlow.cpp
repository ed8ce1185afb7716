#include "lab/fast/FlatFlow.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <stdexcept>
#include <utility>

#include "lab/fast/GraphArrays.hpp"
#include "lab/fast/Sweep.hpp"

namespace lab {

namespace {

/** Call @a use(h) for those of @a all, sorted, with an id in [first, last). */
template <typename Held, typename Use>
void for_part(const std::vector<Held>& all, unsigned first, unsigned last,
              Use use) {
  auto h = std::ranges::lower_bound(all, first, {}, &Held::id);
  for (; h != all.end() && h->id < last; ++h) use(*h);
}

}  // namespace

void FlatFlow::begin(Cloth& g, const ForcePlan& force, bool exact) {
  g_ = &g, force_ = &force, exact_ = exact;
  by_graph_ = force.has_others();
  cloth_.take(g, force.springs(), force.drag());
  prepare();
}

/** What depends on the topology, and the drag of the nodes. */
void FlatFlow::prepare() {
  drag_.clear(), num_drifts_ = 0;
  if (exact_ && !force_->drag().none()) find_drag();
  const std::size_t needed = Sweep::threads() * group;
  if (version_ == cloth_.version() && rings_.size() >= needed) return;
  version_ = cloth_.version();
  rings_.resize(std::max(rings_.size(), needed));
  constexpr unsigned tile = FlatCloth::tile;
  for (Rings& r : rings_) {
    r.rings.clear();
    const auto& rows = cloth_.rows();  // by offset
    const std::size_t stride =
        rows.empty() ? 0 : (rows.back().offset + 3 * tile - 1) / tile * tile;
    r.numbers.resize(3 * rows.size() * stride);
    double* at = r.numbers.data();
    for (const auto& row : rows) {
      const unsigned size = (row.offset + 2 * tile - 1) / tile * tile;
      r.rings.push_back({row.offset, size, 0, cloth_.K() + row.first,
                         cloth_.L() + row.first, at, stride});
      at += 3 * stride;
    }
    r.others.resize(Sweep::part_size);
  }
}

void FlatFlow::find_drag() {
  const NodeData* node = arrays(*g_).node_values().data();
  const Drag& c = force_->drag();
  for (unsigned i = 0; i < cloth_.slots(); ++i) {
    const double gamma = c[i] / node[i].mass;
    if (drag_.empty() || !DragFlow::is_same(gamma, drag_.back().gamma))
      drag_.push_back({i, gamma});
    drag_.back().last = i + 1;
  }
}

const FlatFlow::Drift& FlatFlow::drift_by(double time) {
  for (std::size_t k = 0; k < num_drifts_; ++k)
    if (drifts_[k].time == time) return drifts_[k];
  if (num_drifts_ == drifts_.size()) drifts_.emplace_back();
  Drift& made = drifts_[num_drifts_++];
  made.time = time, made.of_run.clear();
  for (const DragRun& run : drag_) made.of_run.emplace_back(run.gamma, time);
  return made;
}

void FlatFlow::prepare(Level& level, const FlatStage& stage) {
  level.stage = stage;
  level.drift =
      stage.drift && !drag_.empty() ? &drift_by(*stage.drift) : nullptr;
  const auto list = [&](const ConstraintPlan* of, auto value,
                        std::vector<Held>& all) {
    all.clear();
    const auto add = [&](Node n, const Place& place) {
      all.push_back({n.id(), all.size(), value(place)});
    };
    if (of) of->each_place(*g_, stage.t, std::ref(add));
    std::ranges::sort(all, [](const Held& a, const Held& b) {
      return std::pair(a.id, a.order) < std::pair(b.id, b.order);
    });
  };
  list(
      stage.held, [](const Place& p) { return p.at; }, level.held);
  list(
      stage.held_move ? stage.held : stage.last,
      [](const Place& p) { return p.velocity; }, level.ended);
}

std::size_t FlatFlow::run(std::span<const FlatStage> stages) {
  const auto version = arrays(*g_).version();
  if (may_overlap(stages)) {
    if (levels_.size() < stages.size()) levels_.resize(stages.size());
    for (std::size_t k = 0; k < stages.size(); ++k)
      prepare(levels_[k], stages[k]);
    if (run_overlapping(stages)) {
      for (const FlatStage& s : stages)
        if (s.kick) force_->count_evaluation();
      return stages.size();
    }
  }
  if (levels_.empty()) levels_.resize(1);
  for (std::size_t k = 0; k < stages.size(); ++k) {
    prepare(levels_[0], stages[k]);
    run_alone(levels_[0]);
    if (stages[k].last && arrays(*g_).version() != version) return k + 1;
  }
  return stages.size();
}

/** Whether stages may overlap, as far as is known in advance. */
bool FlatFlow::may_overlap(std::span<const FlatStage> stages) {
  if (stages.size() < 2 || cloth_.slots() <= Sweep::part_size || by_graph_)
    return false;
  return waiting_ == 0 || --waiting_ == 0;
}

void FlatFlow::run_alone(Level& level) {
  const FlatStage& stage = level.stage;
  for (Rings& r : rings_) r.next = std::numeric_limits<unsigned>::max();
  if (stage.kick) force_->count_evaluation();
  const bool by_part = !stage.project || stage.project->nodewise();
  const auto move_part = [&](unsigned a, unsigned b) {
    move(level, a, b, by_part);
  };
  const auto kick_part = [&](unsigned a, unsigned b) {
    kick(level, rings_[Sweep::thread()], a, b);
  };
  const auto nothing = [](unsigned, unsigned) {};
  const auto go = [&](int halo, const Sweep::IdVisitor& first,
                      const Sweep::IdVisitor& then) {
    Sweep::in_turn(cloth_.slots(), halo, first, then);
  };
  if (!by_part) {
    go(0, std::ref(move_part), nothing);
    stage.project->apply(cloth_, *g_, stage.t);
    if (version_ != cloth_.version()) {
      prepare();
      prepare(level, FlatStage(stage));
    }
    if (by_graph_ && stage.kick) cloth_.write(*g_);
    go(0, nothing, std::ref(kick_part));
  } else {
    go(stage.kick ? Sweep::halo_of(*force_, cloth_.reach()) : 0,
       std::ref(move_part), std::ref(kick_part));
  }
}

/** Run @a stages, whose levels are prepared, with overlap. The threads take
 * groups of stages in turn; each group follows the one before, part by part.
 * @return false if a constraint needs all nodes at once. Then the state is as
 * before, and the next batches, more each time, run without overlap */
bool FlatFlow::run_overlapping(std::span<const FlatStage> stages) {
  const bool sure = std::ranges::all_of(stages, [](const FlatStage& s) {
    return !s.project || s.project->nodewise();
  });
  if (!sure) cloth_.save(before_);
  const std::size_t count = stages.size(), groups = (count + group - 1) / group;
  if (done_.size() < groups) done_ = std::vector<std::atomic<int>>(groups);
  for (auto& d : done_) d = 0;
  Sweep::FirstError error;
  std::atomic<bool> good = true;
  const auto work = [&](int thread, int threads) {
    Rings* rings = &rings_[std::size_t(thread) * group];
    try {
      for (auto k = std::size_t(thread); k < groups && good;
           k += std::size_t(threads))
        run_group(std::span(levels_).subspan(
                      k * group, std::min(count - k * group, group)),
                  rings, k > 0 ? &done_[k - 1] : nullptr, done_[k], good);
    } catch (...) {
      error.keep();
      good = false;
    }
    if (good) return;
    for (auto& d : done_) d = std::numeric_limits<int>::max();  // none waits
  };
  Sweep::together(cloth_.slots(), std::ref(work));
  error.rethrow();
  if (good) {
    wait_ = 1;
    return true;
  }
  cloth_.restore(before_);
  waiting_ = wait_;
  wait_ = std::min(2 * wait_, longest_wait);
  return false;
}

/** Run the levels of a group, each `lag` parts behind the one before.
 * @param before parts that the group before has finished; null: no such group
 * @param done parts that this group has finished
 * @param good set to false by any group that can't continue; then all stop */
void FlatFlow::run_group(std::span<Level> levels, Rings* rings,
                         const std::atomic<int>* before, std::atomic<int>& done,
                         std::atomic<bool>& good) {
  constexpr unsigned size = Sweep::part_size;
  const unsigned slots = cloth_.slots();
  const int parts = int((slots + size - 1) / size);
  const auto last = [&](int part) {
    return std::min(unsigned(part + 1) * size, slots);
  };
  // A kick reads positions halo parts ahead, and behind, too, for springs that
  // are in no row. The next stage must not have moved these nodes yet.
  const int halo = Sweep::halo_of(*force_, cloth_.reach());
  const int lag = cloth_.rest() ? 2 * halo : halo;
  const int count = int(levels.size());
  for (int k = 0; k < count; ++k)
    rings[k].next = std::numeric_limits<unsigned>::max();
  for (int p = 0; p < parts + (count - 1) * lag; ++p)
    for (int k = 0; k < count; ++k) {
      const int part = p - k * lag;
      if (part < 0 || part >= parts) continue;
      if (k == 0 && before)
        Sweep::await(*before, std::min(part + lag + 1, parts));
      for (int m = part == 0 ? 0 : part + halo;
           m <= std::min(part + halo, parts - 1); ++m)
        if (!move(levels[k], unsigned(m) * size, last(m), true)) good = false;
      if (!good) return;
      kick(levels[k], rings[k], unsigned(part) * size, last(part));
      if (k == count - 1) done.store(part + 1, std::memory_order_release);
    }
}

/** The operations of a stage before its forces, on one part.
 * @param project whether to apply the constraint to the part
 * @return false if that is impossible; then the cloth is undefined */
bool FlatFlow::move(const Level& level, unsigned first, unsigned last,
                    bool project) {
  const FlatStage& stage = level.stage;
  const auto drift = [&](unsigned from, unsigned to, double way, double decay) {
    lanes::run<kernels::DriftNodes>(&cloth_, from, to, stage.first_kick, way,
                                    decay);
  };
  if (stage.sum) {
    lanes::run<kernels::SumTiles>(&cloth_, stage.sum, first, last);
  } else if (level.drift) {
    auto run = std::ranges::upper_bound(drag_, first, {}, &DragRun::last);
    for (unsigned i = first; i < last; ++run) {
      const unsigned end = std::min(run->last, last);
      const auto& by = level.drift->of_run[std::size_t(run - drag_.begin())];
      drift(i, end, by.way, by.decay);
      i = end;
    }
  } else if (stage.drift || stage.first_kick != 0) {
    drift(first, last, stage.drift.value_or(0), 1);
  }
  for_part(level.held, first, last, [this](const Held& h) {
    cloth_.set_position(h.id, h.value);
    cloth_.set_velocity(h.id, Point());
  });
  if (stage.held_move) set_velocities(level, first, last);
  const bool good =
      !project || !stage.project ||
      stage.project->apply_to_part(cloth_, *g_, stage.t, first, last);
  if (by_graph_) cloth_.write(*g_, first, last);
  return good;
}

/** The forces of a stage, its kick, and the end of a step. */
void FlatFlow::kick(const Level& level, Rings& mine, unsigned first,
                    unsigned last) {
  const FlatStage& stage = level.stage;
  if (stage.kick) {
    if (mine.next != first) find_rings(mine, first);
    mine.next = last;
    if (by_graph_) {
      std::ranges::fill(mine.others, Point());
      force_->add_others({*g_, first, last}, stage.t, mine.others);
    }
    const kernels::KickTask task = {
        cloth_,
        mine.rings.data(),
        force_->springs() > 0 ? mine.rings.size() : 0,
        by_graph_ ? mine.others.data() : nullptr,
        !exact_ && !force_->drag().none(),
        stage.keep ? cloth_.nodes()[stage.keep_in] : nullptr,
        force_->gravity().a,
        *stage.kick};
    lanes::run<kernels::KickTiles>(task, first, last);
  }
  set_velocities(level, first, last);
}

/** Set velocities of held nodes, if they move or at the end of a step. */
void FlatFlow::set_velocities(const Level& level, unsigned first,
                              unsigned last) {
  for_part(level.ended, first, last,
           [this](const Held& h) { cloth_.set_velocity(h.id, h.value); });
}

/** Fill the rings for a part that begins with id @a first: with the springs of
 * the nodes before it from which a spring may reach into it. */
void FlatFlow::find_rings(Rings& r, unsigned first) {
  constexpr unsigned tile = FlatCloth::tile;
  for (auto& ring : r.rings) {
    ring.at = 0;
    for (int c = 0; c < 3; ++c) {  // no node has an id below 0
      double* end = ring.kept + c * ring.stride + ring.size;
      std::fill(end - ring.offset, end, 0);
    }
    const unsigned before = (ring.offset + tile - 1) / tile * tile;
    lanes::run<kernels::NearTiles>(&cloth_, &ring,
                                   first - std::min(before, first), first);
  }
}

void FlatFlow::end() { cloth_.write(*g_); }

void FlatFlow::archive_kept(Archive& a, const Cloth& g, unsigned x) {
  std::vector<Point> all;
  for (unsigned i = 0; !a.loads() && i < cloth_.slots(); ++i)
    all.push_back(cloth_.point(x, i));
  a(all);
  if (!a.loads()) return;
  const Drag none;
  cloth_.take(g, 0, none);
  if (all.size() != cloth_.slots() ||
      !std::ranges::all_of(all, [](auto& p) { return std::isfinite(norm(p)); }))
    throw std::runtime_error("holds no accelerations of this cloth");
  for (unsigned i = 0; i < all.size(); ++i) cloth_.set(x, i, all[i]);
}

}  // namespace lab
