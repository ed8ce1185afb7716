// Spectrum.hpp, StepLimit.hpp and Guard.hpp: the estimates of the highest
// frequency against independent ones, the limits of the methods from both
// sides, and the guard, which stops what diverges and lets pass what does not.
#include <gtest/gtest.h>

#include <limits>
#include <numbers>
#include <random>

#include <Spectra/SymEigsSolver.h>
#include <Eigen/Dense>

#include "lab/fast/Energy.hpp"
#include "lab/fast/GraphArrays.hpp"
#include "lab/methods/Methods.hpp"
#include "lab/methods/RungeKutta.hpp"
#include "lab/methods/Splitting.hpp"
#include "lab/stability/Diagnosis.hpp"
#include "lab/stability/Guard.hpp"
#include "tests/Says.hpp"

using namespace lab;

namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

void build_grid(Cloth& g, unsigned side) {
  build_cloth(g, grid_points(side), grid_quads(side), MeshSprings::diagonals);
}

// ------------------------------------------------------------------ Estimates

const MassSpringForce springs;
const ZeroConstraint free_cloth;

/** M^-1/2 H M^-1/2 as a full matrix, of the nodes that move; H the stiffness
 * now, or K in all directions for every spring. */
Eigen::MatrixXd full_matrix(const Cloth& g, const ConstraintPlan& constraint,
                            bool any_shape) {
  std::vector<double> scale(arrays(g).node_slots(), 0);
  for (Node n : g.nodes()) scale[n.id()] = 1 / std::sqrt(n.value().mass);
  constraint.each_held(g, [&](Node n) { scale[n.id()] = 0; });
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(3 * arrays(g).node_slots(),
                                            3 * arrays(g).node_slots());
  for (Edge e : g.edges()) {
    const unsigned i = 3 * e.node1().id(), j = 3 * e.node2().id();
    const Point u = e.node2().position() - e.node1().position();
    const double l = norm(u), K = e.value().K;
    const Eigen::Vector3d n = Eigen::Vector3d(u.x, u.y, u.z) / l;
    Eigen::Matrix3d B = K * Eigen::Matrix3d::Identity();
    if (!any_shape)
      B = K * n * n.transpose() +
          K * (1 - e.value().L / l) *
              (Eigen::Matrix3d::Identity() - n * n.transpose());
    const double a = scale[i / 3], b = scale[j / 3];
    A.block<3, 3>(i, i) += a * a * B;
    A.block<3, 3>(j, j) += b * b * B;
    A.block<3, 3>(i, j) -= a * b * B;
    A.block<3, 3>(j, i) -= a * b * B;
  }
  return A;
}
double root_of_largest(const Eigen::MatrixXd& A) {
  Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> all(A, Eigen::EigenvaluesOnly);
  return std::sqrt(std::max(0.0, all.eigenvalues().maxCoeff()));
}

/** Nodes at random places, masses and K over two decades, some springs, in one
 * piece or in several, lone nodes too. */
struct RandomCloth {
  Cloth g;
  std::vector<Node> held;

  explicit RandomCloth(unsigned seed) : random_(seed) {
    const unsigned n = 3 + random_() % 40;
    for (unsigned i = 0; i < n; ++i)
      g.add_node(Point(uniform(), uniform(), uniform()),
                 {Point(), std::pow(10, 2 * uniform())});
    for (unsigned k = random_() % (3 * n); k > 0; --k) {
      Node a = g.node(random_() % n), b = g.node(random_() % n);
      if (a == b) continue;
      g.add_edge(a, b).value() = {std::pow(10, 1 + 2 * uniform()),
                                  2 * uniform()};
    }
    for (unsigned k = random_() % 4; k > 0; --k)
      held.push_back(g.node(random_() % n));
  }
  double uniform() { return double(random_()) / double(random_.max()); }

 private:
  std::mt19937 random_;
};

