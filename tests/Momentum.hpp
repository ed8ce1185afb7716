#pragma once
/** @file Momentum.hpp
 * Momentum and angular momentum of a cloth, for tests. */
#include "mass_spring.hpp"

/** [kg m/s] */
inline Point momentum(const Cloth& g) {
  Point sum;
  for (Node n : g.nodes()) sum += n.value().mass * n.value().vel;
  return sum;
}
/** About the origin [kg m^2/s]. */
inline Point angular_momentum(const Cloth& g) {
  Point sum;
  for (Node n : g.nodes())
    sum += n.value().mass * cross(n.position(), n.value().vel);
  return sum;
}
