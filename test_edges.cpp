/** @file test_edges.cpp
 * Tests the edges of Graph.hpp against the assignment and nothing beyond it, so
 * any Graph.hpp of the course can be tested. A check that fails prints the
 * sentence of the specification that does not hold.
 *
 *   Homework 0    add_edge, edge, num_edges, has_edge, node1, node2, ==, <
 *   Homework 1    degree, the edges at a node, iterators
 *   Section 3.1   length, when positions are modified
 *   Section 4     values
 *   Section 7.1   remove_edge: by ends, by edge, at an iterator; remove_node
 *   All together  a long random history, compared with a model
 *
 * A removal may change indices and invalidate handles; which ones depends on
 * the graph. So these tests identify a node by its value, which no other node
 * has, and an edge by the values of its ends, and they get a new handle after
 * each removal. Each test runs in a process of its own, unless there are
 * arguments: in a debugger give one, --gtest_filter=Homework0.AddEdge. Nodes:
 * test_nodes.cpp. */
#include <algorithm>
#include <map>
#include <random>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>

#include "CME212/GraphTests.hpp"
#include "Graph.hpp"

namespace {

using CME212::edge_at, CME212::find_node, CME212::same;

using GraphType = Graph<int, double>;
using NodeType = GraphType::node_type;
using EdgeType = GraphType::edge_type;
using size_type = GraphType::size_type;
static_assert(sizeof(EdgeType) <= 32, "an edge is a proxy: at most 32 bytes");

/** The values of the two ends of an edge, the smaller one first. */
using Ends = std::pair<int, int>;
Ends ends(int a, int b) { return {std::min(a, b), std::max(a, b)}; }
Ends ends(EdgeType e) { return ends(e.node1().value(), e.node2().value()); }
std::string text(Ends e) {
  return std::to_string(e.first) + "-" + std::to_string(e.second);
}

/** The expected content: the value of each edge, by its ends. */
using Model = std::map<Ends, double>;

/** The edges at the node of value @a v. */
Model edges_at(const Model& model, int v) {
  Model here;
  for (const auto& [e, value] : model)
    if (e.first == v || e.second == v) here[e] = value;
  return here;
}
void erase_node(Model& model, int v) {
  for (const auto& edge : edges_at(model, v)) model.erase(edge.first);
}

/** A new handle of the edge between the nodes of values @a a and @a b. */
EdgeType find_edge(GraphType& g, int a, int b) {
  for (size_type i = 0; i < g.num_edges(); ++i)
    if (ends(edge_at(g, i)) == ends(a, b)) return edge_at(g, i);
  throw std::runtime_error("edge(i) reaches every edge: not " +
                           text(ends(a, b)));
}

const Ends all_edges[] = {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {3, 4}};

/** Add nodes 0 to 4 and all_edges, each with a different value. */
Model build(GraphType& g) {
  Model model;
  for (int v = 0; v < 5; ++v) g.add_node(Point(v, 0, 0), v);
  for (Ends e : all_edges) {
    model[e] = 10 * e.first + e.second;
    g.add_edge(g.node(size_type(e.first)), g.node(size_type(e.second)))
        .value() = model[e];
  }
  return model;
}

/** Check that the edges from @a it to @a end are those of the model, each once.
 */
template <typename It>
void check_visits(It it, It end, const Model& model, const std::string& range) {
  std::set<Ends> seen;
  for (size_type steps = 0; !same(it, end); ++it) {
    ASSERT_LT(steps++, model.size()) << range << " ends after the last edge";
    EdgeType e = *it;
    ASSERT_EQ(model.count(ends(e)), 1u)
        << range << " visits no edge that is not there: " << text(ends(e));
    EXPECT_TRUE(seen.insert(ends(e)).second)
        << range << " visits no edge twice: " << text(ends(e));
    EXPECT_EQ(e.value(), model.at(ends(e)))
        << "an edge keeps its value: " << text(ends(e));
  }
  EXPECT_EQ(seen.size(), model.size()) << range << " visits every edge";
}

/** Check what is true of every graph of these edges. */
void check(GraphType& g, const Model& model) {
  ASSERT_EQ(g.num_edges(), model.size())
      << "num_edges() is the number of edges added and not removed";
  std::set<Ends> found;
  for (size_type i = 0; i < g.num_edges(); ++i) {
    EdgeType e = edge_at(g, i);
    ASSERT_TRUE(g.has_node(e.node1()) && g.has_node(e.node2()))
        << "node1() and node2() of an edge are nodes of the graph";
    found.insert(ends(e));
  }
  for (const auto& [e, value] : model)
    ASSERT_EQ(found.count(e), 1u)
        << "an edge that was not removed is some edge(i): not " << text(e);
  for (const auto& e : found)
    ASSERT_EQ(model.count(e), 1u)
        << "a removed edge is no edge(i), and no other was added: " << text(e);
  check_visits(g.edge_begin(), g.edge_end(), model,
               "from edge_begin() to edge_end()");
  for (size_type i = 0; i < g.num_nodes(); ++i) {
    NodeType n = g.node(i);
    Model here = edges_at(model, n.value());
    EXPECT_EQ(n.degree(), here.size())
        << "degree() is the number of edges at a node";
    size_type steps = 0;
    for (auto it = n.edge_begin(); it != n.edge_end(); ++it) {
      ASSERT_LT(steps++, here.size())
          << "from n.edge_begin() to n.edge_end() are degree() steps";
      EXPECT_TRUE((*it).node1() == n)
          << "an edge of n.edge_begin() has n as its node1()";
    }
    check_visits(n.edge_begin(), n.edge_end(), here,
                 "from n.edge_begin() to n.edge_end()");
    if (::testing::Test::HasFatalFailure()) return;
    for (size_type j = 0; j < g.num_nodes(); ++j) {
      if (j == i) continue;
      EXPECT_EQ(g.has_edge(n, g.node(j)),
                model.count(ends(n.value(), g.node(j).value())) == 1)
          << "has_edge(a, b) is true of the ends of an edge, in both orders, "
          << "and of no others: " << n.value() << ", " << g.node(j).value();
    }
  }
}

// ---------------------------------------------------------------- Homework 0

TEST(Homework0, AGraphOfNodesHasNoEdges) {
  GraphType g;
  EXPECT_TRUE(same(g.edge_begin(), g.edge_end()))
      << "in a graph without edges edge_begin() == edge_end()";
  g.add_node(Point(0, 0, 0), 0);
  g.add_node(Point(0, 0, 0), 1);
  check(g, {});
}

TEST(Homework0, AddEdge) {
  GraphType g;
  Model model = build(g);
  check(g, model);
  NodeType a = g.node(4), b = g.node(1);
  EdgeType e = g.add_edge(a, b);
  EXPECT_TRUE(e.node1() == a) << "add_edge(a, b): result.node1() == a";
  EXPECT_TRUE(e.node2() == b) << "add_edge(a, b): result.node2() == b";
  EXPECT_EQ(g.num_edges(), 6u) << "add_edge: num_edges() grows by 1";
  EXPECT_TRUE(g.has_edge(a, b)) << "add_edge(a, b): has_edge(a, b) is true";
  EXPECT_EQ(g.num_nodes(), 5u) << "add_edge: num_nodes() stays";
  e.value() = model[{1, 4}] = 41;
  check(g, model);
}

TEST(Homework0, AddEdgeThatIsThereAlready) {
  GraphType g;
  Model model = build(g);
  for (auto [a, b] : {std::pair(0, 2), std::pair(2, 0)}) {
    EdgeType e = g.add_edge(find_node(g, a), find_node(g, b));
    EXPECT_EQ(g.num_edges(), 5u)
        << "add_edge(a, b) if has_edge(a, b): num_edges() stays, in whichever "
        << "order the ends are given";
    EXPECT_TRUE(e == find_edge(g, 0, 2))
        << "add_edge(a, b) if has_edge(a, b): it returns the edge that is "
        << "there";
  }
  check(g, model);  // and the value was kept
}

TEST(Homework0, EqualEdges) {
  GraphType g, other;
  build(g);
  build(other);
  EdgeType e = find_edge(g, 0, 1);
  for (int v : {0, 1}) {
    NodeType n = find_node(g, v);
    size_type equal = 0;
    for (auto it = n.edge_begin(); it != n.edge_end(); ++it)
      if (*it == e) ++equal;
    EXPECT_EQ(equal, 1u)
        << "an edge equals itself seen from either end, and no other edge";
  }
  EXPECT_FALSE(e == find_edge(other, 0, 1))
      << "edges of different graphs are not equal";
}

TEST(Homework0, OrderOfEdges) {
  GraphType g;
  build(g);
  std::set<EdgeType> edges;
  for (size_type i = 0; i < g.num_nodes(); ++i) {
    NodeType n = g.node(i);
    for (auto it = n.edge_begin(); it != n.edge_end(); ++it) {
      EdgeType x = *it;
      edges.insert(x);
      for (size_type j = 0; j < g.num_edges(); ++j) {
        EdgeType y = edge_at(g, j);
        EXPECT_EQ(int(x < y) + int(y < x) + int(x == y), 1)
            << "exactly one of x < y, y < x and x == y is true";
      }
    }
  }
  EXPECT_EQ(edges.size(), 5u)
      << "edges can be the keys of a std::set, seen from either end";
}

TEST(Homework0, Clear) {
  GraphType g;
  build(g);
  g.clear();
  check(g, {});
  Model model = build(g);
  check(g, model);
}

// ---------------------------------------------------------------- Homework 1

TEST(Homework1, Iterators) {
  GraphType g;
  build(g);
  auto it = g.edge_begin(), other = g.edge_begin();
  EXPECT_TRUE(same(it, other)) << "iterators at the same edge are equal";
  ++it;
  EXPECT_FALSE(same(it, other)) << "++ moves to another edge";
  EXPECT_FALSE(*it == *other) << "++ moves to another edge";
  NodeType n = find_node(g, 0);
  auto at = n.edge_begin(), first = n.edge_begin();
  EXPECT_TRUE(same(at, first)) << "iterators at the same edge are equal";
  ++at;
  EXPECT_FALSE(same(at, first)) << "++ moves to another edge of the node";
}

// ------------------------------------------------ Section 3.1 and Section 4

TEST(Section31, LengthIsTheDistanceOfTheEnds) {
  GraphType g;
  build(g);
  EdgeType e = find_edge(g, 0, 3);
  using CME212::length;  // not all graphs have it
  EXPECT_EQ(length(e), 3) << "length() is the distance of node1() and node2()";
  find_node(g, 3).position() = Point(0, 3, 4);
  EXPECT_EQ(length(e), 5) << "length() follows a position that is modified";
}

struct Spring {
  double K = 0, L = 0;
};
bool operator==(const Spring& a, const Spring& b) {
  return a.K == b.K && a.L == b.L;
}

/** Edges hold values of type E. @a a and @a b differ from each other. */
template <typename E>
void check_values(const E& a, const E& b) {
  Graph<int, E> g;
  auto i = g.add_node(Point(0, 0, 0)), j = g.add_node(Point(1, 0, 0)),
       k = g.add_node(Point(2, 0, 0));
  auto e = g.add_edge(i, j);
  auto f = g.add_edge(j, k);
  e.value() = a;
  f.value() = b;
  EXPECT_TRUE(e.value() == a && f.value() == b)
      << "value(): every edge has its own";
  EXPECT_TRUE(g.add_edge(j, i).value() == a)
      << "add_edge(a, b) if has_edge(a, b): the edge keeps its value";
  (*i.edge_begin()).value() = b;
  EXPECT_TRUE((*i.edge_begin()).value() == b && e.value() == b)
      << "value() is the value in the graph: all handles of an edge see it";
  for (auto it = j.edge_begin(); it != j.edge_end(); ++it)
    EXPECT_TRUE((*it).value() == b)
        << "an edge has one value, from whichever end it is seen";
  const auto constant = e;
  EXPECT_TRUE(constant.value() == b) << "value() of a const edge can be read";
}

TEST(Section4, EdgesHaveValues) {
  check_values<int>(1, 2);
  check_values<double>(0.5, -3);
  check_values<Point>(Point(1, 2, 3), Point(0, 0, 4));
  check_values<Spring>(Spring{100, 1}, Spring{50, 2});
}

// ------------------------------------------------- Section 7.1: remove_edge

/** Remove edge @a e by @a remove(graph, first end, second end). */
template <typename Remove>
void check_remove_edge(Ends e, Remove remove) {
  GraphType g;
  Model model = build(g);
  EXPECT_EQ(remove(g, e.first, e.second), 1)
      << "remove_edge returns 1 if an edge was removed";
  EXPECT_EQ(g.num_edges(), 4u) << "remove_edge: num_edges() falls by 1";
  EXPECT_EQ(g.num_nodes(), 5u) << "remove_edge: num_nodes() stays";
  NodeType a = find_node(g, e.first), b = find_node(g, e.second);
  EXPECT_FALSE(g.has_edge(a, b)) << "remove_edge: has_edge(a, b) is false";
  EXPECT_FALSE(g.has_edge(b, a)) << "remove_edge: has_edge(b, a) is false";
  model.erase(e);
  check(g, model);
  EXPECT_EQ(CME212::remove_edge(g, a, b, 0), 0)
      << "remove_edge(a, b) returns 0 if !has_edge(a, b)";
  check(g, model);
  g.add_edge(a, b).value() = model[e] = -1;  // it can come again
  check(g, model);
}

TEST(Section71, RemoveEdgeByItsEnds) {
  for (Ends e : all_edges) {
    check_remove_edge(e, [](GraphType& g, int a, int b) {
      return CME212::remove_edge(g, find_node(g, a), find_node(g, b));
    });
    check_remove_edge(e, [](GraphType& g, int a, int b) {
      return CME212::remove_edge(g, find_node(g, b), find_node(g, a));
    });
  }
}

TEST(Section71, RemoveEdgeByEdge) {
  for (Ends e : all_edges) {
    check_remove_edge(e, [](GraphType& g, int a, int b) {
      return CME212::remove_edge(g, find_edge(g, a, b));
    });
    check_remove_edge(e, [](GraphType& g, int a, int b) {
      NodeType n = find_node(g, b);  // seen from the second end
      auto it = n.edge_begin();
      while ((*it).node2().value() != a) ++it;
      return CME212::remove_edge(g, *it);
    });
  }
}

/** The loop of the assignment: remove the edges of which @a wanted is true. */
template <typename Wanted>
void remove_in_a_loop(Wanted wanted) {
  GraphType g;
  Model model = build(g);
  int steps = 0;
  for (auto it = g.edge_begin(); it != g.edge_end();) {
    ASSERT_LE(++steps, 30)
        << "remove_edge(it) returns an iterator from which the loop ends";
    Ends e = ends(*it);
    if (wanted(e)) {
      ASSERT_EQ(model.erase(e), 1u)
          << "remove_edge(it) removes the edge at it: " << text(e);
      it = CME212::remove_edge_at(g, it);
      ASSERT_EQ(g.num_edges(), model.size())
          << "remove_edge(it): num_edges() falls by 1";
    } else {
      ++it;
    }
  }
  for (Ends e : all_edges)
    EXPECT_FALSE(wanted(e) && model.count(e) == 1)
        << "remove_edge(it) returns an iterator from which the loop visits all "
        << "edges not visited before: it did not visit " << text(e);
  check(g, model);
}

TEST(Section71, RemoveEdgesInALoop) {
  using Wanted = bool (*)(Ends);
  const Wanted cases[] = {
      [](Ends e) { return e == Ends(0, 1) || e == Ends(3, 4); },
      [](Ends e) { return e.first != 0; }, [](Ends e) { return e.first == 0; },
      [](Ends) { return true; }, [](Ends) { return false; }};
  for (Wanted wanted : cases) {
    remove_in_a_loop(wanted);
    if (HasFailure()) return;
  }
}

TEST(Section71, RemoveNodeRemovesItsEdges) {
  for (int v = 0; v < 5; ++v) {
    GraphType g;
    Model model = build(g);
    auto degree = find_node(g, v).degree();
    EXPECT_EQ(CME212::remove_node(g, find_node(g, v)), 1)
        << "remove_node(n) returns 1 if n was removed";
    EXPECT_EQ(g.num_edges(), 5u - degree)
        << "remove_node(n): num_edges() falls by n.degree()";
    erase_node(model, v);
    check(g, model);
  }
}

// -------------------------------------------------------------- All together

TEST(AllTogether, ARandomHistoryDoesWhatTheModelDoes) {
  std::mt19937 random(212);  // the same numbers in every run
  GraphType g;
  Model model;
  for (int step = 0; step < 2000; ++step) {
    SCOPED_TRACE("step " + std::to_string(step));
    auto what = random() % 20;
    if (g.num_nodes() < 2 || (what < 3 && g.num_nodes() < 12)) {
      g.add_node(Point(step, 0, 0), step);
    } else if (what < 5) {
      NodeType n = g.node(size_type(random() % g.num_nodes()));
      erase_node(model, n.value());
      CME212::remove_node(g, n);
    } else if (what < 15 || model.empty()) {
      NodeType a = g.node(size_type(random() % g.num_nodes()));
      NodeType b = g.node(size_type(random() % g.num_nodes()));
      if (a == b) continue;
      g.add_edge(a, b).value() = model[ends(a.value(), b.value())] = step;
    } else {
      EdgeType e = edge_at(g, size_type(random() % g.num_edges()));
      model.erase(ends(e));
      if (what < 17) {
        CME212::remove_edge(g, e);
      } else if (what < 18) {
        CME212::remove_edge(g, e.node2(), e.node1());
      } else {
        auto it = g.edge_begin();
        while (!(*it == e)) ++it;
        CME212::remove_edge_at(g, it);
      }
    }
    check(g, model);
    if (HasFailure()) return;
  }
}

}  // namespace

int main(int argc, char** argv) { return CME212::run_tests(argc, argv); }
