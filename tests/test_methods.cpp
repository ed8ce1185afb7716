// The methods: what all of them do, and what the kind of each promises
// (symmetry, invariants, exact drag). Problems with known answers. Orders:
// test_orders; limits: test_stability; evaluations: test_work_precision.
#include <gtest/gtest.h>

#include <numbers>

#include "lab/methods/Methods.hpp"
#include "lab/methods/MollifiedImpulse.hpp"
#include "lab/methods/RungeKutta.hpp"
#include "lab/methods/Splitting.hpp"
#include "lab/methods/SymplecticEuler.hpp"
#include "lab/stability/StepLimit.hpp"
#include "tests/Allocations.hpp"
#include "tests/Momentum.hpp"
#include "tests/Says.hpp"
#include "tests/TestFolder.hpp"

using namespace lab;

namespace {

using std::numbers::pi;

struct Names {
  template <typename M>
  static std::string GetName(int) {
    return test_name(M::info.name);
  }
};

// Below the limit, which test_stability holds from both sides, the method of
// Blanes and Moan has gaps, which its `fails_when` names.
TEST(Methods, HaveOnlyWeakGapsBelowTheirLimits) {
  for (const MethodEntry& m : methods) {
    if (m.info.limit == no_limit || m.info.adaptive) continue;
    const auto method = m.make();
    double worst = 1;
    for (double h = 0.01; h < 0.997 * m.info.limit; h += 0.01)
      worst = std::max(worst, amplification(*method, h, 1));
    const bool has_gaps = m.info.name == Srkn11b::info.name;
    EXPECT_LT(worst, has_gaps ? 1.02 : 1 + 1e-9) << m.info.name;
  }
}

// ------------------------------------------------------- All of the table

class EveryMethod : public ::testing::TestWithParam<MethodEntry> {};
INSTANTIATE_TEST_SUITE_P(Table, EveryMethod, ::testing::ValuesIn(methods),
                         [](const auto& m) {
                           return test_name(m.param.info.name);
                         });

TEST_P(EveryMethod, TearsWithASoundGraph) {
  Cloth g;
  build_cloth(g, grid_points(9), grid_quads(9), MeshSprings::diagonals);
  auto constraint = make_combined_constraints(
      PinConstraint(g), PlaneConstraint(), TearConstraint());
  auto force = make_combined_force(GravityForce(), MassSpringForce(),
                                   DampingForce(1.0 / 81));
  auto method = GetParam().make();
  for (int n = 0; n < 400; ++n) {
    (*method)(g, 0.002 * n, 0.002, force, constraint);
    if (n % 20 == 0) g.check_invariants();
    for (Node m : g.nodes()) ASSERT_FALSE(Ball().holds(m.position()));
  }
  EXPECT_LT(g.num_nodes(), 81u);
  if (GetParam().info.limit > 0) {
    EXPECT_LT(kinetic_energy(g), 10);
  }
}

TEST_P(EveryMethod, AllocatesNothingAfterItsFirstStep) {
  Cloth g;
  build_cloth(g, grid_points(5), grid_quads(5), MeshSprings::diagonals);
  const ConstraintPlan constraint = make_combined_constraints(
      PinConstraint(g), PlaneConstraint(), SphereConstraint());
  const ForcePlan force = make_combined_force(GravityForce(), MassSpringForce(),
                                              DampingForce(1.0 / 25));
  auto method = GetParam().make();
  double t = 0;
  for (int n = 0; n < 3; ++n) t = method->step(g, t, 0.001, force, constraint);
  long before = allocations;
  for (int n = 0; n < 50; ++n) t = method->step(g, t, 0.001, force, constraint);
  EXPECT_EQ(allocations - before, 0);
}

// A student's force: one virtual function, the call, and no more.
struct OwnGravity : ZeroForce {
  Point operator()(Node n, double) const override {
    return n.value().mass * Point(0, 0, -grav);
  }
};
struct SofterSprings : MassSpringForce {
  Point operator()(Node n, double t) const override {
    return 0.5 * MassSpringForce::operator()(n, t);
  }
};
struct OwnFloor : ZeroConstraint {
  void operator()(Cloth& g, double) const override {
    for (Node n : g.nodes())
      if (n.position().z < -0.02) n.position().z = -0.02, n.value().vel.z = 0;
  }
};
struct LowerFloor : PlaneConstraint {
  LowerFloor() : PlaneConstraint(0.5) {}
  void operator()(Cloth& g, double t) const override { OwnFloor()(g, t); }
};

/** 30 steps of @a method from a sheet of stiffness @a K that swings.
 * @return all positions and velocities */
std::vector<Point> swing(const MethodEntry& entry, double K,
                         const ZeroForce& force,
                         const ZeroConstraint& constraint) {
  Cloth g;
  build_cloth(g, grid_points(5), grid_quads(5), MeshSprings::diagonals, K);
  for (Node n : g.nodes())
    n.value().vel = Point(n.position().y, 0, -n.position().x);
  const auto method = entry.make();
  const CombinedConstraints both({std::make_shared<PinConstraint>(g),
                                  std::shared_ptr<const ZeroConstraint>(
                                      std::shared_ptr<void>(), &constraint)});
  for (int n = 0; n < 30; ++n) (*method)(g, 0.002 * n, 0.002, force, both);
  std::vector<Point> end;
  for (Node n : g.nodes())
    end.push_back(n.position()), end.push_back(n.value().vel);
  return end;
}

TEST_P(EveryMethod, TakesAForceOfOneVirtualOrRefusesItWithWords) {
  const auto own = make_combined_force(OwnGravity(), SofterSprings());
  if (GetParam().info.limit == no_limit) {  // implicit: asks for stiffness
    const auto other = make_combined_force(OwnGravity(), MassSpringForce());
    const SofterSprings softer;
    for (const ZeroForce* force : {static_cast<const ZeroForce*>(&own),
                                   static_cast<const ZeroForce*>(&other),
                                   static_cast<const ZeroForce*>(&softer)}) {
      const std::string what = error_of<std::invalid_argument>(
          [&] { swing(GetParam(), 100, *force, ZeroConstraint()); });
      EXPECT_TRUE(begins(what, GetParam().info.name));
      EXPECT_TRUE(has(what, "does not know its stiffness"));
    }
    return;
  }
  const auto known = make_combined_force(GravityForce(), MassSpringForce());
  const auto expected = swing(GetParam(), 50, known, ZeroConstraint());
  const auto is = swing(GetParam(), 100, own, ZeroConstraint());
  ASSERT_EQ(is.size(), expected.size());
  for (std::size_t k = 0; k < is.size(); ++k)
    EXPECT_LT(norm(is[k] - expected[k]), 1e-11);
}

TEST_P(EveryMethod, TakesAConstraintOfOneVirtual) {
  const auto force = make_combined_force(GravityForce(), MassSpringForce());
  const auto free = swing(GetParam(), 100, force, ZeroConstraint());
  const auto expected = swing(GetParam(), 100, force, PlaneConstraint(-0.02));
  EXPECT_FALSE(free == expected) << "nothing is in the way";
  EXPECT_TRUE(swing(GetParam(), 100, force, OwnFloor()) == expected);
  EXPECT_TRUE(swing(GetParam(), 100, force, LowerFloor()) == expected);
}

TEST(Methods, AreFoundByTheirNames) {
  for (const MethodEntry& m : methods) EXPECT_EQ(find_method(m.info.name), &m);
  EXPECT_EQ(find_method("verlet")->info.order, 2);
  EXPECT_EQ(find_method("no such"), nullptr);
}

TEST(Methods, HaveASectionAndACost) {
  const std::string text = CME212::contents("lab/methods/README.md");
  for (const MethodEntry& m : methods) {
    const std::string name(m.info.name);
    EXPECT_TRUE(has(
        text, "\n### `" + name + "`, order " + std::to_string(m.info.order)))
        << "lab/methods/README.md has no section of " << name;
    EXPECT_GT(m.info.cost.at_limit, 0) << name << ": make method-costs";
    EXPECT_EQ(m.info.cost.at_ten > 0, m.info.limit == no_limit) << name;
  }
}

// ------------------------------------------------------------------ Splittings

template <typename M>
class Symmetric : public ::testing::Test {};
using SymmetricOnes =
    ::testing::Types<Verlet, MollifiedImpulse, Pefrl, Srkn11b>;
TYPED_TEST_SUITE(Symmetric, SymmetricOnes, Names);

/** A grid in motion, without pins. */
void shake(Cloth& g) {
  build_cloth(g, grid_points(5), grid_quads(5), MeshSprings::diagonals);
  stir(g, 4);
}

TYPED_TEST(Symmetric, CanBeTakenBack) {
  Cloth g, start;
  shake(g);
  shake(start);
  auto force = make_combined_force(GravityForce(), MassSpringForce());
  for (int way = 0; way < 2; ++way) {
    TypeParam method;
    for (int n = 0; n < 100; ++n) method(g, 0.005 * n, 0.005, force);
    if (way == 0) {
      EXPECT_GT(norm(g.node(7).position() - start.node(7).position()), 0.01);
    }
    for (Node n : g.nodes()) n.value().vel *= -1;
  }
  for (unsigned i = 0; i < g.num_nodes(); ++i)
    EXPECT_LT(norm(g.node(i).position() - start.node(i).position()), 1e-10);
}

TYPED_TEST(Symmetric, ConservesMomentumAndAngularMomentum) {
  Cloth g;
  shake(g);
  const Point linear = momentum(g), angular = angular_momentum(g);
  TypeParam method;
  for (int n = 0; n < 500; ++n) method(g, 0.005 * n, 0.005, MassSpringForce());
  EXPECT_LT(norm(momentum(g) - linear), 1e-13);
  EXPECT_LT(norm(angular_momentum(g) - angular), 1e-13);
}

// Without gravity, drag is all there is: x = v0 (1 - e^(-ct))/c, exactly. Each
// node has its own c: also none, or the same c/m.
TYPED_TEST(Symmetric, SolvesTheDragOfEachNodeExactly) {
  Cloth g;
  std::vector<double> c;
  for (unsigned i = 0; i < 300; ++i) {  // runs that fill registers and do not
    const unsigned kind = i / 21 % 4;
    c.push_back(std::array{4., 0., 8., 1.}[kind]);
    g.add_node(Point(0, i, 0),
               {Point(1, 0, 0), std::array{2., 5., 4., 5.}[kind]});
  }
  TypeParam method;
  const NodeDrag drag(c);
  for (int n = 0; n < 10; ++n) method(g, 0.3 * n, 0.3, drag);
  for (Node n : g.nodes()) {
    const double gamma = c[n.index()] / n.value().mass;
    EXPECT_NEAR(n.position().x,
                gamma > 0 ? (1 - std::exp(-3 * gamma)) / gamma : 3, 1e-14);
    EXPECT_NEAR(n.value().vel.x, std::exp(-3 * gamma), 1e-14);
  }
}

/** A mass of 1 kg on a spring of K [N/m] to a held node, at rest at y = 0.1:
 * y'' + K y = 0 while y > -1. */
struct Pair {
  Cloth g;
  Node wall = g.add_node(Point()), mass = g.add_node(Point(1.1, 0, 0));
  PinConstraint pin = PinConstraint(std::vector<Node>{wall});
  ForcePlan force = MassSpringForce();
  explicit Pair(double K) { g.add_edge(wall, mass, {K, 1}); }
  double y() const { return mass.position().x - 1; }
};

// Energy swings, and does not drift, over 200,000 steps.
template <typename M>
void expect_no_drift(double h) {
  Pair o(1);
  M method;
  auto largest = [&](int steps) {
    double worst = 0;
    for (int n = 0; n < steps; ++n) {
      method.step(o.g, n * h, h, o.force, o.pin);
      const double v = o.mass.value().vel.x;
      worst = std::max(worst, std::abs((v * v + o.y() * o.y()) / 0.01 - 1));
    }
    return worst;
  };
  double early = largest(1000);
  largest(198000);
  double late = largest(1000);
  EXPECT_GT(early, 1e-9);
  EXPECT_NEAR(late / early, 1, 0.02) << M::info.name;
}
TEST(Energy, DoesNotDriftIn200000StepsOfASymplecticMethod) {
  expect_no_drift<SymplecticEuler>(0.3);
  expect_no_drift<Verlet>(0.3);
  expect_no_drift<Pefrl>(0.7);
  expect_no_drift<Srkn11b>(1.1);
}

// ---------------------------------------------------------------------- Verlet

// From (y, 0) it takes exactly y_n = y cos(n q), q = 2 asin(h w/2).
TEST(Verlet, HasItsNumericalFrequency) {
  const double h = 0.4;
  Pair o(9);
  Verlet method;
  for (int n = 1; n <= 1000; ++n) {
    method.step(o.g, (n - 1) * h, h, o.force, o.pin);
    ASSERT_NEAR(o.y(), 0.1 * std::cos(n * 2 * std::asin(h * 3 / 2)), 1e-12);
  }
}

TEST(Verlet, KeepsNoForceOfAnotherState) {
  Cloth g, h;
  for (Cloth* c : {&g, &h}) shake(*c);
  Verlet kept;
  auto force = make_combined_force(GravityForce(), MassSpringForce());
  for (int n = 0; n < 5; ++n) {
    kept(g, 0.001 * n, 0.001, force);
    Verlet()(h, 0.001 * n, 0.001, force);
    if (n == 2) {  // the graph changes between two steps
      for (Cloth* c : {&g, &h}) c->remove_node(c->node(7));
    }
    if (n == 3) {  // the nodes are moved by hand
      for (Cloth* c : {&g, &h}) c->node(3).position().z += 0.01;
      kept.restart();
    }
  }
  for (unsigned i = 0; i < g.num_nodes(); ++i)
    EXPECT_LT(norm(g.node(i).position() - h.node(i).position()), 1e-15);
}

// ----------------------------------------------------------------------- Drag

// x'' = -k |x'| x' has x = ln(1 + k v t)/k. It is part of the kick, which is
// not symmetric in time then: every splitting falls to order 1; Runge-Kutta
// methods, which treat velocities as positions, keep theirs.
TEST(Drag, OfTheSquareLowersSplittings) {
  const auto error = [](const MethodEntry& m, int steps) {
    Cloth g;
    const Node a = g.add_node(Point(), {Point(2, 0, 0), 1});
    const auto drag = [](Node n, double) {
      return -0.7 * norm(n.value().vel) * n.value().vel;
    };
    const auto method = m.make();
    method->set_tolerance(no_limit);
    for (int n = 0; n < steps; ++n)
      (*method)(g, double(n) / steps, 1. / steps, drag);
    return std::abs(a.position().x - std::log(1 + 0.7 * 2) / 0.7);
  };
  for (const char* name : {"verlet", "mollified-impulse", "pefrl", "srkn11b"}) {
    const MethodEntry& m = *find_method(name);
    EXPECT_NEAR(std::log2(error(m, 400) / error(m, 800)), 1, 0.1) << name;
  }
  const MethodEntry &rk4 = table::rk4, &rkn = table::rkn64;
  EXPECT_GT(std::log2(error(rk4, 20) / error(rk4, 40)), 3.6);
  EXPECT_GT(std::log2(error(rkn, 400) / error(rkn, 800)), 0.9);
}

// Nystroem's: the acceleration is one of c^q and sums a f over the stages, f of
// the same kind; b and the last row of a have to weigh it as the integrals do.
TEST(OrderConditions, OfANystroemPair) {
  using T = Rkn64Tableau;
  struct Term {
    std::vector<double> by_stage;
    int power;      // of t
    double factor;  // it is factor t^power in the limit
  };
  std::vector<Term> terms = {{std::vector<double>(T::c.size(), 1.), 0, 1}};
  const auto weighed = [](const Term& t, const auto& weights) {
    double sum = 0;
    for (std::size_t i = 0; i < weights.size(); ++i)
      sum += weights[i] * t.by_stage[i];
    return sum;
  };
  const std::array x = {T::a[10], T::a[11], T::a[12], T::a[13], T::a[14]};
  for (std::size_t k = 0; k < terms.size(); ++k) {
    const Term t = terms[k];
    const int n = t.power + 1;
    EXPECT_NEAR(weighed(t, T::b), t.factor / n, 1e-14) << k;
    if (n < 6) {
      EXPECT_NEAR(weighed(t, x), t.factor / n / (n + 1), 1e-14) << k;
    }
    if (n < 5) {
      EXPECT_NEAR(weighed(t, T::b_low), t.factor / n, 1e-14) << k;
    }
    if (n < 4) {
      EXPECT_NEAR(weighed(t, T::x_low), t.factor / n / (n + 1), 1e-14) << k;
    }
    Term times_c = t, of_sums = t;
    for (std::size_t i = 0; i < T::c.size(); ++i) {
      times_c.by_stage[i] *= T::c[i];
      of_sums.by_stage[i] = 0;
      for (std::size_t j = 0; j < i; ++j)
        of_sums.by_stage[i] += T::a[i * (i - 1) / 2 + j] * t.by_stage[j];
    }
    times_c.power += 1;
    of_sums.power += 2, of_sums.factor /= n * (n + 1);
    if (times_c.power < 6) terms.push_back(times_c);
    if (of_sums.power < 6) terms.push_back(of_sums);
  }
  EXPECT_EQ(terms.size(), 20u);
}

// ------------------------------------------------------------ Error control

TEST(Rkn64, RefusesDragThatDiffersFromNodeToNode) {
  Cloth g;
  g.add_node(Point());
  g.add_node(Point(1, 0, 0), {Point(), 2});
  EXPECT_THROW(Rkn64()(g, 0, 1, DampingForce(0.1)), std::invalid_argument);
  const auto both = make_combined_force(
      GravityForce(), NodeDrag({0.1, 0.1 * 2 / g.node(0).value().mass}));
  Rkn64(1e-9)(g, 0, 1, both);
  const double r = 0.1 / g.node(0).value().mass, t = 1;
  const double z = -grav * (t / r - (1 - std::exp(-r * t)) / (r * r));
  for (Node n : g.nodes()) EXPECT_NEAR(n.position().z, z, 1e-9);
}

TEST(Rkn64, SaysWhenNoStepMeetsTheTolerance) {
  Cloth g;
  g.add_node(Point());
  auto jump = [](Node, double t) { return Point(t < 0.5 ? 0 : NAN); };
  EXPECT_THROW(Rkn64()(g, 0, 1, jump), StepError);
}

// ------------------------------------------------- Problems with known answers

// A membrane: the whole rim pinned, stretched by s: w^2 = 4 T/(m s L)
// [sin^2(j pi/(2(n-1))) + sin^2(k pi/(2(n-1)))], T = K L (s - 1).
TEST(Problem, MembraneSwingsInItsModes) {
  const unsigned n = 8;
  const double s = 1.25, K = 100, A = 1e-5, L = 1.0 / (n - 1);
  for (auto [j, k] : {std::pair(1, 1), {2, 1}, {3, 2}}) {
    Cloth g;
    build_cloth(g, grid_points(n), grid_quads(n), MeshSprings::plain, K);
    auto shape = [&, j = j, k = k](unsigned i) {
      return std::sin(j * pi * (i / n) / (n - 1)) *
             std::sin(k * pi * (i % n) / (n - 1));
    };
    std::vector<Node> rim;
    for (unsigned i = 0; i < n * n; ++i) {
      Node node = g.node(i);
      node.position() *= s;
      if (i / n == 0 || i / n == n - 1 || i % n == 0 || i % n == n - 1)
        rim.push_back(node);
      else
        node.position().z = A * shape(i);
    }
    PinConstraint pin(rim);
    const double m = 1.0 / (n * n), T = K * L * (s - 1);
    auto sin2 = [&](int mode) {
      return std::pow(std::sin(mode * pi / (2 * (n - 1))), 2);
    };
    const double w = std::sqrt(4 * T / (m * s * L) * (sin2(j) + sin2(k)));
    Pefrl method;
    for (int step = 0; step < 1000; ++step)
      method(g, 0.001 * step, 0.001, MassSpringForce(), pin);
    for (unsigned i : {n + 1, 3 * n + 2, 5 * n + 4})
      EXPECT_NEAR(g.node(i).position().z / A, shape(i) * std::cos(w), 1e-5);
  }
}

}  // namespace
