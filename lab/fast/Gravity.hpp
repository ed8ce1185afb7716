#pragma once
/** @file Gravity.hpp
 * Gravity: an acceleration of free fall in any direction. */
#include <cmath>

#include "mass_spring.hpp"

namespace lab {

/** The acceleration of free fall. A number acts downwards, along -z, whatever
 * its sign: engines write -9.81, the assignment 9.81. */
struct Gravity {
  Point a;  ///< [m/s^2]
  /** @param g [m/s^2] */
  Gravity(double g = grav) : a(0, 0, -std::abs(g)) {}
  explicit Gravity(const Point& vector) : a(vector) {}

  double size() const { return is_down() ? -a.z : norm(a); }
  /** Along -z, or 0: a number says it. */
  bool is_down() const { return a.x == 0 && a.y == 0 && a.z <= 0; }
  bool operator==(const Gravity&) const = default;
};

/** The part of a weight in the plane of x and y; GravityForce is that in z. */
struct SidewaysForce : ZeroForce {
  double x, y;  ///< [m/s^2]
  SidewaysForce(double x, double y) : x(x), y(y) {}
  Point operator()(Node n, double /*t*/) const override {
    return n.value().mass * Point(x, y, 0);
  }
};

}  // namespace lab
