#pragma once
/** @file MeshFile.hpp
 * Reads and writes the files of a mesh: those of CME212/Mesh.hpp, in which a
 * point may also have a velocity. See data/README.md. */
#include <ostream>
#include <string>
#include <vector>

#include "lab/scenes/Net.hpp"

namespace lab {

/** The points of a .nodes file, and their velocities if it has them: "x y z"
 * [m] in each line, or "x y z vx vy vz" [m, m/s] in each.
 * @param text the whole file   @param file its name, for messages
 * @return a mesh without quads
 * Throws InputError: any other line, lines of both kinds, or no line. */
Net parse_nodes(std::string_view text, const std::string& file);

/** The mesh in the files @a nodes and @a cells: quads; by the ending .tris,
 * triangles; .edges, springs. Without @a cells, parse_net() of one file. Quads
 * listed around get the order of Quad, faces listed twice and springs listed
 * from both ends count once, indices that start at 1 are made to start at 0:
 * Net::notes.
 * Throws InputError, also if one can't be read. */
Net load_mesh(const std::string& nodes, const std::string& cells);
/** Of two equal springs of @a net, one from i to j and one from j to i, as a
 * matrix of neighbors has them, leave the one with i < j; a note says how many
 * others were there.  O(springs log springs) */
void join_ends(Net& net);
/** True if the springs of a cloth from @a nodes and @a cells are not those of
 * quads, so that write_quads() can't hold them. */
bool needs_net(const std::string& nodes, const std::string& cells);

/** Write the lines of a .nodes file, with velocities if @a mesh has them, and
 * of a .tets file. Reading them gives the same numbers. */
void write_nodes(std::ostream& out, const Net& mesh);
void write_quads(std::ostream& out, const Net& mesh);

/** The .tets file that belongs to the file of points @a nodes: A.tets to
 * A.nodes, else A.tets to A; "" to A.net, a pipe or a device. */
std::string quads_beside(const std::string& nodes);

/** The absolute path of @a file. */
std::string absolute(const std::string& file);

}  // namespace lab
