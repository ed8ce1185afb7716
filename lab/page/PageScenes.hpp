#pragma once
/** @file PageScenes.hpp
 * The scenes that the web page offers. */
#include <span>

#include "lab/scenes/StoredScenes.hpp"

namespace lab {

/** The five stages of the assignment, and then others. */
std::span<const StoredScene* const> page_scenes();

/** The scene in the file of @a s, but with side x side nodes, by Verlet in
 * steps of 1 ms and without an end.  @pre side >= 2 */
Model page_model(const StoredScene& s, unsigned side);

}  // namespace lab
