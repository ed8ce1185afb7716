#pragma once
/** @file Stencil.hpp
 * Stencil: the neighbors of all nodes of a graph, laid out for a sweep that
 * works on several nodes at a time. */
#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

#include "Graph.hpp"
#include "lab/fast/GraphArrays.hpp"

namespace lab {

/** The neighbors of all nodes of a graph, in blocks of W nodes of consecutive
 * ids. A block consists of rows, each with one neighbor of each node.
 *
 * If the neighbors of a row lie at a constant offset of ids, a sweep can read
 * their data with unit stride; those of other rows are gathered.
 *
 * It contains only topology, and must be made anew when that has changed.
 * Memory: 4 + 8 W bytes a row.
 * @tparam W nodes a block */
template <int W>
class Stencil {
 public:
  using size_type = graph_detail::size_type;
  static constexpr size_type none = ~size_type(0);
  static constexpr int width = W;

  /** The stencil of @a g, without the edges between nodes of ids i and j of
   * which @a skip(i, j) is true.  O(node_slots() + edges) */
  template <typename G, typename Skip>
  Stencil(const G& g, Skip skip) : slots_(arrays(g).node_slots()) {
    row_begin_.reserve(num_blocks() + 1);
    std::array<std::vector<typename GraphArrays<const G>::Neighbor>, W>
        left;  // without a row yet
    for (size_type b = 0; b < num_blocks(); ++b) {
      row_begin_.push_back(num_rows());
      add_block(g, b * W, skip, left);
    }
    row_begin_.push_back(num_rows());
  }

  /** Block b has the nodes with ids b W, ..., b W + W - 1; the last block may
   * have fewer. */
  size_type num_blocks() const { return (slots_ + W - 1) / W; }
  std::size_t num_rows() const { return offset_.size(); }
  /** The rows of a block are [row_begin(block), row_begin(block + 1)). */
  std::size_t row_begin(size_type block) const { return row_begin_[block]; }
  /** Neighbor's id - node's id if it is the same in all the row; else 0. */
  int offset(std::size_t row) const { return offset_[row]; }
  /** The ids of the W neighbors of a row, and of the edges to them. A node with
   * fewer neighbors is its own neighbor, with the edge `none`. */
  const size_type* neighbors(std::size_t row) const {
    return &neighbor_[row * W];
  }
  const size_type* edges(std::size_t row) const { return &edge_[row * W]; }

 private:
  size_type slots_ = 0;
  std::vector<std::size_t> row_begin_;  // by block, and the end
  std::vector<int> offset_;
  std::vector<size_type> neighbor_, edge_;  // W for each row

  template <typename G, typename Skip>
  void add_block(
      const G& g, size_type first, Skip skip,
      std::array<std::vector<typename GraphArrays<const G>::Neighbor>, W>&
          left) {
    std::size_t most = 0;
    for (size_type k = 0; k < W; ++k) {
      left[k].clear();
      if (first + k >= slots_) continue;
      for (const auto& h : arrays(g).neighbors(first + k))
        if (!skip(h.node, first + k)) left[k].push_back(h);
    }
    for (std::size_t m = 0; m < left[0].size();)
      if (!add_at_offset(first, m, left)) ++m;
    for (const auto& l : left) most = std::max(most, l.size());
    for (std::size_t m = 0; m < most; ++m) {
      offset_.push_back(0);
      for (size_type k = 0; k < W; ++k)
        add(m < left[k].size() ? left[k][m]
                               : typename GraphArrays<const G>::Neighbor{
                                     std::min(first + k, slots_ - 1), none});
    }
  }

  /** If all nodes have a neighbor at the same offset as neighbor m of the first
   * node, add a row of these, and remove them from @a left. */
  template <typename Neighbor>
  bool add_at_offset(size_type first, std::size_t m,
                     std::array<std::vector<Neighbor>, W>& left) {
    std::array<std::size_t, W> place;
    const size_type start = left[0][m].node;
    for (size_type k = 0; k < W; ++k) {
      // Neighbors mostly are in the same order: start at number m.
      const auto& l = left[k];
      std::size_t at = std::min(m, l.size());
      if (at == l.size() || l[at].node != start + k)
        for (at = 0; at < l.size() && l[at].node != start + k;) ++at;
      if (at == l.size()) return false;
      place[k] = at;
    }
    offset_.push_back(int(start - first));
    for (size_type k = 0; k < W; ++k) {
      add(left[k][place[k]]);
      left[k].erase(left[k].begin() + std::ptrdiff_t(place[k]));
    }
    return true;
  }

  template <typename Neighbor>
  void add(const Neighbor& h) {
    neighbor_.push_back(h.node);
    edge_.push_back(h.edge);
  }
};

}  // namespace lab
