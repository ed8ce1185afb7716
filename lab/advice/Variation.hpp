#pragma once
/** @file Variation.hpp
 * A scene with one part less, and a scene with one part more: what shows which
 * parts a question needs. */
#include <optional>
#include <string>
#include <vector>

#include "lab/scenes/Model.hpp"

namespace lab {

/** A scene that differs from another one in one part. */
struct Variation {
  std::string part;  ///< "KEY: WORDS", as the scene file has them
  bool dropped;      ///< else added
  Model model;
};

/** @a m on a grid of @a factor times as many cells along each side of each
 * sheet, at least 2: the same cloth, so the drag of a node goes down as nodes
 * become more, and a thickness of self-collision that two nodes would violate
 * at the start goes down with their distance.  @pre m has sheets */
Model refined(const Model& m, double factor);

/** @a m without each part that it names, in turn. */
std::vector<Variation> without_parts(const Model& m);

/** True if @a part is the friction of a part that is @a gone, too. */
bool goes_with_another(const std::string& part,
                       const std::vector<std::string>& gone);

/** @a m without all parts that are @a gone, in the words of without_parts();
 * nullopt if it has not got one of them. */
std::optional<Model> without_all(Model m, const std::vector<std::string>& gone);

/** @a m with each part that it could have next: diagonals, a grid of twice as
 * many cells along each side, half the step, and self-collision with a
 * thickness that lets no node through a quad of squares.
 * Throws as step_of(). */
std::vector<Variation> with_more_parts(const Model& m);

}  // namespace lab
