/** @file test_faces.cpp
 * Tests of faces: which of them are there, and by pixel how they are drawn. */
#include <gtest/gtest.h>

#include <array>
#include <set>
#include <utility>
#include <vector>

#include "CME212/Color.hpp"
#include "CME212/Mesh.hpp"
#include "CME212/SDLViewer.hpp"
#include "CME212/viewer/Faces.hpp"
#include "CME212/viewer/GLCamera.hpp"
#include "CME212/viewer/Image.hpp"
#include "Graph.hpp"

namespace {

using namespace CME212;
using NetGraph = Graph<>;
using NetNode = NetGraph::node_type;

/** A cloth of n x n nodes in the unit square, with diagonals. */
void make_cloth(NetGraph& g, unsigned n) {
  for (const Point& p : grid_points(n)) g.add_node(p);
  const auto quads = grid_quads(n);
  const MeshSprings springs(quads, MeshSprings::diagonals);
  for (unsigned s = 0; s < springs.size(); ++s)
    g.add_edge(g.node(springs[s][0]), g.node(springs[s][1]));
}

TEST(Faces, GoWithTheirNodesAndSides) {
  NetGraph g;
  make_cloth(g, 3);
  SceneBuilder b;
  b.add_faces(g, grid_quads(3));
  SceneData scene;
  auto faces = [&] {
    b.draw_graph(g);
    b.take([&](const SceneData& s, bool) { scene = s; });
    return scene.faces.size();
  };
  EXPECT_EQ(faces(), 4u);
  g.remove_edge(g.node(0), g.node(4));  // a diagonal
  EXPECT_EQ(faces(), 4u);
  g.remove_edge(g.node(0), g.node(1));  // a side
  EXPECT_EQ(faces(), 3u);
  g.remove_node(g.node(8));  // a corner; each face keeps its nodes
  EXPECT_EQ(faces(), 2u);
  for (const Quad& q : scene.faces)
    EXPECT_EQ(scene.nodes[q[3]].x - scene.nodes[q[0]].x, 0.5);
  g.remove_node(g.node(4));
  EXPECT_EQ(faces(), 0u);
}

/** A cloth of 9 x 9 nodes at z = 0 in a viewer that looks at it from above and
 * in front, or from below, and where its points are in the picture. */
struct ClothPicture {
  NetGraph graph;
  SDLViewer viewer{{400, 300, "test_faces", true, true, true}};
  GLCamera camera;
  Image image;
  explicit ClothPicture(Point from = Point(0, -1, 1)) {
    make_cloth(graph, 9);
    const BoundingBox box(Point(-0.5, -0.5, -1), Point(1.5, 1.5, 0));
    camera.look_from(from);
    camera.fit(box, 4.0 / 3);
    viewer.set_view(from, box);
    viewer.add_faces(graph, grid_quads(9));
    viewer.draw_graph(graph);
  }
  /** Red, green and blue of the picture at @a p: of a new one, or of the last
   * one. */
  std::array<int, 3> color(const Point& p, bool draw = true) {
    if (draw) image = viewer.snapshot();
    const auto [x, y] = camera.pixel(p, 400, 300);
    const auto* c = image.pixel(int(x), int(y));
    return {c[0], c[1], c[2]};
  }
};
const Point middle_of_face(0.44, 0.44, 0);

TEST(Faces, FrontIsWarmBackIsCoolAndATornClothHasAHole) {
  ClothPicture above, below(Point(0, -1, -1));
  for (auto* c : {&above, &below}) c->viewer.set_look({.wires = false});
  const auto front = above.color(middle_of_face),
             back = below.color(middle_of_face);
  EXPECT_GT(front[0], front[2] + 15);
  EXPECT_GT(back[2], back[0] + 30);
  // As high in the picture, beside the cloth.
  const auto ground = above.color(middle_of_face + Point(1, 0, 0));
  above.graph.remove_node(above.graph.node(4 * 9 + 4));  // in the middle
  above.viewer.draw_graph(above.graph);
  EXPECT_EQ(above.color(middle_of_face), ground);
  EXPECT_NE(front, ground);
}

TEST(Faces, CastASoftShadowOnFloorAndBall) {
  ClothPicture c;
  auto light_at = [&](const Point& p, bool draw = true) {
    const auto rgb = c.color(p, draw);
    return rgb[0] + rgb[1] + rgb[2];
  };
  // The lamp is to the left and in front: the shadow lies 0.4 m to the right
  // of the cloth and 0.5 m behind it.
  c.viewer.add_plane(-1, 4);
  const int lit = light_at(Point(-0.2, 0.8, -1)),
            shade = light_at(Point(1.2, 0.8, -1));
  EXPECT_LT(shade, 0.7 * lit);
  std::set<int> rim;
  for (double x = 1.35; x < 1.5; x += 0.01)
    rim.insert(light_at(Point(x, 0.8, -1), false));
  EXPECT_GT(rim.size(), 4u);
  EXPECT_GE(*rim.begin(), shade - 9);
  // So is a ball that is to the right of the cloth and below it.
  c.viewer.add_sphere(Point(1.1, 1.1, -0.6), 0.2);
  const Point top(1.1, 1.1, -0.4);
  const int under = light_at(top);
  c.viewer.set_look({.faces = false});
  EXPECT_LT(under, 0.8 * light_at(top));
  EXPECT_NEAR(light_at(Point(1.2, 0.8, -1)), lit, 0.1 * lit);
}

TEST(Faces, StrainColorsKeepTheirHueOnBothSides) {
  for (Point from : {Point(0, -1, 1), Point(0, -1, -1)}) {
    ClothPicture c(from);
    c.viewer.set_look({.wires = false});
    c.viewer.set_strain_colors(true);
    auto red_over_blue = [&](float strain) {
      auto color = [=](NetNode) { return Color::make_strain(strain); };
      auto nodes = c.viewer.empty_node_map(c.graph);
      std::vector<std::array<NetNode, 4>> faces;
      for (const Quad& q : grid_quads(9))
        faces.push_back({c.graph.node(q[0]), c.graph.node(q[1]),
                         c.graph.node(q[2]), c.graph.node(q[3])});
      c.viewer.clear();
      c.viewer.add_nodes(c.graph.node_begin(), c.graph.node_end(), color,
                         nodes);
      c.viewer.add_faces(faces.begin(), faces.end(), nodes);
      c.viewer.add_edges(c.graph.edge_begin(), c.graph.edge_end(), nodes);
      const auto rgb = c.color(middle_of_face);
      return double(rgb[0]) / rgb[2];
    };
    for (float strain : {-1.0f, -0.5f, 0.0f, 0.5f, 1.0f}) {
      const Color expected = Color::make_strain(strain);
      EXPECT_NEAR(red_over_blue(strain), expected.r / expected.b,
                  0.06 * expected.r / expected.b)
          << strain;
    }
  }
}

}  // namespace
