#pragma once
/** @file Checkpoint.hpp
 * Checkpoints: files from which a run continues. See lab/README.md. */
#include <cstdint>
#include <string>
#include <string_view>

#include "lab/fast/Archive.hpp"
#include "mass_spring.hpp"

namespace lab {

struct Model;

/** CRC-64/XZ of @a bytes: the polynomial of ECMA-182, reflected. Detects all
 * burst errors of up to 64 bits, and all but one in 2^64 of the others.
 * @param before checksum of the bytes in front of these.  O(bytes) */
std::uint64_t crc64(std::string_view bytes, std::uint64_t before = 0);

/** The crc64() of the nodes and springs of a new cloth.  O(N) */
std::uint64_t checksum_of(const Cloth& g);

/** Write @a saved to @a file, which appears when it is complete and on disk: a
 * line with the version, the length, the bytes, and a checksum of all three.
 * Throws std::runtime_error "FILE: why" */
void write_checkpoint(const std::string& file, const Archive& saved);

/** The archive in @a file, ready to load from.
 * Throws std::runtime_error "FILE: why" if it can't be read, is no checkpoint,
 * is of another version, too short, or damaged. */
Archive read_checkpoint(const std::string& file);

/** What archive_scene() saves first. */
struct SavedScene {
  std::string name, text;     ///< Model::name; to_scene_file()
  double step_tolerance = 0;  ///< TimeStep::tolerance, not in the text
};
/** The scene of a checkpoint.  Throws as read_checkpoint() */
SavedScene scene_in_checkpoint(const std::string& file);

/** Save the scene @a m, whose cloth starts as @a g: its name, its text, a
 * checksum of the cloth. Or load a scene and compare it with @a m.
 * Throws SceneError if they differ; but t-end, measure, tolerance and view,
 * which do not change the steps, may differ. */
void archive_scene(Archive& a, const Model& m, const Cloth& g);

/** Save or load what changes in a cloth that may lose nodes and edges: which
 * are left, all orders, positions, velocities and masses, but no springs.
 * @pre of loading: @a g is as it was built
 * @post of loading: all ids, indices and orders of edges are the saved ones
 * Throws std::runtime_error: what is loaded does not belong to @a g.
 * Complexity: O(nodes + edges), if nodes that lost an edge have few */
void archive_cloth(Archive& a, Cloth& g);

}  // namespace lab
