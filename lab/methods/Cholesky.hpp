#pragma once
/** @file Cholesky.hpp
 * SparseCholesky: solves A x = b for one sparse matrix A and many b. */
#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include <Eigen/SparseCholesky>

#include "CME212/Point.hpp"
#include "lab/fast/Lanes.hpp"

#ifdef MASS_SPRING_CHOLMOD
#include <suitesparse/cholmod.h>
#endif

namespace lab {

namespace cholesky_detail {

using Matrix = Eigen::SparseMatrix<double>;

/** L of P A P^T = L L^T, by columns; each begins with its diagonal entry, and
 * its rows ascend. A view of what a back end owns. */
struct Factor {
  const int* begin = nullptr;  // of the columns, and the end; null: no factor
  const int* row = nullptr;
  const double* entry = nullptr;
  const int* order = nullptr;  // the row of A, by the row of L
};

/** A back end: factorize() gives a Factor that lives as long as it, or none if
 * @a lower is not positive definite, or memory is short; NaN may pass. It is
 * called once. This one orders by approximate minimum degree. */
class ByEigen {
 public:
  static constexpr const char* name = "Eigen";

  Factor factorize(const Matrix& lower) {
    solver_.compute(lower);
    if (solver_.info() != Eigen::Success) return {};
    const auto& l = solver_.matrixL().nestedExpression();
    return {l.outerIndexPtr(), l.innerIndexPtr(), l.valuePtr(),
            solver_.permutationPinv().indices().data()};
  }

 private:
  Eigen::SimplicialLLT<Matrix, Eigen::Lower> solver_;
};

}  // namespace cholesky_detail

#ifdef MASS_SPRING_CHOLMOD

namespace cholesky_detail {

/** Y. Chen, T. Davis, W. Hager, S. Rajamanickam, ACM Trans. Math. Softw. 35
 * (2008) 22. It factors by dense blocks where that pays, and tries nested
 * dissection where minimum degree fills in too much. */
class ByCholmod {
 public:
  static constexpr const char* name = "CHOLMOD";

  ByCholmod() {
    cholmod_start(&common_);
    common_.print = 0;  // say nothing: the caller reports
    // However it factors, what is left is a Factor, without the zeros that
    // dense blocks hold.
    common_.final_asis = false;
    common_.final_super = false;
    common_.final_ll = true;
    common_.final_pack = true;
    common_.final_monotonic = true;
    common_.final_resymbol = true;
  }
  ~ByCholmod() {
    cholmod_free_factor(&factor_, &common_);
    cholmod_finish(&common_);
  }
  ByCholmod(const ByCholmod&) = delete;
  ByCholmod& operator=(const ByCholmod&) = delete;

  Factor factorize(const Matrix& lower) {
    cholmod_sparse a{};  // a view: nothing writes to it
    a.nrow = a.ncol = std::size_t(lower.rows());
    a.nzmax = std::size_t(lower.nonZeros());
    a.p = const_cast<int*>(lower.outerIndexPtr());
    a.i = const_cast<int*>(lower.innerIndexPtr());
    a.x = const_cast<double*>(lower.valuePtr());
    a.stype = -1;  // the lower triangle
    a.itype = CHOLMOD_INT;
    a.xtype = CHOLMOD_REAL;
    a.dtype = CHOLMOD_DOUBLE;
    a.sorted = a.packed = true;
    factor_ = cholmod_analyze(&a, &common_);
    if (!factor_ || !cholmod_factorize(&a, factor_, &common_) ||
        common_.status != CHOLMOD_OK)
      return {};
    return {static_cast<const int*>(factor_->p),
            static_cast<const int*>(factor_->i),
            static_cast<const double*>(factor_->x),
            static_cast<const int*>(factor_->Perm)};
  }

