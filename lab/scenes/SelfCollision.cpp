#include "lab/scenes/SelfCollision.hpp"

#include <bit>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>

#include "CME212/Util.hpp"
#include "lab/fast/GraphArrays.hpp"
#include "lab/scenes/Contact.hpp"

namespace lab {

void CellTable::fill(const Cloth& g, double side) {
  assert(side > 0);
  const auto x = arrays(g).positions();
  const unsigned bits = std::bit_width(2 * arrays(g).node_slots() + 1);
  shift_ = 64 - bits;
  placed_.clear();
  placed_.reserve(arrays(g).node_slots());
  start_.assign((std::size_t(1) << bits) + 1, 0);
  for (unsigned i = 0; i < arrays(g).node_slots(); ++i) {
    if (!arrays(g).node_in_use(i)) continue;
    const double cell[3] = {std::floor(x[i].x / side),
                            std::floor(x[i].y / side),
                            std::floor(x[i].z / side)};
    auto is_near = [](double c) { return std::abs(c) < 0x1p50; };
    if (!std::all_of(cell, cell + 3, is_near)) continue;
    const std::uint64_t key = key_of(
        std::int64_t(cell[0]), std::int64_t(cell[1]), std::int64_t(cell[2]));
    placed_.push_back({key, i});
    ++start_[bucket(key)];
  }
  std::partial_sum(start_.begin(), start_.end(), start_.begin());
  // Each bucket's entry is its end now; the loop lowers it to its start.
  node_.resize(placed_.size());
  for (std::size_t k = placed_.size(); k-- > 0;)
    node_[--start_[bucket(placed_[k].key)]] = placed_[k].node;
}

namespace {

bool connected(const Cloth& g, unsigned i, unsigned j) {
  const auto all = arrays(g).neighbors(i);
  return std::any_of(
      all.begin(), all.end(),
      [j](const GraphArrays<Cloth>::Neighbor& n) { return n.node == j; });
}

// Pairs are pushed by this share farther than needed. Otherwise distances in a
// pile would approach the thickness round by round but never reach it.
constexpr double margin = 1e-3;
// Pairs up to this many times the thickness apart are gathered, because they
// may become too near in the next rounds.
constexpr double reach = 1.1;
constexpr int rounds_per_gathering = 8;

}  // namespace

double nearest_unconnected(const Cloth& g, double up_to) {
  CellTable cells;
  cells.fill(g, up_to);
  const auto x = arrays(g).positions();
  double least = std::numeric_limits<double>::infinity();
  cells.each_near_pair([&](unsigned i, unsigned j) {
    const double distance = norm(x[i] - x[j]);
    if (distance < std::min(least, up_to) && !connected(g, i, j))
      least = distance;
  });
  return least;
}

void SelfCollision::operator()(Cloth& g, double t) const {
  inner_(g, t);
  rounds_ = 0;
  for (;;) {
    gather_near_pairs(g);
    if (!project_pairs(g)) return;
    int left = rounds_per_gathering;
    do inner_(g, t);
    while (--left > 0 && project_pairs(g));
  }
}

void SelfCollision::gather_near_pairs(const Cloth& g) const {
  held_.assign(arrays(g).node_slots(), false);
  inner_.each_held(g, [this](Node n) { held_[n.id()] = true; });
  near_.clear();
  const double most = reach * thickness_;
  cells_.fill(g, most);
  const auto x = arrays(g).positions();
  cells_.each_near_pair([&](unsigned i, unsigned j) {
    if (normSq(x[i] - x[j]) < most * most && !connected(g, i, j))
      near_.push_back({i, j});
  });
}

/** Push apart all gathered pairs that are too near.
 * @return false if none was  Throws StepError after max_rounds. */
bool SelfCollision::project_pairs(Cloth& g) const {
  const auto x = arrays(g).positions();
  bool pushed = false;
  for (const auto& [i, j] : near_)
    if (normSq(x[i] - x[j]) < thickness_ * thickness_ &&
        arrays(g).node_in_use(i) && arrays(g).node_in_use(j)) {
      push_apart(g, i, j);
      pushed = true;
    }
  if (++rounds_ >= max_rounds && pushed)
    throw StepError("self-collision: nodes are closer than the thickness, " +
                    CME212::short_text(thickness_) + " m, after " +
                    std::to_string(max_rounds) + " rounds");
  return pushed;
}

void SelfCollision::push_apart(Cloth& g, unsigned i, unsigned j) const {
  const auto x = arrays(g).positions();
  const auto node = arrays(g).node_values();
  const double wi = held_[i] ? 0 : 1 / double(node[i].mass);
  const double wj = held_[j] ? 0 : 1 / double(node[j].mass);
  if (wi + wj == 0)
    throw StepError("self-collision: nodes " +
                    std::to_string(arrays(g).node_with_id(i).index()) +
                    " and " +
                    std::to_string(arrays(g).node_with_id(j).index()) +
                    " are held closer than the thickness, " +
                    CME212::short_text(thickness_) + " m");
  const Point apart = x[i] - x[j];
  const double distance = norm(apart);
  const Point out = distance > 0 ? apart / distance : Point(0, 0, 1);
  const Point way = ((1 + margin) * thickness_ - distance) * out;
  const Point u = node[i].vel - node[j].vel;
  const Point kick = contact::kick(u, out, friction_);
  const double part_i = wi / (wi + wj), part_j = wj / (wi + wj);
  x[i] += part_i * way;
  x[j] -= part_j * way;
  node[i].vel += part_i * kick;
  node[j].vel -= part_j * kick;
}

}  // namespace lab
