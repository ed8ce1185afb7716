#pragma once
/** @file SelfCollision.hpp
 * Cloth that does not pass through itself: nodes that no edge connects keep a
 * distance, the thickness. */
#include <algorithm>
#include <array>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "lab/fast/ConstraintPlan.hpp"

namespace lab {

/** The nodes of a cloth, sorted into cubic cells of space: finds near pairs
 * without testing all pairs. The cells are in a hash table of flat arrays,
 * filled by a counting sort. Source: M. Teschner, B. Heidelberger, M. Mueller,
 * D. Pomeranets, M. Gross, Vision, Modeling, Visualization 2003, 47-54. */
class CellTable {
 public:
  /** Insert the nodes of @a g at their present positions, in cells of this
   * @a side [m]. Left out: nodes whose position is not finite, or beyond 2^50
   * sides, where round-off is as large as the distances to be found.
   * O(N); allocates only if there are more nodes than ever before.
   * @pre side > 0 */
  void fill(const Cloth& g, double side);

  /** Call @a use(i, j), i != j, for the ids of each pair of nodes in the same
   * cell or in adjacent cells. These include all pairs no farther apart than
   * the side. Where the hashes of two cells collide, a few other pairs come,
   * and a few come twice. The order depends only on positions and ids.
   * @return the number of calls: O(N) where few nodes share a cell */
  template <typename Use>
  long long each_near_pair(Use use) const {
    // Rows of three cells around a node: its own, and one of each two opposite
    // rows; a pair in the other row is found from the other node.
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
  std::vector<unsigned> start_;  // by bucket: its first entry in node_
  std::vector<unsigned> node_;   // ids, by bucket
  unsigned shift_ = 63;

  /** The key of a cell; its highest bits are the bucket. The key is linear, so
   * the key of a neighbor differs by a constant. Consecutive cells along x have
   * consecutive buckets; rows are spread evenly by multiples of irrational
   * fractions of the range: 1/p and 1/p^2 with p^3 = p + 1, by M. Roberts, "The
   * unreasonable effectiveness of quasirandom sequences" (2018). */
  std::uint64_t key_of(std::int64_t x, std::int64_t y, std::int64_t z) const {
    return (std::uint64_t(x) << shift_) +
           std::uint64_t(y) * 0xc13fa9a902a6328f +
           std::uint64_t(z) * 0x91e10da5c79e7b1d;
  }
  std::size_t bucket(std::uint64_t key) const { return key >> shift_; }
};

/** The smallest distance [m] of two nodes without a common edge if less than
 * @a up_to [m]; else infinity. If it is less than the thickness at the start,
 * the first step of a SelfCollision makes nodes jump.
 * @pre up_to > 0, finite
 * Complexity: O(N) if few nodes lie within a cube of side up_to. */
double nearest_unconnected(const Cloth& g, double up_to);

/** Applies other constraints, and keeps nodes a thickness apart.
 * @post that of @a others; and no two nodes without a common edge are nearer to
 * each other than the thickness.
 *
 * Two nodes that are nearer are pushed apart along the line between them, in
 * proportion to their inverse masses, so that their center of mass stays;
 * contact::kick() changes their relative velocity in the same proportion. So
 * momentum is conserved, and kinetic energy never grows. Held nodes are not
 * pushed. A round projects one pair after the other and then calls the others;
 * rounds are repeated until no pair is too near.
 *
 * Only nodes collide. They pass through wider openings of the mesh: squares of
 * side L are closed by a thickness of L/sqrt(2) or more. In a step nodes must
 * approach by less than the thickness, or they may pass through each other.
 *
 * Complexity of a call: O(N) if few nodes lie in a cube whose side is the
 * thickness; for each further round, a call of the others and O(near pairs).
 * Two layers need two or three rounds if node lies on node; ten to thirty if
 * nodes lie in the gaps of the other layer. Allocates when there are more nodes
 * or near pairs than ever before. Serial, so threads do not change results. */
class SelfCollision : public ForwardingConstraint {
 public:
  static constexpr int max_rounds = 200;

  /** @param thickness [m], > 0, below the distance of any two unconnected nodes
   * at rest: on a grid of squares their diagonal, or two sides if there are
   * springs along the diagonals.
   * @param friction coefficient, >= 0   @param others called first */
  SelfCollision(double thickness, double friction, ConstraintPlan others)
      : ForwardingConstraint(std::move(others)),
        thickness_(thickness),
        friction_(friction) {
    assert(thickness > 0 && friction >= 0);
  }

  /** Throws StepError if max_rounds are not enough, or if two held nodes are
   * too near. */
  void operator()(Cloth& g, double t) const override;
  /** The rounds of the last call; 1 if no pair was too near. */
  int rounds() const { return rounds_; }

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
