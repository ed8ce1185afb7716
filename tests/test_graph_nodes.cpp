/** @file test_graph_nodes.cpp
 * What Graph.hpp promises of nodes beyond the assignment, which test_nodes.cpp
 * tests: random access, what is kept and what is given up, spans, assertions.
 * Edges: test_graph_edges.cpp. Handles that survive, dead ones, ids and the
 * order of the indices: the long random histories of test_graph.cpp. */
#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <memory>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "Graph.hpp"
#include "lab/fast/GraphArrays.hpp"

namespace {

using G = Graph<int, double>;
using Node = G::Node;

static_assert(sizeof(Node) <= 16);
static_assert(std::is_same_v<G::size_type, unsigned>);
static_assert(std::is_same_v<G::node_type, Node>);
static_assert(std::is_same_v<G::node_value_type, int>);
static_assert(std::is_same_v<G::node_iterator, G::NodeIterator>);
static_assert(std::is_trivially_copyable_v<Node>);
static_assert(std::random_access_iterator<G::node_iterator>);
static_assert(std::is_same_v<std::iter_value_t<G::node_iterator>, Node>);
static_assert(!std::is_copy_assignable_v<G>);
// Reading through a const Node gives const, through a Node not.
static_assert(
    std::is_same_v<decltype(std::declval<Node&>().position()), Point&>);
static_assert(std::is_same_v<decltype(std::declval<const Node&>().position()),
                             const Point&>);
static_assert(std::is_same_v<decltype(std::declval<Node&>().value()), int&>);
static_assert(
    std::is_same_v<decltype(std::declval<const Node&>().value()), const int&>);

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

// ------------------------------------------------------------- adding, asking

TEST(EmptyGraph, HasNoNodes) {
  G g;
  EXPECT_EQ(g.size(), 0u);
  EXPECT_EQ(g.num_nodes(), 0u);
  EXPECT_TRUE(g.node_begin() == g.node_end());
  EXPECT_EQ(arrays(g).node_slots(), 0u);
  EXPECT_TRUE(arrays(g).positions().empty());
  g.clear();
  arrays(g).reindex();
  g.check_invariants();
}

TEST_F(Nodes, PositionAndValueAreTheOnesInTheGraph) {
  Node copy = n[3];
  n[3].position() = Point(0, 5, 0);
  n[3].position().z = 2;
  n[3].value() += 4;
  EXPECT_EQ(copy.position(), Point(0, 5, 2));
  EXPECT_EQ(g.node(3).value(), 34);
  EXPECT_EQ(&g.node(3).position(), &copy.position());
}

TEST_F(Nodes, AddNodeTakesItsArgumentsFromTheArraysThatGrow) {
  for (int i = 0; i < 1000; ++i) {  // through many reallocations
    Node m = g.add_node(g.node(3).position(), g.node(3).value());
    ASSERT_EQ(m.position(), Point(3, 0, 0));
    ASSERT_EQ(m.value(), 30);
  }
  Graph<std::string> s;
  const std::string& first = s.add_node(Point(), std::string(50, 'x')).value();
  for (int i = 0; i < 1000; ++i)
    ASSERT_EQ(s.add_node(Point(), s.node(0).value()).value(),
              std::string(50, 'x'));
  (void)first;  // long since somewhere else
}

// ------------------------------------------------------------------- removing

TEST_F(Nodes, RemoveNodeMayBeGivenAReferenceIntoItsOwnCopies) {
  std::vector<Node> all(g.node_begin(), g.node_end());
  for (const Node& m : all) EXPECT_EQ(g.remove_node(m), 1u);
  EXPECT_EQ(g.num_nodes(), 0u);
}

TEST_F(Nodes, ClearBeginsAnewAndKeepsNothingOfTheDead) {
  g.add_edge(n[0], n[1], 1.5);
  g.add_edge(n[1], n[2], 2.5);
  g.remove_node(n[3]);
  for (int round = 0; round < 3; ++round) {
    g.clear();
    g.check_invariants();
    EXPECT_EQ(arrays(g).node_slots(), 0u);
    EXPECT_EQ(arrays(g).edge_slots(), 0u);
    EXPECT_TRUE(arrays(g).positions().empty());
    const Node a = g.add_node(Point(7)), b = g.add_node(Point());
    EXPECT_EQ(a.id(), 0u);
    EXPECT_EQ(a.value() + b.value() + int(b.degree()), 0);
    EXPECT_EQ(g.add_edge(b, a).value(), 0);
    g.check_invariants();
  }
}

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

// ------------------------------------------------------------------ comparing

TEST_F(Nodes, TheOrderIsTotalOverGraphsDeadAndInvalidNodes) {
  G other(g);
  std::vector<Node> all = n;
  all.insert(all.end(), other.node_begin(), other.node_end());
  all.push_back(Node());
  g.remove_node(n[1]);
  all.push_back(g.add_node(Point()));
  for (const Node& a : all)
    for (const Node& b : all) {
      EXPECT_EQ((a < b) + (b < a) + (a == b), 1);
      EXPECT_EQ(a > b, b < a);
      EXPECT_EQ(a <= b, !(b < a));
      EXPECT_EQ(a >= b, !(a < b));
      EXPECT_EQ(a != b, !(a == b));
      for (const Node& c : all) EXPECT_TRUE(a < c || !(a < b && b < c));
    }
}

TEST_F(Nodes, InvalidNodesAreEqualAndCanBeAssigned) {
  Node a, b;
  EXPECT_TRUE(a == b);
  EXPECT_FALSE(a < b || b < a);
  EXPECT_FALSE(g.has_node(a));
  EXPECT_NE(a, n[0]);
  a = n[0];
  EXPECT_EQ(a, n[0]);
}

using NodesDeathTest = Nodes;

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
  EXPECT_DEATH((*g.node_end()).index(), "\\*node_end\\(\\)");
  EXPECT_DEATH(*(g.node_end() + 1), "num_nodes");
  EXPECT_DEATH(g.remove_node(g.node_end()), "num_nodes");
  g.remove_node(g.node(0));
  EXPECT_DEATH(arrays(g).node_with_id(0), "node_in_use");
  EXPECT_DEATH(arrays(g).node_with_id(99), "node_slots");
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

// ---------------------------------------------------------------- arrays by id

TEST_F(Nodes, SpansAndProxiesAreTheSameStorage) {
  g.remove_node(n[1]);
  const G& readable = g;
  ASSERT_EQ(arrays(g).positions().size(), arrays(g).node_slots());
  ASSERT_EQ(arrays(g).node_values().size(), arrays(g).node_slots());
  for (auto m : g.nodes()) {
    EXPECT_EQ(&arrays(g).positions()[m.id()], &m.position());
    EXPECT_EQ(&arrays(g).node_values()[m.id()], &m.value());
    EXPECT_EQ(&arrays(readable).positions()[m.id()], &m.position());
    EXPECT_EQ(&arrays(readable).node_values()[m.id()], &m.value());
    EXPECT_TRUE(arrays(g).node_in_use(m.id()));
    EXPECT_EQ(arrays(g).node_with_id(m.id()), m);
  }
}

TEST_F(Nodes, ARemovedValueIsGivenUpAtOnce) {
  Graph<std::shared_ptr<int>> h;
  auto shared = std::make_shared<int>(1);
  auto a = h.add_node(Point(), shared);
  h.add_node(Point(), shared);
  EXPECT_EQ(shared.use_count(), 3);
  h.remove_node(a);
  EXPECT_EQ(shared.use_count(), 2);
  h.clear();
  EXPECT_EQ(shared.use_count(), 1);
}

TEST_F(Nodes, VersionChangesWithTheNodesOrTheirIndicesOnly) {
  auto version = arrays(g).version();
  auto changed = [&] {
    auto old = std::exchange(version, arrays(g).version());
    return version != old;
  };
  n[0].value() = 1;
  n[0].position() = Point(1);
  arrays(g).positions()[0] = Point(2);
  (void)g.has_node(n[0]);
  g.remove_node(Node());
  EXPECT_FALSE(changed());
  g.add_node(Point());
  EXPECT_TRUE(changed());
  g.remove_node(n[0]);
  EXPECT_TRUE(changed());
  g.remove_node(n[0]);
  EXPECT_FALSE(changed());
  g.remove_node(g.node_begin());
  EXPECT_TRUE(changed());
  arrays(g).reindex();
  EXPECT_TRUE(changed());
  g.clear();
  EXPECT_TRUE(changed());
}

// ------------------------------------------------------------- types of values

/** Add, write, remove and reuse nodes of values @a a and @a b. */
template <typename V>
void exercise(const V& a, const V& b) {
  Graph<V, V> g;
  auto n = g.add_node(Point(1), a);
  auto m = g.add_node(Point(2));
  EXPECT_EQ(n.value(), a);
  EXPECT_EQ(m.value(), V());
  m.value() = b;
  auto e = g.add_edge(n, m, b);
  EXPECT_EQ(e.value(), b);
  e.value() = a;
  EXPECT_EQ(g.edge(0).value(), a);
  for (int i = 0; i < 100; ++i) g.add_node(Point(), b);
  EXPECT_EQ(n.value(), a);
  g.remove_node(n);
  EXPECT_EQ(m.value(), b);
  n = g.add_node(Point());
  EXPECT_EQ(n.value(), V());
  Graph<V, V> copy(g);
  EXPECT_EQ(copy.node(0).value(), g.node(0).value());
  g.clear();
  g.check_invariants();
  copy.check_invariants();
}

TEST(ValueType, IsAnyDefaultConstructibleCopyable) {
  exercise<int>(1, 2);
  exercise<bool>(true, false);
  exercise<char>('a', 'b');
  exercise<std::string>(std::string(40, 'a'), "b");
  exercise<std::vector<int>>({1, 2, 3}, {4});
  exercise<Point>(Point(1), Point(2));
}

TEST(ValueType, MayBeLeftOut) {
  Graph g;
  Graph<> h;
  static_assert(std::is_same_v<decltype(g), decltype(h)>);
  g.add_edge(g.add_node(Point(1)), g.add_node(Point(2)));
  EXPECT_EQ(g.num_nodes(), 2u);
  g.remove_node(g.node(0));
  EXPECT_EQ(g.num_edges(), 0u);
  g.check_invariants();
}

}  // namespace
