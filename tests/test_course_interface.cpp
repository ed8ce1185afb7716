/** @file test_course_interface.cpp
 * Programs as they are written against the course's interface of homework 0 to
 * 3, in small: what students' programs and test suites use has to compile and
 * to run. The idioms are the point here; the contract itself is tested in
 * tests/test_graph_nodes.cpp and tests/test_graph_edges.cpp.
 *
 * The programs come first, and nothing before them but the course's headers:
 * such a program gets standard headers from those, and would not compile if one
 * of them were missing. GoogleTest would hide that. */
#include "CME212/Point.hpp"

// ------------------- homework 0: a graph of their own, with Point.hpp alone

namespace hw0 {

class Graph {
 public:
  typedef unsigned size_type;

  class Node : private totally_ordered<Node> {
   public:
    Node() : graph_(nullptr), i_(0) {}
    const Point& position() const {
      assert(graph_ != nullptr);
      return graph_->points_[i_];
    }
    size_type index() const { return i_; }
    bool operator==(const Node& n) const {
      return graph_ == n.graph_ && i_ == n.i_;
    }
    bool operator<(const Node& n) const {
      return std::tie(graph_, i_) < std::tie(n.graph_, n.i_);
    }

   private:
    friend class Graph;
    const Graph* graph_;
    size_type i_;
    Node(const Graph* g, size_type i) : graph_(g), i_(i) {}
  };

  Node add_node(const Point& p) {
    points_.push_back(p);
    return node(size() - 1);
  }
  size_type size() const { return static_cast<size_type>(points_.size()); }
  Node node(size_type i) const { return Node(this, i); }
  void add_edge(const Node& a, const Node& b) {
    if (edge_of_.count(std::minmax(a, b)) == 0)
      edge_of_.insert({std::minmax(a, b), edge_of_.size()});
  }
  std::size_t num_edges() const { return edge_of_.size(); }

 private:
  std::vector<Point> points_;
  std::map<std::pair<Node, Node>, std::size_t> edge_of_;
};

/** Read both files and print what is in them.  @return as main() */
int viewer_main(const std::string& nodes, const std::string& tets) {
  Graph graph;
  std::ifstream nodes_file(nodes), tets_file(tets);
  if (!nodes_file || !tets_file) {
    std::cerr << "can't read " << nodes << " or " << tets << std::endl;
    return EXIT_FAILURE;
  }
  Point p;
  while (CME212::getline_parsed(nodes_file, p)) graph.add_node(p);
  std::array<int, 4> t;
  while (CME212::getline_parsed(tets_file, t))
    for (unsigned i = 1; i < t.size(); ++i)
      for (unsigned j = 0; j < i; ++j)
        graph.add_edge(graph.node(t[i]), graph.node(t[j]));
  std::cout << graph.size() << ' ' << graph.num_edges() << std::endl;
  return EXIT_SUCCESS;
}

/** Mean, spread and order of the points' distances to the origin. */
struct Statistics {
  std::vector<double> r;
  std::set<double> different;

  explicit Statistics(const std::vector<Point>& points) {
    std::function<double(const Point&)> distance = norm_2;
    std::transform(points.begin(), points.end(), std::back_inserter(r),
                   distance);
    std::sort(r.begin(), r.end());
    different.insert(r.begin(), r.end());
  }
  double mean() const {
    return std::accumulate(r.begin(), r.end(), 0.0) / double(r.size());
  }
  double spread() const {
    double sum = 0;
    for (double a : r) sum += std::pow(a - mean(), 2);
    return r.empty() ? std::numeric_limits<double>::max()
                     : std::sqrt(sum / double(r.size()));
  }
  std::string text() const {
    std::ostringstream s;
    std::copy(r.begin(), r.end(), std::ostream_iterator<double>(s, ";"));
    return s.str();
  }
};

/** A point in the unit cube, drawn as they do it without CME212::random(). */
Point some_point(unsigned seed) {
  std::mt19937 generator(seed);
  std::uniform_real_distribution<double> uniform(0, 1);
  std::unique_ptr<Point> p(new Point);
  std::generate(p->begin(), p->end(), [&] { return uniform(generator); });
  return *p;
}

/** A pause as they make it without CME212::sleep().  @return its length [s] */
double pause(double seconds) {
  auto start = std::chrono::high_resolution_clock::now();
  usleep(useconds_t(1e6 * seconds));
  std::chrono::duration<double> length =
      std::chrono::high_resolution_clock::now() - start;
  return length.count();
}

/** Arithmetic that goes by coordinate. */
double box_volume(const Point& p) {
  return std::accumulate(p.cbegin(), p.cend(), 1.0, std::multiplies<double>());
}
void scale(Real* a, double factor) {
  for (int i = 0; i < 3; ++i) a[i] *= factor;
}
Point mirrored(const Point& p) {
  Point q;
  for (int i = 0; i < 3; ++i) q.elem[i] = p.elem[2 - i];
  return q;
}

}  // namespace hw0

