/** @file wasi.cpp
 * Stubs for files, which a page lacks. Compiled for the page only. */
#include <limits>
#include <string>

#include "lab/scenes/Interrupt.hpp"
#include "lab/scenes/Memory.hpp"
#include "lab/scenes/MeshFile.hpp"

// A page makes its meshes. It knows no signals.

namespace lab {

Net load_mesh(const std::string& nodes, const std::string&) {
  throw InputError(nodes, 0, "a page has no files");
}
double needed_memory(double, double) { return 0; }
double available_memory() { return std::numeric_limits<double>::infinity(); }

int interrupted() { return 0; }
void end_if_interrupted() {}

}  // namespace lab
