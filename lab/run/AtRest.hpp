#pragma once
/** @file AtRest.hpp
 * What --rest prints of a scene that was put to rest. */
#include <string>

#include "lab/stepping/Scene.hpp"

namespace lab {

/** How far @a scene is at rest, whether it stays there, what its pins carry,
 * its lowest frequencies, and what these mean for methods and drag.
 * @pre scene.rest()
 * Throws Interrupted.  Complexity: Equilibrium::modes(10) */
std::string in_words(const Rest& rest, Scene& scene);

}  // namespace lab
