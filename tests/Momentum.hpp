#pragma once
/** @file Momentum.hpp
 * Momentum and angular momentum of a cloth, for tests. */
#include "CME212/Util.hpp"
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
/** Give all nodes velocities of up to 1 m/s along each axis, at random but the
 * same for a @a seed. */
inline void stir(Cloth& g, unsigned seed = 3) {
  CME212::default_generator.seed(seed);
  using CME212::random;
  for (Node n : g.nodes())
    n.value().vel = Point(random(-1, 1), random(-1, 1), random(-1, 1));
}
