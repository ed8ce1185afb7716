#pragma once
/** @file StoredScenes.hpp
 * The scenes of data/scenes, which every program of the laboratory contains:
 * it reads no file for them. tools/stored_scenes.sh writes their text as C++.
 */
#include <span>
#include <string_view>

#include "lab/scenes/Model.hpp"

namespace lab {

/** A scene file. */
struct StoredScene {
  const char* name;   ///< of the file, without .toml
  const char* title;  ///< what is seen: its first line, a comment
  const char* text;
  /** Its scene, which may have no mesh.  Throws SceneFileError */
  Model model() const;
};

/** Those of data/scenes, by name. */
std::span<const StoredScene> stored_scenes();
/** Those of data/scenes/failures, by name: the gallery in
 * lab/stability/README.md. All end with a failure, but for `tunnel`, which
 * Scene::watched() counts. */
std::span<const StoredScene> failing_scenes();

/** The one of stored_scenes() that is called @a name.
 * Throws std::out_of_range: there is none */
const StoredScene& stored_scene(std::string_view name);

}  // namespace lab
