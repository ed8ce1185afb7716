#pragma once
/** @file BlockCholesky.hpp
 * BlockCholesky: a sparse Cholesky factor by blocks of 3 x 3, for matrices of
 * one pattern whose numbers change. */
#include <cstddef>
#include <span>
#include <vector>

#include "lab/methods/BlockFactor.hpp"

namespace lab {

/** Solves A x = b for symmetric positive definite A whose entries are blocks of
 * 3 x 3, a row of them for each node. (SparseCholesky is for numbers instead of
 * blocks, that is for matrices that treat the coordinates alike.)
 * Order and pattern of the factor, P A P^T = L L^T, are kept by analyze(); what
 * follows allocates nothing. Columns are computed from left to right: T. Davis,
 * Direct Methods for Sparse Linear Systems, SIAM 2006, 4.8. The order is that
 * of approximate minimum degree, of the nodes. */
class BlockCholesky {
 public:
  /** A block off the diagonal, between nodes i and j. */
  struct Pair {
    unsigned i, j;
    bool operator==(const Pair&) const = default;
  };

  /** Take the pattern of A; that of before is kept if it is the same.
   * @param pairs i != j; a pair may come twice or turned round
   * @param most always the same
   * @return false if the factor would have more than @a most blocks: then
   *   rows() == 0
   * @pre all i, j < @a rows
   * Complexity: O(pairs) if it is that of before; else it allocates, and takes
   * as long as four factors of a sheet of 25^2 rows, or one of 100^2. */
  bool analyze(unsigned rows, std::span<const Pair> pairs, std::size_t most);

  unsigned rows() const { return unsigned(order_.size()); }
  /** Blocks of L. A row of a sheet with diagonals has 18 at 25^2 rows, 32 at
   * 100^2. */
  std::size_t blocks() const { return row_.size() + order_.size(); }
  /** Products of two blocks that factorize() takes; O(rows^1.5) on a sheet. */
  double updates() const { return updates_; }

  /** A = 0. */
  void clear();
  /** A_ii += the symmetric @a block. */
  void add_diagonal(unsigned i, const Matrix3& block);
  /** A_ij and A_ji += the symmetric @a block, for pair @a k of analyze(). */
  void add(std::size_t k, const Matrix3& block);

  /** Factor A; clear() makes the next one.
   * @return false if A is not positive definite to round-off, or not finite:
   *   then there is nothing to solve with
   * Complexity: O(updates()). */
  bool factorize();

  /** Put x in the place of @a b, A x = b, by row.
   * @pre b.size() == rows(), and factorize() returned true
   * Complexity: O(blocks()). */
  void solve(std::span<Point> b);

  /** L_ij, from row i: where it is among the blocks of column j. */
  struct Left {
    int column, at;
  };

 private:
  std::vector<Pair> pairs_;
  unsigned rows_ = 0;               // of analyze()
  bool fits_ = true;                // what it returned
  std::vector<int> order_, place_;  // node by row of L, and row by node
  std::vector<int> begin_, row_;    // by columns, below the diagonal
  std::vector<Matrix3> entry_;      // as row_
  std::vector<Matrix3> diagonal_;   // of A; then the inverse of that of L
  std::vector<int> left_begin_;     // by rows
  std::vector<Left> left_;
  std::vector<int> at_;    // in entry_, by pair
  std::vector<int> into_;  // where a row is in the column at work
  std::vector<cholesky_detail::Row> x_;
  double updates_ = 0;

  void find_order(unsigned rows);
  bool find_pattern(std::size_t most);
};

}  // namespace lab
