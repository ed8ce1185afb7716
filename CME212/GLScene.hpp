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
#include "CME212/GLCamera.hpp"
#include "CME212/GLTools.hpp"
#include "CME212/Point.hpp"
#include "CME212/SceneBuilder.hpp"

namespace CME212 {

namespace gl_detail {

// ---- The shaders

/** A triangle that covers the picture. */
constexpr const char* ground_vertex = R"(
  void main() {
    gl_Position = vec4(vec2(gl_VertexID % 2, gl_VertexID / 2) * 4 - 1, 0, 1);
  })";
constexpr const char* ground_fragment = R"(
  out vec4 color;
  uniform vec3 low, rise;  // color at the bottom, change for a pixel upwards
  void main() { color = vec4(low + gl_FragCoord.y * rise, 1); })";

/** Nodes and edges. Both come a little towards the eye along the line of
 * sight, so that what lies on a surface is not hidden by it. What is far
 * fades into the ground. */
constexpr const char* cloth_vertex = R"(
  layout(location = 0) in vec3 at;
  layout(location = 1) in vec3 color_in;
  uniform mat4 view, projection;
  uniform vec3 fade_to, size;  // of a node: at distance 1, least, most
  uniform vec2 range;          // distances between which it fades
  uniform float tint;          // 1: the node's color; 0: fade_to
  uniform float nearer;        // factor of the distance
  out vec3 shade;
  flat out float radius;
  void main() {
    vec4 eye = view * vec4(at, 1);
    float fade = clamp((-eye.z - range.x) / (range.y - range.x), 0, 1);
    shade = mix(fade_to, color_in, tint * (1 - 0.35 * fade));
    eye.xyz *= nearer;
    gl_Position = projection * eye;
    gl_PointSize = clamp(size.x / -eye.z, size.y, size.z) + 1;  // soft rim
    radius = gl_PointSize / 2;
  })";
constexpr const char* node_fragment = R"(
  in vec3 shade;
  flat in float radius;
  out vec4 color;
  void main() {
    float inside = radius * (1 - length(2 * gl_PointCoord - 1));
    if (inside < 0.1) discard;
    color = vec4(shade, min(inside, 1));
  })";
constexpr const char* edge_fragment = R"(
  in vec3 shade;
  out vec4 color;
  void main() { color = vec4(shade, 1); })";

/** The unit sphere or the unit disc, placed in the world. */
constexpr const char* solid_vertex = R"(
  layout(location = 0) in vec3 at;
  uniform mat4 view, projection;
  uniform vec3 center;
  uniform float radius;
  out vec3 place, normal;
  void main() {
    place = at;
    normal = mat3(view) * at;
    gl_Position = projection * (view * vec4(center + radius * at, 1));
  })";
constexpr const char* sphere_fragment = R"(
  in vec3 normal;
  uniform vec3 paint;
  out vec4 color;
  void main() {
    vec3 n = normalize(normal);
    float light = max(dot(n, normalize(vec3(-0.5, 0.8, 0.6))), 0);
    float rim = pow(1 - abs(n.z), 3);
    color = vec4(paint * (0.35 + 0.65 * light) + 0.12 * rim, 1);
  })";
constexpr const char* plane_fragment = R"(
  in vec3 place;
  uniform vec3 paint;
  uniform float lines;
  out vec4 color;
  void main() {
    vec2 p = place.xy * lines, width = fwidth(p);
    vec2 line = 1 - clamp(abs(fract(p + 0.5) - 0.5) / width, 0, 1);
    float rim = max(1 - dot(place.xy, place.xy), 0);
    color = vec4(paint, rim * (0.22 + 0.4 * max(line.x, line.y)));
  })";

/** A thick line between two places, or a ring around one, in pixels. */
constexpr const char* mark_vertex = R"(
  uniform mat4 view, projection;
  uniform vec3 from, to;
  uniform vec2 half_size;  // of the picture
  uniform float reach;     // to the outer rim
  flat out vec2 a, b;
  void main() {
    vec4 p = projection * (view * vec4(from, 1));
    vec4 q = projection * (view * vec4(to, 1));
    a = (p.xy / p.w + 1) * half_size;
    b = (q.xy / q.w + 1) * half_size;
    vec2 along = reach * (a == b ? vec2(1, 0) : normalize(b - a));
    vec2 across = vec2(-along.y, along.x);
    vec2 corner = gl_VertexID < 2 ? a - along : b + along;
    corner += gl_VertexID % 2 == 0 ? across : -across;
    gl_Position = vec4(corner / half_size - 1, 0, 1);
    if (p.w <= 0 || q.w <= 0) gl_Position = vec4(2, 2, 2, 1);  // behind us
  })";
constexpr const char* mark_fragment = R"(
  flat in vec2 a, b;
  out vec4 color;
  uniform vec3 paint;
  uniform float ring, width, rim;  // ring: its radius, 0 for a line
  void main() {
    vec2 p = gl_FragCoord.xy - a, line = b - a;
    float at = clamp(dot(p, line) / max(dot(line, line), 1e-6), 0, 1);
    float off = abs(length(p - at * line) - ring) - width / 2;
    color = vec4(paint * clamp(0.5 - off, 0, 1), clamp(rim + 0.5 - off, 0, 1));
  })";

}  // namespace gl_detail

