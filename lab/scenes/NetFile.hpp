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
 *  - .vtp: as ./cloth --vtp writes, and others with arrays that are ascii or
 *    binary, neither compressed nor appended
 * By hand: Assimp has coordinates in single precision, renumbers the nodes and
 * has no lines for messages; each of these formats takes 30 lines.
 * Throws InputError: a wrong line; faces of more than four corners; an index
 * without a node; an ending that is none of these */
Net parse_net(std::string_view text, const std::string& file);

/** Write the lines of a .net file. Reading them gives the same net. */
void write_net(std::ostream& out, const Net& net);

}  // namespace lab
