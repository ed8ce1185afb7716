#pragma once
/** @file Point.hpp
 * Point: a vector of three numbers, with the arithmetic of R^3. */
#include <cstddef>

#include "CME212/Util.hpp"  // includes the other standard headers

/** A point or a vector in R^3. Plain data: three doubles, trivially copyable.
 * p + s adds the scalar s to each coordinate; p * q and p / q act coordinate by
 * coordinate (the scalar product is dot()). */
struct Point {
  using value_type = double;
  using reference = double&;
  using const_reference = const double&;
  using iterator = double*;
  using const_iterator = const double*;
  using size_type = std::size_t;
  using difference_type = std::ptrdiff_t;

  /** The coordinates by name, and the same ones as an array. */
  union {
    struct {
      double x, y, z;
    };
    double elem[3];
  };

  constexpr Point() : Point(0) {}
  /** The point (b, b, b). */
  constexpr explicit Point(double b) : Point(b, b, b) {}
  constexpr Point(double x_, double y_, double z_) : x(x_), y(y_), z(z_) {}

  /** Coordinate @a i.  @pre i < 3 */
  constexpr double& operator[](size_type i) {
    assert(i < 3);
    return i == 0 ? x : i == 1 ? y : z;
  }
  constexpr const double& operator[](size_type i) const {
    assert(i < 3);
    return i == 0 ? x : i == 1 ? y : z;
  }
  /** The three coordinates as an array. */
  double* data() { return &x; }
  const double* data() const { return &x; }
  iterator begin() { return &x; }
  iterator end() { return &x + 3; }
  const_iterator begin() const { return &x; }
  const_iterator end() const { return &x + 3; }
  const_iterator cbegin() const { return begin(); }
  const_iterator cend() const { return end(); }
  /** x, and z. */
  constexpr double& front() { return x; }
  constexpr const double& front() const { return x; }
  constexpr double& back() { return z; }
  constexpr const double& back() const { return z; }
  static constexpr size_type size() { return 3; }
  static constexpr bool empty() { return false; }

  /** Exact equality, coordinate by coordinate. */
  constexpr bool operator==(const Point& b) const {
    return x == b.x && y == b.y && z == b.z;
  }

  constexpr Point& operator+=(const Point& b) {
    return x += b.x, y += b.y, z += b.z, *this;
  }
  constexpr Point& operator-=(const Point& b) {
    return x -= b.x, y -= b.y, z -= b.z, *this;
  }
  constexpr Point& operator*=(const Point& b) {
    return x *= b.x, y *= b.y, z *= b.z, *this;
  }
  constexpr Point& operator/=(const Point& b) {
    return x /= b.x, y /= b.y, z /= b.z, *this;
  }
  constexpr Point& operator+=(double b) { return *this += Point(b); }
  constexpr Point& operator-=(double b) { return *this -= Point(b); }
  constexpr Point& operator*=(double b) { return *this *= Point(b); }
  constexpr Point& operator/=(double b) { return *this /= Point(b); }
};
static_assert(sizeof(Point) == 3 * sizeof(double));  // begin() counts on it

constexpr Point operator+(const Point& a) { return a; }
constexpr Point operator-(const Point& a) { return {-a.x, -a.y, -a.z}; }
constexpr Point operator+(Point a, const Point& b) { return a += b; }
constexpr Point operator+(Point a, double b) { return a += b; }
constexpr Point operator+(double b, Point a) { return a += b; }
constexpr Point operator-(Point a, const Point& b) { return a -= b; }
constexpr Point operator-(Point a, double b) { return a -= b; }
constexpr Point operator-(double b, const Point& a) { return Point(b) -= a; }
constexpr Point operator*(Point a, const Point& b) { return a *= b; }
constexpr Point operator*(Point a, double b) { return a *= b; }
constexpr Point operator*(double b, Point a) { return a *= b; }
constexpr Point operator/(Point a, const Point& b) { return a /= b; }
constexpr Point operator/(Point a, double b) { return a /= b; }

/** The vector product a x b. */
constexpr Point cross(const Point& a, const Point& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
/** The scalar product a . b. */
constexpr double dot(const Point& a, const Point& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
constexpr double inner_prod(const Point& a, const Point& b) {
  return dot(a, b);
}
/** |a|^2 */
constexpr double normSq(const Point& a) { return dot(a, a); }
/** The Euclidean length |a|. */
inline double norm(const Point& a) { return std::sqrt(normSq(a)); }
inline double norm_2(const Point& a) { return norm(a); }
/** |a.x| + |a.y| + |a.z| */
inline double norm_1(const Point& a) {
  return std::abs(a.x) + std::abs(a.y) + std::abs(a.z);
}
/** max(|a.x|, |a.y|, |a.z|) */
inline double norm_inf(const Point& a) {
  return std::max({std::abs(a.x), std::abs(a.y), std::abs(a.z)});
}

/** Write "x y z". */
inline std::ostream& operator<<(std::ostream& s, const Point& a) {
  return s << a.x << ' ' << a.y << ' ' << a.z;
}
/** Read three numbers separated by white space; @a s fails on anything else. */
inline std::istream& operator>>(std::istream& s, Point& a) {
  return s >> a.x >> a.y >> a.z;
}