TEST(Omega, AgreesWithAllEigenvaluesOfRandomCloths) {
  for (unsigned seed = 0; seed < 60; ++seed) {
    RandomCloth r(seed);
    PinConstraint pin(r.held);
    const double sharp = root_of_largest(full_matrix(r.g, pin, false));
    const double safe = root_of_largest(full_matrix(r.g, pin, true));
    SharpOmega omega;
    EXPECT_NEAR(omega(r.g, springs, pin, 200), sharp, 1e-4 * sharp + 1e-9);
    const double found = omega_safe(r.g, springs, pin);
    EXPECT_GE(found, safe * (1 - 1e-9)) << seed;
    EXPECT_LE(found, safe * 1.001 + 1e-9) << seed;
  }
}

// Also when springs are compressed to nothing or stretched without bound, and
// when something is removed: the safe estimate of the start is above.
TEST(Omega, SafeHoldsInEveryShapeAndAfterRemovals) {
  for (unsigned seed = 0; seed < 40; ++seed) {
    RandomCloth r(seed);
    PinConstraint pin(r.held);
    const double safe = omega_safe(r.g, springs, pin);
    for (double stretch : {0.01, 0.3, 1.0, 3.0, 100.0}) {
      for (Node n : r.g.nodes())
        n.position() = stretch * Point(r.uniform(), r.uniform(), r.uniform());
      if (r.g.num_edges() > 2) r.g.remove_edge(r.g.edge(0));
      if (r.g.num_nodes() > 2) r.g.remove_node(r.g.node(1));
      EXPECT_LE(root_of_largest(full_matrix(r.g, pin, false)),
                safe * (1 + 1e-12))
          << seed;
    }
  }
}

// It is known for chains and for large grids; Spectra finds it, too.
TEST(Omega, IsThatOfChainsAndGrids) {
  Cloth chain;
  for (int i = 0; i < 22; ++i) chain.add_node(Point(i, 0, 0), {Point(), 0.05});
  for (unsigned i = 0; i < 21; ++i)
    chain.add_edge(chain.node(i), chain.node(i + 1), {100, 0.5});
  const std::array walls = {chain.node(0), chain.node(21)};
  PinConstraint pin(walls);
  const double exact =
      2 * std::sqrt(100 / 0.05) * std::cos(std::numbers::pi / 42);
  EXPECT_NEAR(SharpOmega()(chain, springs, pin, 100), exact, 1e-6 * exact);
  EXPECT_NEAR(omega_safe(chain, springs, pin), exact, 1e-3 * exact);

  for (auto [mesh, most] :
       {std::pair(MeshSprings::plain, 8.0), {MeshSprings::diagonals, 12.0}}) {
    Cloth g;
    build_cloth(g, grid_points(30), grid_quads(30), mesh);
    PinConstraint corners_held(g);
    const double bound = std::sqrt(most * 100 * 900);
    const double safe = omega_safe(g, springs, corners_held);
    EXPECT_LT(safe, bound);
    EXPECT_GT(safe, 0.99 * bound);
    // at the flat start: 4 K N and 8 K N
    EXPECT_NEAR(SharpOmega()(g, springs, corners_held, 100),
                std::sqrt((most - 4) * 100 * 900), 0.01 * bound);

    struct Operator {
      using Scalar = double;
      Eigen::MatrixXd A;
      Eigen::Index rows() const { return A.rows(); }
      Eigen::Index cols() const { return A.cols(); }
      void perform_op(const double* x, double* y) const {
        Eigen::Map<Eigen::VectorXd>(y, rows()) =
            A * Eigen::Map<const Eigen::VectorXd>(x, rows());
      }
    };
    Cloth small;
    build_cloth(small, grid_points(9), grid_quads(9), mesh);
    for (Node n : small.nodes())
      n.position().z = 0.1 * std::sin(7 * n.position().x + 3 * n.position().y);
    PinConstraint held(small);
    Operator op{full_matrix(small, held, false)};
    Spectra::SymEigsSolver<Operator> solver(op, 1, 12);
    solver.init();
    ASSERT_EQ(solver.compute(Spectra::SortRule::LargestAlge), 1);
    const double spectra = std::sqrt(solver.eigenvalues()[0]);
    EXPECT_NEAR(SharpOmega()(small, springs, held, 100), spectra,
                1e-5 * spectra);
    EXPECT_NEAR(SharpOmega()(small, springs, held), spectra, 0.02 * spectra);
  }
}

