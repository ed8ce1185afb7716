#include "lab/methods/BlockCholesky.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

#include <Eigen/OrderingMethods>
#include <Eigen/SparseCore>

#include "lab/fast/Lanes.hpp"

namespace lab {

namespace {

using cholesky_detail::Row;
using Left = BlockCholesky::Left;

/** to -= from by^T */
[[gnu::always_inline]] inline void subtract(Matrix3& to, const Matrix3& from,
                                            const Matrix3& by) {
  for (int c = 0; c < 3; ++c)
    to.column[c] -= from.column[0] * by.column[0][c] +
                    from.column[1] * by.column[1][c] +
                    from.column[2] * by.column[2][c];
}

/** a = a by^T */
[[gnu::always_inline]] inline void multiply(Matrix3& a, const Matrix3& by) {
  Four product[3];
  for (int c = 0; c < 3; ++c)
    product[c] = a.column[0] * by.column[0][c] + a.column[1] * by.column[1][c] +
                 a.column[2] * by.column[2][c];
  for (int c = 0; c < 3; ++c) a.column[c] = product[c];
}

/** L in the place of A, column by column: of each, what the columns to the left
 * of it take away. */
struct Factorize {
  template <typename>  // four numbers at a time, whatever the processor
  [[gnu::always_inline]] static inline void apply(
      int columns, const int* begin, const int* row, Matrix3* entry,
      Matrix3* diagonal, const int* left_begin, const Left* left, int* into,
      bool* good) {
    for (int j = 0; j < columns && *good; ++j) {
      const Matrix3& d = diagonal[j];
      const Four least =
          1e-15 * Four{d.column[0][0], d.column[1][1], d.column[2][2], 0};
      for (int p = begin[j]; p < begin[j + 1]; ++p) into[row[p]] = p;
      for (const Left* l = left + left_begin[j]; l < left + left_begin[j + 1];
           ++l) {
        const Matrix3 by = entry[l->at];
        subtract(diagonal[j], by, by);
        const int end = begin[l->column + 1];
        for (int p = l->at + 1; p < end; ++p)
          subtract(entry[into[row[p]]], entry[p], by);
      }
      *good = invert_factor(diagonal[j], least);
      for (int p = begin[j]; p < begin[j + 1]; ++p)
        multiply(entry[p], diagonal[j]);
    }
  }
};

struct Solve {
  template <typename>  // four numbers at a time, whatever the processor
  [[gnu::always_inline]] static inline void apply(int columns, const int* begin,
                                                  const int* row,
                                                  const Matrix3* entry,
                                                  const Matrix3* diagonal,
                                                  Row* x) {
    for (int j = 0; j < columns; ++j) {
      const Four y = x[j].c = times(diagonal[j], x[j].c);
      for (int p = begin[j]; p < begin[j + 1]; ++p)
        x[row[p]].c -= times(entry[p], y);
    }
    for (int j = columns; j-- > 0;) {
      Four y = x[j].c;
      for (int p = begin[j]; p < begin[j + 1]; ++p)
        y -= turned_times(entry[p], x[row[p]].c);
      x[j].c = turned_times(diagonal[j], y);
    }
  }
};

}  // namespace

bool BlockCholesky::analyze(unsigned rows, std::span<const Pair> pairs,
                            std::size_t most) {
  if (rows == rows_ && std::ranges::equal(pairs, pairs_)) return fits_;
  rows_ = rows;
  pairs_.assign(pairs.begin(), pairs.end());
  find_order(rows);
  fits_ = find_pattern(most);
  if (!fits_) order_.clear(), row_.clear(), entry_.clear();
  return fits_;
}

/** order_ and place_, for the pattern pairs_. */
void BlockCholesky::find_order(unsigned rows) {
  std::vector<Eigen::Triplet<double>> entries;
  for (unsigned i = 0; i < rows; ++i) entries.emplace_back(i, i, 1);
  for (const Pair& p : pairs_)
    entries.emplace_back(p.i, p.j, 1), entries.emplace_back(p.j, p.i, 1);
  Eigen::SparseMatrix<double> pattern{int(rows), int(rows)};
  pattern.setFromTriplets(entries.begin(), entries.end());
  Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> order;
  if (rows > 0) Eigen::AMDOrdering<int>()(pattern, order);
  const int* first = order.indices().data();
  order_.assign(first, first + rows);
  place_.resize(rows);
  for (unsigned k = 0; k < rows; ++k) place_[unsigned(order_[k])] = int(k);
}

/** The pattern of L for that order, and where A goes in it.
 * @return false if that takes more than @a most blocks */
bool BlockCholesky::find_pattern(std::size_t most) {
  const auto n = order_.size();
  std::vector<std::vector<int>> below(n), children(n);
  for (const Pair& p : pairs_) {
    const auto [first, last] = std::minmax(place_[p.i], place_[p.j]);
    below[unsigned(first)].push_back(last);
  }
  begin_.assign(1, 0);
  row_.clear();
  updates_ = 0;
  std::vector<int> seen(n, -1);
  std::vector<int> count(n + 1, 0);  // of the blocks to the left, by row
  for (int j = 0; j < int(n); ++j) {
    // What is below the diagonal of column j: that of A, and that of each
    // column whose first block below is in row j.
    seen[unsigned(j)] = j;
    const auto first = row_.size();
    auto take = [&](int i) {
      if (i > j && seen[unsigned(i)] != j)
        seen[unsigned(i)] = j, row_.push_back(i);
    };
    for (int i : below[unsigned(j)]) take(i);
    for (int c : children[unsigned(j)])
      for (int p = begin_[unsigned(c)]; p < begin_[unsigned(c) + 1]; ++p)
        take(row_[unsigned(p)]);
    std::sort(row_.begin() + std::ptrdiff_t(first), row_.end());
    if (row_.size() + n > most) return false;
    begin_.push_back(int(row_.size()));
    if (row_.size() > first) children[unsigned(row_[first])].push_back(j);
    for (auto p = first; p < row_.size(); ++p) ++count[unsigned(row_[p]) + 1];
    const double c = double(row_.size() - first);
    updates_ += c * (c + 1) / 2;
  }
  for (std::size_t k = 0; k < n; ++k) count[k + 1] += count[k];
  left_begin_ = count;
  left_.resize(row_.size());
  for (int j = 0; j < int(n); ++j)
    for (int p = begin_[unsigned(j)]; p < begin_[unsigned(j) + 1]; ++p)
      left_[unsigned(count[unsigned(row_[unsigned(p)])]++)] = {j, p};
  at_.clear();
  for (const Pair& p : pairs_) {
    const auto [j, i] = std::minmax(place_[p.i], place_[p.j]);
    const auto column = row_.begin() + begin_[unsigned(j)];
    at_.push_back(int(
        std::lower_bound(column, row_.begin() + begin_[unsigned(j) + 1], i) -
        row_.begin()));
  }
  entry_.resize(row_.size());
  diagonal_.resize(n);
  into_.resize(n);
  x_.resize(n);
  clear();
  return true;
}

void BlockCholesky::clear() {
  std::fill(entry_.begin(), entry_.end(), Matrix3());
  std::fill(diagonal_.begin(), diagonal_.end(), Matrix3());
}
void BlockCholesky::add_diagonal(unsigned i, const Matrix3& block) {
  lab::add(diagonal_[unsigned(place_[i])], block);
}
void BlockCholesky::add(std::size_t k, const Matrix3& block) {
  lab::add(entry_[unsigned(at_[k])], block);
}

bool BlockCholesky::factorize() {
  bool good = true;
  lanes::run<Factorize>(int(order_.size()), begin_.data(), row_.data(),
                        entry_.data(), diagonal_.data(), left_begin_.data(),
                        left_.data(), into_.data(), &good);
  return good;
}

void BlockCholesky::solve(std::span<Point> b) {
  assert(b.size() == order_.size());
  for (std::size_t k = 0; k < order_.size(); ++k) {
    x_[k].c = four(b[unsigned(order_[k])]);
  }
  lanes::run<Solve>(int(order_.size()), begin_.data(), row_.data(),
                    entry_.data(), diagonal_.data(), x_.data());
  for (std::size_t k = 0; k < order_.size(); ++k) {
    b[unsigned(order_[k])] = point(x_[k].c);
  }
}

}  // namespace lab
