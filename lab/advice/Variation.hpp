#pragma once
/** @file Variation.hpp
 * Scenes with one part less, and on other grids. Their answers show which parts
 * and which grid a question needs. */
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "lab/scenes/Model.hpp"

namespace lab {

/** A scene that lacks one part of another one. */
struct Variation {
  std::string part;  ///< "KEY: WORDS", as the scene file has them
  Model model;
};

/** Cells along the sides u and v of each sheet, over those of a scene. */
using Sides = std::vector<std::array<double, 2>>;

/** @a m on a grid of so many times the cells, at least 2 along each side. It is
 * the same cloth: the drag of all nodes together stays, and a thickness of
 * self-collision that two nodes would violate at the start is reduced to less
 * than their distance. A mesh from files has no sheets: it stays.
 * @pre m has as many sheets as @a sides */
Model refined(const Model& m, const Sides& sides);
inline Model refined(const Model& m, double factor) {
  return refined(m, Sides(m.sheets.size(), {factor, factor}));
}

/** For each part that @a m names, @a m without that part. */
std::vector<Variation> without_parts(const Model& m);

/** True if @a part is the friction of a part in @a gone. */
bool goes_with_another(const std::string& part,
                       const std::vector<std::string>& gone);

/** @a m without the parts @a gone, named as in without_parts(); nullopt if @a m
 * lacks one of them. */
std::optional<Model> without_all(Model m, const std::vector<std::string>& gone);

}  // namespace lab
