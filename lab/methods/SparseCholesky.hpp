#pragma once
/** @file SparseCholesky.hpp
 * SparseCholesky: factors sparse matrices of one pattern and solves linear
 * systems with the factor. */
#include <cstddef>
#include <span>
#include <vector>

#include "lab/fast/Matrix3.hpp"

namespace lab {

/** Solves A x = b for symmetric positive definite A by P A P^T = L L^T; b has
 * one Point a row. Eigen finds the order P (approximate minimum degree) and the
 * pattern of L once for each pattern of A. The entries are computed here: Eigen
 * factors 3 x 3 blocks as single numbers, which takes 6 to 8 times as long, and
 * solves for one coordinate at a time, which takes 3 to 4 times as long.
 * Sums are in a fixed order, so every processor gets the same bits.
 * Source: T. Davis, Direct Methods for Sparse Linear Systems, SIAM 2006, 4.8:
 * left-looking. */
class SparseCholesky {
 public:
  /** Row and column of an entry off the diagonal. */
  struct Pair {
    unsigned i, j;
    bool operator==(const Pair&) const = default;
  };

  /** Set the pattern of A. If it is the present one, nothing changes.
   * @param pairs i != j; pairs may be repeated
   * @param most the largest number of entries of L; the same in every call
   * @return false if L would have more: then rows() == 0
   * @pre all i, j < @a rows
   * Complexity: O(pairs) for the present pattern. A new pattern allocates, and
   * takes as much work as a factor of single numbers. */
  bool analyze(unsigned rows, std::span<const Pair> pairs, std::size_t most);

  unsigned rows() const { return unsigned(order_.size()); }
  /** Entries of L. A row of a sheet with diagonals has 18 at 25^2 rows, 32 at
   * 100^2, 56 to 64 at 1000^2. */
  std::size_t entries() const { return row_.size(); }
  /** Products of two entries in factorize(); O(rows^1.5) on a sheet. */
  double updates() const { return updates_; }

  /** A = 0. */
  void clear();
  /** A_ii += the symmetric @a entry. */
  void add_diagonal(unsigned i, const Matrix3& entry);
  /** A_ij += @a entry and A_ji += its transpose, for pair @a k of analyze(). */
  void add(std::size_t k, const Matrix3& entry);

  /** Replace A by L. Call clear() before the next A.
   * @return false if A is not positive definite to round-off, or not finite:
   *   then solve() must not be called
   * Complexity: O(updates()); nothing is allocated. */
  bool factorize();

  /** Replace @a b by the solution x of A x = b.
   * @pre b.size() == rows(), and factorize() returned true
   * Complexity: O(entries()); nothing is allocated. */
  void solve(std::span<Point> b);

 private:
  struct Row {
    Four c;
  };
  struct Factorize;
  struct Solve;

  std::vector<Pair> pairs_;
  unsigned rows_ = 0;  // of analyze()
  bool fits_ = true;   // what analyze() returned
  double updates_ = 0;
  std::vector<int> order_, place_;  // row of A by row of L, and the inverse
  // L by columns, each from its diagonal entry down. Before factorize() these
  // are the entries of A; afterwards the diagonal entries are inverted.
  std::vector<int> begin_, row_;
  std::vector<Matrix3> entry_;
  // L by rows: the column of each entry, and its index in entry_.
  std::vector<int> left_begin_, left_column_, left_at_;
  std::vector<int> at_;    // in entry_, by pair
  std::vector<int> into_;  // in entry_, by row of the present column
  std::vector<Row> x_;
};

}  // namespace lab
