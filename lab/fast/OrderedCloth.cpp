#include "lab/fast/OrderedCloth.hpp"

#include <algorithm>
#include <numeric>
#include <tuple>
#include <utility>
#include <vector>

#include "lab/fast/GraphArrays.hpp"

namespace lab {

bool is_local(const Cloth& g) {
  constexpr unsigned near = 1000;
  const auto ends = arrays(g).edge_ends();
  std::size_t jumps = 0;
  for (std::size_t e = 1; e < ends.size(); ++e)
    jumps += std::ranges::any_of(ends[e], [&](unsigned i) {
      return std::ranges::all_of(ends[e - 1], [&](unsigned j) {
        return (i < j ? j - i : i - j) > near;
      });
    });
  return jumps <= ends.size() / 16;
}

namespace {

/** The indices of all nodes in the order of memory. */
std::vector<unsigned> cuthill_mckee(const Cloth& g) {
  const auto rank = [&g](unsigned i) {
    return std::pair(g.node(i).degree(), i);
  };
  std::vector<unsigned> starts(g.num_nodes()), order;
  std::iota(starts.begin(), starts.end(), 0u);
  std::ranges::sort(starts, {}, rank);
  std::vector<char> found(g.num_nodes());
  const auto add = [&](unsigned i) {
    if (!std::exchange(found[i], 1)) order.push_back(i);
  };
  std::size_t next = 0;
  for (unsigned start : starts) {
    add(start);
    for (; next < order.size(); ++next) {
      const auto old = std::ptrdiff_t(order.size());
      for (Edge e : g.node(order[next]).edges()) add(e.node2().index());
      std::ranges::sort(order.begin() + old, order.end(), {}, rank);
    }
  }
  return order;
}

}  // namespace

void order_in_memory(Cloth& g) {
  if (is_local(g)) return;
  const Cloth from(g);
  g.clear();
  std::vector<unsigned> place(from.num_nodes()), node_id(from.num_nodes()),
      edge_id(from.num_edges());
  for (unsigned i : cuthill_mckee(from)) {
    place[i] = g.num_nodes();
    node_id[i] = g.add_node(from.node(i).position(), from.node(i).value()).id();
  }
  struct Spring {
    unsigned number, low, high, edge;  // of low's; places; index
  };
  std::vector<Spring> springs;
  springs.reserve(from.num_edges());
  for (Edge e : from.edges()) {
    const auto [low, high] =
        std::minmax({place[e.node1().index()], place[e.node2().index()]});
    springs.push_back({0, low, high, e.index()});
  }
  std::ranges::sort(springs, {},
                    [](const Spring& s) { return std::pair(s.low, s.high); });
  for (std::size_t s = 1; s < springs.size(); ++s)
    if (springs[s].low == springs[s - 1].low)
      springs[s].number = springs[s - 1].number + 1;
  std::ranges::stable_sort(springs, {}, &Spring::number);
  for (const Spring& s : springs) {
    const Edge e = from.edge(s.edge);
    edge_id[s.edge] = g.add_edge(g.node(place[e.node1().index()]),
                                 g.node(place[e.node2().index()]), e.value())
                          .id();
  }
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