TEST(Omega, IsZeroWhereNothingSwings) {
  Cloth g;
  auto all_zero = [&g](const ConstraintPlan& c) {
    return omega_safe(g, springs, c) == 0 && SharpOmega()(g, springs, c) == 0;
  };
  EXPECT_TRUE(all_zero(free_cloth));  // no nodes
  Node a = g.add_node(Point(0, 0, 0)), b = g.add_node(Point(1, 0, 0));
  EXPECT_TRUE(all_zero(free_cloth));  // no springs
  g.add_edge(a, b, {0, 1});
  EXPECT_TRUE(all_zero(free_cloth));  // K = 0
  g.edge(0).value().K = 50;
  EXPECT_NEAR(omega_safe(g, springs, free_cloth), 10, 1e-9);  // sqrt(2 K/m)
  EXPECT_NEAR(SharpOmega()(g, springs, free_cloth), 10, 1e-9);
  const std::array ends = {a, b};
  EXPECT_TRUE(all_zero(PinConstraint(ends)));  // all held
}

// A force without a stiffness of its own stands for the cloth's edges.
TEST(Omega, TakesTheEdgesOfAForceThatDoesNotKnowItsStiffness) {
  Cloth g;
  build_grid(g, 5);
  PinConstraint pin(g);
  auto own = make_combined_force(Problem1Force());
  EXPECT_EQ(omega_safe(g, own, pin), omega_safe(g, springs, pin));
  EXPECT_EQ(omega_safe(g, ZeroForce(), pin), 0);
}

// --------------------------------------------------------------------- Limits

/** A method whose step is not cut into smaller ones. */
std::unique_ptr<Method> fixed_step(const MethodEntry& m) {
  auto method = m.make();
  method->set_tolerance(no_limit);
  return method;
}

// Declared limits to a thousandth, from both sides, and a run of an oscillator
// that shows it. Inside, the weak gaps of the Blanes-Moan methods are known.
TEST(StepLimit, OfAnOscillatorHoldsToAThousandth) {
  for (const MethodEntry& m : methods) {
    if (m.info.limit == no_limit || m.info.limit == 0) continue;
    auto method = fixed_step(m);
    EXPECT_LE(amplification(*method, 0.999 * m.info.limit, 1), 1 + 1e-9)
        << m.info.name;
    EXPECT_GT(amplification(*method, 1.001 * m.info.limit, 1), 1 + 1e-7)
        << m.info.name;
    if (m.info.adaptive) continue;
    const double w = 30, limit = step_limit(m, w);
    EXPECT_DOUBLE_EQ(limit, m.info.limit / w);
    for (double share : {0.999, 1.001}) {
      Cloth g;
      g.add_node(Point());
      Node mass = g.add_node(Point(1, 0, 0));
      g.add_edge(g.node(0), mass, {w * w, 0});
      const std::array wall = {g.node(0)};
      PinConstraint pin(wall);
      auto made = m.make();
      double farthest = 0;
      for (int n = 0; n < 5000; ++n) {
        made->step(g, n * share * limit, share * limit, springs, pin);
        farthest = std::max(farthest, norm(mass.position()));
      }
      if (share < 1)
        EXPECT_LT(farthest, 100) << m.info.name;
      else
        EXPECT_GT(farthest, 1e9) << m.info.name;
    }
  }
}