#include <queue>

#include "CME212/BoundingBox.hpp"
#include "CME212/Color.hpp"
#include "CME212/Util.hpp"
#include "Graph.hpp"

namespace {

// ------------------------------------------- homework 1: iterators, algorithms

/** Order of nodes by their distance to a point. */
struct Closer {
  Point to;
  template <typename NODE>
  bool operator()(const NODE& a, const NODE& b) const {
    return norm(a.position() - to) < norm(b.position() - to);
  }
};

template <typename G>
typename G::node_iterator nearest_node(const G& g, const Point& p) {
  return std::min_element(g.node_begin(), g.node_end(), Closer{p});
}

/** Number of edges from @a root to every node, as its value; -1: no way.
 * @return the largest. */
int shortest_path_lengths(Graph<int>& g, Graph<int>::node_type root) {
  for (auto it = g.node_begin(); it != g.node_end(); ++it) (*it).value() = -1;
  std::queue<Graph<int>::node_type> todo;
  root.value() = 0;
  todo.push(root);
  int longest = 0;
  while (!todo.empty()) {
    auto n = todo.front();
    todo.pop();
    longest = std::max(longest, n.value());
    for (auto it = n.edge_begin(); it != n.edge_end(); ++it) {
      auto next = (*it).node2();
      if (next.value() != -1) continue;
      next.value() = n.value() + 1;
      todo.push(next);
    }
  }
  return longest;
}

/** The elements of a range for which a predicate holds. */
template <typename Pred, typename It>
class Filter : private totally_ordered<Filter<Pred, It>> {
 public:
  typedef typename std::iterator_traits<It>::value_type value_type;
  typedef typename std::iterator_traits<It>::pointer pointer;
  typedef typename std::iterator_traits<It>::reference reference;
  typedef typename std::iterator_traits<It>::difference_type difference_type;
  typedef typename std::input_iterator_tag iterator_category;

  Filter(const Pred& p, const It& first, const It& last)
      : p_(p), it_(first), end_(last) {
    skip();
  }
  value_type operator*() const { return *it_; }
  Filter& operator++() {
    ++it_;
    skip();
    return *this;
  }
  bool operator==(const Filter& o) const { return it_ == o.it_; }
  bool operator<(const Filter& o) const { return it_ < o.it_; }

