/** @file test_graph_nodes.cpp
 * What Graph.hpp promises of nodes beyond the assignment, which test_nodes.cpp
 * tests: handles that survive, the order of the indices, random access, ids,
 * spans, assertions. Edges: test_graph_edges.cpp; work and long random
 * histories: test_graph.cpp. */
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cstddef>
#include <iterator>
#include <map>
#include <memory>
#include <set>
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
  std::vector<int> values_by_index() const {
    std::vector<int> v;
    for (auto it = g.node_begin(); it != g.node_end(); ++it)
      v.push_back((*it).value());
    return v;
  }
};
using Values = std::vector<int>;

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

TEST_F(Nodes, AddNodeGivesTheNextIndexAndKeepsTheOthers) {
  Node m = g.add_node(Point(1, 2, 3), 99);
  EXPECT_EQ(g.num_nodes(), 6u);
  EXPECT_EQ(g.size(), 6u);
  EXPECT_EQ(m.index(), 5u);
  EXPECT_EQ(m.position(), Point(1, 2, 3));
  EXPECT_EQ(m.value(), 99);
  EXPECT_EQ(m.degree(), 0u);
  for (int i = 0; i < 5; ++i) {
    expect_intact(i);
    EXPECT_EQ(n[i].index(), unsigned(i));
  }
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

TEST_F(Nodes, HasNodeKnowsItsOwnOnly) {
  G other;
  Node foreign = other.add_node(Point(0, 0, 0), 0);
  EXPECT_EQ(foreign.index(), n[0].index());
  EXPECT_TRUE(g.has_node(n[0]));
  EXPECT_FALSE(g.has_node(foreign));
  EXPECT_FALSE(other.has_node(n[0]));
  EXPECT_FALSE(g.has_node(Node()));
}

// ------------------------------------------------------------------- removing

TEST_F(Nodes, RemoveNodeReturnsOneOnce) {
  EXPECT_EQ(g.remove_node(n[2]), 1u);
  EXPECT_EQ(g.num_nodes(), 4u);
  EXPECT_FALSE(g.has_node(n[2]));
  EXPECT_EQ(g.remove_node(n[2]), 0u);
  EXPECT_EQ(g.num_nodes(), 4u);
}

TEST_F(Nodes, RemoveNodeOfNoNodeHereChangesNothing) {
  G other;
  Node foreign = other.add_node(Point());
  auto version = arrays(g).version();
  EXPECT_EQ(g.remove_node(foreign), 0u);
  EXPECT_EQ(g.remove_node(Node()), 0u);
  EXPECT_EQ(arrays(g).version(), version);
  EXPECT_EQ(values_by_index(), (Values{0, 10, 20, 30, 40}));
  EXPECT_TRUE(other.has_node(foreign));
}

TEST_F(Nodes, TheHighestIndexMovesIntoTheHoleAndNoOther) {
  g.remove_node(n[1]);
  EXPECT_EQ(values_by_index(), (Values{0, 40, 20, 30}));
  g.remove_node(n[0]);
  EXPECT_EQ(values_by_index(), (Values{30, 40, 20}));
  g.remove_node(n[2]);  // has the highest index itself
  EXPECT_EQ(values_by_index(), (Values{30, 40}));
  g.add_node(Point(), 7);
  EXPECT_EQ(values_by_index(), (Values{30, 40, 7}));
  for (int i : {3, 4}) expect_intact(i);
}

TEST_F(Nodes, RemoveNodeMayBeGivenAReferenceIntoItsOwnCopies) {
  std::vector<Node> all(g.node_begin(), g.node_end());
  for (const Node& m : all) EXPECT_EQ(g.remove_node(m), 1u);
  EXPECT_EQ(g.num_nodes(), 0u);
}

TEST_F(Nodes, RemovingAtAnIteratorVisitsEachNodeOnce) {
  for (int keep = 0; keep < 32; ++keep) {  // every subset of five
    G h;
    for (int i = 0; i < 5; ++i) h.add_node(Point(i), i);
    std::multiset<int> visited, left;
    for (auto it = h.node_begin(); it != h.node_end();) {
      visited.insert((*it).value());
      auto at = it - h.node_begin();
      if (keep >> (*it).value() & 1)
        ++it;
      else
        it = h.remove_node(it);
      h.check_invariants();
      ASSERT_LE(it - h.node_begin() - at, 1);
    }
    for (auto m : h.nodes()) left.insert(m.value());
    EXPECT_EQ(visited, (std::multiset<int>{0, 1, 2, 3, 4}));
    EXPECT_EQ(left.size(), std::size_t(std::popcount(unsigned(keep))));
    for (int v : left) EXPECT_TRUE(keep >> v & 1);
  }
}

TEST_F(Nodes, RemovingAtAnIteratorGivesTheNodeInTheHoleOrTheEnd) {
  auto it = g.remove_node(g.node_begin() + 1);
  EXPECT_EQ(it, g.node_begin() + 1);
  EXPECT_EQ(*it, n[4]);
  it = g.remove_node(g.node_begin() + 3);  // the highest index
  EXPECT_EQ(it, g.node_end());
}

TEST_F(Nodes, ClearRemovesAll) {
  g.add_edge(n[0], n[1]);
  g.remove_node(n[3]);
  g.clear();
  g.check_invariants();
  EXPECT_EQ(g.num_nodes(), 0u);
  EXPECT_EQ(g.num_edges(), 0u);
  EXPECT_TRUE(g.node_begin() == g.node_end());
  for (Node m : n) EXPECT_FALSE(g.has_node(m));
  Node m = g.add_node(Point(1), 1);
  EXPECT_EQ(m.index(), 0u);
  EXPECT_EQ(m.degree(), 0u);
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

// ----------------------------------------------------- handles live, stay dead

TEST_F(Nodes, HandlesSurviveTheRemovalOfOthers) {
  g.remove_node(n[0]);
  g.remove_node(n[3]);
  for (int i = 0; i < 100; ++i) g.add_node(Point(i), -i);
  for (int i : {1, 2, 4}) expect_intact(i);
  n[4].value() = 41;
  EXPECT_EQ(g.node(n[4].index()).value(), 41);
}

TEST_F(Nodes, HandlesSurviveReindexWhichOrdersByPlaceInMemory) {
  g.remove_node(n[0]);
  g.remove_node(n[2]);
  EXPECT_EQ(values_by_index(), (Values{40, 10, 30}));
  arrays(g).reindex();
  EXPECT_EQ(values_by_index(), (Values{10, 30, 40}));
  for (int i : {1, 3, 4}) expect_intact(i);
  EXPECT_FALSE(g.has_node(n[0]));
  for (unsigned i = 1; i < g.num_nodes(); ++i)
    EXPECT_LT(g.node(i - 1).id(), g.node(i).id());
}

TEST_F(Nodes, ReindexNodesGivesTheIndicesThatItIsTold) {
  const auto version = arrays(g).version();
  arrays(g).reindex_nodes(std::vector<unsigned>{3, 1, 4, 0, 2});
  EXPECT_NE(arrays(g).version(), version);
  EXPECT_EQ(values_by_index(), (Values{30, 10, 40, 0, 20}));
  for (unsigned i = 0; i < 5; ++i) {
    expect_intact(int(i));
    EXPECT_EQ(n[i].id(), i);
    EXPECT_EQ(arrays(g).positions()[i], Point(i, 0, 0));
  }
  EXPECT_EQ(n[4].index(), 2u);
  g.check_invariants();
  g.remove_node(n[1]);  // the node of highest index takes the hole
  EXPECT_EQ(values_by_index(), (Values{30, 20, 40, 0}));
  EXPECT_EQ(g.add_node(Point(), 50).index(), 4u);  // in the slot of n[1]
  arrays(g).reindex_nodes(std::vector<unsigned>{4, 3, 2, 1, 0});
  EXPECT_EQ(values_by_index(), (Values{40, 30, 20, 50, 0}));
  g.remove_node(n[0]);
  arrays(g).reindex_nodes(std::vector<unsigned>{4, 2, 1, 3});
  EXPECT_EQ(values_by_index(), (Values{40, 20, 50, 30}));
  EXPECT_EQ(G(g).node(2).value(), 50);
  arrays(g).reindex_nodes(std::vector<unsigned>{1, 2, 3, 4});
  EXPECT_EQ(values_by_index(), (Values{50, 20, 30, 40}));
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

TEST_F(Nodes, ReindexAfterTheHolesWereFilledStillCounts) {
  g.remove_node(n[1]);
  Node m = g.add_node(Point(), 11);  // in the slot of n[1]
  EXPECT_EQ(values_by_index(), (Values{0, 40, 20, 30, 11}));
  arrays(g).reindex();
  g.check_invariants();
  EXPECT_EQ(values_by_index(), (Values{0, 11, 20, 30, 40}));
  EXPECT_EQ(m.index(), 1u);
  EXPECT_EQ(g.add_node(Point()).index(), 5u);
  EXPECT_EQ(g.remove_node(m), 1u);
  EXPECT_EQ(values_by_index(), (Values{0, 0, 20, 30, 40}));
}

TEST_F(Nodes, TheIdOfANodeStays) {
  std::vector<unsigned> ids;
  for (Node m : n) ids.push_back(m.id());
  g.remove_node(n[0]);
  arrays(g).reindex();
  g.add_node(Point());
  for (int i = 1; i < 5; ++i) EXPECT_EQ(n[i].id(), ids[i]);
}

TEST_F(Nodes, ADeadHandleStaysDead) {
  g.remove_node(n[2]);
  for (int round = 0; round < 1000; ++round) {
    Node m = g.add_node(Point(), 1);
    ASSERT_FALSE(g.has_node(n[2]));
    ASSERT_NE(m, n[2]);
    if (round % 2) g.remove_node(m);
  }
  g.clear();
  for (Node m : n) EXPECT_FALSE(g.has_node(m));
  for (int i = 0; i < 10; ++i) g.add_node(Point());
  for (Node m : n) EXPECT_FALSE(g.has_node(m));
  G copy(g);
  for (Node m : n) EXPECT_FALSE(copy.has_node(m));
}

TEST_F(Nodes, ADeadHandleIsNotTheNewNodeInItsSlot) {
  g.remove_node(n[2]);
  Node m = g.add_node(Point());
  ASSERT_EQ(m.id(), 2u) << "the slot was to be used again";
  EXPECT_NE(m, n[2]);
  EXPECT_NE(m < n[2], n[2] < m);
}

TEST_F(Nodes, ACopiedGraphIsEqualAndItsOwn) {
  g.add_edge(n[0], n[2], 1.5);
  g.remove_node(n[1]);
  G copy(g);
  copy.check_invariants();
  ASSERT_EQ(copy.num_nodes(), g.num_nodes());
  for (unsigned i = 0; i < g.num_nodes(); ++i) {
    EXPECT_EQ(copy.node(i).value(), g.node(i).value());
    EXPECT_EQ(copy.node(i).position(), g.node(i).position());
    EXPECT_EQ(copy.node(i).id(), g.node(i).id());
    EXPECT_NE(copy.node(i), g.node(i));
    EXPECT_FALSE(copy.has_node(g.node(i)));
    EXPECT_FALSE(g.has_node(copy.node(i)));
  }
  copy.node(0).value() = -1;
  copy.remove_node(copy.node(1));
  EXPECT_EQ(g.num_nodes(), 4u);
  expect_intact(0);
}

// ------------------------------------------------------------------ comparing

TEST_F(Nodes, EqualIndicesInTwoGraphsAreDifferentNodes) {
  G other(g);
  Node m = other.node(0);
  EXPECT_FALSE(n[0] == m);
  EXPECT_TRUE(n[0] != m);
  EXPECT_TRUE((n[0] < m) != (m < n[0]));
  EXPECT_TRUE(n[0] == g.node(0));
  EXPECT_FALSE(n[0] != g.node(0));
  EXPECT_FALSE(n[0] < g.node(0));
  EXPECT_TRUE(n[0] <= g.node(0) && n[0] >= g.node(0));
}

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

TEST_F(Nodes, TheOrderNeverChanges) {
  std::vector<Node> all(n);
  std::sort(all.begin(), all.end());
  g.remove_node(all[0]);
  EXPECT_TRUE(std::is_sorted(all.begin(), all.end()));
  arrays(g).reindex();
  EXPECT_TRUE(std::is_sorted(all.begin(), all.end()));
  g.clear();
  EXPECT_TRUE(std::is_sorted(all.begin(), all.end()));
}

TEST_F(Nodes, ANodeIsAKey) {
  std::map<Node, int> value;
  for (Node m : n) value[m] = m.value();
  g.remove_node(n[0]);
  n.push_back(g.add_node(Point(), 50));
  value[n[5]] = 50;
  EXPECT_EQ(value.size(), 6u);
  for (auto m : g.nodes()) EXPECT_EQ(value.at(m), m.value());
  std::set<Node> nodes(g.node_begin(), g.node_end());
  EXPECT_EQ(nodes.count(n[0]), 0u);
  EXPECT_EQ(nodes.count(n[4]), 1u);
}

TEST_F(Nodes, InvalidNodesAreEqualAndCanBeAssigned) {
  Node a, b;
  EXPECT_TRUE(a == b);
  EXPECT_FALSE(a < b || b < a);
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

TEST_F(Nodes, AlgorithmsOfTheStandardLibraryRead) {
  auto far = std::max_element(g.node_begin(), g.node_end(), [](Node a, Node b) {
    return a.position().x < b.position().x;
  });
  EXPECT_EQ(*far, n[4]);
  auto near = std::min_element(
      g.node_begin(), g.node_end(), [](const Node& a, const Node& b) {
        return norm(a.position() - Point(2)) < norm(b.position() - Point(2));
      });
  EXPECT_EQ(*near, n[2]);
  auto at = std::partition_point(g.node_begin(), g.node_end(),
                                 [](Node m) { return m.value() < 25; });
  EXPECT_EQ(*at, n[3]);
  std::vector<Node> sorted(g.node_begin(), g.node_end());
  std::sort(sorted.begin(), sorted.end(),
            [](Node a, Node b) { return a.value() > b.value(); });
  EXPECT_EQ(sorted.front(), n[4]);
  std::vector<Node> back(std::make_reverse_iterator(g.node_end()),
                         std::make_reverse_iterator(g.node_begin()));
  EXPECT_EQ(back, std::vector<Node>(n.rbegin(), n.rend()));
}

TEST_F(Nodes, NodesIsTheRangeOfAll) {
  std::vector<Node> all;
  for (auto m : g.nodes()) all.push_back(m);
  EXPECT_EQ(all, n);
  const G& readable = g;
  all.clear();
  for (const auto& m : readable.nodes()) all.push_back(m);
  EXPECT_EQ(all, n);
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

TEST_F(Nodes, ADeadSlotHoldsDefaults) {
  unsigned id = n[2].id();
  g.remove_node(n[2]);
  EXPECT_FALSE(arrays(g).node_in_use(id));
  EXPECT_EQ(arrays(g).positions()[id], Point());
  EXPECT_EQ(arrays(g).node_values()[id], 0);
  unsigned in_use = 0;
  for (unsigned i = 0; i < arrays(g).node_slots(); ++i)
    in_use += arrays(g).node_in_use(i);
  EXPECT_EQ(in_use, g.num_nodes());
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

TEST_F(Nodes, SlotsOfRemovedNodesAreUsedAgain) {
  for (int round = 0; round < 1000; ++round) {
    g.remove_node(g.node(unsigned(round) % 5));
    g.add_node(Point(), round);
  }
  EXPECT_EQ(arrays(g).node_slots(), 5u);
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
