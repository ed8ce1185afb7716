/** @file test_graph_edges.cpp
 * What Graph.hpp promises of edges beyond the assignment, which test_edges.cpp
 * tests; in the order of test_graph_nodes.cpp. */
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <iterator>
#include <memory>
#include <ranges>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "Graph.hpp"
#include "lab/fast/GraphArrays.hpp"

namespace {

using G = Graph<int, double>;
using Node = G::Node;
using Edge = G::Edge;

static_assert(sizeof(Edge) <= 24);
static_assert(std::is_same_v<G::edge_type, Edge>);
static_assert(std::is_same_v<G::edge_value_type, double>);
static_assert(std::is_same_v<G::edge_iterator, G::EdgeIterator>);
static_assert(std::is_same_v<G::incident_iterator, G::IncidentIterator>);
static_assert(std::is_trivially_copyable_v<Edge>);
static_assert(std::random_access_iterator<G::edge_iterator>);
static_assert(std::random_access_iterator<G::incident_iterator>);
static_assert(std::is_same_v<std::iter_value_t<G::incident_iterator>, Edge>);
static_assert(std::is_same_v<decltype(std::declval<Edge&>().value()), double&>);
static_assert(std::is_same_v<decltype(std::declval<const Edge&>().value()),
                             const double&>);

/** Nodes 0 to 4 at (i, 0, 0); the edges 01, 02, 03, 12, 34 have the indices
 * 0 to 4 and the values 1, 2, 3, 12, 34. */
class Edges : public ::testing::Test {
 protected:
  G g;
  std::vector<Node> n;
  std::vector<Edge> e;
  const std::vector<std::pair<int, int>> ends{
      {0, 1}, {0, 2}, {0, 3}, {1, 2}, {3, 4}};

  Edges() {
    for (int i = 0; i < 5; ++i) n.push_back(g.add_node(Point(i, 0, 0), i));
    for (auto [a, b] : ends) e.push_back(g.add_edge(n[a], n[b], 10 * a + b));
  }
  void TearDown() override { g.check_invariants(); }

