#pragma once
/** @file SelfCollision.hpp
 * Cloth that does not pass through itself: nodes that no edge connects keep a
 * distance, the thickness. */
#include <algorithm>
#include <array>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "lab/fast/ConstraintPlan.hpp"

namespace lab {

/** The nodes of a cloth by cubic cells of space: finds who is near whom without
 * looking at all pairs. The cells are kept in a hash table of flat arrays,
 * filled by a counting sort. Source: M. Teschner, B. Heidelberger, M. Mueller,
 * D. Pomeranets, M. Gross, Vision, Modeling, Visualization 2003, 47-54. */
class CellTable {
 public:
  /** Take the nodes of @a g where they are now, in cells of this @a side [m].
   * Left out: nodes whose position is not finite, or so far out, 2^50 sides,
   * that round-off is no smaller than what is looked for.
   * O(N); allocates only if there are more nodes than ever before.
   * @pre side > 0 */
  void fill(const Cloth& g, double side);

  /** Call @a use(i, j), i != j, for the ids of each pair of nodes that lie in
   * one cell or in cells that touch; so for all that are no farther apart than
   * the side. Also for few others, and for few pairs twice, where the hash of
   * two cells is the same. The order depends on the nodes' places and ids only.
   * @return the number of calls: O(N) where few nodes share a cell */
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

/** The smallest distance [m] of two nodes that share no edge, if that is less
 * than @a up_to [m]; infinity if not. A SelfCollision needs it to be at least
 * its thickness at the start, or it begins with a jump.
 * @pre up_to > 0, finite
 * Complexity: O(N) if few nodes lie within a cube of side up_to. */
double nearest_unconnected(const Cloth& g, double up_to);

/** Other constraints, and a thickness of the cloth.
 * @post of @a others; and no two nodes that share no edge are nearer to each
 * other than the thickness.
 *
 * Two nodes that are nearer are pushed apart along the line between them, each
 * by its share of the inverse masses, so that their center of mass stays;
 * contact::kick() changes their relative velocity, in the same shares. So
 * momentum stays the same, and kinetic energy never grows. Held nodes are
 * not pushed. The pairs are projected one after the other,
 * then the others are called, and so on, round by round, until no pair is too
 * near.
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
class SelfCollision : public ForwardingConstraint {
 public:
  static constexpr int max_rounds = 200;

  /** @param thickness [m], > 0. Less than any two unconnected nodes of the
   * cloth at rest are apart: on a grid of squares that is their diagonal, or
   * two sides if there are springs along the diagonals.
   * @param friction coefficient, >= 0   @param others called first */
  SelfCollision(double thickness, double friction, ConstraintPlan others)
      : ForwardingConstraint(std::move(others)),
        thickness_(thickness),
        friction_(friction) {
    assert(thickness > 0 && friction >= 0);
  }

  /** Throws StepError if max_rounds do not do, or if two held nodes are too
   * near. */
  void operator()(Cloth& g, double t) const override;
  /** How often the last call went over the pairs that are near; once if none
   * was too near. */
  int rounds() const { return rounds_; }

  bool nodewise() const override { return false; }

 private:
  struct Pair {
    unsigned i, j;
  };
  double thickness_, friction_;
  mutable CellTable cells_;
  mutable std::vector<char> held_;  // by node id
  mutable std::vector<Pair> near_;  // by node ids; no edge between them
  mutable int rounds_ = 0;

  void gather_near_pairs(const Cloth& g) const;
  bool project_pairs(Cloth& g) const;
  void push_apart(Cloth& g, unsigned i, unsigned j) const;
};

}  // namespace lab
