#pragma once
/** @file Stencil.hpp
 * Stencil: the neighbors of all nodes of a graph, laid out for a sweep that
 * works on several nodes at a time. README.md of this room walks through it. */
#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "Graph.hpp"

namespace lab {

/** The neighbors of all nodes of a graph: by blocks of W nodes of consecutive
 * ids, and in a block by rows of one neighbor for each node.
 *
 * On a grid the neighbors of most rows lie at a constant offset of ids. Such a
 * row stores the offset alone, and a sweep reads the neighbors' data with unit
 * stride. The other rows are gathered: they store the id of each neighbor.
 *
 * It holds topology only, and must be made anew when that has changed.
 * Memory: 12 bytes a row, and 8 W more for each gathered row.
 * @tparam W nodes a block */
template <int W>
class Stencil {
 public:
  using size_type = graph_detail::size_type;
  static constexpr size_type none = ~size_type(0);
  static constexpr int width = W;

  /** One neighbor for each node of a block. A node that has no more of them is
   * its own neighbor here, by some edge: a spring of length 0 does nothing. */
  struct Row {
    int offset;            ///< neighbor's id - node's id; 0: gathered
    size_type first_edge;  ///< edge's id, + 1 from node to node; none: gathered
    size_type list;        ///< where in neighbors() and edges()
  };

  /** The stencil of @a g, without the edges between nodes of ids i and j of
   * which @a skip(i, j) is true.  O(node_slots() + edges) */
  template <typename G, typename Skip>
  Stencil(const G& g, Skip skip) : slots_(g.node_slots()) {
    row_begin_.reserve(num_blocks() + 1);
    std::array<std::vector<typename G::Neighbor>, W> left;  // without a row yet
    for (size_type b = 0; b < num_blocks(); ++b) {
      row_begin_.push_back(size_type(rows_.size()));
      add_block(g, b * W, skip, left);
    }
    row_begin_.push_back(size_type(rows_.size()));
    for (size_type k = 0; k < W; ++k)
      last_block_[k] = std::min(num_blocks() * W - W + k, slots_ - 1);
  }

  template <typename G>
  explicit Stencil(const G& g)
      : Stencil(g, [](size_type, size_type) { return false; }) {}

  /** Block b has the nodes of ids b W, ..., b W + W - 1, but the last one may
   * have less. */
  size_type num_blocks() const { return (slots_ + W - 1) / W; }
  bool is_full(size_type block) const { return (block + 1) * W <= slots_; }
  /** The ids in the last block; the last id over and over where it is short. */
  const size_type* last_block() const { return last_block_.data(); }

  std::span<const Row> rows(size_type block) const {
    return {rows_.data() + row_begin_[block],
            rows_.data() + row_begin_[block + 1]};
  }
  /** How many rows the blocks before have. */
  std::size_t row_number(size_type block) const { return row_begin_[block]; }
  /** The ids of the W neighbors, and edges, of a gathered row. */
  const size_type* neighbors(const Row& r) const { return &neighbor_[r.list]; }
  const size_type* edges(const Row& r) const { return &edge_[r.list]; }
  std::size_t num_rows() const { return rows_.size(); }
  /** The largest difference of two neighbors' ids. */
  size_type reach() const { return reach_; }
  /** The number of gathered rows. */
  std::size_t num_gathered() const { return neighbor_.size() / W; }

 private:
  size_type slots_ = 0, reach_ = 0;
  std::vector<size_type> row_begin_;  // by block, and the end
  std::vector<Row> rows_;
  std::vector<size_type> neighbor_, edge_;  // W for each gathered row
  std::array<size_type, W> last_block_ = {};

  template <typename G, typename Skip>
  void add_block(const G& g, size_type first, Skip skip,
                 std::array<std::vector<typename G::Neighbor>, W>& left) {
    std::size_t most = 0;
    for (size_type k = 0; k < W; ++k) {
      left[k].clear();
      if (first + k >= slots_) continue;
      for (const auto& h : g.neighbors(first + k)) {
        if (skip(h.node, first + k)) continue;
        left[k].push_back(h);
        reach_ = std::max(
            reach_, std::max(h.node, first + k) - std::min(h.node, first + k));
      }
    }
    for (std::size_t m = 0; m < left[0].size();)
      if (!add_at_offset(first, m, left)) ++m;
    for (const auto& l : left) most = std::max(most, l.size());
    for (std::size_t m = 0; m < most; ++m) add_gathered(first, m, left);
  }

  /** If all nodes have a neighbor at the offset of number m of the first one,
   * add the row of these, and take them from @a left. */
  template <typename Neighbor>
  bool add_at_offset(size_type first, std::size_t m,
                     std::array<std::vector<Neighbor>, W>& left) {
    std::array<std::size_t, W> place;
    bool in_sequence = true;
    const Neighbor start = left[0][m];
    for (size_type k = 0; k < W; ++k) {
      // Neighbors mostly stand in the same order: begin at number m.
      const auto& l = left[k];
      std::size_t at = std::min(m, l.size());
      if (at == l.size() || l[at].node != start.node + k)
        for (at = 0; at < l.size() && l[at].node != start.node + k;) ++at;
      if (at == l.size()) return false;
      place[k] = at;
      in_sequence = in_sequence && l[at].edge == start.edge + k;
    }
    rows_.push_back({int(start.node - first), in_sequence ? start.edge : none,
                     size_type(neighbor_.size())});
    for (size_type k = 0; k < W; ++k) {
      if (!in_sequence) list(left[k][place[k]]);
      left[k].erase(left[k].begin() + std::ptrdiff_t(place[k]));
    }
    return true;
  }

  /** Add the gathered row of number m of each node. */
  template <typename Neighbor>
  void add_gathered(size_type first, std::size_t m,
                    const std::array<std::vector<Neighbor>, W>& left) {
    rows_.push_back({0, none, size_type(neighbor_.size())});
    for (size_type k = 0; k < W; ++k)
      list(m < left[k].size() ? left[k][m]
                              : Neighbor{std::min(first + k, slots_ - 1), 0});
  }

  template <typename Neighbor>
  void list(const Neighbor& h) {
    neighbor_.push_back(h.node);
    edge_.push_back(h.edge);
  }
};

}  // namespace lab
