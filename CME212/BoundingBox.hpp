#pragma once
/** @file BoundingBox.hpp
 * BoundingBox: the smallest box along the axes that holds some points. */
#include <span>

#include "CME212/Point.hpp"

namespace CME212 {

/** An axis-parallel, closed box in R^3. All functions take O(1). */
class BoundingBox {
 public:
  /** The empty box. */
  BoundingBox() = default;
  /** The box of one point, or of any two opposite corners. Points that are not
   * finite are ignored. */
  explicit BoundingBox(const Point& p) { *this |= p; }
  BoundingBox(const Point& p, const Point& q) { (*this |= p) |= q; }
  /** The box of all @a points.  O(points) */
  explicit BoundingBox(std::span<const Point> points) {
    for (const Point& p : points) *this |= p;
  }

  /** True if it has no finite point. */
  bool empty() const { return min_.x > max_.x; }

  /** Grow to contain @a p, if @a p is finite. */
  BoundingBox& operator|=(const Point& p) {
    for (double a : p)
      if (!std::isfinite(a)) return *this;
    for (Point::size_type i = 0; i < 3; ++i) {
      min_[i] = std::min(min_[i], p[i]);
      max_[i] = std::max(max_[i], p[i]);
    }
    return *this;
  }

  /** Grow to contain @a b. */
  BoundingBox& operator|=(const BoundingBox& b) {
    return b.empty() ? *this : (*this |= b.min_) |= b.max_;
  }

  /** True if @a p is in the box or on a face of it. False for a point that is
   * not finite, and for the empty box. */
  bool contains(const Point& p) const {
    for (Point::size_type i = 0; i < 3; ++i)
      if (!(min_[i] <= p[i] && p[i] <= max_[i])) return false;
    return true;
  }
  /** True if every point of @a b is in this box; always, if @a b is empty. */
  bool contains(const BoundingBox& b) const {
    return b.empty() || (contains(b.min_) && contains(b.max_));
  }

  /** Corners.  @pre !empty() */
  const Point& min() const { return min_; }
  const Point& max() const { return max_; }
  /** Middle; the origin for an empty box. */
  Point center() const { return empty() ? Point() : (min_ + max_) / 2; }
  /** Length of the diagonal; 0 for an empty box. */
  double diagonal() const { return empty() ? 0 : norm(max_ - min_); }

 private:
  Point min_{std::numeric_limits<double>::infinity()};
  Point max_{-std::numeric_limits<double>::infinity()};
};

}  // namespace CME212

/** Its name in the course. */
using Box3D = CME212::BoundingBox;
