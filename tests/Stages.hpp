#pragma once
/** @file Stages.hpp
 * The scenes of the assignment's stages, for tests. */
#include <string>

#include "lab/scenes/SceneFile.hpp"

namespace lab {

inline const char* const stage_names[] = {"problem1", "diagonals", "forces",
                                          "constraints", "tear"};

/** The scene of the stage called @a name, its mesh open. */
inline Model stage_scene(const std::string& name) {
  return load_open_model("data/scenes/" + name + ".toml");
}
/** The same on a grid of @a side x @a side nodes over the unit square: that of
 * grid_points() and grid_quads(). */
inline Model stage_scene(const std::string& name, unsigned side) {
  Model m = stage_scene(name);
  m.sheets = {{.nodes = {side, side}}};
  return m;
}

}  // namespace lab
