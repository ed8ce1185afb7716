#include "lab/fast/OrderedCloth.hpp"

#include <algorithm>
#include <cassert>
#include <numeric>
#include <utility>
#include "lab/fast/GraphArrays.hpp"

namespace lab {

bool is_local(std::span<const Quad> quads, unsigned near) {
  std::size_t jumps = 0;
  for (std::size_t q = 1; q < quads.size(); ++q)
    jumps += std::ranges::any_of(quads[q], [&](unsigned i) {
      return std::ranges::all_of(quads[q - 1], [&](unsigned j) {
        return (i < j ? j - i : i - j) > near;
      });
    });
  return jumps <= quads.size() / 16;
}

namespace {

/** A list of numbers for each point, all lists in one array. */
class Lists {
 public:
  /** @param each each(add) calls add(i, k) for each k that is to be in the list
   *        of point i, in their order; it is called twice */
  template <typename Each>
  Lists(std::size_t num_points, Each each) : first_(num_points + 2) {
    each([this](unsigned i, unsigned) { ++first_[i + 2]; });
    std::partial_sum(first_.begin(), first_.end(), first_.begin());
    all_.resize(first_.back());
    each([this](unsigned i, unsigned k) { all_[first_[i + 1]++] = k; });
  }
  std::span<unsigned> operator[](std::size_t i) {
    return {all_.data() + first_[i], all_.data() + first_[i + 1]};
  }

 private:
  std::vector<unsigned> first_, all_;
};

}  // namespace

MeshOrder cuthill_mckee(std::size_t num_points, std::span<const Quad> quads) {
  Lists quads_at(num_points, [quads](auto add) {
    for (unsigned q = 0; q < quads.size(); ++q)
      for (unsigned i : quads[q]) add(i, q);
  });
  MeshOrder order;
  auto& points = order.points;
  points.reserve(num_points);
  order.quads.reserve(quads.size());
  std::vector<bool> has_point(num_points), has_quad(quads.size());
  auto add_point = [&](unsigned i) {
    if (!has_point[i]) points.push_back(i), has_point[i] = true;
  };
  auto key = [&](unsigned i) { return std::pair(quads_at[i].size(), i); };
  auto walk_from = [&](unsigned start) {
    std::size_t next = points.size();
    for (add_point(start); next < points.size(); ++next) {
      const auto old = std::ptrdiff_t(points.size());
      for (unsigned q : quads_at[points[next]]) {
        if (has_quad[q]) continue;
        order.quads.push_back(q), has_quad[q] = true;
        for (unsigned i : quads[q]) add_point(i);
      }
      std::sort(points.begin() + old, points.end(),
                [&](unsigned i, unsigned j) { return key(i) < key(j); });
    }
  };
  for (unsigned i = 0; i < num_points; ++i)
    if (quads_at[i].size() == 1) walk_from(i);  // a corner
  for (unsigned i = 0; i < num_points; ++i) walk_from(i);
  return order;
}

std::vector<Quad> in_order(std::span<const Quad> quads,
                           const MeshOrder& order) {
  std::vector<unsigned> place(order.points.size());
  for (unsigned p = 0; p < place.size(); ++p) place[order.points[p]] = p;
  std::vector<Quad> ordered;
  ordered.reserve(quads.size());
  for (unsigned q : order.quads)
    for (unsigned& i : ordered.emplace_back(quads[q])) i = place[i];
  return ordered;
}

std::vector<unsigned> sorted_springs(
    const MeshSprings& springs, std::size_t num_points,
    const std::function<unsigned(unsigned)>& number) {
  auto ends = [&](unsigned s) {
    auto [i, j] = springs[s];
    return std::pair(std::min(i, j), std::max(i, j));
  };
  Lists springs_at(num_points, [&](auto add) {
    for (unsigned s = 0; s < springs.size(); ++s) add(ends(s).first, s);
  });
  std::vector<unsigned> all;
  bool more = true;
  for (std::size_t k = 0; more; ++k) {
    more = false;
    for (std::size_t p = 0; p < num_points; ++p) {
      auto here = springs_at[p];
      if (k == 0)
        std::ranges::sort(here, {}, [&](unsigned s) {
          return std::pair(ends(s), number(s));
        });
      // Those with the same ends stand together: step from one to the next.
      if (k >= here.size()) continue;
      more = true;
      if (k == 0 || ends(here[k]) != ends(here[k - 1])) all.push_back(here[k]);
    }
  }
  return all;
}

void build_ordered_cloth(Cloth& g, std::span<const Point> points,
                         std::span<const Quad> quads, MeshSprings::Kind mesh,
                         double K) {
  if (is_local(quads)) return build_cloth(g, points, quads, mesh, K);
  assert(g.size() == 0);
  const MeshSprings springs(quads, mesh);
  g.reserve(unsigned(points.size()), unsigned(springs.expected(points.size())));
  const NodeData at_rest = {Point(), 1.0 / double(points.size())};
  const MeshOrder order = cuthill_mckee(points.size(), quads);
  std::vector<unsigned> node_id(points.size());
  for (unsigned i : order.points)
    node_id[i] = g.add_node(points[i], at_rest).id();
  constexpr unsigned none = -1;  // a spring that came before
  std::vector<unsigned> edge_id(springs.size(), none);
  {
    const auto ordered = in_order(quads, order);
    const MeshSprings local(ordered, mesh);
    const auto n = unsigned(quads.size());
    auto number = [&](unsigned s) { return s / n * n + order.quads[s % n]; };
    for (unsigned s : sorted_springs(local, points.size(), number)) {
      const auto [i, j] = local[s];
      const Node a = g.node(i), b = g.node(j);
      const double L = norm(a.position() - b.position());
      edge_id[number(s)] = g.add_edge(a, b, {K, L}).id();
    }
  }
  std::erase(edge_id, none);
  arrays(g).reindex_nodes(node_id);
  arrays(g).reindex_edges(edge_id);
}

void restore_order(Cloth& g) {
  if (arrays(g).node_slots() < 4096 || g.num_nodes() == arrays(g).node_slots())
    return;
  unsigned descents = 0;  // indices with a smaller id than the index before
  for (unsigned i = 1; i < g.num_nodes(); ++i)
    descents += g.node(i) < g.node(i - 1);
  if (descents > arrays(g).node_slots() / 256) arrays(g).reindex();
}

}  // namespace lab
