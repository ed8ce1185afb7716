#pragma once
/** @file Measure.hpp
 * What is asked of a scene at its end, as numbers that can be compared from
 * grid to grid; and a run that answers. */
#include <functional>
#include <string>
#include <vector>

#include "lab/scenes/Model.hpp"

namespace lab {

class Scene;  // lab/scenes/Scene.hpp

/** Numbers in the unit of a measure. */
using Answer = std::vector<double>;

/** How far apart two answers are: the root of the mean of the squares for
 * positions, else the length of the difference.
 * @pre both to the same question */
double distance(const Answer& a, const Answer& b, Measure measure);

/** The answer to @a what, in the state that @a g, the cloth of @a m, has now:
 * - com: the center of mass [m]
 * - energy: kinetic, elastic and gravitational [J]
 * - positions: of 9 x 9 places on each sheet, the same on all grids; of all
 *   nodes of a mesh from files [m]
 * - max-stretch: the largest l/L - 1 of an edge; 0 if there is none
 * - drape-height: the height of the lowest node [m]
 * @pre no node was removed, for positions: see check_question() */
Answer answer(const Model& m, const Cloth& g, Measure what);
/** That to its own question. */
inline Answer answer(const Model& m, const Cloth& g) {
  return answer(m, g, m.measure);
}

/** True if @a m can be asked for that: a cloth that tears keeps no positions.
 */
inline bool can_answer(const Model& m, Measure what) {
  return what != Measure::positions || (m.tears.empty() && !m.tear_strain);
}

/** Throws SceneError: a question that a scene can't answer. */
void check_question(const Model& m);

/** The result of a run. */
struct Trial {
  Answer answer;        ///< empty: it failed
  std::string failure;  ///< why
  double work = 0;      ///< spring evaluations: those of a force times its
                        ///< evaluations
  double seconds = 0;   ///< of this machine
  double dt = 0;        ///< [s], the first one
  long long steps = 0;
  bool ok() const { return failure.empty(); }
};

/** The step [s] of @a m: its dt, or what it chooses at the start; a part of
 * t-end, so that a run ends there.  Throws as try_out(). */
double step_of(const Model& m);

/** How far nodes start from where they should [m], each of them in a direction
 * of its own, which the seed chooses: what an answer makes of that tells
 * whether it can be had at all. */
struct Shake {
  double size = 0;
  unsigned seed = 1;
};

/** Run @a m to its end, with steps of step_of(m).
 * @param look at the cloth at the end of a run that did not fail
 * @param after each step, with the scene, of which it may change the cloth as
 * between two steps
 * Throws InputError, SceneError; std::invalid_argument as Scene does;
 * Interrupted. */
Trial try_out(
    const Model& m, const Shake& shake = {},
    const std::function<void(const Cloth&)>& look = [](const Cloth&) {},
    const std::function<void(Scene&)>& after = [](Scene&) {});

}  // namespace lab