 private:
  void skip() {
    while (it_ != end_ && !p_(*it_)) ++it_;
  }
  Pred p_;
  It it_, end_;
};

/** A functor for a viewer: the colour of a node. */
struct HeatOfValue {
  int longest;
  template <typename NODE>
  CME212::Color operator()(const NODE& n) const {
    return CME212::Color::make_heat(float(n.value()) / longest);
  }
};

// ------------------------------------------------- homework 2: mass and spring

struct NodeData {
  Point vel;
  double mass;
  NodeData() : vel(0), mass(1) {}
};
struct EdgeData {
  double K, L;
  EdgeData() : K(100), L(1) {}
};
using SpringGraph = Graph<NodeData, EdgeData>;

/** Move and kick, as the assignment's integrator does. */
template <typename G, typename F>
double euler_step(G& g, double t, double dt, F force) {
  for (auto it = g.node_begin(); it != g.node_end(); ++it) {
    auto n = *it;
    n.position() += n.value().vel * dt;
  }
  for (auto it = g.node_begin(); it != g.node_end(); ++it) {
    auto n = *it;
    n.value().vel += force(n, t) * (dt / n.value().mass);
  }
  return t + dt;
}

/** Gravity and springs; the corners hold. */
struct Problem1 {
  template <typename NODE>
  Point operator()(NODE n, double t) {
    (void)t;
    if (n.position() == Point(0) || n.position() == Point(1, 0, 0))
      return Point(0);
    Point f = n.value().mass * Point(0, 0, -9.81);
    for (auto it = n.edge_begin(); it != n.edge_end(); ++it) {
      auto e = *it;
      Point d = n.position() - e.node2().position();
      f -= e.value().K * (norm(d) - e.value().L) / norm(d) * d;
    }
    return f;
  }
};

// ------------------------------------ homework 3: a boundary, in the values

using TaggedGraph = Graph<bool, char>;

/** Remove all nodes in a box. */
void remove_box(TaggedGraph& g, const Box3D& bb) {
  auto it = g.node_begin();
  while (it != g.node_end())
    if (bb.contains((*it).position()))
      it = g.remove_node(it);
    else
      ++it;
}

/** Tag the nodes on the border of [-1, 1]^2 and in a box inside.
 * @return their number */
struct TagBoundary {
  static Box3D box;
  int operator()(TaggedGraph& g) const {
    int count = 0;
    for (auto it = g.node_begin(); it != g.node_end(); ++it) {
      auto n = *it;
      n.value() = norm_inf(n.position()) == 1 || box.contains(n.position());
      count += n.value();
    }
    return count;
  }
};
Box3D TagBoundary::box = Box3D(Point(-.3, -.3, -1), Point(.3, .3, 1));

}  // namespace

#include <gtest/gtest.h>

#include <ranges>
#include <unordered_map>
#include <unordered_set>

#include "tests/TestFolder.hpp"

namespace {

TEST(Homework0, AProgramReadsAndPrints) {
  CME212::TestFolder folder;
  std::ofstream(folder / "nodes") << "0 0 0\n1 0 0\n0 1 0\n1 1 0\n2 1 0\n";
  std::ofstream(folder / "tets") << "0 1 2 3\n1 2 3 4\n";
  testing::internal::CaptureStdout();
  EXPECT_EQ(hw0::viewer_main(folder / "nodes", folder / "tets"), EXIT_SUCCESS);
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "5 9\n");
  testing::internal::CaptureStderr();
  EXPECT_EQ(hw0::viewer_main(folder / "no", folder / "tets"), EXIT_FAILURE);
  EXPECT_NE(testing::internal::GetCapturedStderr(), "");
}

TEST(Homework0, AlgorithmsTakePoints) {
  hw0::Statistics s({Point(3, 0, 0), Point(0, 1, 0), Point(0, 0, 1)});
  EXPECT_EQ(s.text(), "1;1;3;");
  EXPECT_EQ(s.different.size(), 2u);
  EXPECT_DOUBLE_EQ(s.mean(), 5. / 3);
  EXPECT_DOUBLE_EQ(s.spread(), std::sqrt(8. / 9));
  EXPECT_TRUE(Box3D(Point(0), Point(1)).contains(hw0::some_point(7)));
  EXPECT_NE(hw0::some_point(7), hw0::some_point(8));
  EXPECT_GE(hw0::pause(0.001), 0.001);
  EXPECT_EQ(hw0::box_volume(Point(2, 3, 4)), 24);
  EXPECT_EQ(hw0::mirrored(Point(1, 2, 3)), Point(3, 2, 1));
  Point p(1, 2, 3);
  hw0::scale(p.data(), 2);
  hw0::scale(p.elem, 3);
  EXPECT_EQ(p, Point(6, 12, 18));
}

// ----------------------------------------------------- homework 0: the graph

class GraphFixture : public ::testing::Test {
 protected:
  using GraphType = Graph<int, int>;
  using NodeType = typename GraphType::node_type;
  using EdgeType = typename GraphType::edge_type;
  using NodeIter = typename GraphType::node_iterator;
  using EdgeIter = typename GraphType::edge_iterator;
  using IncidentIter = typename GraphType::incident_iterator;

