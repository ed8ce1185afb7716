#pragma once
/** @file GLScene.hpp
 * GLScene: draws a SceneData with OpenGL 3.3 core. */
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <vector>

#include "CME212/BoundingBox.hpp"
#include "CME212/Color.hpp"
#include "CME212/Point.hpp"
#include "CME212/viewer/Faces.hpp"
#include "CME212/viewer/GLCamera.hpp"
#include "CME212/viewer/GLShaders.hpp"
#include "CME212/viewer/GLShadow.hpp"
#include "CME212/viewer/GLTools.hpp"
#include "CME212/viewer/SceneBuilder.hpp"

namespace CME212 {

/** Draws a SceneData; holds its buffers and shaders. */
class GLScene {
 public:
  GLScene() {
    nodes_.bind();
    auto attribute = [](GLuint at, GLint size, GLenum type, std::size_t from) {
      glEnableVertexAttribArray(at);
      glVertexAttribPointer(at, size, type, GL_TRUE, sizeof(Vertex),
                            reinterpret_cast<void*>(from));
    };
    attribute(0, 3, GL_FLOAT, 0);
    attribute(1, 3, GL_UNSIGNED_BYTE, offsetof(SceneData::Vertex, rgba));
    attribute(2, 4, GL_SHORT, offsetof(Vertex, normal));
    set_solid(sphere_, 80, 40, [](double u, double v) {
      double a = 2 * std::numbers::pi * u, b = std::numbers::pi * (v - 0.5);
      return Point(std::cos(a) * std::cos(b), std::sin(a) * std::cos(b),
                   std::sin(b));
    });
    set_solid(plane_, 48, 1, [](double u, double v) {
      double a = 2 * std::numbers::pi * u;
      return Point(v * std::cos(a), v * std::sin(a), 0);
    });
  }

  /** Take over @a scene, to be drawn from now on.
   * @param edges_changed Edges or faces differ from those of the last call
   * Complexity: O(nodes + edges + faces), by 20 ns each */
  void upload(const SceneData& scene, bool edges_changed) {
    if (edges_changed) set_indices(scene);
    const auto normals =
        face_normals(scene.faces, scene.nodes.size(), [&](std::uint32_t i) {
          const auto& v = scene.nodes[i];
          return Point(v.x, v.y, v.z);
        });
    std::vector<Vertex> vertices;
    vertices.reserve(scene.nodes.size());
    for (std::size_t i = 0; i < scene.nodes.size(); ++i)
      vertices.emplace_back(scene.nodes[i], normals[i]);
    nodes_.set_vertices(vertices);
    num_nodes_ = GLsizei(scene.nodes.size());
    spheres_ = scene.spheres;
    planes_ = scene.planes;
    // A node is a fifth as wide as the distance of evenly spread nodes.
    box_ = scene.box();
    const double size = box_.diagonal() > 0 ? box_.diagonal() : 1;
    node_size_ = 0.2 * size / std::sqrt(num_nodes_ + 1.0);
  }
  /** True if the scene has faces, whether or not they are drawn. */
  bool has_faces() const { return num_triangles_ > 0; }

  /** The box of all nodes and spheres. */
  const BoundingBox& box() const { return box_; }

