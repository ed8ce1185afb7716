// Sweep and Stencil: the fast way over all nodes against the slow one. Many
// steps and changes between them: test_flat_flow.
#include "lab/fast/GraphArrays.hpp"
#include "lab/fast/Sweep.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <limits>
#include <stdexcept>
#include <utility>
#include <vector>

#include "lab/methods/Splitting.hpp"
#include "lab/methods/SymplecticEuler.hpp"
#include "lab/scenes/Contact.hpp"
#include "tests/SweptForces.hpp"

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
Point random_point() { return {random(-1, 1), random(-1, 1), random(-1, 1)}; }
unsigned random_below(unsigned n) {
  return std::min(unsigned(random(0, n)), n - 1);
}

/** @a nodes anywhere, with @a edges springs between any two. */
void make_random(Cloth& g, unsigned nodes, unsigned edges) {
  for (unsigned i = 0; i < nodes; ++i)
    g.add_node(random_point(), {random_point(), random(0.5, 2)});
  for (unsigned e = 0; e < edges && nodes > 1; ++e) {
    const unsigned i = random_below(nodes), j = random_below(nodes);
    if (i != j)
      g.add_edge(g.node(i), g.node(j), {random(1, 100), random(0, 1)});
  }
}
/** A grid with diagonals, its nodes up to a third of its mesh away. */
void make_grid(Cloth& g, unsigned side) {
  build_cloth(g, grid_points(side), grid_quads(side), MeshSprings::diagonals);
  for (Node n : g.nodes()) {
    n.position() += (0.3 / side) * random_point();
    n.value().vel = random_point();
    n.value().mass *= random(0.5, 2);
  }
  for (Edge e : g.edges()) e.value().K *= random(0.5, 2);
}
void remove_some(Cloth& g, unsigned nodes, unsigned edges) {
  for (unsigned k = 0; k < edges && g.num_edges() > 0; ++k)
    g.remove_edge(g.edge(random_below(g.num_edges())));
  for (unsigned k = 0; k < nodes && g.num_nodes() > 0; ++k)
    g.remove_node(g.node(random_below(g.num_nodes())));
}

/** The largest difference of a sweep and the call node by node, over the sum
 * of the sizes of the forces of a node's springs. */
double worst(Cloth& g, FlatFlow& sweep) {
  const auto force =
      make_combined_force(GravityForce(), MassSpringForce(), DampingForce(0.1));
  const ZeroForce& by_node = force;
  const auto f = swept_forces(g, force, sweep);
  double most = 0;
  for (Node n : g.nodes()) {
    double size = n.value().mass * grav + norm(n.value().vel);
    for (Edge e : n.edges())
      size +=
          norm(spring_force(e.node2().position() - n.position(), e.value()));
    most = std::max(most, norm(f[n.id()] - by_node(n, 0)) / size);
  }
  for (unsigned i = 0; i < arrays(g).node_slots(); ++i)
    EXPECT_TRUE(arrays(g).node_in_use(i) || f[i] == Point())
        << "removed node " << i;
  return most;
}

constexpr double round_off = 20 * std::numeric_limits<double>::epsilon();

// ----------------------------------------------------------------- the forces

TEST_F(SweepTest, EqualsTheForcesNodeByNodeOnRandomGraphs) {
  for (Cpu cpu : all_cpus()) {
    lanes::cpu = cpu;
    FlatFlow sweep;  // one for all: it must see that the graph is another
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
        arrays(g).reindex();
        EXPECT_LT(worst(g, sweep), round_off) << "reindexed";
        g.clear();
        EXPECT_EQ(worst(g, sweep), 0) << "cleared";
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
    const auto f = swept_forces(g, MassSpringForce());
    for (unsigned i = 0; i < 20; ++i) EXPECT_EQ(f[i], Point());
  }
}

TEST_F(SweepTest, ACopyOfAGraphIsAnotherGraph) {
  Cloth g;
  make_grid(g, 10);
  Cloth copy = g;
  EXPECT_NE(arrays(copy).version(), arrays(g).version());
  FlatFlow sweep;
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
      RisingFloor(), SphereConstraint({Point(0.5, 0.5, -0.1), 0.1}));
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

