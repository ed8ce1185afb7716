#pragma once
/** @file GLCamera.hpp
 * GLCamera: an eye that circles around a point and looks at it. It only
 * computes; the matrices have OpenGL's form. */
#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <numbers>

#include "CME212/BoundingBox.hpp"
#include "CME212/Point.hpp"

namespace CME212 {

/** An orbit camera: +z of the world is always up on the screen.
 * "Aspect" is the width of the picture over its height, > 0. The field of
 * view is fixed in the smaller of the two, so that what fits into a square
 * picture fits into any. */
class GLCamera {
 public:
  /** 4 x 4, column after column. */
  using Matrix = std::array<float, 16>;

  /** Angle between the edges of the picture, in its smaller size [rad]. */
  static constexpr double field_of_view = 0.6;

  /** From the front (-y), a little from the right and from above, at the box
   * in which the course's cloth swings: the unit square and one unit below. */
  GLCamera() {
    look_from(Point(0.45, -1, 0.4));
    fit(usual_box(), 1);
  }
  /** The box that it looks at first. */
  static BoundingBox usual_box() {
    return (BoundingBox() |= Point(0, 0, -1)) |= Point(1, 1, 0);
  }

  /** Look at the same center from @a direction. Keeps: the distance.
   * @pre norm(direction) > 0; straight from above or below is allowed */
  void look_from(const Point& direction) {
    assert(norm(direction) > 0);
    elevation_ = std::atan2(direction.z, std::hypot(direction.x, direction.y));
    azimuth_ = direction.x == 0 && direction.y == 0
                   ? -std::numbers::pi / 2
                   : std::atan2(direction.y, direction.x);
  }

  /** Turn the scene by angles [rad]: to the right about the z axis, and up, at
   * most until the camera looks straight down. */
  void rotate(double right, double up) {
    constexpr double top = std::numbers::pi / 2;
    azimuth_ = std::remainder(azimuth_ - right, 2 * std::numbers::pi);
    elevation_ = std::clamp(elevation_ - up, -top, top);
  }

  /** Move the scene within the picture. Unit: the smaller size of what is
   * seen at the center. */
  void pan(double right, double up) {
    double size = 2 * half_size() * distance_;
    center_ -= size * (right * this->right() + up * this->up());
  }

  /** Zoom: the center of the picture grows by @a factor, within bounds that the
   * last fit() set.  @pre factor > 0 */
  void zoom(double factor) {
    assert(factor > 0);
    distance_ = std::clamp(distance_ / factor, extent_ / 100, extent_ * 100);
  }

  /** Center on @a box and take the distance at which it just fits, with a
   * margin, seen from the present direction. An empty box changes nothing. */
  void fit(const BoundingBox& box, double aspect) {
    assert(aspect > 0);
    if (box.empty()) return;
    constexpr double margin = 1.1;
    center_ = box.center();
    extent_ = box.diagonal() > 0 ? box.diagonal() : 1;
    distance_ = extent_ / 100;
    for (int corner = 0; corner < 8; ++corner) {
      Point p(corner & 1 ? box.min().x : box.max().x,
              corner & 2 ? box.min().y : box.max().y,
              corner & 4 ? box.min().z : box.max().z);
      p -= center_;
      double across =
          std::max(std::abs(dot(p, right())) / (half_height(aspect) * aspect),
                   std::abs(dot(p, up())) / half_height(aspect));
      distance_ = std::max(distance_, dot(p, backward()) + margin * across);
    }
    if (box.diagonal() == 0) distance_ = 2 * extent_;
  }

  /** The point looked at, and its distance from the eye. */
  const Point& center() const { return center_; }
  double distance() const { return distance_; }
  /** Diagonal of the box of the last fit(). */
  double extent() const { return extent_; }
  /** Where the eye is. */
  Point eye() const { return center_ + distance_ * backward(); }
  /** Directions of the picture in the world; unit vectors at right angles. */
  Point right() const { return {-std::sin(azimuth_), std::cos(azimuth_), 0}; }
  Point up() const { return cross(backward(), right()); }
  Point backward() const {
    return {std::cos(elevation_) * std::cos(azimuth_),
            std::cos(elevation_) * std::sin(azimuth_), std::sin(elevation_)};
  }

  /** World to the coordinates along @a axes, which are 0 at @a origin. */
  static Matrix along(const std::array<Point, 3>& axes, const Point& origin) {
    Matrix m{};
    for (int row = 0; row < 3; ++row) {
      for (int column = 0; column < 3; ++column)
        m[4 * column + row] = float(axes[row][column]);
      m[12 + row] = float(-dot(axes[row], origin));
    }
    m[15] = 1;
    return m;
  }
  /** World to eye coordinates (x right, y up, z towards the eye). */
  Matrix view() const { return along({right(), up(), backward()}, eye()); }

  /** Eye to clip coordinates.  @pre aspect > 0 */
  Matrix projection(double aspect) const {
    assert(aspect > 0);
    const double n = near(), f = far();
    Matrix m{};
    m[0] = float(1 / (half_height(aspect) * aspect));
    m[5] = float(1 / half_height(aspect));
    m[10] = float((n + f) / (n - f));
    m[14] = float(2 * n * f / (n - f));
    m[11] = -1;
    return m;
  }

  /** Where @a p is in a picture: x from the left and y from the top [pixels].
   * Not finite if it is behind the eye, or in no place. */
  std::array<double, 2> pixel(const Point& p, int width, int height) const {
    const Point q = p - eye();
    const double depth = -dot(q, backward());
    const double unit = height / (2 * half_height(double(width) / height)) /
                        (depth > 0 ? depth : 0.0);
    return {width / 2.0 + unit * dot(q, right()),
            height / 2.0 - unit * dot(q, up())};
  }

  /** Half of the picture's height at distance 1 from the eye. */
  static double half_height(double aspect) {
    return half_size() / std::min(aspect, 1.0);
  }

 private:
  Point center_;
  double distance_ = 1;
  double azimuth_ = 0;    // of the eye, from +x towards +y [rad]
  double elevation_ = 0;  // of the eye, above the xy plane [rad]
  double extent_ = 1;

  static double half_size() { return std::tan(field_of_view / 2); }
  double near() const { return distance_ / 50; }
  double far() const { return distance_ + 100 * std::max(extent_, distance_); }
};

}  // namespace CME212
