// Warnings.hpp: what is said before the first step is true, and nothing is said
// of a scene where it is not: each from both sides of its bound.
#include "lab/scenes/Warnings.hpp"

#include <gtest/gtest.h>

#include "lab/fast/Energy.hpp"
#include "lab/methods/Methods.hpp"
#include "lab/scenes/SceneFile.hpp"
#include "lab/scenes/Words.hpp"
#include "lab/stepping/Scene.hpp"
#include "tests/Built.hpp"
#include "tests/ReadParts.hpp"
#include "tests/TestFolder.hpp"

using namespace lab;

namespace {

/** 5 x 5 nodes, 0.25 m apart: their openings have a radius of 0.1768 m. */
Model sheet(const std::string& more = "") {
  return with_sheet("nodes 5 5 " + more);
}
std::vector<std::string> warnings_of(const Model& m, double dt = 0.001) {
  const auto mesh = mesh_of(m);
  return warnings(m, mesh, built(m, mesh), dt);
}
/** The one warning of @a m; what there is, if it is not one. */
std::string warning_of(const Model& m, double dt = 0.001) {
  std::string all;
  for (const std::string& w : warnings_of(m, dt))
    all += (all.empty() ? "" : "\n") + w;
  return all;
}
Model with_sphere(const std::string& words) {
  Model m = sheet();
  m.spheres = {read_sphere(words)};
  return m;
}
Model with_tear(const std::string& words) {
  Model m = sheet();
  m.tears = {read_tear(words)};
  return m;
}

// ------------------------------------------------------------------ The mesh

TEST(Warnings, AnOpeningIsTheLargestBallBetweenTheNodes) {
  auto of = [](Point a, Point b, Point c, Point d) {
    return opening({{a, b, c, d}, {}, {}}, Quad{0, 1, 2, 3});
  };
  const double h = std::sqrt(3) / 2;
  EXPECT_NEAR(of({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}), std::sqrt(0.5),
              1e-15);
  EXPECT_NEAR(of({0, 0, 0}, {3, 0, 0}, {0, 4, 0}, {3, 4, 0}), 2.5, 1e-14);
  // Two triangles of equal sides; and the same ones, but folded flat.
  EXPECT_NEAR(of({0, 0, 0}, {1, 0, 0}, {0.5, h, 0}, {1.5, h, 0}),
              1 / std::sqrt(3), 1e-14);
  // A quad much longer than wide, askew: along its side the farthest point is
  // as far from that side's end as from the corner.
  double worst = 0;
  const Point p[] = {{0, 0, 0}, {4, 0, 0}, {1, 0.5, 0}, {5, 0.5, 0}};
  for (double s = 0; s <= 1; s += 1 / 512.)
    for (double t = 0; t <= 1; t += 1 / 512.) {
      const Point x = s * p[1] + t * p[2];
      double least = 9;
      for (const Point& corner : p)
        least = std::min<double>(least, norm(x - corner));
      worst = std::max(worst, least);
    }
  EXPECT_NEAR(of(p[0], p[1], p[2], p[3]), worst, 0.02);
  EXPECT_GE(of(p[0], p[1], p[2], p[3]), worst - 1e-9);
}

TEST(Warnings, NodesInNoQuad) {
  const CME212::TestFolder folder;
  Model m;
  m.nodes = "data/grid1.nodes", m.tets = "data/grid0.tets";
  m.pins = {read_pin("x 0")};
  EXPECT_EQ(warning_of(m),
            "600 of 625 nodes lie in no quad, node 25 first: no spring holds "
            "them; use nodes and quads of the same mesh");
  m.tets = "data/grid1.tets";
  EXPECT_EQ(warning_of(m), "");
}

TEST(Warnings, OfAMeshFromFiles) {
  const auto of = [](const Net& net, const char* pin) {
    Model m;
    if (*pin) m.pins = {read_pin(pin)};
    const auto all = warnings(m, net, built(m, net), 0.001);
    return all.empty() ? "" : all[0].substr(0, all[0].find(':'));
  };
  Net net = {grid_points(3), grid_quads(3)};
  EXPECT_EQ(of(net, "x 0"), "");
  EXPECT_EQ(of(net, ""), "nothing holds the cloth, and nothing is below it");
  net.held = {0};
  EXPECT_EQ(of(net, ""), "");
  net.notes = {"mended"};
  EXPECT_EQ(of(net, ""), "mended");
  net.notes.clear();
  for (Point& p : net.points) p *= 1000;
  EXPECT_EQ(of(net, ""), "the cloth is 1414.21 m large");
  // Sewing: ends apart that are to meet.
  Net sewn = {{{0, 0, 0}, {1, 0, 0}}, {}};
  sewn.springs = {{0, 1, 10, 0}};
  EXPECT_EQ(of(sewn, "x 0"), "");
  // Options that find nothing to change; a net with K and one without.
  Model m;
  m.pins = {read_pin("x 0")};
  const auto with = [&m](const Net& net) {
    return warnings(m, net, built(m, net), 0.001);
  };
  const std::string own =
      " changes nothing: each spring of the net has its own K";
  m.stiffness = 50;
  EXPECT_EQ(with(sewn), std::vector{"--stiffness" + own});
  m.material.modulus = 3;
  EXPECT_EQ(with(sewn), std::vector{"--modulus" + own});
  m.material.modulus.reset(), m.edges.bend = true, sewn.springs[0].K = -1;
  EXPECT_EQ(with(sewn), std::vector<std::string>{
                            "--edges changes nothing: no face gives springs"});
  sewn.quads = {face_around(0, 1, 2)}, sewn.points.push_back({0, 1, 0});
  EXPECT_EQ(with(sewn).size(), 0u);
  m.spheres = {read_sphere("at 0 0 -9 radius 0.1")};
  EXPECT_TRUE(has(with(sewn).at(0), "the openings of 1 of 1 face: "));
}

TEST(Warnings, SpringsOfLengthZero) {
  Model m = sheet();
  Net mesh = mesh_of(m);
  mesh.points[7] = mesh.points[12];  // one side
  const auto found = warnings(m, mesh, built(m, mesh), 0.001);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0],
            "1 spring has length 0: nodes 7 and 12 are at the same point, and "
            "no spring force keeps them apart; make them one node");
  mesh.points[7].z += 1e-6;
  EXPECT_EQ(warnings(m, mesh, built(m, mesh), 0.001).size(), 0u);
}

