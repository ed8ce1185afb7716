#pragma once
/** @file Warnings.hpp
 * Warnings about a scene before its first step. */
#include <string>
#include <vector>

#include "lab/scenes/Compose.hpp"

namespace lab {

/** The radius [m] of the opening between the nodes of a quad: of the largest
 * ball around a point of the quad that contains none of them. The quad is
 * folded along its shorter diagonal. A square of side L has L/sqrt(2). */
double opening(const Net& mesh, const Quad& q);

/** The faults of a scene: a sentence each, with numbers and a remedy.
 *  - what a reader changed in the mesh, mesh_faults(), a size as in mm; springs
 *    of length 0; nothing held; options that change no spring
 *  - nodes below a plane, inside a solid or a tearing ball; and what the first
 *    step does then
 *  - openings of the mesh through which a solid ball fits, now or when
 *    springs are stretched by up to a half; or which a self-collision does not
 *    close
 *  - a ball that moves by more than half of its radius in a step
 *  - a method with error control if the motion is not smooth
 * @param mesh that of mesh_of(m)   @param g the cloth of @a m at t = 0
 * @param dt the first step [s]
 * Complexity: O((points + quads + springs) parts) */
std::vector<std::string> warnings(const Model& m, const Net& mesh,
                                  const Cloth& g, double dt);

}  // namespace lab
