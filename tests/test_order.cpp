// OrderedCloth.hpp: which cloths get another order in memory, which one, and
// that nobody can tell by the indices.
#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <cstdlib>
#include <numeric>
#include <random>
#include <set>

#include "lab/fast/ConstraintPlan.hpp"
#include "lab/fast/ForcePlan.hpp"
#include "lab/fast/GraphArrays.hpp"
#include "lab/fast/OrderedCloth.hpp"
#include "lab/methods/Splitting.hpp"

using namespace lab;

namespace {

// RapidCheck reads this once, before its first check.
[[maybe_unused]] const int same_in_every_run =
    setenv("RC_PARAMS", "seed=212", 0);

struct Shape {
  std::vector<Point> points;
  std::vector<Quad> quads;
  std::vector<unsigned> number;  // of each point of the grid in this shape
};
Shape grid(unsigned side) {
  Shape s{grid_points(side), grid_quads(side), {}};
  s.number.resize(s.points.size());
  std::iota(s.number.begin(), s.number.end(), 0u);
  return s;
}
/** The grid with its points and its quads in any order, some quads mirrored. */
Shape shuffled(unsigned side) {
  const Shape ordered = grid(side);
  Shape s = ordered;
  std::mt19937 random(212);
  std::shuffle(s.number.begin(), s.number.end(), random);
  for (unsigned i = 0; i < s.number.size(); ++i)
    s.points[s.number[i]] = ordered.points[i];
  for (Quad& q : s.quads) {
    for (unsigned& i : q) i = s.number[i];
    if (random() % 2) q = {q[1], q[0], q[3], q[2]};
    if (random() % 2) q = {q[0], q[2], q[1], q[3]};
  }
  std::shuffle(s.quads.begin(), s.quads.end(), random);
  return s;
}

/** The same cloth in no other order than that of the mesh. */
void build_simply(Cloth& g, const Shape& s, MeshSprings::Kind mesh) {
  std::vector<Node> n;
  for (Point p : s.points)
    n.push_back(g.add_node(p, {Point(), 1. / double(s.points.size())}));
  for (auto [a, b] : {std::pair(0, 1), {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}})
    for (const Quad& q : s.quads)
      if (mesh == MeshSprings::diagonals || a + b != 3)
        g.add_edge(n[q[a]], n[q[b]],
                   {100, norm(s.points[q[a]] - s.points[q[b]])});
}

/** build_cloth(), and order_in_memory(). */
void build_in_order(Cloth& g, const Shape& s, MeshSprings::Kind mesh) {
  build_cloth(g, s.points, s.quads, mesh);
  order_in_memory(g);
}

/** Whether the two look the same to whoever asks by index. */
void expect_same(const Cloth& g, const Cloth& expected) {
  g.check_invariants();
  ASSERT_EQ(g.num_nodes(), expected.num_nodes());
  ASSERT_EQ(g.num_edges(), expected.num_edges());
  for (unsigned i = 0; i < g.num_nodes(); ++i) {
    Node a = g.node(i), b = expected.node(i);
    ASSERT_EQ(a.index(), i);
    ASSERT_EQ(a.position(), b.position());
    ASSERT_EQ(a.value().vel, b.value().vel);
    ASSERT_EQ(a.value().mass, b.value().mass);
    ASSERT_EQ(a.degree(), b.degree());
  }
  for (unsigned i = 0; i < g.num_edges(); ++i) {
    Edge a = g.edge(i), b = expected.edge(i);
    ASSERT_EQ(a.index(), i);
    ASSERT_EQ(a.node1().index(), b.node1().index());
    ASSERT_EQ(a.node2().index(), b.node2().index());
    ASSERT_EQ(a.value().K, b.value().K);
    ASSERT_EQ(a.value().L, b.value().L);
  }
}

/** How far apart the ends of an edge lie in memory, on average [nodes]. */
double mean_distance(const Cloth& g) {
  double sum = 0;
  for (Edge e : g.edges())
    sum += std::abs(double(e.node1().id()) - double(e.node2().id()));
  return sum / g.num_edges();
}

/** A mesh of any quads whatever, some of them alike, some points in none. */
rc::Gen<Shape> meshes() {
  return rc::gen::exec([] {
    const unsigned num_points = *rc::gen::element(8u, 60u, 5000u);
    const unsigned num_quads = *rc::gen::inRange(1u, 300u);
    std::mt19937 random(*rc::gen::arbitrary<unsigned>());
    auto number = [&](unsigned below) { return unsigned(random() % below); };
    Shape s;
    for (unsigned i = 0; i < num_points; ++i)
      s.points.push_back(Point(number(100), number(100), number(100)));
    while (s.quads.size() < num_quads) {
      Quad q;
      for (unsigned& i : q) i = number(num_points);
      if (!s.quads.empty() && number(3) == 0)
        q = s.quads[number(s.quads.size())];
      std::shuffle(q.begin(), q.end(), random);
      std::set<unsigned> different(q.begin(), q.end());
      if (different.size() == 4) s.quads.push_back(q);
    }
    return s;
  });
}

// ------------------------------------------------- what becomes of it: a cloth

TEST(OrderInMemory, OrdersAShuffledMeshInMemory) {
  const Shape s = shuffled(100), rows = grid(100);
  Cloth g, simple, ordered;
  build_in_order(g, s, MeshSprings::diagonals);
  build_simply(simple, s, MeshSprings::diagonals);
  build_simply(ordered, rows, MeshSprings::diagonals);
  expect_same(g, simple);
  EXPECT_GT(mean_distance(simple), 30 * mean_distance(ordered));
  EXPECT_LT(mean_distance(g), 1.5 * mean_distance(ordered));
  unsigned last = 0, constant = 0, turns = 0;
  for (auto [i, j] : arrays(g).edge_ends()) {
    turns += std::min(i, j) < last;
    last = std::min(i, j);
  }
  EXPECT_LT(turns, 16u) << "the edges follow the nodes, a few times through";
  // A vectorised sweep is fast if neighbors keep the distances of those before.
  auto distances = [&g](unsigned id) {
    std::multiset<long> all;
    for (Edge e : arrays(g).node_with_id(id).edges())
      all.insert(long(e.node2().id()) - long(id));
    return all;
  };
  for (unsigned id = 1; id < g.num_nodes(); ++id)
    constant += distances(id) == distances(id - 1);
  EXPECT_GT(constant, 0.9 * g.num_nodes());
}

TEST(IsLocal, HoldsForEveryGridAndForAnythingSmall) {
  for (unsigned side : {2u, 5u, 100u, 1200u}) {
    Cloth g;
    build_simply(g, grid(side), MeshSprings::plain);
    EXPECT_TRUE(is_local(g)) << side;
  }
  Cloth small, large;
  build_simply(small, shuffled(30), MeshSprings::diagonals);
  build_simply(large, shuffled(100), MeshSprings::diagonals);
  EXPECT_TRUE(is_local(small));
  EXPECT_FALSE(is_local(large));
}

TEST(OrderInMemory, LeavesAMeshThatIsInOrder) {
  Cloth g, simple;
  const Shape s = grid(100);
  build_in_order(g, s, MeshSprings::diagonals);
  build_simply(simple, s, MeshSprings::diagonals);
  expect_same(g, simple);
  for (Node n : g.nodes()) EXPECT_EQ(n.id(), n.index());
  for (Edge e : g.edges()) EXPECT_EQ(e.id(), e.index());
}

TEST(OrderInMemory, ShowsEveryMeshInItsOwnOrder) {
  unsigned reordered = 0;
  EXPECT_TRUE(rc::check([&] {
    const Shape s = *meshes();
    for (MeshSprings::Kind mesh :
         {MeshSprings::plain, MeshSprings::diagonals}) {
      Cloth g, simple;
      // In a graph that was used before, ids are not given in order.
      std::vector<Node> old;
      for (int k = 0; k < 50; ++k) old.push_back(g.add_node(Point(k)));
      for (int k = 0; k < 49; ++k) g.add_edge(old[k], old[k + 1]);
      for (int k = 0; k < 50; ++k) g.remove_node(old[7 * k % 50]);
      build_in_order(g, s, mesh);
      build_simply(simple, s, mesh);
      expect_same(g, simple);
      for (Node n : old) RC_ASSERT(!g.has_node(n));
      reordered += !is_local(simple);
    }
  }));
  EXPECT_GT(reordered, 40u);
}

TEST(OrderInMemory, MovesAShuffledMeshAsTheOrderedOne) {
  const Shape s = shuffled(60), rows = grid(60);
  Cloth g, expected;
  build_in_order(g, s, MeshSprings::diagonals);
  build_in_order(expected, rows, MeshSprings::diagonals);
  auto force = make_combined_force(GravityForce(), MassSpringForce());
  Verlet method, expected_method;
  PinConstraint pin(g), expected_pin(expected);
  for (int k = 0; k < 50; ++k) {
    method.step(g, k * 1e-3, 1e-3, force, pin);
    expected_method.step(expected, k * 1e-3, 1e-3, force, expected_pin);
  }
  double moved = 0;
  for (unsigned i = 0; i < rows.points.size(); ++i) {
    const Point p = expected.node(i).position();
    EXPECT_LT(norm(g.node(s.number[i]).position() - p), 1e-14);
    moved = std::max(moved, norm(p - rows.points[i]));
  }
  EXPECT_GT(moved, 1e-3);
}

// -------------------------------------------------- after nodes were removed

/** How many indices have a smaller id than the index before. */
unsigned descents(const Cloth& g) {
  unsigned n = 0;
  for (unsigned i = 1; i < g.num_nodes(); ++i)
    n += g.node(i).id() < g.node(i - 1).id();
  return n;
}
/** The ids of all nodes in random order. */
std::vector<unsigned> random_ids(const Cloth& g) {
  std::vector<unsigned> ids(g.num_nodes());
  std::iota(ids.begin(), ids.end(), 0u);
  std::shuffle(ids.begin(), ids.end(), std::mt19937(3));
  return ids;
}

TEST(RestoreOrder, WaitsForManyNodesOfALargeGraph) {
  for (unsigned columns : {64u, 63u}) {  // 4096 nodes, and a few less
    Cloth g;
    build_cloth(g, grid_points(64, columns), grid_quads(64, columns),
                MeshSprings::plain);
    int restored = 0;
    for (unsigned id : random_ids(g)) {
      g.remove_node(arrays(g).node_with_id(id));
      const auto version = arrays(g).version();
      const unsigned before = descents(g);
      restore_order(g);
      if (columns == 64 && before > 16) {
        ASSERT_EQ(descents(g), 0u);
        ++restored;
      } else {
        ASSERT_EQ(arrays(g).version(), version);
      }
    }
    EXPECT_EQ(restored > 0, columns == 64);
    EXPECT_LE(restored, 256);
  }
}

TEST(RestoreOrder, KeepsTheOrderOfTheEdgesAtANode) {
  Cloth g;
  build_cloth(g, grid_points(70), grid_quads(70), MeshSprings::diagonals);
  const auto ids = random_ids(g);
  for (unsigned k = 0; k < ids.size() / 2; ++k)
    g.remove_node(arrays(g).node_with_id(ids[k]));
  std::vector<std::vector<unsigned>> before(arrays(g).node_slots());
  for (Node n : g.nodes())
    for (Edge e : n.edges()) before[n.id()].push_back(e.id());
  restore_order(g);
  for (Node n : g.nodes()) {
    const auto list = arrays(g).neighbors(n.id());
    std::vector<unsigned> now;
    for (auto neighbor : list) now.push_back(neighbor.edge);
    ASSERT_EQ(now, before[n.id()]);
  }
  g.check_invariants();
  const Node a = g.node(0), b = g.node(g.num_nodes() - 1);
  EXPECT_EQ(g.add_edge(a, b).node2(), b);
  g.check_invariants();
}

TEST(RestoreOrder, StepsThatTearDoItAndChangeNothingElse) {
  Cloth g, by_call;
  for (Cloth* c : {&g, &by_call}) {
    build_cloth(*c, grid_points(70), grid_quads(70), MeshSprings::diagonals);
    for (Node n : c->nodes()) n.value().vel = Point(0, 0, n.position().x);
  }
  const auto ids = random_ids(g);
  const std::vector<Node> nodes(g.node_begin(), g.node_end());
  const auto remove_next = [&ids](Cloth& c, double) {
    const unsigned removed = arrays(c).node_slots() - c.num_nodes();
    for (unsigned k = removed; k < removed + 100; ++k)
      c.remove_node(arrays(c).node_with_id(ids[k]));
  };
  const auto force = make_combined_force(GravityForce(), MassSpringForce());
  const double dt = 1e-4;
  for (int step = 0; step < 20; ++step) {
    symp_euler_step(g, 0, dt, force,
                    ConstraintPlan(make_combined_constraints(remove_next)));
    EXPECT_EQ(descents(g), 0u);
    symp_euler_step(by_call, 0, dt, force, remove_next);
  }
  EXPECT_GT(descents(by_call), 500u);
  for (unsigned id = 0; id < nodes.size(); ++id) {
    ASSERT_EQ(g.has_node(nodes[id]), arrays(by_call).node_in_use(id));
    ASSERT_EQ(arrays(g).positions()[id], arrays(by_call).positions()[id]);
    if (arrays(g).node_in_use(id)) {
      ASSERT_EQ(g.node(nodes[id].index()), nodes[id]);
    }
  }
  ConstraintPlan(make_combined_constraints(remove_next))(by_call, 0);
  EXPECT_EQ(descents(by_call), 0u);
}

}  // namespace
