#pragma once
/** @file SelfCollision.hpp
 * Cloth that does not pass through itself: nodes that no edge connects keep a
 * distance, the thickness. */
#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "lab/scenes/Obstacle.hpp"

namespace lab {

/** The nodes of a cloth by cells of space, cubes: so who is near whom can be
 * found without looking at all pairs. The cells are kept in a hash table of
 * flat arrays, filled by a counting sort. Source: M. Teschner, B. Heidelberger,
 * M. Mueller, D. Pomeranets, M. Gross, Vision, Modeling, Visualization 2003,
 * 47-54. */
class CellTable {
 public:
  /** Take the nodes of @a g where they are now, in cells of this @a side [m].
   * Left out: nodes whose position is not finite, or so far out, 2^50 sides,
   * that round-off is no smaller than what is looked for.
   * O(N); allocates only if there are more nodes than ever before.
   * @pre side > 0 */
  void fill(const Cloth& g, double side) {
    assert(side > 0);
    const auto x = g.positions();
    const unsigned bits = std::bit_width(2 * g.node_slots() + 1);
    shift_ = 64 - bits;
    placed_.clear();
    placed_.reserve(g.node_slots());
    start_.assign((std::size_t(1) << bits) + 1, 0);
    for (unsigned i = 0; i < g.node_slots(); ++i) {
      if (!g.node_in_use(i)) continue;
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
    // Each bucket's entry is its end now, and runs down to its start.
    node_.resize(placed_.size());
    for (std::size_t k = placed_.size(); k-- > 0;)
      node_[--start_[bucket(placed_[k].key)]] = placed_[k].node;
  }

  /** Call @a use(i, j), i != j, for the ids of each pair of nodes that lie in
   * one cell or in cells that touch; so for all that are no farther apart than
   * the side. Also for few others, and for few pairs twice, where the hash of
   * two cells is the same. The order depends on the nodes' places and ids only.
   * @return how many calls that were: O(N) where few nodes share a cell */
  template <typename Use>
  long long each_near_pair(Use use) const {
    // Of the rows of three cells around a node, its own, and of two opposite
    // ones one: from the other one the pair is seen, too.
    const std::array<std::uint64_t, 5> row = {
        0, key_of(0, 1, 0), key_of(0, -1, 1), key_of(0, 0, 1), key_of(0, 1, 1)};
    const std::size_t last = start_.size() - 2;  // bucket
    long long calls = 0;
    for (const auto& [key, i] : placed_)
      for (std::size_t k = 0; k < row.size(); ++k) {
        auto visit = [&, i = i](std::size_t first_bucket, std::size_t count) {
          const unsigned end = start_[first_bucket + count];
          for (unsigned at = start_[first_bucket]; at < end; ++at) {
            const unsigned j = node_[at];
            if (k == 0 ? j <= i : j == i) continue;
            ++calls;
            use(i, j);
          }
        };
        const std::size_t b = bucket(key + row[k]);
        if (b > 0 && b < last) {
          visit(b - 1, 3);
        } else {  // the last bucket's neighbor is the first
          visit(std::min(b, last - 1), 2);
          visit(b == 0 ? last : 0, 1);
        }
      }
    return calls;
  }

 private:
  struct Placed {
    std::uint64_t key;
    unsigned node;
  };
  std::vector<Placed> placed_;   // by id of the node
  std::vector<unsigned> start_;  // by bucket: where it starts in node_
  std::vector<unsigned> node_;   // ids, by bucket
  unsigned shift_ = 63;

  /** Of a cell. The first bits of it are its bucket. A sum, so that the key of
   * a neighbor is a constant away; cells in a row along x are in buckets in a
   * row; and rows are spread by multiples of irrational parts of the whole,
   * which fill it evenly whatever the distance of the rows.
   * The parts, 1/p and 1/p^2 with p^3 = p + 1, are those of M. Roberts, "The
   * unreasonable effectiveness of quasirandom sequences" (2018). */
  std::uint64_t key_of(std::int64_t x, std::int64_t y, std::int64_t z) const {
    return (std::uint64_t(x) << shift_) +
           std::uint64_t(y) * 0xc13fa9a902a6328f +
           std::uint64_t(z) * 0x91e10da5c79e7b1d;
  }
  std::size_t bucket(std::uint64_t key) const { return key >> shift_; }
};

namespace self_collision_detail {

inline bool connected(const Cloth& g, unsigned i, unsigned j) {
  const auto halves = g.halves(i);
  return std::any_of(halves.begin(), halves.end(),
                     [j](const Cloth::Half& h) { return h.node == j; });
}

}  // namespace self_collision_detail

/** The smallest distance [m] of two nodes that share no edge, if that is less
 * than @a up_to [m]; infinity if not. A SelfCollision needs it to be at least
 * its thickness at the start, or it begins with a jump.
 * @pre up_to > 0, finite
 * Complexity: O(N) if few nodes lie within a cube of side up_to. */
inline double nearest_unconnected(const Cloth& g, double up_to) {
  CellTable cells;
  cells.fill(g, up_to);
  const auto x = g.positions();
  double least = std::numeric_limits<double>::infinity();
  cells.each_near_pair([&](unsigned i, unsigned j) {
    const double distance = norm(x[i] - x[j]);
    if (distance < std::min(least, up_to) &&
        !self_collision_detail::connected(g, i, j))
      least = distance;
  });
  return least;
}

/** Other constraints, and a thickness of the cloth.
 * @post of @a others; and no two nodes that share no edge are nearer to each
 * other than the thickness.
 *
 * Two nodes that are nearer are pushed apart along the line between them, each
 * by its part of the inverse masses, so that their center of mass stays; and
 * contact::kick() changes their relative velocity, in the
 * same parts. So momentum stays the same, and kinetic energy never grows. Held
 * nodes do not move, and count as standing. Pairs are mended one after the
 * other, then the others have their way, and so on, round by round, until no
 * pair is too near.
 *
 * It is nodes that collide. A mesh lets nodes through where its openings are
 * wider: squares of side L are closed by a thickness of L/sqrt(2) or more. And
 * nodes must come nearer by less than the thickness in a step, or they may
 * pass through each other.
 *
 * Complexity of a call: O(N) where few nodes lie within a cube of the side of
 * the thickness; for each round more, a call of the others and O(pairs that are
 * near). Two layers that lie on each other node on node need two or three
 * rounds; some that lie in the gaps of each other ten to thirty. It allocates
 * when there are more nodes, or more pairs near, than ever before.
 * By one thread, so results do not depend on their number. */
class SelfCollision : public SweptConstraint {
 public:
  static constexpr int max_rounds = 200;

