#pragma once
/** @file SweptForces.hpp
 * Forces as methods evaluate them, for tests. */
#include <vector>

#include "lab/fast/FlatFlow.hpp"
#include "lab/fast/GraphArrays.hpp"

namespace lab {

/** The forces [N] on @a g at time 0, by node id; none on removed nodes.
 * @param flow may have seen another cloth before */
inline std::vector<Point> swept_forces(Cloth& g, const ForcePlan& force,
                                       FlatFlow& flow) {
  flow.accelerate(g, 0, force, false);
  std::vector<Point> f(arrays(g).node_slots());
  for (Node n : g.nodes())
    f[n.id()] = n.value().mass * flow.acceleration(n.id());
  return f;
}
inline std::vector<Point> swept_forces(Cloth& g, const ForcePlan& force) {
  FlatFlow flow;
  return swept_forces(g, force, flow);
}

/** MassSpringForce as a force of the laboratory, to derive from. */
struct SweptSprings : SweptForce {
  ForcePlan springs = MassSpringForce();
  Point operator()(Node n, double t) const override {
    return MassSpringForce()(n, t);
  }
  double energy(const Cloth& g) const override { return springs.energy(g); }
  bool add_stiffness(const Cloth& g,
                     const StiffnessVisitor& use) const override {
    return springs.add_stiffness(g, use);
  }
};

}  // namespace lab
