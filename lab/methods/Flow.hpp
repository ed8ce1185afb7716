#pragma once
/** @file Flow.hpp
 * The two flows that explicit methods are composed of, drift and kick, and how
 * a step goes through the cloth once for both. */
#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include "lab/fast/ConstraintPlan.hpp"
#include "lab/fast/Sweep.hpp"

namespace lab {

/** The flow of x' = v, m v' = -c v over @a h, solved exactly; h may be < 0. */
inline void drift(Cloth& g, const Part& part, double h, double c) {
  Point* x = g.positions().data();
  NodeData* node = g.node_values().data();
  unsigned i = part.first;
  if (c == 0) {
    const unsigned blocks = (part.last - part.first) / lanes::width;
    lanes::run<kernels::DriftBlocks>(x + i, node + i, blocks, Real(h));
    for (i += blocks * lanes::width; i < part.last; ++i)
      x[i] += h * node[i].vel;
    return;
  }
  double mass = 0, decay = 1, way = h;  // most nodes weigh the same
  for (; i < part.last; ++i) {
    if (node[i].mass != mass) {
      mass = node[i].mass;
      way = -std::expm1(-c / mass * h) * mass / c;
      decay = std::exp(-c / mass * h);
    }
    x[i] += way * node[i].vel;
    node[i].vel *= decay;
  }
}

/** v += h f / m.  @param f [N], that on part.first first */
inline void kick(Cloth& g, const Part& part, double h,
                 std::span<const Point> f) {
  NodeData* node = &g.node_values()[part.first];
  const unsigned count = part.last - part.first;
  const unsigned blocks = count / lanes::width;
  lanes::run<kernels::KickBlocks>(node, f.data(), blocks, Real(h));
  for (unsigned k = blocks * lanes::width; k < count; ++k)
    node[k].vel += (h / node[k].mass) * f[k];
}

/** Take linear drag, which drift() takes care of, out of @a f. */
inline void without_drag(const Part& part, const ForcePlan& force,
                         std::span<Point> f) {
  const double c = force.drag();
  if (c == 0) return;
  const NodeData* node = &part.g.node_values()[part.first];
  for (unsigned k = 0; k < part.last - part.first; ++k) f[k] += c * node[k].vel;
}

/** @a move(part) for all parts of @a g; then the constraint; then all forces
 * at time @a t, and @a use(part, forces on it). In one way through memory if
 * the constraint mends node by node.
 * @param f none, or a list for all forces, by node id */
template <typename Move, typename Use, typename... List>
void move_and_sweep(Sweep& sweep, Cloth& g, double t, const ForcePlan& force,
                    const ConstraintPlan& constraint, Move move, Use use,
                    List&... f) {
  if (constraint.nodewise()) {
    auto move_and_mend = [&](const Part& part) {
      move(part);
      constraint.project(g, t, part.first, part.last);
    };
    sweep.after(move_and_mend, g, t, force, f..., use);
  } else {
    sweep.parts(g, move);
    constraint(g, t);
    sweep(g, t, force, f..., use);
  }
}

/** All forces but linear drag into @a f, by node id. */
inline void sweep_without_drag(Sweep& sweep, const Cloth& g, double t,
                               const ForcePlan& force, std::vector<Point>& f) {
  sweep(g, t, force, f, [&](const Part& part, std::span<Point> here) {
    without_drag(part, force, here);
  });
}

}  // namespace lab