  GraphType graph;
  std::vector<Point> points;
  virtual void SetUp() {
    for (int i = 0; i < 10; i++) points.push_back(Point(i));
  }
};

TEST_F(GraphFixture, TypesHaveTheNamesOfTheCourse) {
  using size_type = GraphType::size_type;
  using V = GraphType::node_value_type;
  using E = GraphType::edge_value_type;
  static_assert(std::is_same<size_type, unsigned>::value, "");
  static_assert(std::is_same<V, int>::value && std::is_same<E, int>::value, "");
  static_assert(std::is_same<GraphType::Node, NodeType>::value, "");
  static_assert(std::is_same<GraphType::Edge, EdgeType>::value, "");
  static_assert(std::is_same<GraphType::NodeIterator, NodeIter>::value, "");
  static_assert(std::is_same<GraphType::EdgeIterator, EdgeIter>::value, "");
  static_assert(std::is_same<GraphType::IncidentIterator, IncidentIter>::value,
                "");
  static_assert(std::is_same<Graph<int>::node_value_type, int>::value, "");
  EXPECT_LE(sizeof(NodeType), 16u);
  EXPECT_LE(sizeof(EdgeType), 32u);
}

TEST_F(GraphFixture, NodesAreAddedAndFound) {
  NodeType n0 = graph.add_node(points[0]);
  graph.add_node(points[1], 3);
  EXPECT_TRUE(graph.has_node(n0)) << "has_node did not find n0";
  EXPECT_EQ(graph.num_nodes(), graph.size());
  EXPECT_EQ(graph.size(), 2);  // students compare with int
  EXPECT_EQ(n0.index(), 0);
  EXPECT_EQ(n0.value(), 0);
  EXPECT_EQ(graph.node(1).value(), 3);
  EXPECT_EQ(graph.node(1).position(), points[1]);
  NodeType node = graph.node(1);
  node.value() = 2;
  node.position() += Point(0, 0, 1);
  EXPECT_EQ(graph.node(1).value(), 2);
  EXPECT_EQ(graph.node(1).position().z, 2);
  graph.clear();
  EXPECT_EQ(graph.num_nodes(), 0);
  EXPECT_EQ(graph.num_edges(), 0);
}

TEST_F(GraphFixture, EdgesAreAddedAndCounted) {
  for (const Point& p : points) graph.add_node(p);
  for (unsigned k = 0; k < 30; ++k) {
    unsigned i = unsigned(CME212::random(0, graph.num_nodes()));
    unsigned j = unsigned(CME212::random(0, graph.num_nodes()));
    if (i == j) continue;
    EdgeType e = graph.add_edge(graph.node(i), graph.node(j));
    e.value() = int(k);
    EXPECT_TRUE(graph.has_edge(graph.node(i), graph.node(j)));
    EXPECT_TRUE(graph.has_edge(graph.node(j), graph.node(i)));
    EXPECT_TRUE(e.node1() == graph.node(i) && e.node2() == graph.node(j));
  }
  unsigned count = 0;
  for (unsigned i = 0; i < graph.num_nodes(); ++i)
    for (unsigned j = i + 1; j < graph.num_nodes(); ++j)
      if (graph.has_edge(graph.node(i), graph.node(j))) ++count;
  EXPECT_EQ(graph.num_edges(), count);
  for (unsigned i = 0; i < graph.num_edges(); ++i) {
    EXPECT_NE(graph.edge(i).node1(), graph.edge(i).node2());
    EXPECT_EQ(graph.edge(i), graph.edge(i));
  }
}

