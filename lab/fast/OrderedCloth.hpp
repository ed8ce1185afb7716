#pragma once
/** @file OrderedCloth.hpp
 * Builds a cloth in a good order in memory, whatever the order of its mesh: a
 * sweep is fast if neighbors are in the cache together. See docs/graph.md. */
#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "mass_spring.hpp"

namespace lab {

/** As build_cloth(), but if the order of the mesh is bad for a cache, nodes and
 * springs lie in memory in Cuthill-McKee order; indices are those of the mesh.
 * @pre and @post as build_cloth(); fewer than 2^32 springs */
void build_ordered_cloth(Cloth& g, std::span<const Point> points,
                         std::span<const Quad> quads, MeshSprings::Kind mesh,
                         double K = 100);

/** At the end of a step: GraphArrays::reindex() if removals put so many nodes
 * of a large cloth out of the order of memory that loops over nodes() become
 * slow. Complexity: O(1) before the first removal, then O(num_nodes()); in all
 * at most 256 times reindex() until no node is left */
void restore_order(Cloth& g);

// ---- How the order is found

/** True if the order of @a quads is good for a cache: no corner of a quad lies
 * farther than @a near from all corners of the quad before. One quad in sixteen
 * may be an exception.  O(quads)
 * @param near the positions of 1000 points are 24 kB */
bool is_local(std::span<const Quad> quads, unsigned near = 1000);

/** All points and all quads of a mesh, by number, in the order of memory. */
struct MeshOrder {
  std::vector<unsigned> points, quads;
};

/** Breadth-first (Cuthill-McKee) order of the points and quads of a mesh, from
 * a corner of it; points found from the same point come by their number of
 * quads. So the points of a quad are as close to each other as the front of the
 * search is long. Where the quads make up a grid, they lie at constant offsets
 * over long runs, as in a grid that is numbered row by row.
 * @pre the indices in @a quads are below @a num_points
 * Complexity: O(points + quads) if no point is in very many quads
 * Source: E. Cuthill, J. McKee, Proc. 24th Nat. Conf. ACM (1969) 157,
 * doi:10.1145/800195.805928. */
MeshOrder cuthill_mckee(std::size_t num_points, std::span<const Quad> quads);

/** The quads in the order of memory, each with the places of its points there
 * instead of their numbers.  O(points + quads) */
std::vector<Quad> in_order(std::span<const Quad> quads, const MeshOrder& order);

/** The springs in the order of memory: the first spring of each point, then the
 * second ones, and so on, each counted with its end of lower number and sorted
 * by the other end. So on a grid the springs of one direction follow each
 * other. Of those with the same ends there is only one, the first by number.
 * @param number number(s) is a different one for each spring s
 * @pre springs.size() < 2^32
 * Complexity: O(points + springs log(largest degree)) */
std::vector<unsigned> sorted_springs(
    const MeshSprings& springs, std::size_t num_points,
    const std::function<unsigned(unsigned)>& number);

}  // namespace lab
