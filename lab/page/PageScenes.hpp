#pragma once
/** @file PageScenes.hpp
 * The scenes that the web page offers. */
#include <span>

#include "lab/scenes/StoredScenes.hpp"

namespace lab {

/** The five stages of the assignment, then others, then failing_scenes(). */
std::span<const StoredScene* const> page_scenes();

/** Is @a s one of failing_scenes()? */
bool always_fails(const StoredScene& s);

/** The scene in the file of @a s without an end. Unless it always fails, it has
 * side x side nodes and runs by Verlet in steps of 1 ms.  @pre side >= 2 */
Model page_model(const StoredScene& s, unsigned side);

}  // namespace lab
