/** @file wasi.cpp
 * What a page lacks: exceptions, and files. Compiled for the page only. */
#include <cstddef>
#include <cstdlib>
#include <exception>
#include <limits>
#include <stdexcept>
#include <string>
#include <typeinfo>

#include "lab/Interrupt.hpp"
#include "lab/live/Recording.hpp"
#include "lab/scenes/Checkpoint.hpp"
#include "lab/scenes/Memory.hpp"
#include "lab/scenes/MeshFile.hpp"

// ----------------------------------------------------------------- Exceptions
// clang++ leaves out what a catch does. So a throw ends the call of the page by
// a trap, and the page asks what was thrown. Our sources need no other word.

namespace {
const char* thrown = "";
}

extern "C" {

/** what() of what ended the last call; "" if it was another fault. */
const char* page_thrown() { return thrown; }

void* __cxa_allocate_exception(std::size_t size) { return std::malloc(size); }
void __cxa_free_exception(void*) {}

/** All that is thrown here is a std::exception. */
[[noreturn]] void __cxa_throw(void* object, std::type_info*, void (*)(void*)) {
  thrown = static_cast<const std::exception*>(object)->what();
  __builtin_trap();
}
}

// ---------------------------------------------------------------------- Files
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
