#include "lab/methods/BlockFactor.hpp"

#include <algorithm>

#include "lab/fast/Lanes.hpp"

namespace lab::cholesky_detail {

namespace {

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

}  // namespace

void BlockFactor::assign(const Factor& f, std::size_t rows) {
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
          triangle[f.row[k] - j] = f.row[k] == j ? 1 / f.entry[k] : f.entry[k];
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

void BlockFactor::solve(std::span<Point> b) {
  for (std::size_t i = 0; i < order_.size(); ++i) {
    x_[i].c = four(b[unsigned(order_[i])]);
  }
  const Block *first = block_.data(), *end = first + block_.size();
  lanes::run<Forward>(first, end, entry_.data(), row_.data(), x_.data());
  lanes::run<Backward>(first, end, entry_.data() + entry_.size(),
                       row_.data() + row_.size(), x_.data());
  for (std::size_t i = 0; i < order_.size(); ++i) {
    b[unsigned(order_[i])] = point(x_[i].c);
  }
}

/** Join each column with the block before, while that costs few zeros. */
void BlockFactor::find_blocks(const Factor& f) {
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

}  // namespace lab::cholesky_detail