// ------------------------------------------------------------- What it meets

TEST(Warnings, AFloorAboveTheCloth) {
  Model m = sheet("u 1 0 1");
  m.planes = {read_plane("at 0 0 0.3")};
  EXPECT_EQ(
      warning_of(m),
      "10 of 25 nodes start below --plane \"at 0 0 0.3\", up to 0.3 m: the "
      "plane moves them up at t = 0; to avoid that, put it at 0 0 0");
  m.planes = {read_plane("at 0 0 0")};
  EXPECT_EQ(warning_of(m), "");
  m.planes = {read_plane("at 0 0 0 normal 0 0 -1")};  // a ceiling
  EXPECT_TRUE(has(warning_of(m), "20 of 25 nodes start below"));
  m.planes = {read_plane("at 0 0 1 normal 0 0 -1")};
  EXPECT_EQ(warning_of(m), "");
}

TEST(Warnings, ASolidBallThatStartsAroundNodes) {
  EXPECT_EQ(
      warning_of(with_sphere("at 0.5 0.5 0.1 radius 0.28")),
      "5 of 25 nodes start inside --sphere \"at 0.5 0.5 0.1 radius 0.28\": "
      "the ball moves them to its surface at t = 0; move the ball");
  // It may touch.
  EXPECT_EQ(warning_of(with_sphere("at 0.5 0.5 -0.28 radius 0.28")), "");
}

