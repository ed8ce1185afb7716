// FlatCloth and FlatFlow: many steps on the state by component, against single
// steps and against the loops over nodes.
#include "lab/fast/FlatFlow.hpp"
#include "lab/fast/GraphArrays.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <utility>
#include <vector>

#include "lab/fast/OrderedCloth.hpp"
#include "lab/fast/Sweep.hpp"
#include "lab/methods/RungeKutta.hpp"
#include "lab/methods/Splitting.hpp"
#include "lab/methods/SymplecticEuler.hpp"
#include "lab/scenes/Contact.hpp"
#include "lab/stepping/Scene.hpp"
#include "methods.hpp"
#include "tests/Stages.hpp"

using namespace lab;

namespace {

/** Random numbers that a failure repeats. */
class Dice {
 public:
  explicit Dice(unsigned seed) : engine_(seed) {}
  double real(double a, double b) {
    return std::uniform_real_distribution<double>(a, b)(engine_);
  }
  unsigned below(unsigned n) {
    return std::uniform_int_distribution<unsigned>(0, n - 1)(engine_);
  }
  Point point(double a) { return {real(-a, a), real(-a, a), real(-a, a)}; }

 private:
  std::mt19937 engine_;
};

NodeData heavy(Dice& dice) { return {dice.point(1), dice.real(0.5, 2)}; }
EdgeData spring(Dice& dice) { return {dice.real(1, 100), dice.real(0, 1)}; }

void add_random(Cloth& g, Dice& dice, unsigned nodes, unsigned edges) {
  for (unsigned i = 0; i < nodes; ++i) g.add_node(dice.point(1), heavy(dice));
  for (unsigned e = 0; e < edges && g.num_nodes() > 1; ++e) {
    const unsigned i = dice.below(g.num_nodes()), j = dice.below(g.num_nodes());
    if (i != j) g.add_edge(g.node(i), g.node(j), spring(dice));
  }
}

/** A grid with diagonals, in order or not, or a graph without any order. */
void make(Cloth& g, Dice& dice) {
  const unsigned side = 2 + dice.below(14);
  switch (dice.below(4)) {
    case 0:
      return add_random(g, dice, 1 + dice.below(200), dice.below(600));
    case 1: {
      auto quads = grid_quads(side);
      std::shuffle(quads.begin(), quads.end(), std::mt19937(7));
      build_cloth(g, grid_points(side), quads, MeshSprings::plain);
      break;
    }
    default:
      build_cloth(g, grid_points(side), grid_quads(side),
                  MeshSprings::diagonals);
  }
  for (Node n : g.nodes()) n.position() += dice.point(0.3 / side);
  for (Node n : g.nodes()) n.value() = heavy(dice);
}

/** Changes that a caller may make to a cloth between two calls. */
void change(Cloth& g, Dice& dice) {
  const auto some_node = [&] { return g.node(dice.below(g.num_nodes())); };
  switch (dice.below(8)) {
    case 0:
      for (int k = 0; k < 5; ++k) some_node().position() += dice.point(0.01);
      break;
    case 1:
      for (int k = 0; k < 5; ++k) some_node().value().vel = dice.point(1);
      break;
    case 2:
      some_node().value().mass *= 2;
      break;
    case 3:
      for (int k = 0; k < 9 && g.num_edges() > 0; ++k)
        g.edge(dice.below(g.num_edges())).value() = spring(dice);
      break;
    case 4:
      for (int k = 0; k < 3 && g.num_nodes() > 1; ++k)
        g.remove_node(some_node());
      break;
    case 5:
      for (int k = 0; k < 5 && g.num_edges() > 0; ++k)
        g.remove_edge(g.edge(dice.below(g.num_edges())));
      break;
    case 6:
      add_random(g, dice, 1 + dice.below(4), 8);
      break;
    default:
      break;  // nothing
  }
}

bool same_bits(const Cloth& a, const Cloth& b) {
  if (a.num_nodes() != b.num_nodes()) return false;
  for (unsigned i = 0; i < a.num_nodes(); ++i)
    if (a.node(i).position() != b.node(i).position() ||
        a.node(i).value().vel != b.node(i).value().vel)
      return false;
  return true;
}

/** The largest difference of two states, over 1 and what is there. */
double difference(const Cloth& a, const Cloth& b) {
  double most = 0;
  for (unsigned i = 0; i < a.num_nodes(); ++i) {
    const Point x = b.node(i).position(), v = b.node(i).value().vel;
    most = std::max(most, norm(a.node(i).position() - x) / (1 + norm(x)));
    most = std::max(most, norm(a.node(i).value().vel - v) / (1 + norm(v)));
  }
  return most;
}

constexpr double h = 1e-3;

/** A step by the call node by node. */
template <typename M>
void step_by_node(Cloth& g, double t, const ZeroForce& force,
                  const ZeroConstraint& constraint) {
  if constexpr (std::is_same_v<M, SymplecticEuler>)
    symp_euler_step(g, t, h, force, constraint);
  else
    verlet_step(g, t, h, force, constraint);
}

template <typename M>
class FlatFlowTest : public ::testing::Test {
 protected:
  ~FlatFlowTest() override { Sweep::set_threads(0); }

