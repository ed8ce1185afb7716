#pragma once
/** @file Built.hpp
 * The cloth of a model, as a value. */
#include "lab/scenes/Compose.hpp"

namespace lab {

inline Cloth built(const Model& m, const Net& net) {
  Cloth g;
  build_model(g, m, net);
  return g;
}
inline Cloth built(const Model& m) { return built(m, mesh_of(m)); }

}  // namespace lab
