#pragma once
/** @file Measure.hpp
 * What is asked of a scene at its end, as numbers that can be compared between
 * grids; and try_out(), a run that answers. */
#include <functional>
#include <string>
#include <vector>

#include "lab/scenes/Model.hpp"

namespace lab {

class Scene;  // lab/scenes/Scene.hpp

/** Numbers in the unit of a measure. */
using Answer = std::vector<double>;

/** The distance of two answers: RMS over the positions, or else the Euclidean
 * norm of the difference.  @pre both answer the same question */
double distance(const Answer& a, const Answer& b, Measure measure);

/** The value of @a what in the present state of @a g, the cloth of @a m:
 * - com: the center of mass [m]
 * - energy: kinetic, elastic and gravitational [J]
 * - positions: of 9 x 9 places on each sheet, the same on all grids; of all
 *   nodes of a mesh from files [m]
 * - max-stretch: the largest l/L - 1 of an edge; 0 if there is none
 * - drape-height: the height of the lowest point of the surface [m], quadratic
 *   between the nodes of a sheet, so that grids with odd and even cells agree;
 *   of a mesh from files, or if the cloth has lost nodes or may tear by
 *   strain, of the lowest node
 * @pre no node was removed, for positions: see check_question() */
Answer answer(const Model& m, const Cloth& g, Measure what);
/** The answer to the scene's own question. */
inline Answer answer(const Model& m, const Cloth& g) {
  return answer(m, g, m.measure);
}

/** False only for the positions of a cloth that may tear. */
inline bool can_answer(const Model& m, Measure what) {
  return what != Measure::positions || (m.tears.empty() && !m.tear_strain);
}

/** Throws SceneError if !can_answer(m, m.measure). */
void check_question(const Model& m);

/** The result of a run. */
struct Trial {
  Answer answer;        ///< empty if the run failed
  std::string failure;  ///< why it failed; else empty
  double work = 0;      ///< spring evaluations: springs times force
                        ///< evaluations, summed over the steps
  double seconds = 0;   ///< duration on this machine
  double dt = 0;        ///< the first step [s]
  long long steps = 0;
  bool ok() const { return failure.empty(); }
};

/** The step [s] of @a m: its dt, or the first step that is chosen, shortened so
 * that t-end is a multiple of it.  Throws as try_out(). */
double step_of(const Model& m);

/** A random change of each initial coordinate, by at most size [m]. If it
 * changes an answer much, the motion is chaotic: there is no better answer. */
struct Shake {
  double size = 0;
  unsigned seed = 1;
};

/** Run @a m to its end, with steps of step_of(m).
 * @param look called with the cloth at the end, unless the run failed
 * @param after called with the scene after each step; it may change the cloth
 * Throws InputError, SceneError; std::invalid_argument as Scene does;
 * Interrupted. */
Trial try_out(
    const Model& m, const Shake& shake = {},
    const std::function<void(const Cloth&)>& look = [](const Cloth&) {},
    const std::function<void(Scene&)>& after = [](Scene&) {});

}  // namespace lab