 private:
  cholmod_common common_;
  cholmod_factor* factor_ = nullptr;
};
using Best = ByCholmod;

}  // namespace cholesky_detail

#else

namespace cholesky_detail {
using Best = ByEigen;
}

#endif

namespace cholesky_detail {

// The three coordinates in one register, and a lane to spare.
typedef double Four __attribute__((vector_size(32), aligned(32)));
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

/** x = L^-1 x.
 * @param e the entries of [block, end), block by block: the triangle by
 *   columns, the inverse of the diagonal in it; then each panel by columns
 * @param r the rows of all panels */
struct Forward {
  template <typename>  // four numbers at a time, whatever the processor
  [[gnu::always_inline]] static inline void apply(const Block* block,
                                                  const Block* end,
                                                  const double* e, const int* r,
                                                  Row* x) {
    constexpr int high = Block::high;
    for (; block < end; ++block) {
      Row* const top = x + block->first;
      const int columns = block->columns;
      for (int j = 0; j < columns; ++j) {
        const Four t = top[j].c *= *e++;
        for (int i = j + 1; i < columns; ++i) top[i].c -= *e++ * t;
      }
      for (int p = 0; p < block->panels; ++p, r += high) {
        Four sum[high];
        for (int i = 0; i < high; ++i) sum[i] = x[r[i]].c;
        for (int j = 0; j < columns; ++j, e += high)
          for (int i = 0; i < high; ++i) sum[i] -= e[i] * top[j].c;
        for (int i = 0; i < high; ++i) x[r[i]].c = sum[i];
      }
    }
  }
};

/** x = L^-T x, backwards through the same memory, from its ends. */
struct Backward {
  template <typename>  // four numbers at a time, whatever the processor
  [[gnu::always_inline]] static inline void apply(const Block* begin,
                                                  const Block* block,
                                                  const double* e, const int* r,
                                                  Row* x) {
    constexpr int high = Block::high;
    while (block-- > begin) {
      Row* const top = x + block->first;
      const int columns = block->columns;
      for (int p = 0; p < block->panels; ++p) {
        r -= high;
        Four below[high];
        for (int i = 0; i < high; ++i) below[i] = x[r[i]].c;
        for (int j = columns; j-- > 0;) {
          e -= high;
          Four t = top[j].c;
          for (int i = 0; i < high; ++i) t -= e[i] * below[i];
          top[j].c = t;
        }
      }
      for (int j = columns; j-- > 0;) {
        e -= columns - j;
        Four t = top[j].c;
        for (int i = j + 1; i < columns; ++i) t -= e[i - j] * top[i].c;
        top[j].c = t * *e;
      }
    }
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
  void assign(const Factor& f, std::size_t rows) {
    constexpr int high = Block::high;
    x_.resize(rows);
    order_.assign(f.order, f.order + rows);
    std::vector<int> place(rows);  // below the block, by row
    find_blocks(f);
    std::size_t rows_below = 0, all = 0;
    for (const Block& b : block_)
      rows_below += unsigned(b.panels * high), all += b.entries();
    row_.clear();
    row_.reserve(rows_below);
    entry_.assign(all, 0);
    double* triangle = entry_.data();
    for (const Block& b : block_) {
      const int end = b.first + b.columns;
      const int* below = f.row + f.begin[end - 1] + 1;
      const int count = int(f.row + f.begin[end] - below);
      for (int k = 0; k < count; ++k) place[unsigned(below[k])] = k;
      row_.insert(row_.end(), below, below + count);
      row_.resize(row_.size() + unsigned(b.panels * high - count), 0);
      double* panels = triangle + b.columns * (b.columns + 1) / 2;
      for (int j = b.first; j < end; ++j) {
        for (int k = f.begin[j]; k < f.begin[j + 1]; ++k)
          if (f.row[k] < end) {
            triangle[f.row[k] - j] =
                f.row[k] == j ? 1 / f.entry[k] : f.entry[k];
          } else {
            const int at = place[unsigned(f.row[k])];
            panels[(at / high * b.columns + j - b.first) * high + at % high] =
                f.entry[k];
          }
        triangle += end - j;
      }
      triangle = panels + b.panels * high * b.columns;
    }
  }

  /** As BasicSparseCholesky::solve(). */
  void solve(std::span<Point> b) {
    for (std::size_t i = 0; i < order_.size(); ++i) {
      const Point& from = b[unsigned(order_[i])];
      x_[i].c = Four{from.x, from.y, from.z, 0};
    }
    const Block *first = block_.data(), *end = first + block_.size();
    lanes::run<Forward>(first, end, entry_.data(), row_.data(), x_.data());
    lanes::run<Backward>(first, end, entry_.data() + entry_.size(),
                         row_.data() + row_.size(), x_.data());
    for (std::size_t i = 0; i < order_.size(); ++i) {
      const Four& to = x_[i].c;
      b[unsigned(order_[i])] = Point(to[0], to[1], to[2]);
    }
  }

 private:
  std::vector<Block> block_;
  std::vector<int> row_;       // see Forward
  std::vector<double> entry_;  // there, too
  std::vector<int> order_;     // the row of A, by the row of L
  std::vector<Row> x_;

  /** Join each column with the block before, while that costs few zeros. */
  void find_blocks(const Factor& f) {
    constexpr int high = Block::high;
    constexpr int widest = 32;  // x of a block stays in the nearest cache
    block_.clear();
    for (int j = 0; j < int(x_.size()); ++j) {
      const int below = f.begin[j + 1] - f.begin[j] - 1;
      Block b = {j, 1, (below + high - 1) / high};
      while (!block_.empty()) {
        // It can be joined if b's first column is the first row below it: then
        // what else is below it, is in b or below b, too.
        const Block& a = block_.back();
        const int last = f.begin[b.first - 1];
        if (f.begin[b.first] - last < 2 || f.row[last + 1] != b.first) break;
        const Block both = {a.first, a.columns + b.columns, b.panels};
        const int zeros =
            int(both.entries()) - (f.begin[j + 1] - f.begin[a.first]);
        if (both.columns > widest ||
            zeros > std::max(8, int(both.entries()) / 10))
          break;
        b = both;
        block_.pop_back();
      }
      block_.push_back(b);
    }
  }
};

}  // namespace cholesky_detail

/** Solves A x = b by a factor of A that is kept, for symmetric positive
 * definite A and the three coordinates of b at once.
 * @tparam BackEnd what factors: see cholesky_detail::ByEigen */
template <typename BackEnd>
class BasicSparseCholesky {
 public:
  using Matrix = cholesky_detail::Matrix;
  static constexpr const char* back_end = BackEnd::name;

