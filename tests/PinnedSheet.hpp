#pragma once
/** @file PinnedSheet.hpp
 * A sheet for the tests of implicit methods, and what two of them differ by. */
#include <cmath>

#include "lab/fast/ConstraintPlan.hpp"
#include "lab/fast/ForcePlan.hpp"
#include "tests/Momentum.hpp"

namespace lab::sheets {

/** A grid with diagonals, K [N/m]; gravity, springs and drag. */
struct PinnedSheet {
  Cloth g;
  CombinedForces force;
  PinConstraint pin;
  explicit PinnedSheet(unsigned side, double K = 100, double drag = 0)
      : force(make_combined_force(GravityForce(), MassSpringForce(),
                                  DampingForce(drag))),
        pin((build_cloth(g, grid_points(side), grid_quads(side),
                         MeshSprings::diagonals, K),
             g)) {}
  void stir() { ::stir(g); }
  template <typename M>
  void run(M& method, double h, int steps) {
    for (int n = 0; n < steps; ++n) method(g, n * h, h, force, pin);
  }
};

/** The distance of two cloths in positions [m] and velocities times 1 s. */
inline double distance(const Cloth& a, const Cloth& b) {
  double sum = 0;
  for (unsigned i = 0; i < a.num_nodes(); ++i)
    sum += normSq(a.node(i).position() - b.node(i).position()) +
           normSq(a.node(i).value().vel - b.node(i).value().vel);
  return std::sqrt(sum);
}

}  // namespace lab::sheets
