// Compose.hpp: a cloth, forces and constraints have what a model names, and
// nothing else; a finer grid of a material is the same cloth.
#include <gtest/gtest.h>

#include "lab/fast/Energy.hpp"
#include "lab/methods/Methods.hpp"
#include "lab/scenes/Measure.hpp"
#include "lab/scenes/Words.hpp"
#include "lab/stepping/Trial.hpp"
#include "tests/Built.hpp"
#include "tests/ReadParts.hpp"
#include "tests/Says.hpp"

using namespace lab;

namespace {

/** The spring between two nodes, by their indices. */
EdgeData spring(const Cloth& g, unsigned i, unsigned j) {
  for (Edge e : g.node(i).edges())
    if (e.node2().index() == j) return e.value();
  ADD_FAILURE() << "no edge from " << i << " to " << j;
  return {};
}

// ------------------------------------------------------------------- The cloth

TEST(Compose, EdgesAreTheOnesNamed) {
  const unsigned n = 5, m = 4;
  const auto count = [&](const std::string& edges) {
    Model model = with_sheet("nodes 5 4");
    model.edges = read_edges(edges);
    Cloth g = built(model);
    return g.num_edges();
  };
  const unsigned sides = n * (m - 1) + m * (n - 1);
  const unsigned diagonals = 2 * (n - 1) * (m - 1);
  const unsigned bend = n * (m - 2) + m * (n - 2);
  EXPECT_EQ(count("sides"), sides);
  EXPECT_EQ(count("sides diagonals"), sides + diagonals);
  EXPECT_EQ(count("sides bend"), sides + bend);
  EXPECT_EQ(count("sides diagonals bend"), sides + diagonals + bend);
}

TEST(Compose, BendSpringsLieAcrossTwoSidesInALine) {
  Model m = with_sheet("u 2 0 0 nodes 4 5");
  m.edges = read_edges("sides bend");
  Cloth g = built(m);
  for (Edge e : g.edges()) {
    const Point way = e.node2().position() - e.node1().position();
    EXPECT_TRUE(way.x == 0 || way.y == 0);
    EXPECT_EQ(e.value().L, norm(way));
  }
  EXPECT_NEAR(spring(g, 0, 2).L, 0.5, 1e-15);      // along v
  EXPECT_NEAR(spring(g, 0, 10).L, 4 / 3., 1e-15);  // along u
}

// ---------------------------------------------------------------------- A net

TEST(Compose, ASheetOfOneRowIsARope) {
  for (const char* nodes : {"nodes 75 1", "nodes 1 75"}) {
    Cloth g = built(with_sheet(nodes));
    EXPECT_EQ(g.num_nodes(), 75u);
    ASSERT_EQ(g.num_edges(), 74u);
    EXPECT_NEAR(spring(g, 73, 74).L, 1 / 74., 1e-15);
  }
  Cloth mass = built(with_sheet("nodes 1 1"));
  EXPECT_EQ(mass.num_nodes(), 1u);
}

/** Two triangles of the unit square, 0-1-2 and 1-3-2, as of a file. */
Net two_triangles() {
  return {grid_points(2), {face_around(0, 1, 2), face_around(1, 3, 2)}};
}

TEST(Compose, ATriangleHasItsThreeEdgesAndAThirdOfItsMassAtEachNode) {
  Model m;
  m.material.density = 0.6;
  Cloth g = built(m, two_triangles());
  EXPECT_EQ(g.num_edges(), 5u);
  EXPECT_NEAR(spring(g, 1, 2).L, std::sqrt(2), 1e-15);
  EXPECT_NEAR(g.node(0).value().mass, 0.1, 1e-15);
  EXPECT_NEAR(g.node(1).value().mass, 0.2, 1e-15);
  EXPECT_NEAR(total_mass(g), 0.6, 1e-15);
  m.edges.bend = true;
  Cloth stiff = built(m, two_triangles());
  EXPECT_EQ(stiff.num_edges(), 6u);
  EXPECT_EQ(spring(stiff, 0, 3).L, std::sqrt(2));
}

// A lattice of equilateral triangles with equal K has Young's modulus
// 2 K/sqrt(3) (Van Gelder 1998).
TEST(Compose, ModulusOfTrianglesIsThatOfTheirLattice) {
  const double h = std::sqrt(3) / 2;
  Net net{{{0, 0, 0}, {1, 0, 0}, {0.5, h, 0}, {1.5, h, 0}},
          {face_around(0, 1, 2), face_around(1, 3, 2)}};
  Model m;
  m.material.modulus = 2 / std::sqrt(3);
  Cloth g = built(m, net);
  EXPECT_NEAR(spring(g, 1, 2).K, 1, 1e-15);
  EXPECT_NEAR(spring(g, 0, 1).K, 0.5, 1e-15);  // at the rim
}

TEST(Compose, ANetListsItsSpringsMassesAndHeldNodes) {
  Net net{{{0, 0, 0}, {0, 0, -1}, {0, 0, -3}}, {}};
  net.springs = {{0, 1, 10, 0.5}, {1, 2}, {0, 1, 30, 0.5}};
  net.masses = {1, 2, 3};
  net.velocities = {{1, 0, 0}, {1, 0, 0}, {1, 0, 0}};
  net.held = {0};
  Model m;
  m.stiffness = 7;
  Cloth g = built(m, net);
  ASSERT_EQ(g.num_edges(), 2u);
  EXPECT_EQ(spring(g, 0, 1).K, 40);
  EXPECT_EQ(spring(g, 0, 1).L, 0.5);
  for (const Spring& other :
       {Spring{1, 0, 30, 0.9}, Spring{0, 1, 30, 0.5, Acts::pulls}}) {
    Net two = net;
    two.springs[2] = other;
    EXPECT_TRUE(has(error_of([&] { built(m, two); }), "differ in more than K"));
  }
  EXPECT_EQ(spring(g, 1, 2).K, 7);
  EXPECT_EQ(spring(g, 1, 2).L, 2);
  EXPECT_EQ(total_mass(g), 6);
  EXPECT_EQ(g.node(0).value().vel, Point());
  EXPECT_EQ(g.node(2).value().vel, Point(1, 0, 0));
  constraint_of(m, net, g)(g, 0);
  const auto held = held_of(m, net, g);
  ASSERT_EQ(held.size(), 1u);
  EXPECT_EQ(held[0].nodes[0].id, g.node(0).id());
  // One in the place of a face's spring replaces it.
  Net faces = two_triangles();
  faces.springs = {{2, 1, 3, 0}};
  Cloth sewn = built(m, faces);
  EXPECT_EQ(sewn.num_edges(), 5u);
  EXPECT_EQ(spring(sewn, 1, 2).L, 0);
  faces.bare_faces = true;
  Cloth bare = built(m, faces);
  EXPECT_EQ(bare.num_edges(), 1u);
  m.material.modulus = 1;
  net.springs.push_back({0, 2});
  EXPECT_THROW(built(m, net), SceneError);
}

TEST(Compose, EachKindOfSpringMayHaveItsOwnStiffness) {
  Model m = with_sheet("nodes 3 3");
  m.edges = read_edges("sides 40 diagonals bend 2");
  m.rest_length = 0.5;
  Cloth g = built(m);
  EXPECT_EQ(spring(g, 0, 1).K, 40);
  EXPECT_EQ(spring(g, 0, 4).K, 100);
  EXPECT_EQ(spring(g, 0, 2).K, 2);
  EXPECT_EQ(spring(g, 0, 1).L, 0.25);
  EXPECT_EQ(to_words(m.edges), "sides 40 diagonals bend 2");
  EXPECT_THROW(read_edges("sides -1"), SceneError);
  EXPECT_THROW(read_edges("sides 1 2"), SceneError);
}

// A pin holds the nodes at its numbers; if these were rounded, the nearest.
TEST(Compose, APinHoldsNodesByPlaceOrIndex) {
  const auto held = [](const std::string& pin, double size) {
    Model m = with_sheet("u " + std::to_string(size) + " 0 0 nodes 4 2");
    m.pins = {read_pin(pin)};
    return points_held(m, mesh_of(m))[0];
  };
  using All = std::vector<unsigned>;
  EXPECT_EQ(held("x 0", 1), (All{0, 1}));
  EXPECT_EQ(held("x 0.333333", 1), (All{2, 3}));
  EXPECT_EQ(held("x 0.333333 y 1", 1), All{3});
  EXPECT_EQ(held("x 0.3333", 1), All{});
  EXPECT_EQ(held("x 33.3333", 100), (All{2, 3}));
  EXPECT_EQ(held("node 5", 1), All{5});
  EXPECT_EQ(held("node 5 x 0", 1), All{});
  EXPECT_EQ(held("node 8", 1), All{});
}

// ---------------------------------------------------------------- The material

TEST(Compose, ARegionHasSomethingToChange) {
  auto complaint = [](const std::string& region) {
    Model m = with_sheet("nodes 5 5");
    m.regions = {read_region(region)};
    return error_of<SceneError>([&] { built(m); });
  };
  EXPECT_EQ(complaint("from 0.1 0 0 to 0.2 1 0 mass-factor 2"),
            "--region \"from 0.1 0 0 to 0.2 1 0 mass-factor 2\" holds no node");
  const std::string one = "from 0 0 0 to 0.1 0.1 0 ";
  EXPECT_EQ(complaint(one + "mass-factor 2"), "");
  EXPECT_EQ(complaint(one + "stiffness-factor 2"),
            "--region \"" + one + "stiffness-factor 2\" holds no edge");
}

TEST(Compose, StiffnessIsModulusTimesWidthOverLength) {
  Model m = with_sheet("u 3 0 0 nodes 4 6");  // cells of 1 by 0.2
  m.edges = read_edges("sides diagonals bend");
  m.material.modulus = 10;
  Cloth g = built(m);
  EXPECT_NEAR(spring(g, 7, 13).K, 10 * 0.2 / 1, 1e-12);  // inside, along u
  EXPECT_NEAR(spring(g, 7, 8).K, 10 * 1 / 0.2, 1e-12);   // inside, along v
  EXPECT_NEAR(spring(g, 0, 6).K, 10 * 0.1 / 1, 1e-12);   // on the rim
  Model square = m;
  square.sheets = {read_sheet("nodes 6 6")};
  Cloth s = built(square);
  for (auto [i, j] : {std::pair(7u, 8u),
                      {7u, 13u},
                      {7u, 14u},
                      {8u, 13u},
                      {7u, 9u},
                      {7u, 19u}})
    EXPECT_NEAR(spring(s, i, j).K, 10, 1e-12) << i << ' ' << j;
  EXPECT_NEAR(spring(s, 0, 1).K, 5, 1e-12);
}

// Pulled by a strain along x, cloth of springs along its sides answers with
// force per width = modulus times strain, whatever the grid: exactly, as the
// half springs at the rim stand for half a cell.
TEST(Compose, StrainOfOneGridIsStrainOfAnother) {
  for (const char* nodes : {"2 2", "5 9", "30 7"}) {
    Model m = with_sheet(std::string("u 2 0 0 v 0 0.7 0 nodes ") + nodes);
    m.edges = read_edges("sides");
    m.material.modulus = 10;
    Cloth g = built(m);
    for (Node n : g.nodes()) n.position().x *= 1.01;
    double energy = 10 * 0.01 * 0.01 / 2 * (2 * 0.7);
    EXPECT_NEAR(elastic_energy(g), energy, 1e-12) << nodes;
  }
}

TEST(Compose, ANodeWithoutAQuadHasNoMassByArea) {
  Model m;
  m.material.density = 1;
  Net mesh{grid_points(2), grid_quads(2)};
  mesh.points.push_back(Point(9, 9, 9));
  EXPECT_THROW(built(m, mesh), SceneError);
}

/** log2 of how much the answer moves from 1 to 2 over from 2 to 4 times the
 * cells: the order in which it converges. */
double order_of(Model m, Measure what, unsigned cells) {
  m.measure = what;
  m.method = &table::verlet;
  m.step = {.rule = StepRule::safe};
  Answer at[3];
  for (int k : {0, 1, 2}) {
    const unsigned n = (cells << k) + 1;
    m.sheets = {{.v = Point(0, 0, -1), .nodes = {n, n}}};
    at[k] = try_out(m).answer;
  }
  return std::log2(distance(at[0], at[1], what) / distance(at[1], at[2], what));
}

// The same cloth on finer grids: springs and masses by area, rim included, make
// a difference scheme of order 2 where the motion is smooth, and Verlet's step
// goes down with the grid.
TEST(Compose, RefiningAHangingClothConvergesAtOrderTwo) {
  Model m;
  m.edges = read_edges("sides");
  m.pins = {read_pin("z 0")};
  m.material.density = 1;
  m.material.modulus = 100;
  m.t_end = 0.1;
  EXPECT_NEAR(order_of(m, Measure::com, 16), 2, 0.1);
  EXPECT_NEAR(order_of(m, Measure::energy, 16), 2, 0.1);
}

// ----------------------------------------------------------------- The parts

TEST(Compose, WhatIsNotNamedCostsNothing) {
  Model m = with_sheet("nodes 3 3");
  Cloth g = built(m);
  // Without a constraint no node is looked at: a cloth below any floor stays.
  for (Node n : g.nodes()) n.position().z = -100;
  constraint_of(m, mesh_of(m), g)(g, 0);
  for (Node n : g.nodes()) EXPECT_EQ(n.position().z, -100);
  EXPECT_EQ(constraint_of(m, mesh_of(m), g).parts.size(), 0u);
  EXPECT_EQ(force_of(m, mesh_of(m), g).parts.size(), 2u);  // and springs
  m.gravity = 0;
  EXPECT_EQ(force_of(m, mesh_of(m), g).parts.size(), 1u);
  m.damping = 0.1;
  EXPECT_EQ(force_of(m, mesh_of(m), g).parts.size(), 2u);
  m.pins = {read_pin("x 0")};
  m.planes = {Wall()};
  EXPECT_EQ(constraint_of(m, mesh_of(m), g).parts.size(), 2u);
}

TEST(Compose, SelfCollisionMustFitTheStart) {
  Model m = with_sheet("nodes 5 5");  // two nodes two sides apart: 0.5 m
  Cloth g = built(m);
  m.self_collision = {.thickness = 0.51};
  EXPECT_THROW(constraint_of(m, mesh_of(m), g), SceneError);
  m.self_collision = {.thickness = 0.49};
  EXPECT_NO_THROW(constraint_of(m, mesh_of(m), g));
}

}  // namespace
