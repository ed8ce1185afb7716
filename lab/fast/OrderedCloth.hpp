#pragma once
/** @file OrderedCloth.hpp
 * Builds a cloth whose nodes and springs are in memory in an order that is good
 * for sweeps, whatever the order of its mesh. */
#include <span>

#include "mass_spring.hpp"

namespace lab {

/** As build_cloth(), but if the order of the mesh is bad for a cache, nodes and
 * springs lie in memory in Cuthill-McKee order; indices are those of the mesh.
 * @pre and @post as build_cloth(); fewer than 2^32 springs */
void build_ordered_cloth(Cloth& g, std::span<const Point> points,
                         std::span<const Quad> quads, MeshSprings::Kind mesh,
                         double K = 100);

/** At the end of a step: Graph::reindex() if removals put so many nodes of a
 * large cloth out of the order of memory that loops over nodes() become slow.
 * Complexity: O(1) before the first removal, then O(num_nodes()); in all at
 *       most 256 times reindex() until no node is left */
void restore_order(Cloth& g);

}  // namespace lab