TEST_F(GraphFixture, ElementsOfTwoGraphsCompare) {
  GraphType g2;
  for (int i = 0; i < 50; ++i) {
    graph.add_node(Point(i));
    g2.add_node(Point(i));
  }
  EXPECT_FALSE(graph.node(23) == g2.node(23));
  EXPECT_TRUE(graph.node(23) < g2.node(21) || graph.node(23) > g2.node(21));
  EXPECT_TRUE(graph.node(2) < graph.node(3) || graph.node(3) < graph.node(2));
  EdgeType e1 = graph.add_edge(graph.node(0), graph.node(1));
  EdgeType e2 = g2.add_edge(g2.node(0), g2.node(1));
  EXPECT_TRUE(e1 < e2 || e2 < e1);
  EXPECT_FALSE(e1 == e2);
  std::map<NodeType, unsigned> place;
  std::set<EdgeType> seen;
  for (unsigned i = 0; i < graph.size(); ++i) place[graph.node(i)] = i;
  EXPECT_EQ(place[graph.node(7)], 7u);
  EXPECT_TRUE(seen.insert(e1).second);
  EXPECT_FALSE(
      seen.insert(graph.add_edge(graph.node(1), graph.node(0))).second);
}

TEST_F(GraphFixture, DeathOfInvalidElements) {
  EXPECT_DEATH(GraphType::node_type().degree(), "");
  EXPECT_DEATH(NodeType().position(), "");
  EXPECT_DEATH(NodeType().index(), "");
  EXPECT_DEATH(EdgeType().node1(), "");
  EXPECT_DEATH(graph.node(0), "");
}

// ------------------------------------------- homework 1: iterators, algorithms

class PathFixture : public ::testing::Test {
 protected:
  Graph<int> g;
  // A ring of ten, and one node apart.
  PathFixture() {
    for (int i = 0; i < 10; ++i) g.add_node(Point(i, 0, 0));
    for (int i = 0; i < 10; ++i) g.add_edge(g.node(i), g.node((i + 1) % 10));
    g.add_node(Point(100, 0, 0));
  }
};

TEST_F(PathFixture, LoopsOverIterators) {
  int count = 0, degrees = 0;
  for (auto it = g.node_begin(); it != g.node_end(); ++it) {
    ++count;
    degrees += int((*it).degree());
    for (auto e = (*it).edge_begin(); e != (*it).edge_end(); ++e) {
      EXPECT_EQ((*e).node1(), *it);
      EXPECT_NE((*e).node2(), *it);
    }
  }
  EXPECT_EQ(count, 11);
  EXPECT_EQ(degrees, 20);
  count = 0;
  for (Graph<int>::EdgeIterator it = g.edge_begin(); it != g.edge_end(); ++it)
    count += (*it).length() >= 1;
  EXPECT_EQ(count, 10);
  EXPECT_EQ(std::distance(g.edge_begin(), g.edge_end()), 10);
  EXPECT_TRUE(g.node(10).edge_begin() == g.node(10).edge_end());
}

TEST_F(PathFixture, NearestNode) {
  EXPECT_EQ((*nearest_node(g, Point(3.4, 0, 0))).index(), 3u);
  EXPECT_EQ((*nearest_node(g, Point(1000, 0, 0))).index(), 10u);
  Graph<int> empty;
  EXPECT_TRUE(nearest_node(empty, Point()) == empty.node_end());
}

TEST_F(PathFixture, ShortestPathLengths) {
  EXPECT_EQ(shortest_path_lengths(g, *nearest_node(g, Point(0, 0, 0))), 5);
  EXPECT_EQ(g.node(3).value(), 3);
  EXPECT_EQ(g.node(8).value(), 2);
  EXPECT_EQ(g.node(10).value(), -1);
}

