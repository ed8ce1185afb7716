#pragma once
/** @file Energy.hpp
 * Energies of a cloth, its mass, its center, and the stiffness of its springs.
 * Sums run over the graph's arrays, in the order of memory. */
#include "lab/fast/Gravity.hpp"
#include "mass_spring.hpp"

namespace lab {

// -------------------------------------------------------------------- Springs

/** The derivative of the force between two nodes with respect to u = x_j - x_i:
 * the force on i changes by B du, that on j by -B du, where B = along n n^T +
 * across (I - n n^T) is the Hessian of the energy in u. */
struct Stiffness {
  Point direction;    ///< n, of length 1
  double along = 0;   ///< [N/m]
  double across = 0;  ///< [N/m]; may be negative
  /** B u [N].  @param u [m] */
  Point operator*(const Point& u) const {
    return across * u + ((along - across) * dot(direction, u)) * direction;
  }
};

/** The stiffness of a spring whose ends lie @a u [m] apart: K along it and
 * K (1 - L/l) across, negative while it is compressed. At l = 0, where no
 * direction is defined, K in all directions: the limit for L = 0, and an upper
 * bound for L > 0, since no direction is stiffer than K. */
inline Stiffness spring_stiffness(const Point& u, const EdgeData& s) {
  double l = norm(u);
  if (l == 0) return {Point(1, 0, 0), s.K, s.K};
  return {u / l, s.K, s.K * (1 - s.L / l)};
}

/** The energy [J] of a spring of length @a l [m]: K (l - L)^2 / 2. */
inline double spring_energy(double l, const EdgeData& s) {
  return 0.5 * s.K * (l - s.L) * (l - s.L);
}

/** Which way a spring acts: a cable pulls only, a strut pushes only. */
enum class Acts : signed char { pushes = -1, both = 0, pulls = 1 };

// ------------------------------------------------------------------- Energies

/** Sum of m |v|^2 / 2 [J].  O(N) */
double kinetic_energy(const Cloth& g);

/** Minus the sum of m a . x [J], zero at the origin.  O(N) */
double gravitational_energy(const Cloth& g, const Gravity& gravity = grav);

/** Sum of the springs' energies [J].  O(number of edges) */
double elastic_energy(const Cloth& g);

/** Total mass [kg].  O(N) */
double total_mass(const Cloth& g);

/** The sum of m x [kg m].  O(N) */
Point first_moment(const Cloth& g);

/** Center of mass [m]; the origin for a cloth without nodes.  O(N) */
Point center_of_mass(const Cloth& g);

/** The highest speed of a node [m/s]; 0 for a cloth without nodes.  O(N) */
double max_speed(const Cloth& g);

}  // namespace lab
