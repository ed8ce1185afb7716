/** @file wasi.cpp
 * Stubs for files, which a page lacks. Compiled for the page only. */
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>

#include "lab/live/Recording.hpp"
#include "lab/scenes/Interrupt.hpp"
#include "lab/scenes/Memory.hpp"
#include "lab/scenes/MeshFile.hpp"
#include "lab/stepping/Checkpoint.hpp"

// A page makes its meshes, and its link holds what was asked of it. It knows no
// signals.

namespace lab {

PointsAndQuads load_mesh(const std::string& nodes, const std::string&) {
  throw InputError(nodes, 0, "a page has no files");
}
double needed_memory(double, double) { return 0; }
double available_memory() { return std::numeric_limits<double>::infinity(); }

int interrupted() { return 0; }
void end_if_interrupted() {}

std::uint64_t checksum_of(const Cloth&) { return 0; }
std::string scene_request(const Model&, std::uint64_t) { return "scene"; }
SceneRequest read_scene(const std::string&, const std::string& file,
                        std::size_t line) {
  throw InputError(file, line, "a page has no files");
}

}  // namespace lab
