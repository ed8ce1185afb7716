#pragma once
/** @file Acting.hpp
 * What acts in a scene, in words, with its share of the work of a step. */
#include <string>
#include <vector>

#include "lab/scenes/MeshFile.hpp"
#include "lab/scenes/Model.hpp"

namespace lab {

/** A line for the method, and one for the cloth, each force and each
 * constraint of @a m, "  WHAT: WORK", where work is counted a step: springs
 * evaluated, nodes looked at.
 * @param g the cloth of @a m   @param mesh what it was built from
 * Complexity: O(nodes + springs) */
std::vector<std::string> what_acts(const Model& m, const Cloth& g,
                                   const PointsAndQuads& mesh);

}  // namespace lab