  /** Draw all over the present content.
   * @param width,height Of the picture [pixels]
   * @param scale        Width of a line [pixels], 1 on a plain screen
   * @param plain        Keep the colors of nodes, as they have a meaning */
  void draw(const GLCamera& camera, int width, int height, double scale,
            const Look& look, bool plain) {
    const bool faces = look.faces && has_faces();
    const bool shaded = faces || !spheres_.empty();
    if (shaded) make_shadow(camera, faces);
    glViewport(0, 0, width, height);
    glDisable(GL_BLEND);
    glDisable(GL_DEPTH_TEST);
    glClear(GL_DEPTH_BUFFER_BIT);
    glEnable(GL_PROGRAM_POINT_SIZE);

    const double aspect = double(width) / height;
    auto use = [&](const GLProgram& p) {
      p.use();
      p.set("view", camera.view());
      p.set("projection", camera.projection(aspect));
      p.set("above", above);
      p.set("below", below);
      p.set("height", float(height));
      shadow_.use(p);
    };
    sphere_.bind();
    use(backdrop_program_);
    glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
    glEnable(GL_DEPTH_TEST);
    use(sphere_program_);
    sphere_program_.set("paint", orange);
    for (const auto& s : spheres_) {
      place(sphere_program_, s);
      sphere_.draw(GL_TRIANGLES);
    }

    const double extent = camera.extent();
    const double pixels = height / (2 * GLCamera::half_height(aspect));
    nodes_.bind();
    glLineWidth(std::max(1.0f, std::round(float(scale))));
    auto use_cloth = [&](const GLProgram& p, float tint, float nearer) {
      use(p);
      p.set("fade_to", fog);
      p.set("size", Point(node_size_ * pixels, 2 * scale, 14 * scale));
      p.set("range", float(camera.distance() - extent / 2),
            float(camera.distance() + extent / 2));
      p.set("tint", tint);
      p.set("nearer", nearer);
      p.set("ink", 0.0f);
      p.set("show", 1.0f);
    };
    if (faces) {
      use(face_program_);
      face_program_.set("nearer", 0.997f);
      face_program_.set("to_eye", camera.backward());
      face_program_.set("front_dye", plain ? Color(1) : linen);
      face_program_.set("back_dye", plain ? Color(0.88f) : denim);
      nodes_.draw(GL_TRIANGLES, num_lines_, num_triangles_);
    }
    glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
    if (look.wires) {
      use_cloth(edge_program_, 0.75f, faces ? 0.995f : 0.99f);
      // On faces, wires are dark lines. They fade out where they are so close
      // together that they would only darken the cloth.
      const double apart = 5 * node_size_ * pixels / camera.distance() / scale;
      if (faces) edge_program_.set("ink", float(std::min(apart / 40, 0.4)));
      glEnable(GL_BLEND);
      nodes_.draw(GL_LINES, 0, !faces || apart > 8 ? num_lines_ : num_loose_);
      glDisable(GL_BLEND);
    }
    glEnable(GL_SAMPLE_ALPHA_TO_COVERAGE);
    use_cloth(node_program_, 1, 0.985f);  // in front of the edges
    node_program_.set("show", look.nodes ? 1.0f : 0.0f);
    glDrawArrays(GL_POINTS, 0, num_nodes_);
    glDisable(GL_SAMPLE_ALPHA_TO_COVERAGE);

    draw_planes(shaded, use);
    glDisable(GL_DEPTH_TEST);
    glBindVertexArray(0);
  }

 private:
  // The backdrop is lighter below, where a floor is.
  static constexpr Color above{0.12f, 0.14f, 0.18f}, below{0.27f, 0.29f, 0.33f};
  static constexpr Color fog{0.2f, 0.22f, 0.26f}, orange{0.80f, 0.33f, 0.0f};
  static constexpr Color linen{1.0f, 0.93f, 0.82f}, denim{0.62f, 0.76f, 0.95f};

  /** A node as it is uploaded. */
  struct Vertex {
    SceneData::Vertex node;
    /** Of length 1 and with a fourth 1; all 0 if the node is in no face. */
    std::array<std::int16_t, 4> normal{};
    Vertex(const SceneData::Vertex& v, const Point& n) : node(v) {
      const double length = norm(n);
      if (!(length > 0)) return;
      for (unsigned k : {0, 1, 2})
        normal[k] = std::int16_t(std::lround(32767 * n[k] / length));
      normal[3] = 32767;
    }
  };