/** Draws a SceneData; holds its buffers and shaders. */
class GLScene {
 public:
  GLScene() {
    nodes_.bind();
    glEnableVertexAttribArray(0);
    glVertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, sizeof(SceneData::Vertex),
                          nullptr);
    glEnableVertexAttribArray(1);
    glVertexAttribPointer(
        1, 3, GL_UNSIGNED_BYTE, GL_TRUE, sizeof(SceneData::Vertex),
        reinterpret_cast<void*>(offsetof(SceneData::Vertex, rgba)));
    set_solid(sphere_, 48, 24, [](double u, double v) {
      double a = 2 * std::numbers::pi * u, b = std::numbers::pi * (v - 0.5);
      return Point(std::cos(a) * std::cos(b), std::sin(a) * std::cos(b),
                   std::sin(b));
    });
    set_solid(plane_, 48, 1, [](double u, double v) {
      double a = 2 * std::numbers::pi * u;
      return Point(v * std::cos(a), v * std::sin(a), 0);
    });
  }

  /** Take over @a scene, to be drawn from now on. */
  void upload(const SceneData& scene, bool edges_changed) {
    nodes_.set_vertices(scene.nodes);
    if (edges_changed) nodes_.set_indices(scene.edges);
    num_nodes_ = GLsizei(scene.nodes.size());
    spheres_ = scene.spheres;
    planes_ = scene.planes;
    marks_ = scene.marks;
    // A node is a fifth as wide as nodes would be apart, if spread evenly.
    box_ = scene.box();
    const double size = box_.diagonal() > 0 ? box_.diagonal() : 1;
    node_size_ = 0.2 * size / std::sqrt(num_nodes_ + 1.0);
  }

  /** Of the scene. */
  const BoundingBox& box() const { return box_; }

  /** Draw all, over what was there.
   * @param width,height Of the picture [pixels]
   * @param scale        Width of a line [pixels], 1 on a plain screen */
  void draw(const GLCamera& camera, int width, int height, double scale) const {
    glViewport(0, 0, width, height);
    glClear(GL_DEPTH_BUFFER_BIT | GL_COLOR_BUFFER_BIT);
    glDisable(GL_DEPTH_TEST);
    glDisable(GL_BLEND);
    glEnable(GL_PROGRAM_POINT_SIZE);
    ground_.use();
    ground_.set("low", low);
    ground_.set("rise",
                Point(high.r - low.r, high.g - low.g, high.b - low.b) / height);
    plane_.bind();  // any will do
    glDrawArrays(GL_TRIANGLES, 0, 3);

    glEnable(GL_DEPTH_TEST);
    const double aspect = double(width) / height;
    auto use = [&](const GLProgram& p) {
      p.use();
      p.set("view", camera.view());
      p.set("projection", camera.projection(aspect));
    };
    use(sphere_program_);
    sphere_.bind();
    for (const auto& s : spheres_) {
      sphere_program_.set("center", s.center);
      sphere_program_.set("radius", float(s.radius));
      sphere_program_.set("paint", s.color);
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
    };
    use_cloth(edge_program_, 0.75f, 0.99f);
    nodes_.draw(GL_LINES);
    glEnable(GL_SAMPLE_ALPHA_TO_COVERAGE);
    use_cloth(node_program_, 1, 0.985f);  // in front of its edges
    glDrawArrays(GL_POINTS, 0, num_nodes_);
    glDisable(GL_SAMPLE_ALPHA_TO_COVERAGE);

    glEnable(GL_BLEND);
    glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
    glDepthMask(GL_FALSE);
    use(plane_program_);
    plane_.bind();
    for (const auto& p : planes_) {
      plane_program_.set("center", p.center);
      plane_program_.set("radius", float(p.half));
      plane_program_.set("paint", p.color);
      plane_program_.set("lines", 10.0f);
      plane_.draw(GL_TRIANGLES);
    }
    glDepthMask(GL_TRUE);
    glDisable(GL_DEPTH_TEST);
    use(mark_program_);
    mark_program_.set("half_size", float(width) / 2, float(height) / 2);
    mark_program_.set("paint", Color::make_mark());
    for (const auto& m : marks_) {
      const float ring = m.from == m.to ? float(17 * scale) : 0;
      const float thick = float(3.5 * scale), rim = float(1.5 * scale);
      mark_program_.set("from", m.from);
      mark_program_.set("to", m.to);
      mark_program_.set("ring", ring);
      mark_program_.set("width", thick);
      mark_program_.set("rim", rim);
      mark_program_.set("reach", ring + thick / 2 + rim + 1);
      glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
    }
    glBindVertexArray(0);
  }

 private:
  static constexpr Color low{0.055f, 0.067f, 0.09f}, high{0.13f, 0.16f, 0.21f};
  static constexpr Color fog{0.12f, 0.145f, 0.19f};

  GLProgram ground_{gl_detail::ground_vertex, gl_detail::ground_fragment};
  GLProgram node_program_{gl_detail::cloth_vertex, gl_detail::node_fragment};
  GLProgram edge_program_{gl_detail::cloth_vertex, gl_detail::edge_fragment};
  GLProgram sphere_program_{gl_detail::solid_vertex,
                            gl_detail::sphere_fragment};
  GLProgram plane_program_{gl_detail::solid_vertex, gl_detail::plane_fragment};
  GLProgram mark_program_{gl_detail::mark_vertex, gl_detail::mark_fragment};
  GLMesh nodes_, sphere_, plane_;
  GLsizei num_nodes_ = 0;
  std::vector<SceneData::Sphere> spheres_;
  std::vector<SceneData::Plane> planes_;
  std::vector<SceneData::Mark> marks_;
  double node_size_ = 0;
  BoundingBox box_;

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
        triangles.push_back({a, b, a + 1});
        triangles.push_back({b, b + 1, a + 1});
      }
    mesh.set_vertices(vertices);
    mesh.set_indices(triangles);
    glEnableVertexAttribArray(0);
    glVertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, 0, nullptr);
  }
};

}  // namespace CME212
