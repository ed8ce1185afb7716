#pragma once
/** @file BlockFactor.hpp
 * BlockFactor: a sparse Cholesky factor by blocks of columns, for fast
 * triangular solves. */
#include <cstddef>
#include <span>
#include <vector>

#include "CME212/Point.hpp"
#include "lab/methods/Matrix3.hpp"

namespace lab {

namespace cholesky_detail {

/** L of P A P^T = L L^T, by columns; each begins with its diagonal entry, and
 * its rows ascend. A view of what a back end owns. */
struct Factor {
  const int* begin = nullptr;  // of the columns, and the end; null: no factor
  const int* row = nullptr;
  const double* entry = nullptr;
  const int* order = nullptr;  // the row of A, by the row of L
};

struct Row {
  Four c;
};

/** Neighboring columns of L that have the same rows: their triangle, and what
 * is below it by panels of `high` rows. What the last of these lacks are zeros
 * in row 0, which is below no column. */
struct Block {
  static constexpr int high = 4;
  int first, columns, panels;
  /** How many numbers it has. */
  std::size_t entries() const {
    return unsigned(columns * (columns + 1) / 2 + panels * high * columns);
  }
};

/** The factor L as triangular solves want it, by blocks: their rows are stored
 * once, their entries lie in the order of their use, and x stays in registers.
 * That takes a third of the time of a solve by single columns. Columns whose
 * rows are nearly the same are made so, by zeros: longer loops are worth them.
 * Source: C. Ashcraft, R. Grimes, ACM Trans. Math. Softw. 15 (1989) 291,
 * "relaxed supernodes". */
class BlockFactor {
 public:
  /** Take over @a f, the factor of @a rows rows.  O(entries) */
  void assign(const Factor& f, std::size_t rows);
  /** Put x in the place of @a b, L L^T x = b, by row of A.  O(entries)
   * @pre b.size() is the rows of assign() */
  void solve(std::span<Point> b);

 private:
  std::vector<Block> block_;
  std::vector<int> row_;       // see Forward
  std::vector<double> entry_;  // there, too
  std::vector<int> order_;     // the row of A, by the row of L
  std::vector<Row> x_;

  void find_blocks(const Factor& f);
};

}  // namespace cholesky_detail

}  // namespace lab
