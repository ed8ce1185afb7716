/** @file 4.2.build_cloth.cpp
 * The cloth at its start: what build_cloth() makes, or, in a program without
 * it, what main() gives to the viewer first. */
#if __has_include("mass_spring.hpp")
#include "CME212/Mesh.hpp"
#endif
#include "cloth.hpp"
#include "program.hpp"

namespace kit {

/** The cloth of cloth.nodes and cloth.tets: 3 x 4 nodes, such that edges have
 * different lengths, and a quad apart that falls through the ball. One of its
 * corners is the last node: a pin that holds indices lets it go when the cloth
 * tears. */
static std::vector<Point> cloth_points() {
  std::vector<Point> points;
  std::ifstream file(data_file("cloth.nodes"));
  for (Point p; file >> p.x >> p.y >> p.z;) points.push_back(p);
  return points;
}
static std::vector<std::array<unsigned, 4>> cloth_quads() {
  std::vector<std::array<unsigned, 4>> quads;
  std::ifstream file(data_file("cloth.tets"));
  for (std::array<unsigned, 4> q; file >> q[0] >> q[1] >> q[2] >> q[3];)
    quads.push_back(q);
  return quads;
}
/** The ends of all edges, the smaller one first: sides and diagonals. */
static std::set<std::pair<int, int>> cloth_edges() {
  std::set<std::pair<int, int>> edges;
  for (const auto& q : cloth_quads())
    for (auto [a, b] :
         {std::pair(0, 1), {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}})
      edges.insert(std::minmax(int(q[a]), int(q[b])));
  return edges;
}

struct Start {
  std::vector<Film::Body> bodies;
  std::vector<Film::Spring> springs;
};

/** Whatever the order of nodes and edges. */
static void answer_start(Start start) {
  const auto before = [](const Point& a, const Point& b) {
    return std::tie(a.x, a.y) < std::tie(b.x, b.y);
  };
  std::sort(start.bodies.begin(), start.bodies.end(),
            [&](const auto& a, const auto& b) { return before(a.x, b.x); });
  for (auto& s : start.springs)
    if (before(s.b, s.a)) std::swap(s.a, s.b);
  std::sort(start.springs.begin(), start.springs.end(),
            [&](const auto& s, const auto& r) {
              return before(s.a, r.a) || (s.a == r.a && before(s.b, r.b));
            });
  for (const auto& b : start.bodies) {
    answer("node", b.x);
    answer("velocity", b.v);
    answer("mass", b.m, 1e-7);
  }
  for (const auto& s : start.springs) {
    answer("ends", s.a);
    answer("ends", s.b);
    answer("L", s.L);
    if (s.has_K) answer("K~", s.K);
  }
}

static void compare_start(const Start& start) {
  answer_start(start);

  const auto points = cloth_points();
  const int num_nodes = int(start.bodies.size());
  CHECK_EQUAL(num_nodes, 16);
  std::vector<int> met(points.size());
  for (const Film::Body& b : start.bodies) {
    const auto at = std::find(points.begin(), points.end(), b.x);
    CHECK(at != points.end(), words("no node at ", b.x));
    ++met[std::size_t(at - points.begin())];
    const Point vel = b.v;
    CHECK_NEAR(vel, Point(0, 0, 0), 0);
    const double mass = b.m;
    CHECK_NEAR(mass, 1. / 16, 1e-7);
  }
  for (std::size_t i = 0; i < points.size(); ++i)
    CHECK(met[i] == 1, words("one node at ", points[i]));

  auto edges = cloth_edges();
  for (const Film::Spring& s : start.springs) {
    int ends[2];
    for (int e : {0, 1})
      ends[e] = int(std::find(points.begin(), points.end(), e ? s.b : s.a) -
                    points.begin());
    CHECK(edges.erase(std::minmax(ends[0], ends[1])) == 1,
          words("no edge, or no second one, between ", s.a, " and ", s.b));
    CHECK(s.has_L, "an edge's value to hold the spring's L");
    const double L = s.L;
    CHECK_NEAR(L, norm(s.a - s.b), 1e-9);
    const double K = s.has_K ? s.K : given_K;
    CHECK_NEAR(K, given_K, 0);
  }
  if (!edges.empty()) {
    const Point a = points[std::size_t(edges.begin()->first)],
                b = points[std::size_t(edges.begin()->second)];
    CHECK(edges.empty(), words("an edge between ", a, " and ", b));
  }
}

template <typename G>
static Start start_of(G& g) {
  Start start;
  for (int i = 0; i < int(g.num_nodes()); ++i)
    start.bodies.push_back(body_of(node_of(g, i)));
  for (auto it = g.edge_begin(); it != g.edge_end(); ++it) {
    auto e = *it;
    Film::Spring s{e.node1().position(), e.node2().position()};
    read_spring(e, s);
    start.springs.push_back(s);
  }
  return start;
}

#ifdef KIT_HAS_MAIN
static Start start_of_program() {
  DID("the program on a cloth of 16 nodes and 7 quads");
  const Film& f =
      run_program(&KIT_MAIN, [](const Film& film) { return film.frames >= 2; });
  CHECK(f.frames > 0, "the program to draw the cloth");
  return {f.start, f.edges};
}
#else
static Start start_of_program() { fail("build_cloth() or main()", "neither"); }
#endif

#if __has_include("mass_spring.hpp")
/** K is what build_cloth() is given, if it takes one. */
template <typename G>
static void check_given_K(const std::vector<Point>& points,
                          const std::vector<Quad>& quads) {
  if constexpr (requires(G g) {
                  ::build_cloth(g, points, quads, MeshSprings::plain, 60.);
                  *K_in((*g.edge_begin()).value());
                }) {
    DID("build_cloth() of 16 points and 7 quads, with K = 60");
    G g;
    ::build_cloth(g, points, quads, MeshSprings::plain, 60.);
    for (auto it = g.edge_begin(); it != g.edge_end(); ++it) {
      const double K = *K_in((*it).value());
      CHECK_NEAR(K, 60., 0);
    }
  }
}
template <typename G>
static Start start_of_cloth(G& g) {
  const std::vector<Point> points = cloth_points();
  const std::vector<Quad> quads = cloth_quads();
  if constexpr (requires {
                  {
                    ::build_cloth(g, points, quads, MeshSprings::diagonals)
                    } -> Present;
                }) {
    check_given_K<G>(points, quads);
    DID("build_cloth() of 16 points and 7 quads, with diagonals");
    ::build_cloth(g, points, quads, MeshSprings::diagonals);
    return start_of(g);
  }
  return start_of_program();
}
#else
template <typename G>
static Start start_of_cloth(G&) {
  return start_of_program();
}
#endif

}  // namespace kit

TASK("4.2.build_cloth", cloth_at_its_start) {
  Cloth g;
  compare_start(start_of_cloth(g));
}