TEST_F(PathFixture, DeathAtTheEndOfARange) {
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

TEST_F(PathFixture, FilterIterators) {
  auto right = [](const Graph<int>::node_type& n) {
    return n.position().x > 5;
  };
  using F = Filter<decltype(right), Graph<int>::node_iterator>;
  F first(right, g.node_begin(), g.node_end());
  F last(right, g.node_end(), g.node_end());
  std::vector<unsigned> found;
  for (; first != last; ++first) found.push_back((*first).index());
  EXPECT_EQ(found, (std::vector<unsigned>{6, 7, 8, 9, 10}));

  auto up = [](Graph<int>::edge_type e) { return e.node1() < e.node2(); };
  using I = Filter<decltype(up), Graph<int>::incident_iterator>;
  int edges = 0;
  for (auto n = g.node_begin(); n != g.node_end(); ++n) {
    I it(up, (*n).edge_begin(), (*n).edge_end());
    I end(up, (*n).edge_end(), (*n).edge_end());
    for (; it != end; ++it) ++edges;
  }
  EXPECT_EQ(edges, 10);
}

// An end that is taken by its node, and never read.
TEST_F(PathFixture, TheNodeAtTheEndIsPassedOn) {
  auto count = [](const auto& first, const auto& last, auto it) {
    int nodes = 0;
    for (auto n = first; !(n == last); n = *++it) ++nodes;
    return nodes;
  };
  EXPECT_EQ(count(*g.node_begin(), *g.node_end(), g.node_begin()), 11);
  Graph<int> empty;
  EXPECT_EQ(count(*empty.node_begin(), *empty.node_end(), empty.node_end()), 0);
}

TEST_F(PathFixture, NodesAndEdgesAreKeysOfHashTables) {
  std::unordered_map<Graph<int>::node_type, int> place;
  std::unordered_set<Graph<int>::edge_type> seen;
  for (auto n : g.nodes()) {
    place[n] = int(n.index());
    for (auto e : n.edges()) seen.insert(e);
  }
  EXPECT_EQ(place.size(), 11u);
  EXPECT_EQ(seen.size(), 10u) << "an edge is the same from both ends";
  const auto gone = g.node(4);
  g.remove_node(gone);
  EXPECT_EQ(place.at(gone), 4) << "a removed node is found, too";
  EXPECT_EQ(place.count(g.add_node(Point())), 0u) << "in its slot, and new";
}

TEST_F(PathFixture, RangesAreThoseOfTheStandard) {
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

// ------------------------------------------------- homework 2: mass and spring

TEST(MassSpring, AStepHoldsTheCornersAndDropsTheRest) {
  SpringGraph g;
  auto a = g.add_node(Point(0, 0, 0));
  auto b = g.add_node(Point(1, 0, 0));
  auto c = g.add_node(Point(0, 1, 0));
  g.add_edge(a, b);
  g.add_edge(a, c).value().L = 1;
  for (auto it = g.edge_begin(); it != g.edge_end(); ++it)
    (*it).value().L = (*it).length();
  double t = 0;
  for (int i = 0; i < 10; ++i) t = euler_step(g, t, 0.001, Problem1());
  EXPECT_NEAR(t, 0.01, 1e-12);
  EXPECT_EQ(a.position(), Point(0));
  EXPECT_EQ(b.position(), Point(1, 0, 0));
  EXPECT_NEAR(c.value().vel.z, -9.81 * 0.01, 1e-4);
  EXPECT_LT(c.position().z, 0);
}

TEST(MassSpring, RemovalAsTheAssignmentUsesIt) {
  SpringGraph graph;
  std::vector<SpringGraph::node_type> nodes;
  for (int i = 0; i < 20; ++i) nodes.push_back(graph.add_node(Point(i, 0, 0)));
  for (int i = 0; i + 1 < 20; ++i) graph.add_edge(nodes[i], nodes[i + 1]);
  auto node = graph.node(4);
  EXPECT_TRUE(graph.remove_node(node));
  EXPECT_FALSE(graph.remove_node(node));
  EXPECT_FALSE(graph.has_node(node));
  EXPECT_TRUE(graph.remove_edge(nodes[0], nodes[1]));
  EXPECT_FALSE(graph.remove_edge(nodes[0], nodes[1]));
  SpringGraph::edge_type edge = graph.edge(0);
  EXPECT_EQ(graph.remove_edge(edge), 1u);
  EXPECT_EQ(graph.num_edges(), 15u);
  auto it = graph.node_begin();
  while (it != graph.node_end()) {
    if (norm((*it).position() - Point(15, 0, 0)) < 2.5)
      it = graph.remove_node(it);
    else
      ++it;
  }
  EXPECT_EQ(graph.num_nodes(), 14u);
  for (auto e = graph.edge_begin(); e != graph.edge_end();)
    e = graph.remove_edge(e);
  EXPECT_EQ(graph.num_edges(), 0u);
  for (unsigned i = 0; i < graph.num_nodes(); ++i)
    EXPECT_EQ(graph.node(i).index(), i);
}

// ------------------------------------------------------- layout of other years

TEST(OtherYears, ProgramsOfTheOldLayoutAreBuiltWithOneFlag) {
  CME212::TestFolder folder;
  std::ofstream(folder / "old.cpp") << R"(
    #include "CS207/SDLViewer.hpp"
    #include "CS207/Util.hpp"
    #include "CS207/Color.hpp"
    #include "Graph.hpp"
    #include "Point.hpp"
    template <typename V> class Mesh { V value; };  // of homework 4
    struct ByValue {
      template <typename N> CS207::Color operator()(const N& n) const {
        return CS207::Color::make_heat(float(n.value()));
      }
    };
    int main(int, char** argv) {
      CS207::Clock clock;
      Graph<double, double> g;
      std::ifstream in(argv[1]);
      for (Point p; CS207::getline_parsed(in, p);) g.add_node(p);
      CS207::SDLViewer viewer;
      auto node_map = viewer.empty_node_map(g);
      viewer.add_nodes(g.node_begin(), g.node_end(), ByValue(), node_map);
      viewer.launch();
      CS207::sleep(CS207::random() * clock.seconds());
    })";
  const std::string compile = "c++ -std=c++20 -fsyntax-only -I. ";
  const auto result =
      folder.run(compile + "-Icourse/years " + folder / "old.cpp");
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_NE(folder.run(compile + folder / "old.cpp").status, 0);
}

// --------------------------------------------- homework 3: boundary and matrix

TEST(Homework3, TagsTheBoundaryAndCutsABox) {
  TaggedGraph g;
  for (int i = -5; i <= 5; ++i)
    for (int j = -5; j <= 5; ++j) g.add_node(Point(i, j, 0) / 5);
  EXPECT_EQ(TagBoundary()(g), 40 + 9);
  EXPECT_TRUE(g.node(0).value());
  EXPECT_FALSE(g.node(12).value());
  remove_box(g, Box3D(Point(.1, 1, 1), Point(1, -1, -1)));
  EXPECT_EQ(g.num_nodes(), 66u);
  for (auto n : g.nodes()) EXPECT_LE(n.position().x, 0);
}

TEST(Homework3, ValuesMayBeBool) {
  using G = Graph<bool, bool>;
  G g;
  g.reserve(4, 3);
  for (int i = 0; i < 100; ++i) g.add_node(Point(i), i % 3 == 0);
  for (int i = 1; i < 100; ++i)
    g.add_edge(g.node(i - 1), g.node(i), i % 2 == 0);
  bool& value = g.node(1).value();
  value = true;
  std::span<bool> nodes = g.node_values();
  std::span<const bool> edges = std::as_const(g).edge_values();
  ASSERT_EQ(nodes.size(), 100u);
  ASSERT_EQ(edges.size(), 99u);
  EXPECT_EQ(std::count(nodes.begin(), nodes.end(), true), 35);
  EXPECT_EQ(std::count(edges.begin(), edges.end(), true), 49);
  nodes[2] = true;
  EXPECT_TRUE(g.node(2).value());
  G copy(g);
  g.remove_node(g.node(1));
  EXPECT_FALSE(nodes[1]);
  EXPECT_TRUE(copy.node(1).value());
  EXPECT_TRUE(copy.edge(1).value());
  EXPECT_EQ(g.num_edges(), 97u);
  g.check_invariants();
  g.clear();
  EXPECT_FALSE(g.add_node(Point()).value());
}

TEST_F(PathFixture, ColorsByPathLength) {
  int longest = shortest_path_lengths(g, g.node(0));
  auto c = HeatOfValue{longest}(g.node(5));
  EXPECT_NEAR(c.r, 1, 1e-6);
  EXPECT_NEAR(c.g, 0.12, 1e-6);
  EXPECT_NEAR(c.b, 0, 1e-6);
}

}  // namespace
