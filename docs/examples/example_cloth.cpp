// A cloth by plain calls: two files, three forces, two constraints, a loop.
#include <iostream>
#include "mass_spring.hpp"
int main() {
  Cloth g;
  const auto points = load_points("data/grid1.nodes");
  const auto quads = load_quads("data/grid1.tets", points.size());
  build_cloth(g, points, quads, MeshSprings::diagonals);
  const auto force = make_combined_force(GravityForce(), MassSpringForce(),
                                         DampingForce(1.0 / g.num_nodes()));
  const auto constraint =
      make_combined_constraints(PinConstraint(g), PlaneConstraint());
  const double dt = 0.001;  // [s]
  double t = 0;
  while (t < 1) t = symp_euler_step(g, t, dt, force, constraint);
  double lowest = 0;  // [m]
  for (Node n : g.nodes()) lowest = std::min<double>(lowest, n.position().z);
  std::cout << "at t = " << t << " s the lowest node is at z = " << lowest
            << " m\n";
}