  /** The values of the nodes next to @a m, in the order of m.edges(). */
  static std::vector<int> neighbors(Node m) {
    std::vector<int> v;
    for (auto it = m.edge_begin(); it != m.edge_end(); ++it) {
      EXPECT_EQ((*it).node1(), m);
      v.push_back((*it).node2().value());
    }
    EXPECT_EQ(v.size(), m.degree());
    return v;
  }
};
using Ints = std::vector<int>;

// ------------------------------------------------------------- adding, asking

TEST_F(Edges, AddEdgeTakesItsValueFromTheArrayThatGrows) {
  Graph<int, std::string> s;
  std::vector<Graph<int, std::string>::Node> m;
  for (int i = 0; i < 60; ++i) m.push_back(s.add_node(Point()));
  s.add_edge(m[0], m[1], std::string(50, 'x'));
  for (int i = 0; i < 60; ++i)
    for (int k = 0; k < i; ++k)
      ASSERT_EQ(s.add_edge(m[i], m[k], s.edge(0).value()).value(),
                std::string(50, 'x'));
}

TEST_F(Edges, HasEdgeIsFalseForStrangers) {
  EXPECT_FALSE(g.has_edge(n[0], n[0]));
  EXPECT_FALSE(g.has_edge(n[0], Node()));
  EXPECT_FALSE(g.has_edge(Node(), Node()));
  EXPECT_FALSE(g.has_edge(Edge()));
  G other(g);
  EXPECT_FALSE(g.has_edge(n[0], other.node(1)));
  EXPECT_FALSE(g.has_edge(other.node(0), other.node(1)));
  EXPECT_FALSE(g.has_edge(other.edge(0)));
  g.remove_node(n[1]);
  g.add_edge(g.add_node(Point()), n[0]);  // in the slot of n[1]
  EXPECT_FALSE(g.has_edge(n[0], n[1]));
  EXPECT_FALSE(g.has_edge(n[1], n[0]));
}

using EdgesDeathTest = Edges;

TEST_F(EdgesDeathTest, AddEdgeNeedsTwoNodesOfItsOwn) {
  G other(g);
  Node dead = n[4];
  g.remove_node(dead);
  EXPECT_DEATH(g.add_edge(n[0], n[0]), "a == b");
  EXPECT_DEATH(g.add_edge(n[0], other.node(1)), "has_node");
  EXPECT_DEATH(g.add_edge(other.node(0), n[1]), "has_node");
  EXPECT_DEATH(g.add_edge(n[0], dead), "has_node");
  EXPECT_DEATH(g.add_edge(Node(), n[0]), "has_node");
}

TEST_F(EdgesDeathTest, AnInvalidOrDeadEdgeIsNotUsed) {
  Edge dead = e[1];
  g.remove_edge(dead);
  g.add_edge(n[1], n[4]);  // in its slot
  for (Edge f : {Edge(), dead}) {
    EXPECT_DEATH(f.node1(), "has_edge");
    EXPECT_DEATH(f.node2(), "has_edge");
    EXPECT_DEATH(f.value(), "has_edge");
    EXPECT_DEATH(std::as_const(f).value(), "has_edge");
    EXPECT_DEATH(f.index(), "has_edge");
    EXPECT_DEATH(f.length(), "has_edge");
  }
  EXPECT_DEATH(g.edge(5), "num_edges");
  EXPECT_DEATH(*g.edge_end(), "num_edges");
  EXPECT_DEATH(g.remove_edge(g.edge_end()), "num_edges");
  g.remove_edge(g.edge(0));
  EXPECT_DEATH(arrays(g).edge_with_id(0), "edge_in_use");
  EXPECT_DEATH(arrays(g).edge_with_id(99), "edge_slots");
}

// ------------------------------------------------------------------- removing

TEST_F(Edges, AnEdgeRemovedComesAsNewWithItsDefault) {
  g.remove_edge(e[0]);
  Edge f = g.add_edge(n[1], n[0]);
  EXPECT_NE(f, e[0]);
  EXPECT_EQ(f.value(), 0);
  EXPECT_EQ(f.index(), 4u);
  EXPECT_EQ(g.edge(4).node1(), n[1]);
}

TEST_F(Edges, RemoveNodeMayBeGivenAnEndOfItsEdge) {
  EXPECT_EQ(g.remove_node(e[0].node1()), 1u);
  EXPECT_EQ(g.remove_node(g.edge(0).node2()), 1u);
  EXPECT_EQ(g.num_nodes(), 3u);
}

TEST_F(Edges, ReorderEdgesGivesThoseOfANodeAnotherOrder) {
  const auto version = arrays(g).version();
  arrays(g).reorder_edges(n[0], std::vector<unsigned>{2, 0, 1});
  EXPECT_EQ(neighbors(n[0]), (Ints{3, 1, 2}));
  EXPECT_NE(arrays(g).version(), version);
  g.check_invariants();
  // It takes back what removals make of the order.
  g.remove_edge(e[2]);
  EXPECT_EQ(neighbors(n[0]), (Ints{2, 1}));
  arrays(g).reorder_edges(n[0], std::vector<unsigned>{0, 1});
  EXPECT_EQ(neighbors(n[0]), (Ints{1, 2}));
  EXPECT_EQ(neighbors(n[1]), (Ints{0, 2}));
  arrays(g).reorder_edges(n[4], std::vector<unsigned>{4});
  g.check_invariants();
}

// ------------------------------------------------------------------ comparing

TEST_F(Edges, TheOrderIsTotalOverGraphsDeadAndInvalidEdges) {
  G other(g);
  std::vector<Edge> all = e;
  all.insert(all.end(), other.edge_begin(), other.edge_end());
  all.push_back(Edge());
  g.remove_edge(e[1]);
  all.push_back(g.add_edge(n[1], n[4]));
  ASSERT_EQ(all.back().id(), 1u) << "the slot was to be used again";
  for (const Edge& a : all)
    for (const Edge& b : all) {
      EXPECT_EQ((a < b) + (b < a) + (a == b), 1);
      EXPECT_EQ(a > b, b < a);
      EXPECT_EQ(a <= b, !(b < a));
      EXPECT_EQ(a >= b, !(a < b));
      EXPECT_EQ(a != b, !(a == b));
      for (const Edge& c : all) EXPECT_TRUE(a < c || !(a < b && b < c));
    }
}

TEST_F(Edges, InvalidEdgesAreEqualAndCanBeAssigned) {
  Edge a, b;
  EXPECT_TRUE(a == b);
  EXPECT_NE(a, e[0]);
  a = e[0];
  EXPECT_EQ(a, e[0]);
}

// ------------------------------------------------------------------ iterating

TEST_F(Edges, IncidentIteratorsAreRandomAccess) {
  auto b = n[0].edge_begin(), end = n[0].edge_end();
  EXPECT_EQ(end - b, 3);
  EXPECT_EQ(b[2], e[2]);
  EXPECT_EQ(*(b + 1), e[1]);
  EXPECT_EQ(*(1 + b), e[1]);
  EXPECT_EQ(end[-1].node2(), n[3]);
  EXPECT_EQ(b->node2(), n[1]);
  EXPECT_TRUE(b < end && end > b && b != end && b + 3 == end);
  std::vector<Edge> back(std::make_reverse_iterator(end),
                         std::make_reverse_iterator(b));
  EXPECT_EQ(back, (std::vector<Edge>{e[2], e[1], e[0]}));
  auto longest = std::max_element(
      b, end, [](Edge x, Edge y) { return x.length() < y.length(); });
  EXPECT_EQ(*longest, e[2]);
}

TEST_F(Edges, EdgeIteratorsAreRandomAccess) {
  auto b = g.edge_begin(), end = g.edge_end();
  EXPECT_EQ(end - b, 5);
  EXPECT_EQ(b[3], e[3]);
  EXPECT_EQ(*(end - 1), e[4]);
  EXPECT_EQ(b->value(), 1);
  std::vector<Edge> all;
  for (auto f : g.edges()) all.push_back(f);
  EXPECT_EQ(all, e);
}

TEST_F(Edges, AddEdgeKeepsTheIteratorsItSaysItKeeps) {
  auto node = g.node_begin() + 3;
  auto edge = g.edge_begin() + 3;
  auto incident = n[1].edge_begin() + 1;  // node 1 gets no edge
  for (int i = 0; i < 100; ++i)
    g.add_edge(n[i % 2 ? 0 : 4], g.add_node(Point()));
  EXPECT_EQ(*node, n[3]);
  EXPECT_EQ(*edge, e[3]);
  EXPECT_EQ(*incident, e[3]);
  EXPECT_EQ((*incident).node2(), n[2]);
}

TEST_F(Edges, RemoveEdgeKeepsWhatItSaysItKeeps) {
  double& value = e[2].value();
  auto node = g.node_begin() + 3;
  auto edge = g.edge_begin() + 3;
  auto incident = n[3].edge_begin() + 1;
  g.remove_edge(e[0]);
  EXPECT_EQ(&e[2].value(), &value);
  EXPECT_EQ(*node, n[3]);
  EXPECT_EQ(*edge, e[3]);
  EXPECT_EQ(*incident, e[4]);
}

// ---------------------------------------------------------------- arrays by id

TEST_F(Edges, SpansAndProxiesAreTheSameStorage) {
  g.remove_node(n[1]);
  const G& readable = g;
  ASSERT_EQ(arrays(g).edge_ends().size(), arrays(g).edge_slots());
  ASSERT_EQ(arrays(g).edge_values().size(), arrays(g).edge_slots());
  for (auto f : g.edges()) {
    EXPECT_EQ(&arrays(g).edge_values()[f.id()], &f.value());
    EXPECT_EQ(&arrays(readable).edge_values()[f.id()], &f.value());
    EXPECT_EQ(arrays(g).edge_ends()[f.id()][0], f.node1().id());
    EXPECT_EQ(arrays(g).edge_ends()[f.id()][1], f.node2().id());
    EXPECT_TRUE(arrays(g).edge_in_use(f.id()));
    EXPECT_EQ(arrays(g).edge_with_id(f.id()), f);
    EXPECT_EQ(arrays(g).edge_with_id(f.id()).node1(), f.node1());
  }
}

TEST_F(Edges, ARemovedValueIsGivenUpAtOnce) {
  Graph<int, std::shared_ptr<int>> h;
  auto a = h.add_node(Point()), b = h.add_node(Point()),
       c = h.add_node(Point());
  auto shared = std::make_shared<int>(1);
  h.add_edge(a, b, shared);
  h.add_edge(b, c, shared);
  EXPECT_EQ(shared.use_count(), 3);
  h.remove_edge(a, b);
  EXPECT_EQ(shared.use_count(), 2);
  h.remove_node(b);
  EXPECT_EQ(shared.use_count(), 1);
}

TEST_F(Edges, VersionChangesWithTheEdgesOnly) {
  auto version = arrays(g).version();
  auto changed = [&] {
    auto old = std::exchange(version, arrays(g).version());
    return version != old;
  };
  e[0].value() = 1;
  arrays(g).edge_values()[0] = 2;
  (void)g.has_edge(n[0], n[1]);
  g.add_edge(n[0], n[1]);
  g.remove_edge(Edge());
  g.remove_edge(n[1], n[4]);
  EXPECT_FALSE(changed());
  g.add_edge(n[1], n[4]);
  EXPECT_TRUE(changed());
  g.remove_edge(n[1], n[4]);
  EXPECT_TRUE(changed());
  g.remove_edge(e[0]);
  EXPECT_TRUE(changed());
  g.remove_edge(e[0]);
  EXPECT_FALSE(changed());
  g.remove_edge(g.edge_begin());
  EXPECT_TRUE(changed());
}

// ------------------------------------------------------- ranges and their ends

/** A ring of ten nodes, and one node apart. */
class Ring : public ::testing::Test {
 protected:
  Graph<int> g;
  Ring() {
    for (int i = 0; i < 10; ++i) g.add_node(Point(i, 0, 0));
    for (int i = 0; i < 10; ++i) g.add_edge(g.node(i), g.node((i + 1) % 10));
    g.add_node(Point(100, 0, 0));
  }
};

TEST_F(Ring, DeathAtTheEndOfARange) {
  auto n = g.node(3);
  EXPECT_DEATH((*g.node_end()).value(), "in no graph: .* \\*node_end");
  EXPECT_DEATH(*(g.node_end() + 1), "beyond node_end");
  EXPECT_DEATH(*g.edge_end(), "edge_end\\(\\) is dereferenced");
  EXPECT_DEATH(*n.edge_end(), "Node::edge_end\\(\\) is dereferenced");
  EXPECT_DEATH(n.edge_end()->node2(), "Node::edge_end");
  EXPECT_DEATH(n.edge_begin()[2], "Node::edge_end");
  EXPECT_DEATH(*(n.edge_begin() - 1), "Node::edge_end");
  EXPECT_DEATH(*g.node(10).edge_begin(), "Node::edge_end");  // it has none
  EXPECT_DEATH(*Graph<int>::node_iterator(), "no graph");
  EXPECT_DEATH(*Graph<int>::incident_iterator(), "no graph");
  auto second = n.edge_begin() + 1;
  g.remove_edge(*second);  // the list got shorter
  EXPECT_DEATH(*second, "iterator gone stale");
  auto first = n.edge_begin();
  g.remove_node(n);
  EXPECT_DEATH(*first, "iterator gone stale");
}

// An end that is taken by its node, and never read.
TEST_F(Ring, TheNodeAtTheEndIsPassedOn) {
  auto count = [](const auto& first, const auto& last, auto it) {
    int nodes = 0;
    for (auto n = first; !(n == last); n = *++it) ++nodes;
    return nodes;
  };
  EXPECT_EQ(count(*g.node_begin(), *g.node_end(), g.node_begin()), 11);
  Graph<int> empty;
  EXPECT_EQ(count(*empty.node_begin(), *empty.node_end(), empty.node_end()), 0);
}

TEST_F(Ring, RangesAreThoseOfTheStandard) {
  using G = Graph<int, char>;
  static_assert(std::random_access_iterator<G::node_iterator>);
  static_assert(std::random_access_iterator<G::edge_iterator>);
  static_assert(std::random_access_iterator<G::incident_iterator>);
  using Nodes = decltype(std::declval<const G&>().nodes());
  using Edges = decltype(std::declval<G::node_type>().edges());
  static_assert(std::ranges::random_access_range<Nodes>);
  static_assert(std::ranges::sized_range<Nodes>);
  static_assert(std::ranges::view<Nodes> && std::ranges::view<Edges>);
  static_assert(std::ranges::borrowed_range<Edges>);
  for (auto n : g.nodes()) n.value() = int(10 - n.index());
  using N = Graph<int>::node_type;
  const auto least = std::ranges::min_element(
      g.nodes(), {}, [](const N& n) { return n.value(); });
  EXPECT_EQ(*least, g.node(10));
  EXPECT_EQ(std::ranges::count_if(
                g.nodes(), [](const N& n) { return n.value() % 2 == 0; }),
            6);
  EXPECT_EQ(std::ranges::distance(g.node(3).edges()), 2);
}

}  // namespace
