#include "lab/fast/FlatCloth.hpp"

#include "lab/fast/FlatKernels.hpp"
#include "lab/fast/GraphArrays.hpp"

namespace lab {

void FlatCloth::take(const Cloth& g, int multiplicity, const Drag& c) {
  multiplicity_ = multiplicity, drag_ = &c;
  if (version_ != arrays(g).version()) lay_out(g);
  read_nodes(g, 0, slots_);
  if (!c.none())
    for (unsigned i = 0; i < slots_; ++i) nodes_[DragC][i] = c[i];
  lanes::run<kernels::ReadSprings>(std::span<const Run>(runs_),
                                   arrays(g).edge_values().data(), multiplicity,
                                   springs_[0], springs_[1]);
  if (!rest_) return;
  const EdgeData* edge = arrays(g).edge_values().data();
  double *K = springs_[0] + rest_first_, *L = springs_[1] + rest_first_;
  const unsigned* id = rest_->edges(0);
  const std::size_t count = rest_->num_rows() * lanes::width;
  for (std::size_t k = 0; k < count; ++k) {
    if (id[k] == Rest::none) continue;  // K = 0
    K[k] = multiplicity * edge[id[k]].K, L[k] = edge[id[k]].L;
  }
}

void FlatCloth::read_nodes(const Cloth& g, unsigned first, unsigned last) {
  lanes::run<kernels::ReadNodes>(&nodes_, arrays(g).positions().data(),
                                 arrays(g).node_values().data(), first, last);
  if (slots_ == g.num_nodes()) return;
  for (unsigned i = first; i < last; ++i)
    if (!arrays(g).node_in_use(i)) nodes_[PerMass][i] = 0;
}

void FlatCloth::write(Cloth& g, unsigned first, unsigned last) const {
  const bool all = slots_ == g.num_nodes();
  const auto write_nodes = [&](unsigned from, unsigned to) {
    lanes::run<kernels::WriteNodes>(&nodes_, arrays(g).positions().data(),
                                    arrays(g).node_values().data(), from, to);
  };
  if (all) return write_nodes(first, last);
  // The nodes between two that were removed, at once.
  for (unsigned i = first; i < last; ++i) {
    const unsigned from = i;
    while (i < last && arrays(g).node_in_use(i)) ++i;
    if (from < i) write_nodes(from, i);
  }
}

namespace {
constexpr auto state = {FlatCloth::X,  FlatCloth::Y,  FlatCloth::Z,
                        FlatCloth::VX, FlatCloth::VY, FlatCloth::VZ,
                        FlatCloth::AX, FlatCloth::AY, FlatCloth::AZ};
}  // namespace

bool FlatCloth::any_inside(const Zone& zone, unsigned first,
                           unsigned last) const {
  bool found = false;
  lanes::run<kernels::AnyInside>(&nodes_, &zone, first, last, &found);
  return found;
}

void FlatCloth::save(std::vector<double>& copy) const {
  copy.resize(state.size() * slots_);
  double* to = copy.data();
  for (const Column c : state) to = std::copy_n(nodes_[c], slots_, to);
}

void FlatCloth::restore(const std::vector<double>& copy) {
  const double* from = copy.data();
  for (const Column c : state) {
    std::copy_n(from, slots_, nodes_[c]);
    from += slots_;
  }
}

void FlatCloth::lay_out(const Cloth& g) {
  slots_ = arrays(g).node_slots(), reach_ = 0;
  rows_.clear(), runs_.clear(), rest_.reset();
  std::vector<char> is_row;
  find_rows(g, is_row);
  const std::size_t whole = (slots_ + tile - 1) / tile * tile;
  // Rows begin at different places of a page, as columns do.
  const std::size_t stride = whole + 9 * 64 / sizeof(double);
  std::vector<std::size_t> first(is_row.size());
  for (std::size_t r = 0; r < rows_.size(); ++r)
    first[rows_[r].offset] = rows_[r].first = r * stride;
  rest_first_ = rows_.size() * stride;
  std::size_t left = 0;
  const auto ends = arrays(g).edge_ends();
  for (unsigned e = 0; e < arrays(g).edge_slots(); ++e) {
    if (!arrays(g).edge_in_use(e)) continue;
    const auto [i, j] = std::minmax(ends[e][0], ends[e][1]);
    reach_ = std::max(reach_, j - i);
    if (j - i < is_row.size() && is_row[j - i])
      add_run(e, first[j - i] + i);
    else
      ++left;
  }
  if (left > 0)
    rest_.emplace(g, [&](unsigned i, unsigned j) {
      const unsigned offset = std::max(i, j) - std::min(i, j);
      return offset < is_row.size() && is_row[offset];
    });
  springs_.resize(2, rest_first_ + (rest_ ? rest_->num_rows() : 0) *
                                       std::size_t(lanes::width));
  // A row's springs reach beyond the last node where they do nothing.
  nodes_.resize(columns_, whole + (rows_.empty() ? 0 : rows_.back().offset));
  version_ = arrays(g).version();
}

/** The rows: offsets that a third of the nodes has a spring at. Evaluated once
 * for each node, these take less time than gathered from both ends. */
void FlatCloth::find_rows(const Cloth& g, std::vector<char>& is_row) {
  std::vector<unsigned> count(std::min(slots_, longest_row + 1));
  const auto ends = arrays(g).edge_ends();
  for (unsigned e = 0; e < arrays(g).edge_slots(); ++e) {
    if (!arrays(g).edge_in_use(e)) continue;
    const auto [i, j] = std::minmax(ends[e][0], ends[e][1]);
    if (j - i < count.size()) ++count[j - i];
  }
  for (unsigned o = 1; o < count.size(); ++o)
    if (3 * std::size_t(count[o]) >= slots_) rows_.push_back({o, 0});
  if (rows_.size() > most_rows) {
    std::ranges::stable_sort(rows_, [&](const Row& a, const Row& b) {
      return count[a.offset] > count[b.offset];
    });
    rows_.resize(most_rows);
    std::ranges::sort(rows_, {}, &Row::offset);
  }
  is_row.assign(rows_.empty() ? 0 : rows_.back().offset + 1, false);
  for (const Row& r : rows_) is_row[r.offset] = true;
}

void FlatCloth::add_run(unsigned edge, std::size_t number) {
  if (!runs_.empty())
    if (Run& last = runs_.back();
        last.edge + last.count == edge && last.number + last.count == number) {
      ++last.count;
      return;
    }
  runs_.push_back({edge, 1, number});
}

}  // namespace lab