/** @a move and @a use are called for ten parts as they should be if nodes are
 * read that are in a halo of @a halo parts. */
void expect_moved_in_time(int halo) {
  constexpr int parts = 10;
  constexpr unsigned size = Sweep::part_size, slots = parts * size - 100;
  for (int threads : {1, 2, 3, 7, 20}) {
    Sweep::set_threads(threads);
    std::vector<std::atomic<int>> moved(parts), used(parts);
    std::atomic<int> at_first = 0;
    Sweep::in_turn(
        slots, halo,
        [&](unsigned first, unsigned last) {
          EXPECT_EQ(last, std::min(first + size, slots));
          EXPECT_EQ(used[first / size], 0);
          ++moved[first / size];
        },
        [&](unsigned first, unsigned last) {
          EXPECT_EQ(last, std::min(first + size, slots));
          const int k = int(first / size);
          for (int j = 0; j < parts; ++j)
            if (std::abs(j - k) <= halo) {
              EXPECT_EQ(moved[std::size_t(j)], 1);
            }
          for (auto& m : moved) at_first += k == 0 ? int(m) : 0;
          ++used[std::size_t(k)];
        });
    for (std::size_t k = 0; k < parts; ++k) {
      EXPECT_EQ(moved[k], 1);
      EXPECT_EQ(used[k], 1);
    }
    // Its own part, those after it, and the last ones, which another thread
    // would wait for.
    if (threads == 1) {
      EXPECT_EQ(at_first, std::min(1 + 2 * halo, parts)) << halo;
    }
  }
}

TEST_F(SweepTest, MovesWhatIsReadBeforeItIsAndNoMoreThanThat) {
  for (int halo : {0, 1, 2, 3, 9, 10}) expect_moved_in_time(halo);
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
  const auto f = swept_forces(g, force);
  EXPECT_EQ(calls, 5000);
  EXPECT_LT(norm(f[4999] - Point(1, 2, 3)), round_off);
}

TEST_F(SweepTest, ThreadsLetExceptionsThrough) {
  Cloth g;
  make_random(g, 5000, 0);
  Sweep::set_threads(3);
  const auto force = make_combined_force([](Node n, double) -> Point {
    if (n.index() % 2000 == 1999) throw std::range_error("no force");
    return {};
  });
  EXPECT_THROW(swept_forces(g, force), std::range_error);
  const auto nothing = [](unsigned, unsigned) {};
  const auto move = [](unsigned first, unsigned) {
    if (first == 2 * Sweep::part_size) throw std::range_error("no way");
  };
  // Before threads wait for each other, and after.
  for (int halo : {0, 5})
    EXPECT_THROW(Sweep::in_turn(5000, halo, move, nothing), std::range_error);
}

// ----------------------------------------------------------------- the stencil

// Only blocks at the ends of a grid's lines have gathered rows: of a
// line of n nodes at most two blocks of eight, and the first and last line.
TEST(Stencil, FindsTheConstantOffsetsOfAGrid) {
  for (unsigned side : {40u, 100u}) {
    for (MeshSprings::Kind mesh :
         {MeshSprings::plain, MeshSprings::diagonals}) {
      Cloth g;
      build_cloth(g, grid_points(side), grid_quads(side), mesh);
      const Stencil<8> s(g, [](unsigned, unsigned) { return false; });
      const unsigned degree = mesh == MeshSprings::plain ? 4 : 8;
      EXPECT_GE(s.num_rows(), degree * (side - 2) * side / 8);
      EXPECT_LE(s.num_rows(), degree * (side * side / 8 + 2 * side));
      std::size_t gathered = 0;
      for (std::size_t row = 0; row < s.num_rows(); ++row)
        gathered += s.offset(row) == 0;
      EXPECT_LE(gathered, degree * (2 * side + 2 * side / 8));
      EXPECT_GT(gathered, 0u);
    }
  }
}

}  // namespace