TEST(StepLimit, WithDrag) {
  const double w = 20, gamma = 3;
  auto limit = [&](const char* name, double drag) {
    return step_limit(*find_method(name), w, drag);
  };
  // (h w)^2 + 2 h gamma < 4, and h < gamma/w^2
  EXPECT_NEAR(limit("symplectic-euler", gamma),
              (std::sqrt(gamma * gamma + 4 * w * w) - gamma) / (w * w), 1e-9);
  EXPECT_NEAR(limit("forward-euler", gamma), gamma / (w * w), 1e-9);
  EXPECT_EQ(limit("forward-euler", 0), 0);
  EXPECT_LE(limit("rk4", gamma), Rk4::info.limit / w);
  EXPECT_EQ(limit("verlet", gamma), limit("verlet", 0));
  // steps backwards in time undo drag: a little less, or nothing
  for (const char* exact : {"pefrl", "srkn11b"}) {
    EXPECT_LE(limit(exact, gamma), limit(exact, 0)) << exact;
    EXPECT_GT(limit(exact, gamma), 0.99 * limit(exact, 0)) << exact;
  }
  for (const MethodEntry& m : methods) {
    if (m.info.limit != no_limit && !m.info.adaptive) continue;
    EXPECT_EQ(step_limit(m, w, gamma), no_limit) << m.info.name;
  }
  EXPECT_EQ(step_limit(table::verlet, 0), no_limit);
}

TEST(StepLimit, TakesTheLightestNodesDrag) {
  Cloth g;
  EXPECT_EQ(largest_gamma(g, 0), 0);
  g.add_node(Point(), {Point(), 4});
  g.add_node(Point(), {Point(), 0.5});
  EXPECT_DOUBLE_EQ(largest_gamma(g, 3), 6);
}

// ---------------------------------------------------------------------- Guard

TEST(DivergenceGuard, StopsOnEveryNumberThatIsNotFinite) {
  for (double bad : {nan, std::numeric_limits<double>::infinity()}) {
    Cloth g;
    build_grid(g, 3);
    DivergenceGuard guard(g, grav, 0.01);
    EXPECT_TRUE(guard.accept(g));
    g.node(4).value().vel.x = bad;
    EXPECT_FALSE(guard.accept(g));
    EXPECT_TRUE(
        has(WorstPlace(g).text(), "node 4 has a position or a velocity that"));
  }
}

TEST(DivergenceGuard, StopsAClothThatIsStretchedBeyondItsEnergy) {
  Cloth g;
  build_grid(g, 5);
  DivergenceGuard guard(g, grav, 0.01);
  for (int n = 0; n < 20; ++n) EXPECT_TRUE(guard.accept(g));
  for (Node n : g.nodes()) n.position() *= 3;
  int accepted = 0;
  while (accepted < 100 && guard.accept(g)) ++accepted;
  EXPECT_LT(accepted, 10);
}

TEST(DivergenceGuard, RestoresTheLastGoodState) {
  Cloth g;
  build_grid(g, 3);
  g.node(2).value().vel = Point(3, 0, 0);
  DivergenceGuard guard(g, grav, 0.01);
  const Point moved = g.node(1).position() + Point(0, 0.02, 0);
  g.node(1).position() = moved;
  g.node(1).value().vel = Point(1, 0, 0);
  ASSERT_TRUE(guard.accept(g));
  g.remove_node(g.node(5));
  for (Node n : g.nodes()) n.position() = n.value().vel = Point(nan);
  ASSERT_FALSE(guard.accept(g));
  guard.restore(g);
  EXPECT_EQ(g.num_nodes(), 8u);
  EXPECT_EQ(g.node(1).position(), moved);
  EXPECT_EQ(g.node(1).value().vel, Point(1, 0, 0));
  EXPECT_EQ(g.node(0).position(), Point(0, 0, 0));
  EXPECT_TRUE(guard.accept(g));
}

TEST(DivergenceGuard, NamesTheFastestNodeAndItsLongestSpring) {
  Cloth g;
  Node a = g.add_node(Point()), b = g.add_node(Point(0.5, 0, 0));
  Node c = g.add_node(Point(0, 0, 8), {Point(3, 4, 0), 1});
  g.add_edge(a, b, {100, 0.5});
  g.add_edge(c, b, {100, 2});
  g.add_edge(c, a, {100, 9});
  EXPECT_EQ(WorstPlace(g).text(),
            "node 2 moves at 5 m/s, its spring to node 1 is 4.01 times its "
            "rest length of 2 m");
  g.clear();
  EXPECT_EQ(WorstPlace(g).text(), "no node is left");
}

}  // namespace