  /** Rounds of changes and of steps, by batches of any length, one by one, and
   * by node; from one state each. */
  void interleave(unsigned seed, const CombinedForces& force,
                  const CombinedConstraints& constraint) {
    Dice dice(seed);
    Cloth batches;
    make(batches, dice);
    Cloth singles = batches;
    M by_batches, by_singles;
    StepTimes times = {0, h};
    for (int round = 0; round < 12; ++round) {
      Dice again = dice;
      change(batches, dice);
      change(singles, again);
      by_batches.restart(), by_singles.restart();
      Cloth by_node = batches;
      int left = 1 + int(dice.below(12));
      for (int k = 0; k < left; ++k) {
        const double t = times(k);
        by_singles.step(singles, t, h, force, constraint);
        step_by_node<M>(by_node, t, force, constraint);
      }
      while (left > 0) {
        const int count = 1 + int(dice.below(unsigned(left)));
        const int made =
            by_batches.steps(batches, times, count, force, constraint);
        ASSERT_EQ(made, count);
        times.done += made, left -= made;
      }
      ASSERT_TRUE(same_bits(batches, singles)) << seed << ", round " << round;
      for (unsigned i = 0; i < arrays(batches).node_slots(); ++i)
        ASSERT_TRUE(arrays(batches).node_in_use(i) ||
                    arrays(batches).positions()[i] == Point())
            << "removed node " << i;
      ASSERT_LT(difference(batches, by_node),
                500 * std::numeric_limits<double>::epsilon())
          << seed << ", round " << round;
    }
  }
};
using Methods = ::testing::Types<SymplecticEuler, Verlet>;
TYPED_TEST_SUITE(FlatFlowTest, Methods);

constexpr unsigned seeds = 15;

// The springs count as often as they are in the sum.
TYPED_TEST(FlatFlowTest, BatchesAreSingleStepsAndLoopsOverNodes) {
  const CombinedConstraints none(CombinedConstraints::List{});
  for (unsigned seed = 0; seed < seeds; ++seed) {
    this->interleave(
        seed, make_combined_force(GravityForce(), MassSpringForce()), none);
    this->interleave(seed,
                     make_combined_force(MassSpringForce(), GravityForce(3)),
                     make_combined_constraints(
                         PlaneConstraint(0.1),
                         SphereConstraint({Point(0.5, 0.5, 0.2), 0.3})));
    if (seed >= 5) continue;
    this->interleave(seed, make_combined_force(GravityForce()), none);
    this->interleave(
        seed, make_combined_force(MassSpringForce(), MassSpringForce()), none);
  }
}

// They see the graph as it is at their place in a step, and may change it.
TYPED_TEST(FlatFlowTest, ThatHoldsForForcesAndConstraintsByCall) {
  for (unsigned seed = 0; seed < seeds; ++seed)
    this->interleave(seed,
                     make_combined_force(MassSpringForce(),
                                         [](Node n, double t) {
                                           Point f = t * n.position();
                                           for (Edge e : n.edges())
                                             f += e.node2().position() -
                                                  n.position();
                                           return f;
                                         }),
                     make_combined_constraints([](Cloth& g, double t) {
                       for (Node n : g.nodes())
                         if (n.position().x < 0) n.value().vel.x += t * 0.1;
                       for (Edge e : g.edges()) e.value().K *= 1.001;
                     }));
}

TYPED_TEST(FlatFlowTest, NeitherThreadsNorProcessorsChangeABit) {
  const auto run = [](int threads, lanes::Cpu cpu) {
    Sweep::set_threads(threads);
    lanes::cpu = cpu;
    Dice dice(3);
    Cloth g;  // rows of offsets up to 71, and others: 5 parts
    build_cloth(g, grid_points(70), grid_quads(70), MeshSprings::diagonals);
    for (Node n : g.nodes()) n.value() = heavy(dice);
    for (int k = 0; k < 500; ++k) g.remove_node(g.node(dice.below(4000)));
    for (int k = 0; k < 300; ++k) {
      const Node a = g.node(dice.below(4000)), b = g.node(dice.below(4000));
      if (a != b) g.add_edge(a, b, spring(dice));
    }
    TypeParam method;
    method.steps(g, {0, h}, 40,
                 make_combined_force(GravityForce(), MassSpringForce(),
                                     DampingForce(0.1)),
                 SphereConstraint());
    lanes::cpu = lanes::best_cpu();
    return g;
  };
  const Cloth one = run(1, lanes::Cpu::plain);
  for (int cpu = 0; cpu <= int(lanes::best_cpu()); ++cpu)
    for (int threads : {1, 3})
      EXPECT_TRUE(same_bits(run(threads, lanes::Cpu(cpu)), one))
          << threads << " threads, " << cpu;
}

// In a batch a part of 1024 nodes is some steps ahead of the next one; springs
// join it to the next part only, to the one after that, or to others, too.
TYPED_TEST(FlatFlowTest, PartsStepsAheadOfOthersChangeNoBit) {
  struct Shape {
    unsigned wide, high, chord;  // chord: of ids, 0: none
  };
  for (const auto& [wide, high, chord] :
       {Shape{90, 91, 0}, Shape{1100, 7, 0}, Shape{90, 91, 1500},
        Shape{90, 91, 8000}}) {
    Dice dice(wide + chord);
    Cloth g;
    build_cloth(g, grid_points(high, wide), grid_quads(high, wide),
                MeshSprings::diagonals);
    for (Node n : g.nodes()) n.value() = heavy(dice);
    for (unsigned k = 0; chord > 0 && k + chord < g.num_nodes(); k += 97)
      g.add_edge(g.node(k), g.node(k + chord), spring(dice));
    const auto force = make_combined_force(GravityForce(), MassSpringForce(),
                                           DampingForce(0.3));
    const Node corner = g.node(0), inner = g.node(3000);
    const PinnedNodes moving(PinConstraint(std::span(&inner, 1)),
                             Motion{.velocity = Point(0, 1, 2)});
    const auto constraint = make_combined_constraints(
        PinConstraint(std::span(&corner, 1)), moving, PlaneConstraint(-0.002),
        SphereConstraint({Point(0.5, 0.5, -0.15), 0.2}));
    Cloth singles = g;
    TypeParam one_by_one;
    for (int k = 0; k < 11; ++k)
      one_by_one.step(singles, k * h, h, force, constraint);
    for (int threads : {1, 2, 3}) {
      Sweep::set_threads(threads);
      Cloth batch = g;
      TypeParam method;
      EXPECT_EQ(method.steps(batch, {0, h}, 11, force, constraint), 11);
      EXPECT_TRUE(same_bits(batch, singles))
          << wide << ", " << chord << ", " << threads;
    }
  }
}

// A ball that tears may need all nodes, or none, as the steps before: batches
// in which parts are steps apart begin again where it does.
TYPED_TEST(FlatFlowTest, PartsAheadWaitForABallThatTears) {
  Cloth g;
  build_cloth(g, grid_points(40), grid_quads(40), MeshSprings::diagonals);
  for (Node n : g.nodes()) n.value().vel = Point(0, 0, -1);
  const auto force = make_combined_force(GravityForce(), MassSpringForce());
  // Reached by some nodes a few steps from one another, until below.
  const auto constraint = make_combined_constraints(
      PlaneConstraint(-0.03),
      TearConstraint(Ball{Point(0.5, 0.5, -0.305), 0.3}));
  Cloth singles = g;
  TypeParam one_by_one;
  constexpr int steps = 60;
  for (int k = 0; k < steps; ++k)
    one_by_one.step(singles, k * h, h, force, constraint);
  EXPECT_LT(singles.num_nodes(), 1590u);
  for (int threads : {1, 3}) {
    Sweep::set_threads(threads);
    Cloth batch = g;
    TypeParam method;
    StepTimes times = {0, h};
    int batches = 0;
    for (; times.done < steps; ++batches)
      times.done +=
          method.steps(batch, times, std::min(8, steps - int(times.done)),
                       force, constraint);
    EXPECT_GT(batches, 9);
    EXPECT_LT(batches, 40);
    EXPECT_TRUE(same_bits(batch, singles)) << threads;
  }
}

// A stage keeps its accelerations and nothing else.
TEST(FlatFlowRungeKutta, BatchesAreSingleStepsAndKuttasFormula) {
  const auto force =
      make_combined_force(GravityForce(), MassSpringForce(), DampingForce(0.3),
                          [](Node n, double t) { return t * n.value().vel; });
  for (unsigned seed = 0; seed < 5; ++seed) {
    Dice dice(seed);
    Cloth batch;
    make(batch, dice);
    Cloth single = batch, by_node = batch;
    Rk4 rk4, again;
    EXPECT_EQ(rk4.steps(batch, {0, h}, 9, force, ZeroConstraint()), 9);
    for (int k = 0; k < 9; ++k) {
      again.step(single, k * h, h, force, ZeroConstraint());
      rk4_step(by_node, k * h, h, force, ZeroConstraint());
    }
    EXPECT_TRUE(same_bits(batch, single)) << seed;
    EXPECT_LT(difference(batch, by_node),
              500 * std::numeric_limits<double>::epsilon())
        << seed;
  }
}

// ----------------------------------------------------------------------- Scene

// Who looks at a run changes no bit of it, whether steps are chosen or not.
TEST(FlatFlowScene, StepsAtOnceAreStepsOneByOne) {
  for (const TimeStep& step :
       {TimeStep{.dt = 0.0007}, TimeStep{.rule = StepRule::sharp}}) {
    Model m = stage_scene("tear", 8);
    m.step = step;
    Scene at_once(m), one_by_one(m), mixed(m);
    constexpr double end = 0.71;
    EXPECT_TRUE(at_once.run_to(end)) << text_of(at_once.failure());
    EXPECT_TRUE(one_by_one.run_to(end, [] {}));
    while (!mixed.done(end))
      mixed.steps_at_once(1 + int(mixed.steps() % 7), end);
    for (const Scene* s : {&one_by_one, &mixed}) {
      EXPECT_EQ(s->steps(), at_once.steps());
      EXPECT_EQ(s->time(), at_once.time());
      EXPECT_EQ(s->evaluations(), at_once.evaluations());
      EXPECT_TRUE(same_bits(s->cloth(), at_once.cloth()));
    }
  }
}

}  // namespace
