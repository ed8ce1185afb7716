#pragma once
/** @file Built.hpp
 * The cloth of a model, as a value; a model of a square sheet. */
#include "lab/scenes/Compose.hpp"

namespace lab {

inline Cloth built(const Model& m, const Net& net) {
  Cloth g;
  build_model(g, m, net);
  return g;
}
inline Cloth built(const Model& m) { return built(m, mesh_of(m)); }

/** A sheet of n x n nodes, without drag, until @a t_end [s]. */
inline Model square(unsigned n, double t_end) {
  Model m;
  m.sheets.resize(1), m.sheets[0].nodes = {n, n};
  m.t_end = t_end;
  return m;
}
/** @a m, hung by the two corners with y = 0. */
inline Model hung(Model m) {
  m.pins = {Pin{0, 0, {}, {}, {}}, Pin{1, 0, {}, {}, {}}};
  return m;
}

}  // namespace lab
