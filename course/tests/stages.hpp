/** @file stages.hpp
 * mass_spring.cpp in each of its stages, each in a namespace of its own:
 * whoever includes this file has renamed main(), and included the program's
 * headers. */
#ifndef KIT_STAGES_HPP
#define KIT_STAGES_HPP

// What our main() includes must not come first inside of a stage's namespace.
#include <CME212/Energy.hpp>
#include <CME212/MeshFaults.hpp>

namespace kit_problem1 {
#define STAGE problem1
#include "mass_spring.cpp"
#undef STAGE
}  // namespace kit_problem1
namespace kit_diagonals {
#define STAGE diagonals
#include "mass_spring.cpp"
#undef STAGE
}  // namespace kit_diagonals
namespace kit_forces {
#define STAGE forces
#include "mass_spring.cpp"
#undef STAGE
}  // namespace kit_forces
namespace kit_constraints {
#define STAGE constraints
#include "mass_spring.cpp"
#undef STAGE
}  // namespace kit_constraints
namespace kit_tear {
#define STAGE tear
#include "mass_spring.cpp"
#undef STAGE
}  // namespace kit_tear

#endif
