// Removal at nodes of many edges: what it costs, counted, and that it does the
// same once the graph keeps the places of edges in the lists of their ends.
#include <gtest/gtest.h>
#include <algorithm>
#include <cstddef>
#include <random>
#include <set>
#include <span>
#include <stdexcept>
#include <utility>
#include <vector>
#include "Graph.hpp"

namespace {

std::size_t reads = 0;  // entries of neighbor lists looked at

// A graph of a type of its own: of that type the functions through which lists
// are read are specialized here, to count; another opens what is private.
struct Counted {};
using Counting = Graph<Counted, int>;
using G = Graph<int, int>;

}  // namespace

template <>
std::span<const Counting::Neighbor>
graph_detail::ListPool<Counting::Neighbor>::items(const List& l) const {
  reads += l.size;
  return {pool_.data() + l.begin, l.size};
}
template <>
Counting::Neighbor& graph_detail::ListPool<Counting::Neighbor>::operator[](
    std::size_t at) {
  return ++reads, pool_[at];
}

namespace {

// To search the lists would read n^2/2 entries of the star's, and n^3/6 of the
// complete graph's.
TEST(GraphHubs, RemovalTakesConstantTimeForEachEdge) {
  for (bool by_edge : {false, true}) {
    Counting star;
    auto hub = star.add_node(Point());
    for (int i = 0; i < 2000; ++i) star.add_edge(hub, star.add_node(Point()));
    std::vector<Counting::Edge> edges(hub.edge_begin(), hub.edge_end());
    reads = 0;
    for (auto e : edges)
      by_edge ? star.remove_edge(e) : star.remove_node(e.node2());
    EXPECT_LE(reads, 8 * edges.size());
    EXPECT_EQ(hub.degree(), 0u);
    star.check_invariants();
  }
  Counting complete;
  for (int i = 0; i < 100; ++i) {
    auto n = complete.add_node(Point());
    for (int k = 0; k < i; ++k) complete.add_edge(n, complete.node(k));
  }
  const std::size_t edges = complete.num_edges();
  reads = 0;
  while (complete.num_nodes() > 0) complete.remove_node(complete.node(0));
  EXPECT_LE(reads, 8 * edges);
}

// An explicit instantiation may name private members ([temp.spec]).
template <auto pool, auto places>
struct Open {
  friend constexpr auto& places_of(G& g) { return g.*pool.*places; }
};
constexpr auto& places_of(G& g);
template struct Open<&G::pool_,
                     &graph_detail::NeighborPool<G::Neighbor>::places_>;

// The histories of test_graph have short lists; here they have up to 29
// entries.
TEST(GraphHubs, NothingChangesOnceTheGraphKeepsPlaces) {
  std::mt19937 random(5);
  G g;
  std::vector<G::Node> n;
  std::set<std::pair<int, int>> edges;  // by the nodes' values
  for (int step = 0; step < 2000; ++step) {
    if (step == 1200) {
      EXPECT_GT(places_of(g).size(), 0u);
      g.clear(), n.clear(), edges.clear();
    }
    while (n.size() < 30)
      n.push_back(g.add_node(Point(), step + int(n.size())));
    const auto a = n[random() % 30], b = n[random() % 30];
    const auto ends = std::minmax({a.value(), b.value()});
    if (a == b && random() % 4 == 0) {
      std::erase_if(edges, [v = a.value()](auto e) {
        return e.first == v || e.second == v;
      });
      g.remove_node(a);
      std::erase(n, a);
    } else if (a == b) {
      std::vector<unsigned> ids;
      for (auto e : a.edges()) ids.push_back(e.id());
      std::shuffle(ids.begin(), ids.end(), random);
      g.reorder_edges(a, ids);
    } else if (random() % 5 == 0) {
      EXPECT_EQ(g.remove_edge(a, b), edges.erase(ends));
    } else {
      g.add_edge(a, b);
      edges.insert(ends);
    }
    g.check_invariants();
    std::set<std::pair<int, int>> there;
    for (auto e : g.edges())
      there.insert(std::minmax({e.node1().value(), e.node2().value()}));
    ASSERT_EQ(there, edges) << step;
  }
  auto& places = places_of(g);
  ASSERT_GT(places.size(), 0u);
  ++places[g.edge(0).id()][0];
  EXPECT_THROW(g.check_invariants(), std::logic_error);
}

}  // namespace