TEST(Warnings, ATearingBallThatStartsAroundNodes) {
  EXPECT_EQ(warning_of(with_tear("at 0.5 0.5 0 radius 0.2")),
            "1 of 25 nodes starts inside --tear \"at 0.5 0.5 0 radius 0.2\": "
            "the first step removes it; move the ball");
  EXPECT_EQ(warning_of(with_tear("at 0.5 0.5 -0.2 radius 0.2")), "");
}

TEST(Warnings, ABallThatFitsThroughTheMesh) {
  auto below = [](double r) {
    return with_sphere("at 0.5 0.5 -1 radius " + std::to_string(r));
  };
  EXPECT_EQ(warning_of(below(0.17)),
            "--sphere \"at 0.5 0.5 -1 radius 0.17\" fits through the openings "
            "of 16 of 16 quads: their middle is up to 0.176777 m from the "
            "nearest node, and the ball only touches nodes; use a radius above "
            "0.265165 m, or a finer grid");
  EXPECT_TRUE(has(warning_of(below(0.18)),
                  "of 16 of 16 quads where springs are stretched by 1.8 %: "));
  EXPECT_NE(warning_of(below(0.26)), "");
  EXPECT_EQ(warning_of(below(0.2652)), "");  // the cure of the first
}

// What fits through is not met; what does not is.
TEST(Warnings, ABallFitsThroughWhereTheySaySo) {
  auto touched = [](double r) {
    Model m = with_sphere("at 0.625 0.625 -0.5 radius " + std::to_string(r));
    m.stiffness = 1e4;
    m.method = &table::verlet;
    m.step.rule = StepRule::safe;
    Scene scene(m);
    EXPECT_TRUE(scene.run_to(0.5)) << text_of(scene.failure());  // falls 1.2 m
    return elastic_energy(scene.cloth()) > 1e-12;
  };
  EXPECT_FALSE(touched(0.176));
  EXPECT_TRUE(touched(0.178));
}

TEST(Warnings, ASelfCollisionThatDoesNotCloseTheMesh) {
  Model m = sheet();
  m.self_collision = read_self_collision("thickness 0.1765");
  EXPECT_EQ(warning_of(m),
            "--self-collision \"thickness 0.1765\" does not close 16 of 16 "
            "quads, where a node may be 0.176777 m from the nearest one, so "
            "the cloth can pass through itself there; use a thickness above "
            "that, 0.71 times the side of a square");
  m.self_collision = read_self_collision("thickness 0.177");
  EXPECT_EQ(warning_of(m), "");
  // One of two sheets is finer.
  m.sheets.push_back(read_sheet("at 0 0 1 nodes 9 9"));
  m.self_collision = read_self_collision("thickness 0.1");
  EXPECT_TRUE(has(warning_of(m), "16 of 80 quads"));
}

TEST(Warnings, ABallThatIsTooFastForTheStep) {
  const Model m = with_sphere("radius 0.3 velocity 0 3 4 until 1");
  EXPECT_EQ(warning_of(m, 0.04),
            "--sphere moves 0.2 m a step, more than half of its radius, 0.3 "
            "m: nodes may tunnel through it; use --dt 0.03");
  EXPECT_EQ(warning_of(m, 0.0299), "");
}

TEST(Warnings, AreShownByARunOnceAndNotIfItIsToBeQuiet) {
  const CME212::TestFolder folder;
  const std::string command = CME212::program("cloth", "build/") +
                              " data/grid1.nodes data/grid0.tets --headless "
                              "--t-end 0.01 --plane 'at 0 0 1' ";
  auto r = folder.run(command);
  EXPECT_EQ(r.status, 0);
  r.err = joined(r.err);
  EXPECT_EQ(std::count(r.err.begin(), r.err.end(), '\n'), 3) << r.err;
  EXPECT_TRUE(begins(r.err, "cloth: warning: 600 of 625 nodes lie in no quad"));
  EXPECT_TRUE(has(r.err, "\ncloth: warning: 625 of 625 nodes start below"));
  EXPECT_TRUE(has(r.err, "\ncloth: warning: at t = 0 the obstacles give"));
  EXPECT_EQ(folder.run(command + "--quiet").err, "");
}

}  // namespace