  GLProgram node_program_{{shaders::cloth_vertex}, {shaders::node_fragment}};
  GLProgram edge_program_{{shaders::cloth_vertex}, {shaders::edge_fragment}};
  GLProgram face_program_{{shaders::light_source, shaders::face_vertex},
                          {shaders::face_fragment}};
  GLProgram sphere_program_{{shaders::light_source, shaders::sphere_vertex},
                            {shaders::sphere_fragment}};
  GLProgram backdrop_program_{{shaders::backdrop_vertex},
                              {shaders::backdrop, shaders::backdrop_fragment}};
  GLProgram plane_program_{
      {shaders::plane_vertex},
      {shaders::backdrop, shaders::light_source, shaders::plane_fragment}};
  GLShadow shadow_;
  GLMesh nodes_, sphere_, plane_;
  GLsizei num_nodes_ = 0;
  // Indices, in this order: edges with an end in no face, other edges, faces.
  GLsizei num_loose_ = 0, num_lines_ = 0, num_triangles_ = 0;
  std::vector<SceneData::Sphere> spheres_;
  std::vector<SceneData::Plane> planes_;
  double node_size_ = 0;
  BoundingBox box_;

  /** The ends of edges, then the corners of two triangles a face. */
  void set_indices(const SceneData& scene) {
    std::vector<char> in_face(scene.nodes.size());
    for (const Quad& f : scene.faces)
      for (std::uint32_t corner : f) in_face[corner] = 1;
    std::vector<std::uint32_t> indices;
    indices.reserve(2 * scene.edges.size() + 6 * scene.faces.size());
    for (bool loose : {true, false}) {
      for (const auto& [a, b] : scene.edges)
        if (loose != (in_face[a] && in_face[b]))
          indices.insert(indices.end(), {a, b});
      if (loose) num_loose_ = GLsizei(indices.size());
    }
    num_lines_ = GLsizei(indices.size());
    const auto [a, b, c, d] = around_quad;
    for (const Quad& f : scene.faces)
      indices.insert(indices.end(), {f[a], f[b], f[c], f[c], f[d], f[a]});
    num_triangles_ = GLsizei(indices.size()) - num_lines_;
    nodes_.set_indices(indices);
  }

  /** Draw the planes as seen from above, with the shadows on them if @a shaded.
   * They are opaque; at its rim a plane has the backdrop's color. */
  template <typename Use>
  void draw_planes(bool shaded, Use use) const {
    glEnable(GL_CULL_FACE);
    use(plane_program_);
    plane_program_.set("dark", shaded ? 0.55f : 0.0f);
    plane_.bind();
    for (const auto& p : planes_) {
      plane_program_.set("center", p.center);
      plane_program_.set("radius", float(p.half));
      plane_.draw(GL_TRIANGLES);
    }
    glDisable(GL_CULL_FACE);
  }

  /** A ball is drawn a little smaller, so that a flat face between nodes on its
   * surface does not sink into it. */
  static void place(const GLProgram& p, const SceneData::Sphere& s) {
    p.set("center", s.center);
    p.set("radius", float(0.98 * s.radius));
  }
  void make_shadow(const GLCamera& camera, bool faces) {
    shadow_.make(camera, [&](const GLProgram& p) {
      sphere_.bind();
      for (const auto& s : spheres_) place(p, s), sphere_.draw(GL_TRIANGLES);
      if (!faces) return;
      p.set("center", Point());
      p.set("radius", 1.0f);
      nodes_.bind();
      nodes_.draw(GL_TRIANGLES, num_lines_, num_triangles_);
    });
  }

  /** Triangles over a grid of @a m x @a n cells of (u, v) in [0, 1]^2. */
  template <typename F>
  static void set_solid(GLMesh& mesh, unsigned m, unsigned n, F at) {
    std::vector<std::array<float, 3>> vertices;
    std::vector<std::array<std::uint32_t, 3>> triangles;
    for (unsigned i = 0; i <= m; ++i)
      for (unsigned j = 0; j <= n; ++j) {
        Point p = at(double(i) / m, double(j) / n);
        vertices.push_back({float(p.x), float(p.y), float(p.z)});
        if (i == m || j == n) continue;
        unsigned a = i * (n + 1) + j, b = a + n + 1;
        triangles.push_back({a, a + 1, b});
        triangles.push_back({b, a + 1, b + 1});
      }
    mesh.set_vertices(vertices);
    mesh.set_indices(triangles);
    glEnableVertexAttribArray(0);
    glVertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, 0, nullptr);
  }
};

}  // namespace CME212
