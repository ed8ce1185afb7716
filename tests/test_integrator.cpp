// symp_euler_step() against exact solutions of the difference equations. The
// method symplectic-euler is held to it by test_plain_methods and test_stages.
#include <gtest/gtest.h>

#include "lab/fast/Energy.hpp"
#include "mass_spring.hpp"
#include "tests/Momentum.hpp"

using namespace lab;

namespace {

// From rest: v_k = -g h k and z_n = z_0 - g h^2 n (n - 1)/2, exactly.
TEST(SympEulerStep, FallsAlongTheDiscreteParabola) {
  Cloth g;
  Node a = g.add_node(Point(2, 3, 5), {Point(1, 0, 0), 4});
  const double h = 0.01;
  double t = 0;
  for (int n = 1; n <= 100; ++n) {
    t = symp_euler_step(g, t, h, GravityForce());
    EXPECT_NEAR(a.position().z, 5 - 9.81 * h * h * n * (n - 1) / 2, 1e-13);
    EXPECT_NEAR(a.position().x, 2 + h * n, 1e-13);
    EXPECT_NEAR(a.value().vel.z, -9.81 * h * n, 1e-13);
  }
  EXPECT_NEAR(t, 1, 1e-14);
}

// One mass on a spring: y_n+1 - 2 y_n + y_n-1 = -(h w)^2 y_n with y_0 = y_1,
// so y_n = y_0 cos((n - 1/2) q)/cos(q/2), cos q = 1 - (h w)^2/2.
TEST(SympEulerStep, SwingsByTheExactRecurrence) {
  Cloth g;
  Node wall = g.add_node(Point(0, 0, 0)), a = g.add_node(Point(1.1, 0, 0));
  a.value().mass = 0.5;
  g.add_edge(wall, a, {50, 1});
  PinConstraint pin(g);
  const double h = 0.05, hw = h * std::sqrt(50 / 0.5);
  const double q = std::acos(1 - hw * hw / 2);
  double t = 0;
  for (int n = 1; n <= 1000; ++n) {
    t = symp_euler_step(g, t, h, MassSpringForce(), pin);
    EXPECT_NEAR(a.position().x - 1,
                0.1 * std::cos((n - 0.5) * q) / std::cos(q / 2), 1e-12);
    EXPECT_EQ(a.position().y, 0);
  }
}

// Drag as a force: v_n = v_0 (1 - h c/m)^n.
TEST(SympEulerStep, SlowsDownByTheExactRecurrence) {
  Cloth g;
  Node a = g.add_node(Point(2, 0, 0), {Point(1, 0, 0), 2});
  for (int n = 0; n < 50; ++n) symp_euler_step(g, 0, 0.1, DampingForce(0.6));
  EXPECT_NEAR(a.value().vel.x, std::pow(1 - 0.1 * 0.6 / 2, 50), 1e-14);
}

TEST(SympEulerStep, ConservesMomentumAndAngularMomentum) {
  Cloth g;
  build_cloth(g, grid_points(6), grid_quads(6), MeshSprings::diagonals);
  stir(g);
  const Point linear = momentum(g), angular = angular_momentum(g);
  for (int n = 0; n < 1000; ++n)
    symp_euler_step(g, 0, 0.002, MassSpringForce(), ZeroConstraint());
  EXPECT_LT(norm(momentum(g) - linear), 1e-13);
  EXPECT_LT(norm(angular_momentum(g) - angular), 1e-13);
  EXPECT_GT(elastic_energy(g), 0.01);  // it did move
}

// A constraint sees the new positions, and the force what it left of them.
TEST(SympEulerStep, ConstrainsAfterPositionsAndBeforeForces) {
  Cloth g;
  struct Watch : ZeroConstraint {
    void operator()(Cloth& g, double t) const override {
      EXPECT_EQ(t, 7);
      EXPECT_EQ(g.node(0).position(), Point(1, 1, 1));
      g.node(0).position() = Point(2, 2, 2);
      EXPECT_EQ(g.node(0).value().vel, Point(2));
    }
  };
  struct See : ZeroForce {
    Point operator()(Node n, double t) const override {
      EXPECT_EQ(t, 7);
      EXPECT_EQ(n.position(), Point(2, 2, 2));
      return Point(0, 0, 4);
    }
  };
  Node a = g.add_node(Point(0, 0, 0), {Point(2), 8});
  EXPECT_EQ(symp_euler_step(g, 7, 0.5, See(), Watch()), 7.5);
  EXPECT_EQ(a.value().vel, Point(2, 2, 2.25));
}

TEST(SympEulerStep, TakesLambdasAndGraphsOfAnyKind) {
  struct Mass {
    Point vel;
    double mass = 2;
    int color = 0;
  };
  Graph<Mass, int> g;
  auto a = g.add_node(Point(1));
  auto force = [](auto n, double t) { return Point(n.value().mass * t); };
  double t = symp_euler_step(g, 3, 0.5, force);
  symp_euler_step(g, t, 0.5, force, [](auto& h, double now) {
    EXPECT_EQ(now, 3.5);
    h.node(0).value().color = 1;
  });
  EXPECT_EQ(a.value().vel, Point(0.5 * 3 + 0.5 * 3.5));
  EXPECT_EQ(a.position(), Point(1 + 0.5 * 1.5));
  EXPECT_EQ(a.value().color, 1);
}

}  // namespace