  /** @param thickness [m], > 0. Less than any two unconnected nodes of the
   * cloth at rest are apart: on a grid of squares that is their diagonal, or
   * two sides if there are springs along the diagonals.
   * @param friction coefficient, >= 0   @param others called first */
  SelfCollision(double thickness, double friction, ConstraintPlan others)
      : thickness_(thickness), friction_(friction), others_(std::move(others)) {
    assert(thickness > 0 && friction >= 0);
  }

  /** Throws StepError if max_rounds do not do, or if two held nodes are too
   * near. */
  void operator()(Cloth& g, double t) const override {
    others_(g, t);
    rounds_ = 0;
    for (;;) {
      list_near_pairs(g);
      if (!mend_pairs(g)) return;
      int left = list_rounds;
      do others_(g, t);
      while (--left > 0 && mend_pairs(g));
    }
  }
  /** How often the last call went over the pairs that are near; once if none
   * was too near. */
  int rounds() const { return rounds_; }

  void each_held(const Cloth& g, const NodeVisitor& use) const override {
    others_.each_held(g, use);
  }
  std::optional<Point> first_hit(const Point& from,
                                 const Point& to) const override {
    return others_.first_hit(from, to);
  }
  double thinnest() const override { return others_.thinnest(); }

 private:
  // Pushed so much farther than needed, nodes in a pile come to rest within a
  // few rounds; else each would approach the thickness but never reach it.
  static constexpr double margin = 1e-3;
  // Pairs up to so many times the thickness apart are listed: those that may
  // get too near in rounds to come.
  static constexpr double reach = 1.1;
  static constexpr int list_rounds = 8;  // with one list, then a new one

  struct Pair {
    unsigned i, j;
  };
  double thickness_, friction_;
  ConstraintPlan others_;
  mutable CellTable cells_;
  mutable std::vector<char> held_;  // by node id
  mutable std::vector<Pair> near_;  // by node ids; no edge between them
  mutable int rounds_ = 0;

  void list_near_pairs(const Cloth& g) const {
    held_.assign(g.node_slots(), false);
    others_.each_held(g, [this](Node n) { held_[n.id()] = true; });
    near_.clear();
    const double most = reach * thickness_;
    cells_.fill(g, most);
    const auto x = g.positions();
    cells_.each_near_pair([&](unsigned i, unsigned j) {
      if (normSq(x[i] - x[j]) < most * most &&
          !self_collision_detail::connected(g, i, j))
        near_.push_back({i, j});
    });
  }

  /** Push apart all listed pairs that are too near.
   * @return false if none was  Throws StepError after max_rounds. */
  bool mend_pairs(Cloth& g) const {
    const auto x = g.positions();
    bool mended = false;
    for (const auto& [i, j] : near_)
      if (normSq(x[i] - x[j]) < thickness_ * thickness_ && g.node_in_use(i) &&
          g.node_in_use(j)) {
        push_apart(g, i, j);
        mended = true;
      }
    if (++rounds_ >= max_rounds && mended)
      throw StepError("self-collision: nodes are nearer than the thickness, " +
                      CME212::short_text(thickness_) + " m, after " +
                      std::to_string(max_rounds) + " rounds");
    return mended;
  }

  void push_apart(Cloth& g, unsigned i, unsigned j) const {
    const auto x = g.positions();
    const auto node = g.node_values();
    const double wi = held_[i] ? 0 : 1 / double(node[i].mass);
    const double wj = held_[j] ? 0 : 1 / double(node[j].mass);
    if (wi + wj == 0)
      throw StepError("self-collision: nodes " +
                      std::to_string(g.node_with_id(i).index()) + " and " +
                      std::to_string(g.node_with_id(j).index()) +
                      " are held, nearer than the thickness, " +
                      CME212::short_text(thickness_) + " m");
    const Point apart = x[i] - x[j];
    const double distance = norm(apart);
    const Point out = distance > 0 ? apart / distance : Point(0, 0, 1);
    const Point way = ((1 + margin) * thickness_ - distance) * out;
    const Point kick = contact::kick(node[i].vel - node[j].vel, out, friction_);
    const double part_i = wi / (wi + wj), part_j = wj / (wi + wj);
    x[i] += part_i * way;
    x[j] -= part_j * way;
    node[i].vel += part_i * kick;
    node[j].vel -= part_j * kick;
  }
};

}  // namespace lab
