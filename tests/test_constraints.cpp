// What constraints of mass_spring.hpp promise beyond the assignment, to which
// course/tests holds them.
#include <gtest/gtest.h>

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

TEST(SphereConstraint, SendsANodeAtItsCenterToTheTop) {
  Cloth g;
  Node n = g.add_node(Point(0.5, 0.5, -0.5), {Point(1, 2, 3), 1});
  SphereConstraint()(g, 0);
  EXPECT_EQ(n.position(), Point(0.5, 0.5, -0.35));
  EXPECT_EQ(n.value().vel, Point(1, 2, 0));
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
