// mass_spring.hpp and Energy.hpp: memory of a cloth, spring formulas, energies.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <string>

#include "lab/fast/Energy.hpp"

using namespace lab;

namespace {

void load_cloth(Cloth& g, const std::string& nodes, const std::string& quads,
                MeshSprings::Kind mesh) {
  const auto points = load_points(nodes);
  build_cloth(g, points, load_quads(quads, points.size()), mesh);
}

#ifdef __SANITIZE_ADDRESS__
// The sanitizer's; g++ does not install its header everywhere.
extern "C" int __sanitizer_install_malloc_and_free_hooks(
    void (*)(const volatile void*, std::size_t),
    void (*)(const volatile void*));
extern "C" std::size_t __sanitizer_get_allocated_size(const volatile void*);

// What this program has on the heap, and the most that it had [bytes].
std::size_t in_use = 0, most_in_use = 0;

// 400 bytes a node are what lab/fast/README.md promises, of which the graph,
// with both ends of 4 springs a node, needs 228.
TEST(LoadCloth, NeedsAtMost400BytesANodeWithDiagonals) {
  ASSERT_TRUE(__sanitizer_install_malloc_and_free_hooks(
      [](const volatile void*, std::size_t size) {
        in_use += size;
        most_in_use = std::max(most_in_use, in_use);
      },
      [](const volatile void* p) {
        if (p) in_use -= __sanitizer_get_allocated_size(p);
      }));
  Cloth g;
  const std::size_t before = most_in_use = in_use;
  load_cloth(g, "data/grid3.nodes", "data/grid3.tets", MeshSprings::diagonals);
  EXPECT_LT(most_in_use - before, 400 * g.num_nodes());
  EXPECT_LT(in_use - before, 300 * g.num_nodes());
  EXPECT_GT(in_use - before, 220 * g.num_nodes()) << "the count is wrong";
}
#endif

TEST(LoadCloth, LeavesTheClothAsItWasOnAnError) {
  Cloth g;
  EXPECT_THROW(
      load_cloth(g, "data/grid1.nodes", "data/none", MeshSprings::plain),
      InputError);
  EXPECT_THROW(
      load_cloth(g, "data/grid0.nodes", "data/grid1.tets", MeshSprings::plain),
      InputError);
  EXPECT_EQ(g.num_nodes(), 0u);
}

// Hooke: 100 N/m stretched by 0.5 m pulls with 50 N and holds 12.5 J.
TEST(Spring, FollowsHookesLaw) {
  EdgeData s{100, 1};
  EXPECT_EQ(spring_force(Point(1.5, 0, 0), s), Point(50, 0, 0));
  EXPECT_EQ(spring_force(Point(0, -0.5, 0), s), Point(0, 50, 0));
  EXPECT_EQ(spring_force(Point(0, 0, 1), s), Point());
  EXPECT_EQ(spring_force(Point(), s), Point());
  EXPECT_EQ(spring_energy(1.5, s), 12.5);
  EXPECT_EQ(spring_energy(0.5, s), 12.5);
}

TEST(Energies, AreThoseOfTwoMassesOnASpring) {
  Cloth g;
  Node a = g.add_node(Point(0, 0, 2), {Point(3, 0, 4), 2});
  Node b = g.add_node(Point(0, 0, 5), {Point(0, 1, 0), 4});
  g.add_edge(a, b, {10, 1});
  EXPECT_DOUBLE_EQ(kinetic_energy(g), 0.5 * 2 * 25 + 0.5 * 4 * 1);
  EXPECT_DOUBLE_EQ(gravitational_energy(g, 10), 2 * 10 * 2 + 4 * 10 * 5);
  EXPECT_DOUBLE_EQ(elastic_energy(g), 0.5 * 10 * 4);
  EXPECT_DOUBLE_EQ(center_of_mass(g).z, (2 * 2 + 4 * 5) / 6.0);
}

TEST(Energies, DoNotCountWhatWasRemoved) {
  Cloth g;
  build_cloth(g, grid_points(5), grid_quads(5), MeshSprings::diagonals);
  for (Node n : g.nodes()) {
    n.position() *= 1.1;
    n.position().z = 1;
    n.value().vel = Point(1, 0, 0);
  }
  for (int k = 0; k < 10; ++k) g.remove_node(g.node(7));
  double kinetic = 0, elastic = 0, height = 0;
  for (Node n : g.nodes()) {
    kinetic += 0.5 * n.value().mass * normSq(n.value().vel);
    height += n.value().mass * grav * n.position().z;
  }
  for (Edge e : g.edges()) elastic += spring_energy(e.length(), e.value());
  EXPECT_NEAR(kinetic_energy(g), kinetic, 1e-14);
  EXPECT_NEAR(elastic_energy(g), elastic, 1e-14);
  EXPECT_NEAR(gravitational_energy(g), height, 1e-14);
  EXPECT_NEAR(total_mass(g), 15.0 / 25, 1e-15);
  Cloth none;
  EXPECT_EQ(center_of_mass(none), Point());
}

}  // namespace
