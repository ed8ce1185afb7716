#pragma once
/** @file Refusals.hpp
 * Why there is no advice, and what one would ask or change instead. */
#include <string>
#include <vector>

#include "lab/scenes/Measure.hpp"

namespace lab {

/** Why the answer of @a m has no limit on finer grids, and what has; empty if
 * no reason is known.  Throws InputError, SceneError */
std::string diverging(const Model& m);

/** Why its grids converge slowly, and what to hold instead: the end of a
 * sentence, or empty.  Throws InputError, SceneError */
std::string converging_slowly(const Model& m);

/** What can be asked of @a m at its end although its motion is chaotic: the
 * measures that are known to a tenth of the size of the cloth or better, or
 * what to change if there are none.
 * @param still,shaken answers by Measure, of a run and of one that started
 *        slightly off; an empty one: not known */
std::string offers(const Model& m, const std::vector<Answer>& still,
                   const std::vector<Answer>& shaken);

}  // namespace lab
