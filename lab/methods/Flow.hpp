#pragma once
/** @file Flow.hpp
 * The two flows that explicit methods are composed of, drift and kick. */
#include <span>
#include <vector>

#include "lab/fast/Sweep.hpp"

namespace lab {

/** The flow of x' = v, m v' = -c v over @a h, solved exactly for each node's c;
 * h may be < 0. */
void drift(Cloth& g, const Part& part, double h, const Drag& c);

/** v += h f / m.  @param f [N], that on part.first first */
void kick(Cloth& g, const Part& part, double h, std::span<const Point> f);

/** Take linear drag, which drift() takes care of, out of @a f. */
void without_drag(const Part& part, const ForcePlan& force, std::span<Point> f);

/** All forces but linear drag into @a f, by node id. */
void sweep_without_drag(Sweep& sweep, const Cloth& g, double t,
                        const ForcePlan& force, std::vector<Point>& f);

}  // namespace lab
