/** @file test_graph_contract.cpp
 * What Graph.hpp promises beyond the assignment, which test_nodes.cpp and
 * test_edges.cpp test: random access, what is kept and what is given up,
 * versions, assertions. Handles that survive, dead ones, their order, ids, the
 * values of slots and the order of the indices: the long random histories of
 * test_graph.cpp. */
#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>
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

static_assert(std::is_trivially_copyable_v<Node>);
static_assert(std::is_trivially_copyable_v<Edge>);
static_assert(std::random_access_iterator<G::node_iterator>);
static_assert(std::random_access_iterator<G::edge_iterator>);
static_assert(std::random_access_iterator<G::incident_iterator>);
static_assert(!std::is_copy_assignable_v<G>);
// Reading through a const handle gives const, through another one not.
template <typename H>
using Value = decltype(std::declval<H&>().value());
template <typename H>
using Position = decltype(std::declval<H&>().position());
static_assert(std::is_same_v<Position<Node>, Point&>);
static_assert(std::is_same_v<Position<const Node>, const Point&>);
static_assert(std::is_same_v<Value<Node>, int&>);
static_assert(std::is_same_v<Value<const Node>, const int&>);
static_assert(std::is_same_v<Value<Edge>, double&>);
static_assert(std::is_same_v<Value<const Edge>, const double&>);

/** A graph of five nodes: node i is at (i, 0, 0) and has the value 10 i. */
class Nodes : public ::testing::Test {
 protected:
  G g;
  std::vector<Node> n;

  Nodes() {
    for (int i = 0; i < 5; ++i) n.push_back(g.add_node(Point(i, 0, 0), 10 * i));
  }
  void TearDown() override { g.check_invariants(); }

  /** Node i of the start is alive and is what it was. */
  void expect_intact(int i) {
    EXPECT_TRUE(g.has_node(n[i]));
    EXPECT_EQ(n[i].position(), Point(i, 0, 0));
    EXPECT_EQ(n[i].value(), 10 * i);
    EXPECT_EQ(g.node(n[i].index()), n[i]);
  }
};

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

TEST_F(Nodes, AddNodeTakesItsArgumentsFromTheArraysThatGrow) {
  for (int i = 0; i < 1000; ++i) {  // through many reallocations
    Node m = g.add_node(g.node(3).position(), g.node(3).value());
    ASSERT_EQ(m.position(), Point(3, 0, 0));
    ASSERT_EQ(m.value(), 30);
  }
  Graph<std::string> s;
  s.add_node(Point(), std::string(50, 'x'));
  for (int i = 0; i < 1000; ++i)
    ASSERT_EQ(s.add_node(Point(), s.node(0).value()).value(),
              std::string(50, 'x'));
}

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
  G other(g);
  for (Node m : {n[0], Node(), other.node(1)})
    EXPECT_FALSE(g.has_edge(n[0], m) || g.has_edge(m, m));
  EXPECT_FALSE(g.has_edge(Edge()) || g.has_edge(other.edge(0)));
  g.remove_node(n[1]);
  g.add_edge(g.add_node(Point()), n[0]);  // in the slot of n[1]
  EXPECT_FALSE(g.has_edge(n[0], n[1]) || g.has_edge(n[1], n[0]));
}

// ------------------------------------------------------------------- removing

/** Counts what is done to any of its kind. */
struct Touched {
  static inline int times = 0;
  Touched() { ++times; }
  Touched(const Touched&) { ++times; }
  Touched& operator=(const Touched&) { return ++times, *this; }
  ~Touched() { ++times; }
};
TEST(Clear, CostsWhatIsThereNow) {
  for (int many : {100, 10000}) {
    Graph<Touched, Touched> g;
    for (int i = 0; i < many; ++i) {
      g.add_node(Point());
      if (i > 0) g.add_edge(g.node(i - 1), g.node(i));
    }
    while (g.num_nodes() > 10) g.remove_node(g.node(10));
    ASSERT_EQ(g.num_edges(), 9u);
    for (int nodes : {10, 0, 3}) {
      const int elements = int(g.num_nodes() + g.num_edges());
      Touched::times = 0;
      g.clear();
      // Made, assigned and gone: the default that each is reset to.
      EXPECT_EQ(Touched::times, 3 * elements) << many;
      for (int i = 0; i < nodes; ++i) g.add_node(Point());
    }
  }
}

