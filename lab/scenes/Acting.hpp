#pragma once
/** @file Acting.hpp
 * The list that ./cloth prints before a run: what acts in the scene. */
#include <string>
#include <vector>

#include "lab/scenes/MeshFile.hpp"
#include "lab/scenes/Model.hpp"

namespace lab {

/** A line for the method, and then a line "  WHAT: WORK" for the cloth, each
 * force and each constraint of @a m. Its work in a step is the number of
 * springs evaluated or nodes visited.
 * @param g the cloth of @a m   @param mesh what it was built from
 * Complexity: O(nodes + springs) */
std::vector<std::string> what_acts(const Model& m, const Cloth& g,
                                   const Net& mesh);

}  // namespace lab
