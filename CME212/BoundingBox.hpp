#pragma once
/** @file BoundingBox.hpp
 * BoundingBox: the smallest box along the axes that holds some points. */
#include <algorithm>
#include <cmath>
#include <limits>

#include "CME212/Point.hpp"

namespace CME212 {

/** An axis-parallel box in R^3, empty at first. */
class BoundingBox {
 public:
  BoundingBox() = default;

  /** True until the first point came. */
  bool empty() const { return min_.x > max_.x; }

  /** Grow to hold @a p. Points that are not finite are left out. */
  BoundingBox& operator|=(const Point& p) {
    for (double a : p)
      if (!std::isfinite(a)) return *this;
    for (Point::size_type i = 0; i < 3; ++i) {
      min_[i] = std::min(min_[i], p[i]);
      max_[i] = std::max(max_[i], p[i]);
    }
    return *this;
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
