#pragma once
/** @file MouseTool.hpp
 * MouseTool: translates what a user does with the mouse into changes of the
 * scene. It only computes; it needs no window and no OpenGL. */
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "CME212/Point.hpp"
#include "CME212/viewer/GLCamera.hpp"
#include "CME212/viewer/SceneBuilder.hpp"

namespace CME212 {

/** One thing that a user does to a scene. */
struct Touch {
  enum class Kind {
    grab,     ///< grabs node, which must go to at
    move,     ///< the grabbed node must go to at
    release,  ///< releases the grabbed node
    cut,      ///< cuts all edges that cross the triangle at, from, to
    pin,      ///< pins node: the key p
  };
  Kind kind;
  unsigned node = 0;   ///< its index in the scene, in the order of add_nodes()
  Point at = Point();  ///< [m]; the eye, for a cut
  Point from = Point(), to = Point();  ///< behind all that is visible [m]
};

/** A camera's picture; coordinates are [pixels] from the top left corner. */
struct Picture {
  GLCamera camera;
  double width = 1, height = 1;  ///< [pixels]

  double aspect() const { return width / height; }
  /** Where @a p [m] is; z is its distance from the eye's plane [m]. */
  Point place_of(const Point& p) const {
    const Point q = camera.project(p, aspect());
    return {(1 + q.x) * width / 2, (1 - q.y) * height / 2, q.z};
  }
  /** The point [m] at (x, y), @a depth [m] away from the eye's plane. */
  Point point_at(double x, double y, double depth) const {
    return camera.unproject({2 * x / width - 1, 1 - 2 * y / height, depth},
                            aspect());
  }
  /** Pixels that @a length [m] takes at @a depth, across the line of sight. */
  double pixels(double length, double depth) const {
    return length * height / (2 * depth * camera.high(aspect()));
  }
};

/** The mouse on a scene: over a node, holding one, or cutting. */
class MouseTool {
 public:
  /** Work on @a scene from now on.  O(nodes), and O(edges) if they changed */
  void look(const SceneData& scene, bool edges_changed) {
    nodes_ = scene.nodes;
    spheres_ = scene.spheres;
    if (edges_changed) spacing_ = scene.mean_edge();
    for (auto* node : {&over_, &held_})
      if (*node && **node >= nodes_.size()) node->reset();
  }

  /** The node at (x, y): the nearest one within @a near [pixels] or 0.6 edges,
   * unless another node is in front of it, or a ball hides it.  O(nodes) */
  std::optional<unsigned> node_at(const Picture& picture, double x, double y,
                                  double near) const {
    const double ball = depth_of_ball(picture, x, y);
    std::optional<unsigned> best;
    double least = std::numeric_limits<double>::infinity();
    for (unsigned i = 0; i < nodes_.size(); ++i) {
      const Point q = picture.place_of(position(i));
      if (!(q.z > 0) || q.z > ball) continue;
      const double reach = std::max(near, picture.pixels(0.6 * spacing_, q.z));
      const double away = std::hypot(q.x - x, q.y - y) / reach;
      // A depth of four edges counts as much as the reach.
      const double cost =
          away * away + (spacing_ > 0 ? q.z / (4 * spacing_) : 0);
      if (away < 1 && cost < least) least = cost, best = i;
    }
    return best;
  }

  /** The mouse moved to (x, y), nothing pressed. */
  void hover(const Picture& picture, double x, double y, double near) {
    over_ = node_at(picture, x, y, near);
  }
  void leave() { over_.reset(); }

  /** The left button went down at (x, y): grab the node there.
   * @return nothing if there is no node */
  std::optional<Touch> grab(const Picture& picture, double x, double y,
                            double near) {
    held_ = node_at(picture, x, y, near);
    if (!held_) return {};
    over_.reset();
    depth_ = picture.place_of(position(*held_)).z;
    return Touch{Touch::Kind::grab, *held_, picture.point_at(x, y, depth_)};
  }
  /** Move the grabbed node with the mouse; its distance from the eye's plane
   * stays the same.  @pre holds() */
  Touch move(const Picture& picture, double x, double y) const {
    return {Touch::Kind::move, *held_, picture.point_at(x, y, depth_)};
  }
  /** @pre holds() */
  Touch release() {
    const Touch t{Touch::Kind::release, *held_};
    held_.reset();
    return t;
  }
  bool holds() const { return held_.has_value(); }

  /** Begin a cut at (x, y), continue it, end it.
   * @pre cuts(), except for the first */
  void start_cut(double x, double y) {
    over_.reset();
    stroke_ = {{float(x), float(y)}};
  }
  Touch cut(const Picture& picture, double x, double y) {
    const auto [x0, y0] = stroke_.back();
    stroke_.push_back({float(x), float(y)});
    const GLCamera& c = picture.camera;
    const double behind = c.distance() + 10 * std::max(c.extent(), 1.0);
    return {Touch::Kind::cut, 0, c.eye(), picture.point_at(x0, y0, behind),
            picture.point_at(x, y, behind)};
  }
  void end_cut() { stroke_.clear(); }
  bool cuts() const { return !stroke_.empty(); }

  /** The node that the mouse is over or holds, in the picture [pixels]. */
  std::optional<std::array<float, 2>> ring(const Picture& picture) const {
    const auto node = held_ ? held_ : over_;
    if (!node) return {};
    const Point q = picture.place_of(position(*node));
    return std::array{float(q.x), float(q.y)};
  }
  /** The corners of the stroke so far [pixels]. */
  const std::vector<std::array<float, 2>>& stroke() const { return stroke_; }

 private:
  std::vector<SceneData::Vertex> nodes_;
  std::vector<SceneData::Sphere> spheres_;
  double spacing_ = 0;  // mean length of an edge [m]
  std::optional<unsigned> over_, held_;
  double depth_ = 0;  // of the node when it was grabbed [m]
  std::vector<std::array<float, 2>> stroke_;

  Point position(unsigned i) const {
    return {nodes_[i].x, nodes_[i].y, nodes_[i].z};
  }
  /** Where the ray through (x, y) enters the first ball; infinite if none. */
  double depth_of_ball(const Picture& picture, double x, double y) const {
    const Point eye = picture.camera.eye();
    const Point ray = picture.point_at(x, y, 1) - eye;  // to depth 1
    double first = std::numeric_limits<double>::infinity();
    for (const auto& s : spheres_) {
      const Point c = eye - s.center;
      const double a = normSq(ray), b = dot(ray, c);
      const double root = b * b - a * (normSq(c) - s.radius * s.radius);
      if (root > 0 && b < 0)
        first = std::min(first, (-b - std::sqrt(root)) / a);
    }
    return first;
  }
};

}  // namespace CME212
