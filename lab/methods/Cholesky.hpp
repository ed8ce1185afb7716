#pragma once
/** @file Cholesky.hpp
 * SparseCholesky: solves A x = b for one sparse matrix A and many b. */
#include <cstddef>
#include <memory>
#include <span>

#include "CME212/Point.hpp"

namespace lab {

/** Solves A x = b by a factor of A that is kept, for symmetric positive
 * definite A and the three coordinates of b at once: by CHOLMOD where the
 * library was compiled with it, by Eigen elsewhere. */
class SparseCholesky {
 public:
  /** An entry of a matrix; entries at the same place are added up. */
  struct Entry {
    unsigned i, j;  ///< row and column
    double a;
    unsigned row() const { return i; }
    unsigned col() const { return j; }
    double value() const { return a; }
  };
  static const char* const back_end;  ///< "CHOLMOD" or "Eigen"

  SparseCholesky();
  ~SparseCholesky();

  /** Factor A, of any pattern, in place of the matrix before.
   * @param lower the lower triangle of A; entries above the diagonal are
   * ignored.
   * @pre all rows and columns < @a rows
   * @return false if A is not positive definite to round-off, not finite or
   *   too large for the memory; then rows() == 0
   * Complexity: on a grid about O(rows^1.5). */
  bool factorize(std::size_t rows, std::span<const Entry> lower);

  /** Rows of A. */
  std::size_t rows() const;
  /** Entries of the factor. A row of a grid with diagonals has 17 or 18 at
   * 25^2 rows, 30 to 33 at 100^2, 56 to 64 at 1000^2. */
  std::size_t nonzeros() const;

  /** Put x in the place of @a b, A x = b, by row.  @pre b.size() == rows()
   * Complexity: O(nonzeros()); nothing is allocated. */
  void solve(std::span<Point> b);

 private:
  struct Solver;
  std::unique_ptr<Solver> solver_;
};

}  // namespace lab
