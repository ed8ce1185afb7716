// A force of your own, by a method of the laboratory.
#include <iostream>
#include "lab/methods/Splitting.hpp"
/** Wind: drag relative to air that moves at velocity w: f = -c (v - w) [N]. */
struct WindForce {
  double c;  // [kg/s]
  Point w;   // [m/s]
  Point operator()(Node n, double /*t*/) const {
    return -c * (n.value().vel - w);
  }
};
int main() {
  Cloth g;
  build_cloth(g, grid_points(25), grid_quads(25), MeshSprings::diagonals);
  const auto force =
      make_combined_force(GravityForce(), MassSpringForce(),
                          WindForce{1.0 / g.num_nodes(), Point(0, 10, 0)});
  const auto constraint = make_combined_constraints(PinConstraint(g));
  lab::Verlet method;
  const double dt = 0.001;  // [s]
  for (int k = 0; k < 1000; ++k) method(g, k * dt, dt, force, constraint);
  std::cout << "center of mass: " << lab::center_of_mass(g) << " m\n";
}
