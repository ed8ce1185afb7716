#include "lab/methods/SparseCholesky.hpp"

#include <algorithm>
#include <cassert>
#include <numeric>

#include <Eigen/SparseCholesky>

#include "lab/fast/Lanes.hpp"

namespace lab {

namespace {

/** Eigen's factor of single numbers; its pattern is used here. */
struct Pattern : Eigen::SimplicialLLT<Eigen::SparseMatrix<double>> {
  /** Of L below the diagonal.  @pre analyzePattern() */
  double entries() const { return m_nonZerosPerCol.cast<double>().sum(); }
};

}  // namespace

/** Replaces A by L, column by column: subtract the contributions of the columns
 * to the left, then divide by the diagonal. */
struct SparseCholesky::Factorize {
  template <typename>  // Four on every processor
  [[gnu::always_inline]] static inline void apply(
      int columns, const int* begin, const int* row, Matrix3* entry,
      const int* left_begin, const int* left_column, const int* left_at,
      int* into, bool* good) {
    for (int j = 0; j < columns && *good; ++j) {
      Matrix3& diagonal = entry[begin[j]];
      const Matrix3 before = diagonal;
      for (int p = begin[j]; p < begin[j + 1]; ++p) into[row[p]] = p;
      for (int l = left_begin[j]; l < left_begin[j + 1] - 1; ++l) {
        const int first = left_at[l], end = begin[left_column[l] + 1];
        const Matrix3 by = entry[first];
        for (int p = first; p < end; ++p)
          subtract(entry[into[row[p]]], entry[p], by);
      }
      *good = invert_factor(diagonal, before);
      for (int p = begin[j] + 1; p < begin[j + 1]; ++p)
        multiply(entry[p], diagonal);
    }
  }
};

/** x = L^-T L^-1 x */
struct SparseCholesky::Solve {
  template <typename>  // Four on every processor
  [[gnu::always_inline]] static inline void apply(int columns, const int* begin,
                                                  const int* row,
                                                  const Matrix3* entry,
                                                  Row* x) {
    for (int j = 0; j < columns; ++j) {
      const Four y = x[j].c = times(entry[begin[j]], x[j].c);
      int p = begin[j] + 1;
      const int end = begin[j + 1];
      if (p < end && row[p] == j + 1 && begin[j + 2] - end == end - p) {
        // The next column has the same rows: one pass over x for both.
        x[++j].c -= times(entry[p], y);
        const Four z = x[j].c = times(entry[end], x[j].c);
        for (int q = end + 1; ++p < end; ++q)
          x[row[p]].c = x[row[p]].c - times(entry[p], y) - times(entry[q], z);
      }
      for (; p < end; ++p) x[row[p]].c -= times(entry[p], y);
    }
    for (int j = columns; j-- > 0;) {
      Four y = x[j].c;
      for (int p = begin[j] + 1; p < begin[j + 1]; ++p)
        y -= transposed_times(entry[p], x[row[p]].c);
      x[j].c = transposed_times(entry[begin[j]], y);
    }
  }
};

bool SparseCholesky::analyze(unsigned rows, std::span<const Pair> pairs,
                             std::size_t most) {
  if (rows == rows_ && std::ranges::equal(pairs, pairs_)) return fits_;
  rows_ = rows;
  pairs_.assign(pairs.begin(), pairs.end());
  // A positive definite matrix of this pattern.
  std::vector<Eigen::Triplet<double>> entries;
  for (unsigned i = 0; i < rows; ++i) entries.emplace_back(i, i, 1);
  for (auto [i, j] : pairs_) {
    entries.emplace_back(i, i, 1), entries.emplace_back(j, j, 1);
    entries.emplace_back(std::max(i, j), std::min(i, j), -1);
  }
  Eigen::SparseMatrix<double> a{int(rows), int(rows)};
  a.setFromTriplets(entries.begin(), entries.end());
  Pattern pattern;
  if (rows > 0) pattern.analyzePattern(a);
  fits_ = rows + pattern.entries() <= double(most);
  if (!fits_ || rows == 0) {
    order_.clear(), row_.clear(), entry_.clear();
    return fits_;
  }
  pattern.factorize(a);
  const int* first = pattern.permutationPinv().indices().data();
  order_.assign(first, first + rows);
  first = pattern.permutationP().indices().data();
  place_.assign(first, first + rows);
  const auto& l = pattern.matrixL().nestedExpression();
  begin_.assign(l.outerIndexPtr(), l.outerIndexPtr() + rows + 1);
  row_.assign(l.innerIndexPtr(), l.innerIndexPtr() + begin_[rows]);
  into_.resize(row_.size());
  std::iota(into_.begin(), into_.end(), 0);
  const Eigen::SparseMatrix<int> left =
      Eigen::Map<const Eigen::SparseMatrix<int>>(int(rows), int(rows),
                                                 begin_[rows], begin_.data(),
                                                 row_.data(), into_.data())
          .transpose();
  left_begin_.assign(left.outerIndexPtr(), left.outerIndexPtr() + rows + 1);
  left_column_.assign(left.innerIndexPtr(),
                      left.innerIndexPtr() + begin_[rows]);
  left_at_.assign(left.valuePtr(), left.valuePtr() + begin_[rows]);
  updates_ = 0;
  for (unsigned j = 0; j < rows; ++j) {
    const double below = begin_[j + 1] - begin_[j] - 1;
    updates_ += below * (below + 1) / 2;
  }
  at_.clear();
  for (auto [i, j] : pairs_) {
    const auto [column, row] = std::minmax(place_[i], place_[j]);
    const int* const p = row_.data();
    at_.push_back(int(
        std::lower_bound(p + begin_[column], p + begin_[column + 1], row) - p));
  }
  into_.resize(rows);
  x_.resize(rows);
  entry_.resize(row_.size());
  clear();
  return true;
}

void SparseCholesky::clear() {
  std::fill(entry_.begin(), entry_.end(), Matrix3());
}
void SparseCholesky::add_diagonal(unsigned i, const Matrix3& entry) {
  lab::add(entry_[begin_[place_[i]]], entry);
}
void SparseCholesky::add(std::size_t k, const Matrix3& entry) {
  if (const auto [i, j] = pairs_[k]; place_[i] > place_[j])
    return lab::add(entry_[at_[k]], entry);
  for (int c = 0; c < 3; ++c)
    for (int r = 0; r < 3; ++r)
      entry_[at_[k]].column[c][r] += entry.column[r][c];
}

bool SparseCholesky::factorize() {
  bool good = true;
  lanes::run<Factorize>(int(rows()), begin_.data(), row_.data(), entry_.data(),
                        left_begin_.data(), left_column_.data(),
                        left_at_.data(), into_.data(), &good);
  return good;
}

void SparseCholesky::solve(std::span<Point> b) {
  assert(b.size() == rows());
  for (unsigned k = 0; k < rows(); ++k) x_[k].c = four(b[order_[k]]);
  lanes::run<Solve>(int(rows()), begin_.data(), row_.data(), entry_.data(),
                    x_.data());
  for (unsigned k = 0; k < rows(); ++k) b[order_[k]] = point(x_[k].c);
}

}  // namespace lab
