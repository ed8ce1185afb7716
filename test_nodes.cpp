/** @file test_nodes.cpp
 * Tests the nodes of Graph.hpp against the assignment and nothing beyond it, so
 * any Graph.hpp of the course can be tested. A check that fails prints the
 * sentence of the specification that does not hold.
 *
 *   Homework 0    add_node, node, num_nodes, has_node, index, ==, <, clear
 *   Homework 1    values, iterators
 *   Section 3.1   positions that can be modified
 *   Section 7.1   remove_node: by node, at an iterator
 *
 * A removal may change indices and invalidate handles; which ones depends on
 * the graph. So these tests identify a node by its value, which no other node
 * has, and get a new handle after each removal. Each test runs in a process of
 * its own, unless there are arguments: in a debugger give one test,
 * --gtest_filter=Homework0.AddNode. Edges: test_edges.cpp. */
#include <map>
#include <set>
#include <string>

#include "CME212/GraphTests.hpp"
#include "Graph.hpp"

namespace {

using CME212::find_node, CME212::same;

using GraphType = Graph<int, double>;
using NodeType = GraphType::node_type;
using size_type = GraphType::size_type;
static_assert(sizeof(NodeType) <= 16, "a node is a proxy: at most 16 bytes");

/** The expected content: the position of each node, by its value. */
using Model = std::map<int, Point>;

/** The first position of the node of value @a v. */
Point place(int v) { return Point(v, 2 * v, -v); }

/** Add the nodes of values 0, ..., n - 1. */
Model add_nodes(GraphType& g, int n) {
  Model model;
  for (int v = 0; v < n; ++v) {
    g.add_node(place(v), v);
    model[v] = place(v);
  }
  return model;
}

/** Check what is true of every graph of these nodes. */
void check(GraphType& g, const Model& model) {
  ASSERT_EQ(g.num_nodes(), model.size())
      << "num_nodes() is the number of nodes added and not removed";
  ASSERT_EQ(g.size(), model.size()) << "size() equals num_nodes()";
  std::set<int> values, seen;
  for (size_type i = 0; i < g.num_nodes(); ++i) {
    NodeType n = g.node(i);
    EXPECT_EQ(n.index(), i) << "node(i).index() == i for all i < num_nodes()";
    EXPECT_TRUE(g.has_node(n)) << "has_node(node(i)) is true";
    ASSERT_EQ(model.count(n.value()), 1u)
        << "a node keeps its value, and a removed node is gone: there is one "
        << "of value " << n.value();
    values.insert(n.value());
    EXPECT_TRUE(n.position() == model.at(n.value()))
        << "a node keeps its position: not the one of value " << n.value();
  }
  for (const auto& [v, p] : model)
    EXPECT_EQ(values.count(v), 1u)
        << "a node that was not removed is some node(i): none has value " << v;
  size_type visits = 0;
  for (auto it = g.node_begin(); it != g.node_end(); ++it) {
    ASSERT_LT(visits++, g.num_nodes())
        << "node_begin() reaches node_end() after num_nodes() steps";
    EXPECT_TRUE(seen.insert((*it).value()).second)
        << "from node_begin() to node_end() no node is visited twice";
  }
  EXPECT_EQ(seen, values)
      << "from node_begin() to node_end() every node is visited";
}

// ---------------------------------------------------------------- Homework 0

TEST(Homework0, AnEmptyGraphHasNoNodes) {
  GraphType g;
  EXPECT_EQ(g.num_nodes(), 0u) << "a new graph has no nodes";
  EXPECT_EQ(g.size(), 0u) << "size() equals num_nodes()";
  EXPECT_EQ(g.num_edges(), 0u) << "a new graph has no edges";
  EXPECT_TRUE(same(g.node_begin(), g.node_end()))
      << "in an empty graph node_begin() == node_end()";
}

TEST(Homework0, AddNode) {
  GraphType g;
  for (unsigned i = 0; i < 100; ++i) {
    NodeType n = g.add_node(place(int(i)), int(i));
    ASSERT_EQ(g.num_nodes(), i + 1) << "add_node: num_nodes() grows by 1";
    EXPECT_EQ(n.index(), i) << "add_node: result.index() == old num_nodes()";
    EXPECT_TRUE(n == g.node(i)) << "add_node returns the node that it added";
    EXPECT_TRUE(n.position() == place(int(i)))
        << "add_node: the node has the position given";
    EXPECT_EQ(n.degree(), 0u) << "add_node: the node has no edges";
  }
  g.add_node(place(7), 100);
  EXPECT_EQ(g.num_nodes(), 101u) << "two nodes may have the same position";
}

TEST(Homework0, NodesOfTwoGraphs) {
  GraphType g, other;
  add_nodes(g, 3);
  add_nodes(other, 3);
  EXPECT_TRUE(g.has_node(g.node(1))) << "has_node: true of its own nodes";
  EXPECT_FALSE(g.has_node(other.node(1)))
      << "has_node: false of a node of another graph";
  EXPECT_TRUE(g.node(1) == g.node(1))
      << "nodes of the same graph and the same index are equal";
  EXPECT_FALSE(g.node(1) == g.node(2))
      << "nodes of different indices are not equal";
  EXPECT_FALSE(g.node(1) == other.node(1))
      << "nodes of different graphs are not equal";
}

TEST(Homework0, OrderOfNodes) {
  GraphType g, other;
  add_nodes(g, 4);
  add_nodes(other, 4);
  std::set<NodeType> nodes;
  for (GraphType* a : {&g, &other})
    for (size_type i = 0; i < 4; ++i) {
      NodeType x = a->node(i);
      nodes.insert(x);
      for (GraphType* b : {&g, &other})
        for (size_type j = 0; j < 4; ++j) {
          NodeType y = b->node(j);
          EXPECT_EQ(int(x < y) + int(y < x) + int(x == y), 1)
              << "exactly one of x < y, y < x and x == y is true";
        }
    }
  EXPECT_EQ(nodes.size(), 8u) << "nodes can be the keys of a std::set";
  EXPECT_EQ(nodes.count(other.node(2)), 1u) << "a std::set finds its nodes";
}

TEST(Homework0, Clear) {
  GraphType g;
  add_nodes(g, 5);
  g.add_edge(g.node(0), g.node(1));
  g.clear();
  EXPECT_EQ(g.num_edges(), 0u) << "clear: num_edges() == 0";
  check(g, {});
  Model model = add_nodes(g, 3);
  check(g, model);
  EXPECT_EQ(g.node(0).degree(), 0u) << "clear: no edges are left";
}

// ---------------------------------------------------------------- Homework 1

struct Mass {
  double kg = 0;
  Point velocity = Point(0, 0, 0);
};
bool operator==(const Mass& a, const Mass& b) {
  return a.kg == b.kg && a.velocity == b.velocity;
}

/** Nodes hold values of type V. @a a and @a b differ from each other. */
template <typename V>
void check_values(const V& a, const V& b) {
  Graph<V, double> g;
  auto n = g.add_node(place(0), a);
  auto m = g.add_node(place(1));
  EXPECT_TRUE(n.value() == a) << "add_node(position, value): it has that value";
  EXPECT_TRUE(m.value() == V()) << "add_node(position): the value is V()";
  m.value() = b;
  EXPECT_TRUE(g.node(1).value() == b)
      << "value() is the value in the graph: all handles of a node see it";
  EXPECT_TRUE(n.value() == a) << "value(): every node has its own";
  for (int i = 2; i < 100; ++i) g.add_node(place(i), b);
  const auto constant = g.node(0);
  EXPECT_TRUE(constant.value() == a) << "add_node keeps the values of others";
}

TEST(Homework1, NodesHaveValues) {
  check_values<int>(1, 2);
  check_values<double>(0.5, -3);
  check_values<Point>(Point(1, 2, 3), Point(0, 0, 4));
  check_values<Mass>(Mass{1, place(1)}, Mass{2, place(2)});
}

TEST(Homework1, NodeIterator) {
  GraphType g;
  Model model = add_nodes(g, 10);
  check(g, model);
  auto it = g.node_begin(), other = g.node_begin();
  EXPECT_TRUE(same(it, other)) << "iterators at the same node are equal";
  ++it;
  EXPECT_FALSE(same(it, other)) << "++ moves to another node";
  ++other;
  EXPECT_TRUE(same(it, other)) << "++ moves each of two equal iterators alike";
  EXPECT_TRUE(*it == *other) << "equal iterators are at equal nodes";
  (*it).value() = 77;
  EXPECT_EQ(find_node(g, 77).value(), 77) << "*it is a node of the graph";
}

// ----------------------------------------- Section 3.1: modifiable positions

TEST(Section31, PositionsCanBeModified) {
  GraphType g;
  Model model = add_nodes(g, 5);
  NodeType n = g.node(3), copy = n;
  n.position() = Point(0, 5, 1);
  EXPECT_TRUE(n.position() == Point(0, 5, 1))
      << "position() = p: the position is p";
  EXPECT_TRUE(copy.position() == Point(0, 5, 1))
      << "position() = p: all handles of the node see it";
  n.position() += Point(1, 0, 1);
  n.position().x += 1;
  model[3] = Point(2, 5, 2);
  check(g, model);  // and all other nodes stayed
  const NodeType constant = g.node(3);
  EXPECT_TRUE(constant.position() == Point(2, 5, 2))
      << "position() of a const node can be read";
  EXPECT_EQ(constant.index(), 3u) << "position() = p: the index is kept";
  for (auto it = g.node_begin(); it != g.node_end(); ++it)
    (*it).position() += Point(0, 0, 10);
  for (auto& [v, p] : model) p += Point(0, 0, 10);
  check(g, model);
}

// ------------------------------------------------- Section 7.1: remove_node

TEST(Section71, RemoveNode) {
  for (int v = 0; v < 5; ++v) {  // the first, the last, and those between
    GraphType g;
    Model model = add_nodes(g, 5);
    EXPECT_EQ(CME212::remove_node(g, find_node(g, v)), 1)
        << "remove_node(n) returns 1 if n was removed";
    EXPECT_EQ(g.num_nodes(), 4u) << "remove_node(n): num_nodes() falls by 1";
    model.erase(v);
    check(g, model);
    NodeType n = g.add_node(place(9), 9);
    EXPECT_EQ(n.index(), 4u) << "add_node: result.index() == old num_nodes()";
    model[9] = place(9);
    check(g, model);
  }
}

TEST(Section71, RemoveNodeThatIsNotThere) {
  if (!CME212::CountsRemovals<GraphType>) GTEST_SKIP();
  GraphType g, other;
  Model model = add_nodes(g, 3);
  Model others = add_nodes(other, 5);
  EXPECT_EQ(CME212::remove_node(g, other.node(4), 0), 0)
      << "remove_node(n) returns 0 if n is no node of the graph";
  EXPECT_EQ(CME212::remove_node(g, other.node(1), 0), 0)
      << "remove_node(n) returns 0 if n is a node of another graph";
  check(g, model);
  check(other, others);
}

/** The loop of the assignment: remove the nodes of which @a wanted is true. */
template <typename Wanted>
void remove_in_a_loop(int size, Wanted wanted) {
  GraphType g;
  Model model = add_nodes(g, size);
  int steps = 0;
  for (auto it = g.node_begin(); it != g.node_end();) {
    ASSERT_LE(++steps, size * size + size)
        << "remove_node(it) returns an iterator from which the loop ends";
    int v = (*it).value();
    if (wanted(v)) {
      ASSERT_EQ(model.erase(v), 1u) << "remove_node(it) removes the node at it";
      it = CME212::remove_node_at(g, it);
      ASSERT_EQ(g.num_nodes(), model.size())
          << "remove_node(it): num_nodes() falls by 1";
    } else {
      ++it;
    }
  }
  for (int v = 0; v < size; ++v)
    EXPECT_FALSE(wanted(v) && model.count(v) == 1)
        << "remove_node(it) returns an iterator from which the loop visits all "
        << "nodes not visited before: it did not visit the one of value " << v;
  check(g, model);
}

TEST(Section71, RemoveNodesInALoop) {
  using Wanted = bool (*)(int);
  const Wanted cases[] = {[](int v) { return v % 2 == 0; },
                          [](int v) { return v == 4; },
                          [](int v) { return v % 3 != 1; },
                          [](int) { return true; }, [](int) { return false; }};
  for (int size : {5, 20})
    for (Wanted wanted : cases) {
      remove_in_a_loop(size, wanted);
      if (HasFailure()) return;
    }
}

}  // namespace

int main(int argc, char** argv) { return CME212::run_tests(argc, argv); }
