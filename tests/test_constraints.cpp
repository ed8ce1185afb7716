// The constraints of mass_spring.hpp: the post-condition of each, and that
// twice is once.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <typeinfo>
#include <utility>
#include <vector>

#include "lab/fast/GraphArrays.hpp"
#include "tests/ScatteredCloth.hpp"

namespace {

class Scattered : public ScatteredCloth {
 protected:
  void expect_twice_is_once(const ZeroConstraint& c) {
    c(g, 0);
    auto once = state();
    c(g, 0);
    auto twice = state();
    ASSERT_EQ(once.size(), twice.size());
    for (std::size_t k = 0; k < once.size(); ++k)
      EXPECT_LT(norm(once[k] - twice[k]), 1e-15);
  }
};

TEST_F(Scattered, TwiceIsOnce) {
  expect_twice_is_once(PlaneConstraint());
  expect_twice_is_once(SphereConstraint());
  expect_twice_is_once(TearConstraint());
  expect_twice_is_once(PinConstraint(std::vector<Node>{g.node(1)}));
  expect_twice_is_once(ZeroConstraint());
}

TEST_F(Scattered, PlaneStopsWhatIsBelowItAndNothingElse) {
  Cloth before = g;
  PlaneConstraint(-0.6)(g, 0);
  int stopped = 0;
  for (unsigned i = 0; i < g.num_nodes(); ++i) {
    Node was = before.node(i), is = g.node(i);
    bool below = was.position().z < -0.6;
    stopped += below;
    EXPECT_EQ(is.position().x, was.position().x);
    EXPECT_EQ(is.position().y, was.position().y);
    EXPECT_EQ(is.position().z, below ? -0.6 : was.position().z);
    EXPECT_EQ(is.value().vel.x, was.value().vel.x);
    EXPECT_EQ(is.value().vel.z, below ? 0 : was.value().vel.z);
  }
  EXPECT_GT(stopped, 5);
  EXPECT_LT(stopped, 60);
}

TEST(PlaneConstraint, LeavesANodeThatLiesOnIt) {
  Cloth g;
  Node n = g.add_node(Point(0, 0, -0.75), {Point(0, 0, -1), 1});
  PlaneConstraint()(g, 0);
  EXPECT_EQ(n.value().vel, Point(0, 0, -1));
  n.position().z = std::nextafter(-0.75, -1);
  PlaneConstraint()(g, 0);
  EXPECT_EQ(n.position().z, -0.75);
  EXPECT_EQ(n.value().vel, Point());
}

TEST_F(Scattered, SphereMovesToTheNearestPointAndTakesTheNormalVelocity) {
  Cloth before = g;
  SphereConstraint()(g, 0);
  int moved = 0;
  for (unsigned i = 0; i < g.num_nodes(); ++i) {
    Node was = before.node(i), is = g.node(i);
    if (norm(was.position() - ball.center) >= ball.radius) {
      EXPECT_EQ(is.position(), was.position());
      EXPECT_EQ(is.value().vel, was.value().vel);
      continue;
    }
    ++moved;
    Point out = is.position() - ball.center;
    EXPECT_NEAR(norm(out), ball.radius, 1e-16);
    // The old place lies on the same ray, and only the normal part is gone.
    EXPECT_NEAR(norm(cross(out, was.position() - ball.center)), 0, 1e-16);
    EXPECT_GT(dot(out, was.position() - ball.center), 0);
    EXPECT_NEAR(dot(is.value().vel, out), 0, 1e-16);
    EXPECT_NEAR(norm(cross(is.value().vel - was.value().vel, out)), 0, 1e-15);
  }
  EXPECT_GT(moved, 5);
  EXPECT_LT(moved, 60);
}

TEST(SphereConstraint, SendsANodeAtItsCenterToTheTop) {
  Cloth g;
  Node n = g.add_node(Point(0.5, 0.5, -0.5), {Point(1, 2, 3), 1});
  SphereConstraint()(g, 0);
  EXPECT_EQ(n.position(), Point(0.5, 0.5, -0.35));
  EXPECT_EQ(n.value().vel, Point(1, 2, 0));
}

TEST_F(Scattered, TearRemovesExactlyTheNodesInside) {
  std::vector<Node> inside, outside;
  for (Node n : g.nodes())
    (norm(n.position() - ball.center) < ball.radius ? inside : outside)
        .push_back(n);
  ASSERT_GT(inside.size(), 5u);
  TearConstraint()(g, 0);
  g.check_invariants();
  EXPECT_EQ(g.num_nodes(), outside.size());
  for (Node n : inside) EXPECT_FALSE(g.has_node(n));
  for (Node n : outside) EXPECT_TRUE(g.has_node(n));
}

TEST(TearConstraint, KeepsANodeOnTheSurfaceAndCanTakeAll) {
  Cloth g;
  Node on = g.add_node(Point(0.5, 0.5, 0));
  Node in = g.add_node(Point(0.5, 0.5, -0.01));
  TearConstraint({Point(0.5, 0.5, -0.5), 0.5})(g, 0);
  EXPECT_TRUE(g.has_node(on));
  EXPECT_FALSE(g.has_node(in));
  TearConstraint({Point(), 10})(g, 0);
  EXPECT_EQ(g.num_nodes(), 0u);
}

TEST(PinConstraint, HoldsTheRightNodesWhenIndicesHaveMoved) {
  Cloth g;
  build_cloth(g, grid_points(5), grid_quads(5), MeshSprings::plain);
  PinConstraint pin(g);
  Node first = g.node(0), second = g.node(20);
  for (unsigned i : {1u, 2u, 3u, 5u, 8u}) g.remove_node(g.node(i));
  g.remove_edge(g.edge(0));
  arrays(g).reindex();
  ASSERT_NE(second.index(), 20u);
  for (Node n : g.nodes()) {
    n.position() += Point(0, 0, -1);
    n.value().vel = Point(1);
  }
  pin(g, 0);
  EXPECT_EQ(first.position(), Point(0, 0, 0));
  EXPECT_EQ(second.position(), Point(1, 0, 0));
  for (Node n : g.nodes()) {
    const bool held = n == first || n == second;
    EXPECT_EQ(n.position().z, held ? 0 : -1);
    EXPECT_EQ(n.value().vel, held ? Point() : Point(1));
  }
}

TEST(PinConstraint, GoesOnWithoutAPinnedNodeThatWasRemoved) {
  Cloth g;
  build_cloth(g, grid_points(5), grid_quads(5), MeshSprings::plain);
  PinConstraint pin(g);
  Node second = g.node(20);
  g.remove_node(g.node(0));
  Node other = g.add_node(Point(9, 9, 9));  // may take the slot of the old one
  second.position().z = -1;
  pin(g, 0);
  EXPECT_EQ(other.position(), Point(9, 9, 9));
  EXPECT_EQ(second.position(), Point(1, 0, 0));
}

TEST(CombinedConstraints, RunInTheirOrderAndTakeFunctions) {
  Cloth g;
  Node n = g.add_node(Point(0, 0, -2));
  auto lift = [](Cloth& cloth, double t) {
    for (Node m : cloth.nodes()) m.position().z += t;
  };
  make_combined_constraints(PlaneConstraint(-1), lift)(g, 0.25);
  EXPECT_EQ(n.position().z, -0.75);
  make_combined_constraints(lift, PlaneConstraint(-0.5))(g, -5);
  EXPECT_EQ(n.position().z, -0.5);
  make_combined_constraints()(g, 0);
  EXPECT_EQ(n.position().z, -0.5);
}

// ------------------------------------------ children with a call of their own

/** Constraint k raises all nodes by k: so one sees which of them were called.
 */
void raise(Cloth& g, double by) {
  for (Node n : g.nodes()) n.position().z += by;
}
struct NotConst : ZeroConstraint {
  void operator()(Cloth& g, double) { raise(g, 1); }
};
struct Template : ZeroConstraint {
  template <typename G>
  void operator()(G& g, double) const {
    raise(g, 2);
  }
};
struct OfAPlane : PlaneConstraint {
  template <typename G>
  int operator()(G& g, double) {
    return raise(g, 4), 0;
  }
};
struct Overrides : PlaneConstraint {
  void operator()(Cloth& g, double) const override { raise(g, 8); }
};
struct Inherits : Overrides {};

template <typename C>
double height_after(C&& c) {
  Cloth g;
  const Node n = g.add_node(Point());
  c(g, 0.0);
  return n.position().z;
}
/** After a step that is given the constraint itself. */
template <typename C>
double height_after_a_step(C&& c) {
  return height_after([&c](Cloth& g, double t) {
    symp_euler_step(g, t, 0.1, ZeroForce(), std::forward<C>(c));
  });
}

template <typename C>
void expect_called(double k) {
  EXPECT_EQ(height_after(make_combined_constraints(C())), k);
  EXPECT_EQ(height_after_a_step(C()), k);
  C c;
  EXPECT_EQ(height_after_a_step(c), k);
  EXPECT_EQ(height_after_a_step(make_combined_constraints(c)), k);
}

TEST(OwnConstraints, AreCalledByTheirOwnCall) {
  expect_called<NotConst>(1);
  expect_called<Template>(2);
  expect_called<OfAPlane>(4);
  expect_called<Overrides>(8);
  expect_called<Inherits>(8);
  expect_called<ZeroConstraint>(0);
  EXPECT_EQ(height_after(make_combined_constraints(
                NotConst(), make_combined_constraints(Template(), OfAPlane()),
                Inherits())),
            15);
}

TEST(CombinedConstraints, SharesItsParts) {
  const auto eight = std::make_shared<Overrides>();
  EXPECT_EQ(height_after(CombinedConstraints({eight, eight})), 16);
}

}  // namespace
