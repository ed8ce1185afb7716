#pragma once
/** @file ReadParts.hpp
 * The parts of a scene from their words, for tests that build a Model. */
#include "lab/scenes/Words.hpp"

namespace lab {

inline constexpr auto read_edges = read_part<Edges>;
inline constexpr auto read_sheet = read_part<Sheet>;
inline constexpr auto read_region = read_part<Region>;
inline constexpr auto read_pin = read_part<Pin>;
inline constexpr auto read_wind = read_part<Wind>;
inline constexpr auto read_plane = read_part<Wall>;
inline constexpr auto read_sphere = read_part<Solid>;
inline constexpr auto read_tear = read_part<Ball>;
inline constexpr auto read_self_collision = read_part<Distance>;
inline constexpr auto read_view = read_part<Box>;

/** A model with one sheet. */
inline Model with_sheet(const std::string& sheet) {
  Model m;
  m.sheets = {read_sheet(sheet)};
  return m;
}

}  // namespace lab
