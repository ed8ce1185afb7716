#pragma once
/** @file OrderedCloth.hpp
 * Puts a cloth in a good order in memory, whatever the order of its mesh: a
 * sweep is fast if neighbors are in the cache together. See docs/graph.md. */
#include "mass_spring.hpp"

namespace lab {

/** If the order of @a g in memory is bad for a cache, put the nodes there in
 * Cuthill-McKee order: breadth-first over the springs, from a corner; nodes
 * found from the same node come by degree. So the ends of a spring are as close
 * to each other as the front of the search is long; in a grid they lie at
 * constant offsets over long runs. The springs follow: the first spring of each
 * node, then the second ones, and so on, each counted with its end of lower
 * place and sorted by the other. All indices stay.
 * Invalidates: every Node, Edge, iterator and reference.
 * Complexity: O(nodes + springs log springs), and a copy of @a g
 * Source: E. Cuthill, J. McKee, Proc. 24th Nat. Conf. ACM (1969) 157,
 * doi:10.1145/800195.805928. */
void order_in_memory(Cloth& g);

/** True if the order of the springs in memory is good for a cache: no end lies
 * farther than 1000 nodes (their positions are 24 kB) from both ends of the
 * spring before. One in sixteen may be an exception.  O(springs) */
bool is_local(const Cloth& g);

/** At the end of a step: GraphArrays::reindex() if removals put so many nodes
 * of a large cloth out of the order of memory that loops over nodes() become
 * slow. Complexity: O(1) before the first removal, then O(num_nodes()); in all
 * at most 256 times reindex() until no node is left */
void restore_order(Cloth& g);

}  // namespace lab