TEST_F(Nodes, ReserveKeepsThePlacesOfWhatComesLater) {
  g.reserve(1000, 500);
  for (int i : {0, 1, 2, 3, 4}) expect_intact(i);
  const auto version = arrays(g).version();
  const Point* positions = arrays(g).positions().data();
  const int* values = arrays(g).node_values().data();
  g.add_edge(n[0], n[1]);
  const double* edges = arrays(g).edge_values().data();
  for (int i = 5; i < 1000; ++i)
    n.push_back(g.add_node(Point(i, 0, 0), 10 * i));
  for (int i = 1; i < 500; ++i) g.add_edge(n[i], n[i + 1]);
  EXPECT_EQ(g.num_edges(), 500u);
  EXPECT_EQ(arrays(g).positions().data(), positions);
  EXPECT_EQ(arrays(g).node_values().data(), values);
  EXPECT_EQ(arrays(g).edge_values().data(), edges);
  EXPECT_NE(arrays(g).version(), version);
  g.reserve(1, 1);  // never less than there is
  for (int i = 0; i < 1000; ++i) expect_intact(i);
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

TEST_F(Edges, InvalidHandlesAreEqualAndCanBeAssigned) {
  Node a, b;
  EXPECT_TRUE(a == b && !(a < b) && a != n[0] && Edge() == Edge());
  EXPECT_NE(a < n[0], n[0] < a);
  EXPECT_FALSE(g.has_node(a));
  EXPECT_EQ(a = n[0], n[0]);
}

using NodesDeathTest = Nodes;
using EdgesDeathTest = Edges;

TEST_F(NodesDeathTest, AnInvalidOrDeadNodeIsNotUsed) {
  Node dead = n[2];
  g.remove_node(dead);
  g.add_node(Point());  // in its slot
  for (Node m : {Node(), dead}) {
    EXPECT_DEATH(m.position(), "has_node");
    EXPECT_DEATH(std::as_const(m).position(), "has_node");
    EXPECT_DEATH(m.value(), "has_node");
    EXPECT_DEATH(std::as_const(m).value(), "has_node");
    EXPECT_DEATH(m.index(), "has_node");
    EXPECT_DEATH(m.id(), "has_node");
    EXPECT_DEATH(m.degree(), "has_node");
    EXPECT_DEATH(m.edge_begin(), "has_node");
    EXPECT_DEATH(m.edge_end(), "has_node");
  }
  EXPECT_DEATH(g.node(5), "num_nodes");
  EXPECT_FALSE(g.has_node(*g.node_end())) << "it may be passed on";
  EXPECT_DEATH(g.remove_node(g.node_end()), "num_nodes");
  g.remove_node(g.node(0));
  EXPECT_DEATH(arrays(g).node_with_id(0), "node_in_use");
  EXPECT_DEATH(arrays(g).node_with_id(99), "node_slots");
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
  EXPECT_DEATH(g.remove_edge(g.edge_end()), "num_edges");
  g.remove_edge(g.edge(0));
  EXPECT_DEATH(arrays(g).edge_with_id(0), "edge_in_use");
  EXPECT_DEATH(arrays(g).edge_with_id(99), "edge_slots");
}

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

TEST_F(NodesDeathTest, ReindexNodesWantsEachNodeOnce) {
  g.remove_node(n[4]);
  using Ids = std::vector<unsigned>;
  EXPECT_DEATH(arrays(g).reindex_nodes(Ids{1, 2, 3}), "size_");
  EXPECT_DEATH(arrays(g).reindex_nodes(Ids{3, 2, 1, 2}), "index_of");
  EXPECT_DEATH(arrays(g).reindex_nodes(Ids{0, 0, 1, 2}), "index_of");
  EXPECT_DEATH(arrays(g).reindex_nodes(Ids{3, 2, 1, 4}), "in_use");
  EXPECT_DEATH(arrays(g).reindex_nodes(Ids{3, 2, 1, 5}), "slots_");
}

// ------------------------------------------------------------------ iterating

TEST_F(Nodes, NodeIteratorsAreRandomAccess) {
  auto b = g.node_begin(), e = g.node_end();
  EXPECT_EQ(e - b, 5);
  EXPECT_EQ(b - e, -5);
  EXPECT_EQ(*b, n[0]);
  EXPECT_EQ(b[3], n[3]);
  EXPECT_EQ(*(b + 2), n[2]);
  EXPECT_EQ(*(2 + b), n[2]);
  EXPECT_EQ(*(e - 1), n[4]);
  EXPECT_EQ(e[-2], n[3]);
  auto it = b;
  EXPECT_EQ(*it++, n[0]);
  EXPECT_EQ(*++it, n[2]);
  EXPECT_EQ(*it--, n[2]);
  EXPECT_EQ(*--it, n[0]);
  EXPECT_EQ(*(it += 4), n[4]);
  EXPECT_EQ(*(it -= 3), n[1]);
  EXPECT_TRUE(b < it && it > b && b <= b && b >= b && it != b && it == b + 1);
  EXPECT_EQ(it->value(), 10);
  it->value() = 11;
  EXPECT_EQ(n[1].value(), 11);
}

TEST_F(Nodes, AddNodeKeepsIterators) {
  auto first = g.node_begin(), third = first + 2;
  auto end = g.node_end();
  for (int i = 0; i < 100; ++i) g.add_node(Point());
  EXPECT_EQ(*first, n[0]);
  EXPECT_EQ(*third, n[2]);
  EXPECT_EQ((*end).index(), 5u);  // an end stays where it was
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

TEST_F(Nodes, RemoveNodeKeepsIteratorsReferencesAndSpansOfOthers) {
  Point& p = n[3].position();
  int& v = n[3].value();
  auto positions = arrays(g).positions();
  auto second = g.node_begin() + 2;
  g.remove_node(n[1]);
  EXPECT_EQ(&n[3].position(), &p);
  EXPECT_EQ(&n[3].value(), &v);
  EXPECT_EQ(&positions[n[3].id()], &p);
  EXPECT_EQ(*second, n[2]);
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

TEST_F(Ring, RangesAreThoseOfTheStandard) {
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

TEST_F(Edges, VersionChangesWithTheGraphOrItsIndicesOnly) {
  const auto expect = [this](bool changes, auto&& what) {
    const auto old = arrays(g).version();
    what();
    EXPECT_EQ(arrays(g).version() != old, changes);
  };
  expect(false, [this] {
    n[0].value() = 1, e[0].value() = 1, n[0].position() = Point(1);
    arrays(g).positions()[0] = Point(2), arrays(g).edge_values()[0] = 2;
    (void)g.has_edge(n[0], n[1]), g.add_edge(n[0], n[1]);  // is there
    g.remove_node(Node()), g.remove_edge(Edge()), g.remove_edge(n[1], n[4]);
  });
  expect(true, [this] { g.add_edge(n[1], n[4]); });
  expect(true, [this] { g.remove_edge(n[1], n[4]); });
  expect(true, [this] { g.remove_edge(g.edge_begin()); });
  expect(true, [this] { g.add_node(Point()); });
  expect(true, [this] { g.remove_node(n[0]); });
  expect(false, [this] { g.remove_node(n[0]); });
  expect(true, [this] { g.remove_node(g.node_begin()); });
  expect(true, [this] { arrays(g).reindex(); });
  expect(true, [this] { g.clear(); });
}

// bool has no array of its own in std::vector; values may be left out.
TEST(ValueType, IsBoolOrNothing) {
  Graph<bool, bool> g;
  const auto a = g.add_node(Point(), true), b = g.add_node(Point());
  auto e = g.add_edge(a, b, true);
  EXPECT_TRUE(a.value() && !b.value() && e.value());
  e.value() = false;
  EXPECT_FALSE(g.edge(0).value());
  Graph h;
  static_assert(std::is_same_v<decltype(h), Graph<>>);
}

}  // namespace
