#pragma once
/** @file Flow.hpp
 * The two flows that explicit methods are composed of, drift and kick, and how
 * a step goes through the cloth once for both. */
#include <span>
#include <vector>

#include "lab/fast/ConstraintPlan.hpp"
#include "lab/fast/Sweep.hpp"

namespace lab {

/** The flow of x' = v, m v' = -c v over @a h, solved exactly for each node's c;
 * h may be < 0. */
void drift(Cloth& g, const Part& part, double h, const Drag& c);

/** v += h f / m.  @param f [N], that on part.first first */
void kick(Cloth& g, const Part& part, double h, std::span<const Point> f);

/** Take linear drag, which drift() takes care of, out of @a f. */
void without_drag(const Part& part, const ForcePlan& force, std::span<Point> f);

/** @a move(part) for all parts of @a g; then the constraint; then all forces
 * at time @a t, and @a use(part, forces on it). If the constraint is nodewise,
 * the data go through the cache once.
 * @param f none, or a list for all forces, by node id */
template <typename Move, typename Use, typename... List>
void move_and_sweep(Sweep& sweep, Cloth& g, double t, const ForcePlan& force,
                    const ConstraintPlan& constraint, Move move, Use use,
                    List&... f) {
  if (constraint.nodewise()) {
    auto move_and_project = [&](const Part& part) {
      move(part);
      constraint.project(g, t, part.first, part.last);
    };
    sweep.after(move_and_project, g, t, force, f..., use);
  } else {
    sweep.parts(g, move);
    constraint(g, t);
    sweep(g, t, force, f..., use);
  }
}

/** All forces but linear drag into @a f, by node id. */
void sweep_without_drag(Sweep& sweep, const Cloth& g, double t,
                        const ForcePlan& force, std::vector<Point>& f);

}  // namespace lab
