// Sweep and Stencil: the fast way over all nodes against the slow one.
#include "lab/fast/Sweep.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <limits>
#include <set>
#include <stdexcept>
#include <tuple>
#include <utility>
#include <vector>

#ifdef _OPENMP
#include <omp.h>
#endif

#include "lab/fast/Kernels.hpp"
#include "lab/methods/Flow.hpp"
#include "lab/methods/Pefrl.hpp"
#include "lab/methods/SymplecticEuler.hpp"
#include "lab/methods/Verlet.hpp"
#include "lab/scenes/Obstacle.hpp"

using namespace lab;

namespace {

using lanes::Cpu;

/** The kinds of processor that this one can stand in for. */
std::vector<Cpu> all_cpus() {
  std::vector<Cpu> all = {Cpu::plain};
  if (lanes::best_cpu() >= Cpu::avx2) all.push_back(Cpu::avx2);
  if (lanes::best_cpu() >= Cpu::avx512) all.push_back(Cpu::avx512);
  return all;
}

/** A test that leaves processor and threads as they were. */
class SweepTest : public ::testing::Test {
 protected:
  ~SweepTest() override {
    lanes::cpu = lanes::best_cpu();
    Sweep::set_threads(0);
  }
};

double random(double a, double b) { return CME212::random(a, b); }
Point random_point() {
  return {Real(random(-1, 1)), Real(random(-1, 1)), Real(random(-1, 1))};
}
unsigned random_below(unsigned n) {
  return std::min(unsigned(random(0, n)), n - 1);
}

/** @a nodes anywhere, with @a edges springs between any two. */
void make_random(Cloth& g, unsigned nodes, unsigned edges) {
  for (unsigned i = 0; i < nodes; ++i)
    g.add_node(random_point(), {random_point(), Real(random(0.5, 2))});
  for (unsigned e = 0; e < edges && nodes > 1; ++e) {
    const unsigned i = random_below(nodes), j = random_below(nodes);
    if (i != j)
      g.add_edge(g.node(i), g.node(j),
                 {Real(random(1, 100)), Real(random(0, 1))});
  }
}
/** A grid with diagonals, its nodes up to a third of its mesh away. */
void make_grid(Cloth& g, unsigned side) {
  build_cloth(g, grid_points(side), grid_quads(side), Mesh::diagonals);
  for (Node n : g.nodes()) {
    n.position() += (0.3 / side) * random_point();
    n.value().vel = random_point();
    n.value().mass *= Real(random(0.5, 2));
  }
  for (Edge e : g.edges()) e.value().K *= Real(random(0.5, 2));
}
void remove_some(Cloth& g, unsigned nodes, unsigned edges) {
  for (unsigned k = 0; k < edges && g.num_edges() > 0; ++k)
    g.remove_edge(g.edge(random_below(g.num_edges())));
  for (unsigned k = 0; k < nodes && g.num_nodes() > 0; ++k)
    g.remove_node(g.node(random_below(g.num_nodes())));
}

/** The largest difference of a sweep and the call node by node, over the sum
 * of the sizes of the forces of a node's springs. */
double worst(Cloth& g, Sweep& sweep) {
  const auto force =
      make_combined_force(GravityForce(), MassSpringForce(), DampingForce(0.1));
  const ZeroForce& by_node = force;
  std::vector<Point> f;
  sweep(g, 0, force, f);
  double most = 0;
  for (Node n : g.nodes()) {
    double size = n.value().mass * grav + norm(n.value().vel);
    for (Edge e : n.edges())
      size +=
          norm(spring_force(e.node2().position() - n.position(), e.value()));
    most = std::max(most, norm(f[n.id()] - by_node(n, 0)) / size);
  }
  for (unsigned i = 0; i < g.node_slots(); ++i)
    EXPECT_TRUE(g.node_in_use(i) || f[i] == Point()) << "removed node " << i;
  return most;
}

constexpr double round_off = 20 * std::numeric_limits<Real>::epsilon();

// ----------------------------------------------------------------- the forces

TEST_F(SweepTest, EqualsTheForcesNodeByNodeOnRandomGraphs) {
  for (Cpu cpu : all_cpus()) {
    lanes::cpu = cpu;
    Sweep sweep;  // one for all: it must see that the graph is another
    for (unsigned nodes : {1u, 2u, 7u, 8u, 9u, 15u, 16u, 17u, 33u, 100u, 1500u})
      for (unsigned per_node : {0u, 1u, 3u, 10u}) {
        Cloth g;
        make_random(g, nodes, per_node * nodes);
        EXPECT_LT(worst(g, sweep), round_off) << nodes << " nodes";
        while (g.num_nodes() > nodes / 3) {
          remove_some(g, 1 + nodes / 10, nodes / 10);
          EXPECT_LT(worst(g, sweep), round_off) << g.num_nodes() << " left";
        }
        make_random(g, 1 + nodes / 4, nodes);  // into the slots of the removed
        EXPECT_LT(worst(g, sweep), round_off) << "refilled";
        g.reindex();
        EXPECT_LT(worst(g, sweep), round_off) << "reindexed";
        g.clear();
        EXPECT_EQ(worst(g, sweep), 0) << "cleared";
      }
  }
}

TEST_F(SweepTest, EqualsTheForcesNodeByNodeOnTornGrids) {
  for (Cpu cpu : all_cpus()) {
    lanes::cpu = cpu;
    for (unsigned side : {2u, 3u, 8u, 9u, 16u, 31u, 40u}) {
      Cloth g;
      Sweep sweep;
      make_grid(g, side);
      EXPECT_LT(worst(g, sweep), round_off) << side;
      remove_some(g, side, side);
      EXPECT_LT(worst(g, sweep), round_off) << side << ", torn";
    }
  }
}

TEST_F(SweepTest, NodesInOnePlaceFeelNoSpringAndNoNan) {
  for (Cpu cpu : all_cpus()) {
    lanes::cpu = cpu;
    Cloth g;
    for (int i = 0; i < 20; ++i) g.add_node(Point(1));
    for (unsigned i = 0; i < 20; ++i)
      for (unsigned j = 0; j < i; ++j)
        g.add_edge(g.node(i), g.node(j), {1000, 1});
    std::vector<Point> f;
    Sweep()(g, 0, MassSpringForce(), f);
    for (unsigned i = 0; i < 20; ++i) EXPECT_EQ(f[i], Point());
  }
}

TEST_F(SweepTest, SeesChangedSpringsAndPositionsAtOnce) {
  Cloth g;
  make_grid(g, 20);
  Sweep sweep;
  EXPECT_LT(worst(g, sweep), round_off);
  for (Edge e : g.edges()) e.value().K *= 3, e.value().L *= 2;
  for (Node n : g.nodes()) n.position() *= 2;
  EXPECT_LT(worst(g, sweep), round_off);
}

TEST_F(SweepTest, ACopyOfAGraphIsAnotherGraph) {
  Cloth g;
  make_grid(g, 10);
  Cloth copy = g;
  EXPECT_NE(copy.version(), g.version());
  Sweep sweep;
  worst(g, sweep);
  remove_some(g, 3, 0);
  remove_some(copy, 0, 5);
  EXPECT_LT(worst(g, sweep), round_off);
  EXPECT_LT(worst(copy, sweep), round_off);
}

// -------------------------------------------------------------------- threads

/** Positions and velocities after 20 steps and a tear. */
std::vector<Point> run(Method& method, int threads,
                       const ConstraintPlan& constraint = ZeroConstraint(),
                       bool far = false) {
  CME212::default_generator.seed(5);
  Sweep::set_threads(threads);
  Cloth g;
  make_grid(g, 70);  // 4900 nodes: five parts
  CombinedForces force = make_combined_force(GravityForce(), MassSpringForce(),
                                             DampingForce(0.0001));
  if (far)  // as it may be, for all that is known of it
    force = make_combined_force(force, [](Node, double) { return Point(); });
  double t = 0;
  for (int k = 0; k < 20; ++k) {
    if (k == 10) remove_some(g, 300, 100);
    t = method(g, t, 0.0005, force, constraint);
  }
  std::vector<Point> end;
  for (Node n : g.nodes()) {
    end.push_back(n.position());
    end.push_back(n.value().vel);
  }
  return end;
}

TEST_F(SweepTest, ThreadsDoNotChangeABit) {
  SymplecticEuler euler;
  Verlet verlet;
  for (Method* method :
       {static_cast<Method*>(&euler), static_cast<Method*>(&verlet)}) {
    const auto one = run(*method, 1);
    for (int threads : {2, 3, 4, 7}) {
      method->restart();
      EXPECT_TRUE(run(*method, threads) == one) << threads << " threads";
    }
  }
}

/** A floor that rises at 0.2 m/s. */
class RisingFloor final : public NodewiseConstraint {
 public:
  void project(Cloth& g, double t, unsigned first,
               unsigned last) const override {
    const double z = -0.004 + 0.2 * t;
    for_each_violating(
        g, first, last, [z](const Point& p) { return p.z < z; },
        [z](Node n) { n.position().z = z, n.value().vel.z = 0.2; });
  }
};

// A nodewise constraint projects part by part, on the way.
TEST_F(SweepTest, ProjectingOnTheWayDoesNotChangeABit) {
  SymplecticEuler euler;
  Verlet verlet;
  Pefrl pefrl;
  const auto by_node = make_combined_constraints(
      RisingFloor(), SphereConstraint(Point(0.5, 0.5, -0.1), 0.1));
  const auto in_turn =
      make_combined_constraints([&](Cloth& g, double t) { by_node(g, t); });
  ASSERT_TRUE(ConstraintPlan(by_node).nodewise() &&
              !ConstraintPlan(in_turn).nodewise());
  for (Method* method :
       {static_cast<Method*>(&euler), static_cast<Method*>(&verlet),
        static_cast<Method*>(&pefrl)}) {
    const auto expected = run(*method, 1, in_turn);
    method->restart();
    ASSERT_FALSE(run(*method, 1) == expected) << "nothing is in the way";
    for (int threads : {1, 2, 7}) {
      method->restart();
      EXPECT_TRUE(run(*method, threads, by_node) == expected)
          << threads << " threads";
      method->restart();
      EXPECT_TRUE(run(*method, threads, by_node, true) == expected)
          << threads << " threads, far";
    }
  }
}

/** @a move and @a use are called for the ten parts of @a g as they should be if
 * @a force asks for nodes that are in a halo of @a halo parts. */
void expect_moved_in_time(const Cloth& g, const ForcePlan& force,
                          unsigned halo) {
  constexpr unsigned parts = 10, size = Sweep::part_size;
  for (int threads : {1, 2, 3, 7, 20}) {
    Sweep::set_threads(threads);
    std::vector<std::atomic<int>> moved(parts), used(parts);
    std::atomic<int> at_first = 0;
    Sweep().after(
        [&](const Part& part) {
          EXPECT_EQ(used[part.first / size], 0);
          ++moved[part.first / size];
        },
        g, 0, force,
        [&](const Part& part, std::span<const Point>) {
          const unsigned k = part.first / size;
          for (unsigned j = 0; j < parts; ++j)
            if (j + halo >= k && j <= k + halo) {
              EXPECT_EQ(moved[j], 1);
            }
          for (auto& m : moved) at_first += k == 0 ? int(m) : 0;
          ++used[k];
        });
    for (unsigned k = 0; k < parts; ++k) {
      EXPECT_EQ(moved[k], 1);
      EXPECT_EQ(used[k], 1);
    }
    // Its own part, those after it, and the last ones, which another thread
    // would wait for.
    if (threads == 1) {
      EXPECT_EQ(at_first, std::min(1 + 2 * int(halo), 10)) << halo;
    }
  }
}

TEST_F(SweepTest, MovesWhatAForceAsksForBeforeItAndNoMoreThanThat) {
  Cloth g;
  make_grid(g, 100);  // neighbors at most 101 ids away
  const auto near = make_combined_force(GravityForce(), MassSpringForce());
  expect_moved_in_time(g, near, 1);
  expect_moved_in_time(
      g, make_combined_force(near, [](Node, double) { return Point(); }), 10);
  g.add_edge(g.node(0), g.node(1023));
  expect_moved_in_time(g, near, 1);
  // A gather of that node reads the first number of the next one.
  g.add_edge(g.node(0), g.node(1024));
  expect_moved_in_time(g, near, 2);
  g.add_edge(g.node(6000), g.node(3500));
  expect_moved_in_time(g, near, 3);
  g.add_edge(g.node(0), g.node(9999));
  expect_moved_in_time(g, near, 10);
}

TEST_F(SweepTest, ProcessorsDoNotChangeABit) {
  Verlet verlet;
  lanes::cpu = Cpu::plain;
  const auto plain = run(verlet, 1);
  for (Cpu cpu : all_cpus()) {
    lanes::cpu = cpu;
    verlet.restart();
    EXPECT_TRUE(run(verlet, 1) == plain) << int(cpu);
  }
}

// Large cloths without constant offsets are swept by another kernel.
TEST_F(SweepTest, PrefetchDoesNotChangeABit) {
  using kernels::SpringSweep;
  const auto expect_same = [](const Cloth& g) {
    const ClothStencil stencil(g);
    const auto sum = [&]<bool prefetch>(std::bool_constant<prefetch>) {
      std::vector<Point> f(stencil.num_blocks() * lanes::width);
      lanes::run<SpringSweep<prefetch>>(stencil, g.positions().data(),
                                        g.edge_values().data(), 0u,
                                        stencil.num_blocks(), f.data());
      return f;
    };
    for (Cpu cpu : all_cpus()) {
      lanes::cpu = cpu;
      EXPECT_TRUE(sum(std::true_type()) == sum(std::false_type()))
          << g.num_nodes();
    }
  };
  for (unsigned nodes : {1u, 16u, 33u, 100u, 1500u}) {
    Cloth g;
    make_random(g, nodes, 4 * nodes);
    expect_same(g);
  }
  for (unsigned side : {2u, 9u, 40u}) {
    Cloth g;
    make_grid(g, side);
    expect_same(g);
  }
}

// As many springs as no cache holds, so that the force takes that kernel.
TEST_F(SweepTest, EqualsTheForcesNodeByNodeOnALargeCloth) {
  Cloth g;
  make_random(g, 20000, 300000);
  ASSERT_GT(g.edge_slots() * sizeof(EdgeData), kernels::cache);
  Sweep sweep;
  EXPECT_LT(worst(g, sweep), round_off);
}

TEST_F(SweepTest, FunctionsNeedNotBeFitForThreads) {
  Cloth g;
  make_random(g, 5000, 0);
  Sweep::set_threads(3);
  int calls = 0;
  const auto force = make_combined_force([&calls](Node, double) {
    ++calls;
    return Point(1, 2, 3);
  });
  std::vector<Point> f;
  Sweep()(g, 0, force, f);
  EXPECT_EQ(calls, 5000);
  EXPECT_EQ(f[4999], Point(1, 2, 3));
}

TEST_F(SweepTest, ThreadsLetExceptionsThrough) {
  Cloth g;
  make_random(g, 5000, 0);
  Sweep::set_threads(3);
  const auto force = make_combined_force([](Node n, double) -> Point {
    if (n.index() % 2000 == 1999) throw std::range_error("no force");
    return {};
  });
  std::vector<Point> f;
  EXPECT_THROW(Sweep()(g, 0, force, f), std::range_error);
  const auto move = [](const Part& part) {
    if (part.first == 2 * Sweep::part_size) throw std::range_error("no way");
  };
  // Before threads wait for each other, and after.
  const auto far = make_combined_force([](Node, double) { return Point(); });
  const GravityForce gravity;
  for (const ZeroForce* wanted : {static_cast<const ZeroForce*>(&far),
                                  static_cast<const ZeroForce*>(&gravity)})
    EXPECT_THROW(Sweep().after(move, g, 0, *wanted, f,
                               [](const Part&, std::span<Point>) {}),
                 std::range_error);
}

// A team costs more than a step of a small cloth, even if one thread is all.
TEST_F(SweepTest, AClothOfOnePartIsSweptWithoutATeam) {
#ifdef _OPENMP
  Sweep::set_threads(2);
  for (unsigned nodes : {Sweep::part_size, Sweep::part_size + 1}) {
    Cloth g;
    make_random(g, nodes, 0);
    std::atomic<int> parts = 0, level = 0;
    Sweep().parts(g, [&](const Part&) { ++parts, level = omp_get_level(); });
    EXPECT_EQ(parts, nodes == Sweep::part_size ? 1 : 2);
    EXPECT_EQ(level, nodes == Sweep::part_size ? 0 : 1);
  }
#else
  GTEST_SKIP() << "built without OpenMP";
#endif
}

TEST_F(SweepTest, PartsMakeUpTheCloth) {
  for (unsigned nodes : {0u, 1u, 1023u, 1024u, 1025u, 5000u}) {
    Cloth g;
    make_random(g, nodes, 0);
    std::vector<std::atomic<int>> seen(nodes);
    Sweep().parts(g, [&](const Part& part) {
      EXPECT_EQ(part.first % ClothStencil::width, 0u);
      for (unsigned i = part.first; i < part.last; ++i) ++seen[i];
    });
    for (auto& times : seen) EXPECT_EQ(times, 1);
  }
}

// ------------------------------------------------------------ drift and kick

TEST_F(SweepTest, DriftAndKickAreTheirFormulas) {
  for (Cpu cpu : all_cpus()) {
    lanes::cpu = cpu;
    for (unsigned nodes : {1u, 7u, 8u, 16u, 19u, 64u, 1100u}) {
      Cloth g;
      make_random(g, nodes, 0);
      Cloth before = g;
      std::vector<Point> f(nodes);
      for (Point& p : f) p = random_point();
      const double h = 0.37;
      Sweep().parts(g, [&](const Part& part) {
        drift(g, part, h, 0);
        kick(g, part, h, std::span(f).subspan(part.first));
      });
      for (unsigned i = 0; i < nodes; ++i) {
        const NodeData old = before.node(i).value();
        const Point x = before.node(i).position() + h * old.vel;
        const Point v = old.vel + (h / old.mass) * f[i];
        EXPECT_LT(norm(g.node(i).position() - x), round_off);
        EXPECT_LT(norm(g.node(i).value().vel - v), round_off);
        EXPECT_EQ(g.node(i).value().mass, old.mass);
      }
    }
  }
}

// ------------------------------------------------------------------- precision

TEST(Precision, IsThatOfRealInAllThatAClothHolds) {
  EXPECT_EQ(sizeof(Point), 3 * sizeof(Real));
  EXPECT_EQ(sizeof(NodeData), 4 * sizeof(Real));
  EXPECT_EQ(sizeof(EdgeData), 2 * sizeof(Real));
  EXPECT_EQ(lanes::width * sizeof(Real), 64u);
  EXPECT_EQ(Point(0.1).x, Real(0.1));
  EXPECT_EQ((0.1 * Point(1)).z, Real(0.1));
}

// 0.1 added up a hundred thousand times in float is off by a thousandth.
TEST(Precision, SumsOverNodesAreInDouble) {
  constexpr unsigned n = 100000;
  const double tenth = Real(0.1);
  Cloth g;
  for (unsigned i = 0; i < n; ++i)
    g.add_node(Point(0, 0, 3), {Point(1, 0, 0), Real(0.1)});
  EXPECT_NEAR(total_mass(g), n * tenth, 1e-6);
  EXPECT_NEAR(kinetic_energy(g), n * tenth / 2, 1e-6);
  EXPECT_NEAR(gravitational_energy(g, 2), n * tenth * 6, 1e-5);
  EXPECT_NEAR(center_of_mass(g).z, 3, 1e-6);
}

// ----------------------------------------------------------------- the stencil

/** Every (node, neighbor, edge) that the rows name, springs of a node to itself
 * left out; and that they name none twice. */
template <int W>
std::set<std::tuple<unsigned, unsigned, unsigned>> springs_of(
    const Stencil<W>& s, unsigned slots) {
  std::set<std::tuple<unsigned, unsigned, unsigned>> all;
  for (unsigned b = 0; b < s.num_blocks(); ++b)
    for (const auto& row : s.rows(b))
      for (unsigned k = 0; k < W; ++k) {
        const unsigned id = std::min(b * W + k, slots - 1);
        const unsigned j =
            row.offset != 0 ? id + unsigned(row.offset) : s.neighbors(row)[k];
        const unsigned e =
            row.first_edge != s.none ? row.first_edge + k : s.edges(row)[k];
        EXPECT_TRUE(j == id || all.insert({id, j, e}).second)
            << id << " has " << j << " twice";
      }
  return all;
}

TEST(Stencil, NamesEachEdgeFromBothEnds) {
  for (unsigned nodes : {1u, 5u, 8u, 30u, 64u}) {
    Cloth g;
    make_random(g, nodes, 4 * nodes);
    remove_some(g, nodes / 4, nodes / 4);
    std::set<std::tuple<unsigned, unsigned, unsigned>> expected;
    for (Edge e : g.edges()) {
      expected.insert({e.node1().id(), e.node2().id(), e.id()});
      expected.insert({e.node2().id(), e.node1().id(), e.id()});
    }
    EXPECT_EQ(springs_of(Stencil<8>(g), g.node_slots()), expected);
    EXPECT_EQ(springs_of(Stencil<4>(g), g.node_slots()), expected);
  }
}

TEST(Stencil, ReachesAsFarAsTheFarthestNeighbor) {
  Cloth g;
  EXPECT_EQ(Stencil<8>(g).reach(), 0u);
  for (int i = 0; i < 40; ++i) g.add_node(Point());
  EXPECT_EQ(Stencil<8>(g).reach(), 0u);
  g.add_edge(g.node(7), g.node(8));
  EXPECT_EQ(Stencil<8>(g).reach(), 1u);
  g.add_edge(g.node(30), g.node(1));
  EXPECT_EQ(Stencil<8>(g).reach(), 29u);
  g.remove_node(g.node(1));
  EXPECT_EQ(Stencil<8>(g).reach(), 1u);
}

// Only blocks at the ends of a grid's lines have gathered rows: of a
// line of n nodes at most two blocks of eight, and the first and last line.
TEST(Stencil, FindsTheConstantOffsetsOfAGrid) {
  for (unsigned side : {40u, 100u}) {
    for (Mesh mesh : {Mesh::plain, Mesh::diagonals}) {
      Cloth g;
      build_cloth(g, grid_points(side), grid_quads(side), mesh);
      const Stencil<8> s(g);
      const unsigned degree = mesh == Mesh::plain ? 4 : 8;
      EXPECT_GE(s.num_rows(), degree * (side - 2) * side / 8);
      EXPECT_LE(s.num_rows(), degree * (side * side / 8 + 2 * side));
      EXPECT_LE(s.num_gathered(), degree * (2 * side + 2 * side / 8));
      EXPECT_GT(s.num_gathered(), 0u);
    }
  }
}

// A line whose edges come in any order, so that no two nodes list their
// neighbors alike; all but its two ends have both at a constant offset.
TEST(Stencil, FindsConstantOffsetsInListsOfAnyOrder) {
  Cloth g;
  for (unsigned i = 0; i < 64; ++i) g.add_node(Point());
  for (unsigned k = 0; k < 63; ++k)
    g.add_edge(g.node(5 * k % 63), g.node(5 * k % 63 + 1));
  const Stencil<8> s(g);
  unsigned constant = 0;
  for (unsigned b = 0; b < s.num_blocks(); ++b)
    for (const auto& row : s.rows(b)) constant += row.offset != 0;
  EXPECT_EQ(constant, 14u);
  EXPECT_EQ(s.num_rows(), 16u);
}

TEST(Stencil, GathersTheEdgesOfAGridWhoseEdgesComeQuadByQuad) {
  const unsigned side = 64;
  Cloth g;
  for (const Point& p : grid_points(side)) g.add_node(p);
  for (const Quad& q : grid_quads(side))
    for (auto [a, b] : {std::pair(0, 1), {0, 2}, {1, 3}, {2, 3}})
      g.add_edge(g.node(q[a]), g.node(q[b]));
  const Stencil<8> s(g);
  unsigned constant = 0;
  for (unsigned b = 0; b < s.num_blocks(); ++b)
    for (const auto& row : s.rows(b))
      if (row.offset != 0) {
        ++constant;
        EXPECT_EQ(row.first_edge, s.none);
        EXPECT_EQ(s.neighbors(row)[3], b * 8 + 3 + unsigned(row.offset));
      }
  EXPECT_GT(constant, 4 * (side - 2) * (side / 8 - 2));
}

}  // namespace
