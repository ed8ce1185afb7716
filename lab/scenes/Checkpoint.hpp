#pragma once
/** @file Checkpoint.hpp
 * The file from which a run goes on. lab/README.md says how to use it. */
#include <cstdint>
#include <string>
#include <string_view>

#include "lab/Archive.hpp"
#include "mass_spring.hpp"

namespace lab {

struct Model;

/** CRC-64/XZ of @a bytes; or of what had the checksum @a before and @a bytes:
 * the polynomial of ECMA-182, reflected. Any change of up to 64 bits in a row
 * is found, any other one but for one in 2^64.  O(bytes) */
std::uint64_t crc64(std::string_view bytes, std::uint64_t before = 0);

/** The crc64() of nodes and springs of a cloth as it was made.  O(N) */
std::uint64_t checksum_of(const Cloth& g);

/** Write what @a saved holds to @a file, whole or not at all, and until it is
 * on the disk: a line with the version, the length, the bytes, the checksum of
 * all that.  Throws std::runtime_error "FILE: why" */
void write_checkpoint(const std::string& file, const Archive& saved);

/** What was saved in @a file, to load.
 * Throws std::runtime_error "FILE: why": it can't be read, is no checkpoint,
 * one of another version or of another precision, too short, damaged. */
Archive read_checkpoint(const std::string& file);

/** The scene that archive_scene() saved first of all. */
struct SavedScene {
  std::string name, text;     ///< of a scene file
  double step_tolerance = 0;  ///< TimeStep::tolerance, which is not in it
};
/** That of a checkpoint.  Throws as read_checkpoint() */
SavedScene scene_in_checkpoint(const std::string& file);

/** Save or load the scene @a m whose cloth starts as @a g: its
 * name, its file, a checksum of the cloth.
 * Throws SceneError: what is loaded is another scene. t-end, and what does not
 * change the run (measure, tolerance, view), may differ. */
void archive_scene(Archive& a, const Model& m, const Cloth& g);

/** Save or load the state of a cloth that has lost nodes and edges since it was
 * made: who is left, all orders, positions, velocities and masses.
 * @pre of loading: @a g is as it was made. Springs are the same
 * @post of loading: every id, index and order of edges is as it was
 * Throws std::runtime_error: what is loaded does not belong to @a g.
 * Complexity: O(nodes + edges), if no node that lost an edge has very many */
void archive_cloth(Archive& a, Cloth& g);

}  // namespace lab
