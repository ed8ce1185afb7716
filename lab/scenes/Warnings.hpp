#pragma once
/** @file Warnings.hpp
 * What will go wrong in a run, as far as can be said before its first step. */
#include <string>
#include <vector>

#include "lab/scenes/Compose.hpp"

namespace lab {

/** The radius [m] of the opening between four nodes: of the largest ball that
 * touches none of them, with its center on the quad, which is folded along its
 * shorter diagonal. A square of side L has L/sqrt(2). */
double opening(const PointsAndQuads& mesh, const Quad& q);

/** What is wrong with a scene before its first step: a sentence each, with
 * numbers and a cure. None of them is a guess: each says what is the case.
 *  - nodes in no quad; springs of length 0
 *  - nodes below a plane, inside a solid or a tearing ball; a ball across quads
 *    without a node inside; with what the first step then does
 *  - openings of the mesh through which a solid ball fits, or will when springs
 * are stretched by less than a half; or which a self-collision does not close
 *  - a ball that moves by more than half of its radius in a step
 *  - a method with error control where motion is not smooth
 * @param mesh that of mesh_of(m)   @param g the cloth of @a m at t = 0
 * @param dt the first step [s]
 * Complexity: O((points + quads + springs) parts) */
std::vector<std::string> warnings(const Model& m, const PointsAndQuads& mesh,
                                  const Cloth& g, double dt);

}  // namespace lab
