#pragma once
/** @file NetFile.hpp
 * Reads a net from the text of one file, and writes it. See data/README.md. */
#include <ostream>
#include <string>
#include <string_view>

#include "lab/scenes/Net.hpp"

namespace lab {

/** The net in @a text, the content of @a file, by the ending of its name:
 *  - .net: write_net()
 *  - .obj: v, f of three or four corners, l (springs)
 *  - .off
 *  - .ply: ASCII or binary; x y z, vx vy vz of vertex, lists of face, vertex1
 *    and vertex2 of edge (springs)
 *  - .stl: ASCII or binary; its corners at the same place are one node
 * By hand: Assimp 5.2.5 gives coordinates in single precision, numbers the
 * nodes of .obj by their faces, names no line, takes a .ply whose face has a
 * node that is not there, and reads no velocities; OpenMesh has no springs.
 * Throws InputError: a wrong line; faces of more than four corners; an index
 * without a node; an ending that is none of these */
Net parse_net(std::string_view text, const std::string& file);

/** Write the lines of a .net file. Reading them gives the same net. */
void write_net(std::ostream& out, const Net& net);

}  // namespace lab
