#pragma once
/** @file Refusals.hpp
 * Texts of refusals: their cause, and what can be answered instead. */
#include <string>
#include <vector>

#include "lab/scenes/Measure.hpp"

namespace lab {

/** Why the answer of @a m has no limit on finer grids, and what to ask instead;
 * empty if no reason is known.  Throws InputError, SceneError */
std::string diverging(const Model& m);

/** Why the answers of @a m converge slowly, and which pins would be better: the
 * end of a sentence, or empty.  Throws InputError, SceneError */
std::string converging_slowly(const Model& m);

/** Questions that can be answered at the end of @a m although its motion is
 * chaotic: the measures that are known to a tenth of the size of the cloth or
 * better, or what to change if there are none.
 * @param answers,shaken by Measure, of a run and of one from a perturbed start;
 *        an empty one: unknown */
std::string offers(const Model& m, const std::vector<Answer>& answers,
                   const std::vector<Answer>& shaken);

}  // namespace lab
