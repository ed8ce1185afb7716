#pragma once
/** @file CholeskyBackEnds.hpp
 * What SparseCholesky is made of: Eigen, and CHOLMOD where the library was
 * compiled with it. For Cholesky.cpp and its test. */
#include <cassert>
#include <cmath>
#include <cstddef>
#include <span>

#include <Eigen/SparseCholesky>

#include "lab/methods/BlockFactor.hpp"

#ifdef MASS_SPRING_CHOLMOD
#include <suitesparse/cholmod.h>
#endif

namespace lab {

namespace cholesky_detail {

using Matrix = Eigen::SparseMatrix<double>;

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

/** Solves A x = b by a factor of A that is kept, for symmetric positive
 * definite A and the three coordinates of b at once.
 * @tparam BackEnd what factors: see cholesky_detail::ByEigen */
template <typename BackEnd>
class BasicSparseCholesky {
 public:
  using Matrix = cholesky_detail::Matrix;
  static constexpr const char* back_end = BackEnd::name;

  /** Factor A, of any pattern, in place of the matrix before.
   * @param lower the lower triangle of A, compressed; entries above the
   *   diagonal are ignored.  @pre square
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

}  // namespace lab
