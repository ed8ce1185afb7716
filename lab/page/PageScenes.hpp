#pragma once
/** @file PageScenes.hpp
 * The scenes that the web page offers. */
#include <span>

#include "lab/scenes/Model.hpp"

namespace lab {

/** A scene of the page. */
struct PageScene {
  const char* name;   ///< that of its file in data/scenes
  const char* title;  ///< what is seen
  Model (*model)(unsigned side);
};

/** The five stages of the assignment, and then others. Each is what its file
 * says, of side x side nodes in place of those of the file, by Verlet and
 * without an end.  @pre side >= 2 */
std::span<const PageScene> page_scenes();

}  // namespace lab
