#pragma once
/** @file StoredScenes.hpp
 * The scenes of data/scenes, compiled into every program of the laboratory.
 * tools/stored_scenes.sh writes their text as C++. */
#include <span>
#include <string_view>

#include "lab/scenes/Model.hpp"

namespace lab {

/** A scene file. */
struct StoredScene {
  const char* name;   ///< of the file, without .toml
  const char* title;  ///< the comment in its first line
  const char* text;
  /** The scene, which may have no mesh.  Throws SceneFileError */
  Model model() const;
};

/** The scenes of data/scenes, sorted by name. */
std::span<const StoredScene> stored_scenes();
/** The scenes of data/scenes/failures, sorted by name: the gallery in
 * lab/stability/README.md. All fail but `tunnel`, in which Scene::watched()
 * stops nodes. */
std::span<const StoredScene> failing_scenes();

/** The scene of stored_scenes() called @a name.
 * Throws std::out_of_range if there is none */
const StoredScene& stored_scene(std::string_view name);

}  // namespace lab
