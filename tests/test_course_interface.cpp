/** @file test_course_interface.cpp
 * Programs as they are written against the course's interface of homework 0 to
 * 3, in small: what students' programs and test suites use has to compile and
 * to run. The idioms are the point here; the contract itself is tested in
 * tests/test_graph_contract.cpp.
 *
 * The programs come first, and nothing before them but the course's headers:
 * such a program gets standard headers from those, and would not compile if one
 * of them were missing. GoogleTest would hide that. */
#include "CME212/Point.hpp"

// ------------------------------------ homework 0: a program of Point.hpp alone

namespace hw0 {

/** Read both files and print what is in them.  @return as main() */
int viewer_main(const std::string& nodes, const std::string& tets) {
  std::vector<Point> points;
  std::set<std::pair<int, int>> edges;
  std::ifstream nodes_file(nodes), tets_file(tets);
  if (!nodes_file || !tets_file) {
    std::cerr << "can't read " << nodes << " or " << tets << std::endl;
    return EXIT_FAILURE;
  }
  for (Point p; CME212::getline_parsed(nodes_file, p);) points.push_back(p);
  std::array<int, 4> t;
  while (CME212::getline_parsed(tets_file, t))
    for (unsigned i = 1; i < t.size(); ++i)
      for (unsigned j = 0; j < i; ++j) edges.insert(std::minmax(t[i], t[j]));
  std::cout << points.size() << ' ' << edges.size() << std::endl;
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
void scale(double* a, double factor) {
  for (int i = 0; i < 3; ++i) a[i] *= factor;
}
Point mirrored(const Point& p) {
  Point q;
  for (int i = 0; i < 3; ++i) q.elem[i] = p.elem[2 - i];
  return q;
}

}  // namespace hw0

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

}  // namespace

#include <gtest/gtest.h>

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

TEST_F(PathFixture, NearestNode) {
  EXPECT_EQ((*nearest_node(g, Point(3.4, 0, 0))).index(), 3u);
  EXPECT_EQ((*nearest_node(g, Point(1000, 0, 0))).index(), 10u);
  Graph<int> empty;
  EXPECT_TRUE(nearest_node(empty, Point()) == empty.node_end());
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
}

// --------------------------------------------- homework 3: boundary and matrix

TEST(Homework3, TagsTheBoundaryAndCutsABox) {
  TaggedGraph g;
  for (int i = -5; i <= 5; ++i)
    for (int j = -5; j <= 5; ++j) g.add_node(Point(i, j, 0) / 5);
  for (auto it = g.node_begin(); it != g.node_end(); ++it)
    (*it).value() = norm_inf((*it).position()) == 1;
  EXPECT_TRUE(g.node(0).value());
  EXPECT_FALSE(g.node(12).value());
  remove_box(g, Box3D(Point(.1, 1, 1), Point(1, -1, -1)));
  EXPECT_EQ(g.num_nodes(), 66u);
}

// -------------------------------------------------- the two published layouts

/** Compile a program that includes and names what @a year calls its library.
 * @param viewer the name of its window   @param flag for its folder */
CME212::TestFolder::Result compile(const std::string& year,
                                   const std::string& viewer,
                                   const std::string& flag) {
  CME212::TestFolder folder;
  std::string text = R"(
    #include "YEAR/VIEWER.hpp"
    #include "YEAR/Util.hpp"
    #include "YEAR/Color.hpp"
    #include "YEAR/BoundingBox.hpp"
    #include "Graph.hpp"
    #include POINT
    template <typename V> class Mesh { V value; };  // of homework 4
    struct ByValue {
      template <typename N> YEAR::Color operator()(const N& n) const {
        return YEAR::Color::make_heat(float(n.value()));
      }
    };
    int main(int, char** argv) {
      YEAR::Clock clock;
      Graph<double, double> g;
      std::ifstream in(argv[1]);
      for (Point p; YEAR::getline_parsed(in, p);) g.add_node(p);
      YEAR::VIEWER viewer;
      auto node_map = viewer.empty_node_map(g);
      viewer.add_nodes(g.node_begin(), g.node_end(), ByValue(), node_map);
      viewer.launch();
      YEAR::sleep(YEAR::random() * clock.seconds());
    })";
  for (auto [name, value] :
       {std::pair("YEAR", year), std::pair("VIEWER", viewer),
        std::pair("POINT", year == "CS207" ? std::string("\"Point.hpp\"")
                                           : "\"CME212/Point.hpp\"")})
    for (std::size_t at; (at = text.find(name)) != text.npos;)
      text.replace(at, std::string(name).size(), value);
  std::ofstream(folder / "program.cpp") << text;
  return folder.run("c++ -std=c++20 -fsyntax-only -I. " + flag + ' ' +
                    folder / "program.cpp");
}

TEST(Layouts, AValueThatNoGraphCanKeepIsRefusedInASentence) {
  CME212::TestFolder folder;
  const char *copyable = "values of a Graph are copyable",
             *changes = "values of a Graph can change";
  for (auto [value, why] : {std::pair("std::unique_ptr<int>", copyable),
                            {"std::reference_wrapper<int>", copyable},
                            {"const int", changes}}) {
    std::ofstream(folder / "a.cpp")
        << "#include \"Graph.hpp\"\n#include <memory>"
           "\nGraph<"
        << value << ", int> g;\n";
    const auto result =
        folder.run("c++ -std=c++20 -fsyntax-only -I. " + folder / "a.cpp");
    EXPECT_LT(result.err.find(why),
              result.err.find('\n', result.err.find("error: ")))
        << result.err;
  }
}

TEST(Layouts, ProgramsOfBothCompile) {
  for (const std::string viewer : {"SDLViewer", "SFML_Viewer"}) {
    const auto result = compile("CME212", viewer, "");
    EXPECT_EQ(result.status, 0) << result.err;
  }
  const auto result = compile("CS207", "SDLViewer", "-Icourse/years");
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_NE(compile("CS207", "SDLViewer", "").status, 0) << "needs the flag";
}

}  // namespace
