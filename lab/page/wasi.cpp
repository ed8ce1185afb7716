/** @file wasi.cpp
 * Stubs for what a page lacks: files, and statics, which none of its scenes
 * asks for. Compiled for the page only. */
#include <limits>
#include <stdexcept>
#include <string>

#include "lab/rest/Equilibrium.hpp"
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

Equilibrium::Equilibrium(const Model& m, Cloth& g, const ForcePlan& force,
                         const ConstraintPlan&)
    : m_(m), g_(g), force_(force) {}
Rest Equilibrium::find(int) {
  throw std::runtime_error("a page begins no run at rest");
}

int interrupted() { return 0; }
void end_if_interrupted() {}

}  // namespace lab