  /** Factor A, of any pattern, in place of the matrix before.
   * @param lower the lower triangle of A, compressed; what stands above the
   *   diagonal is not looked at.  @pre square
   * @return false if A is not positive definite to round-off, not finite or
   *   too large for the memory; then rows() == 0
   * Complexity: on a grid about O(rows^1.5). */
  bool factorize(const Matrix& lower) {
    assert(lower.rows() == lower.cols() && lower.isCompressed());
    rows_ = nonzeros_ = 0;
    const auto n = std::size_t(lower.rows());
    if (n == 0) return true;
    BackEnd back_end;
    const cholesky_detail::Factor f = back_end.factorize(lower);
    if (!f.begin) return false;
    // What is not finite in A makes a diagonal entry so, too.
    for (std::size_t j = 0; j < n; ++j)
      if (!std::isfinite(f.entry[f.begin[j]])) return false;
    factor_.assign(f, n);
    rows_ = n;
    nonzeros_ = std::size_t(f.begin[n]);
    return true;
  }

  /** Rows of A. */
  std::size_t rows() const { return rows_; }
  /** Entries of the factor. A row of a grid with diagonals has 17 or 18 at
   * 25^2 rows, 30 to 33 at 100^2, 56 to 64 at 1000^2. */
  std::size_t nonzeros() const { return nonzeros_; }

  /** Put x in the place of @a b, A x = b, by row.  @pre b.size() == rows()
   * Complexity: O(nonzeros()); nothing is allocated. */
  void solve(std::span<Point> b) {
    assert(b.size() == rows_);
    if (rows_ > 0) factor_.solve(b);
  }

 private:
  cholesky_detail::BlockFactor factor_;
  std::size_t rows_ = 0, nonzeros_ = 0;
};

/** By CHOLMOD where the program was compiled with it, by Eigen elsewhere. */
using SparseCholesky = BasicSparseCholesky<cholesky_detail::Best>;

}  // namespace lab
