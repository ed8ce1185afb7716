#pragma once
/** @file OrderedCloth.hpp
 * A cloth whose nodes and springs lie in memory in an order that is good for
 * sweeps, whatever the order of its mesh. */
#include <span>

#include "mass_spring.hpp"

namespace lab {

/** As build_cloth(), but if the order of the mesh is bad for a cache, nodes and
 * springs lie in memory in Cuthill-McKee order; indices are those of the mesh.
 * @pre and @post as build_cloth(); fewer than 2^32 springs */
void build_ordered_cloth(Cloth& g, std::span<const Point> points,
                         std::span<const Quad> quads, Mesh mesh,
                         double K = 100);

}  // namespace lab
