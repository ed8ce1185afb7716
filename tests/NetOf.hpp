#pragma once
/** @file NetOf.hpp
 * A scene from a cloth that a test has built. */
#include "lab/fast/ConstraintPlan.hpp"
#include "lab/scenes/Net.hpp"

namespace lab {

/** The state of @a g as a net, in which the nodes that @a constraint holds are
 * held. */
inline Net net_of(const Cloth& g, const ConstraintPlan& constraint = {}) {
  Net net;
  for (Node n : g.nodes()) {
    net.points.push_back(n.position());
    net.velocities.push_back(n.value().vel);
    net.masses.push_back(n.value().mass);
  }
  for (Edge e : g.edges())
    net.springs.push_back(
        {e.node1().index(), e.node2().index(), e.value().K, e.value().L});
  constraint.each_held(g, [&net](Node n) { net.held.push_back(n.index()); });
  return net;
}

}  // namespace lab
