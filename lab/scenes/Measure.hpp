#pragma once
/** @file Measure.hpp
 * The answer to the question about a scene, as numbers that can be compared
 * between grids; and try_out(), a run that answers. */
#include <array>
#include <functional>
#include <string>
#include <vector>

#include "lab/Archive.hpp"
#include "lab/scenes/Model.hpp"

namespace lab {

class Scene;  // lab/scenes/Scene.hpp

/** Numbers in the unit of a measure. */
using Answer = std::vector<double>;

/** The distance of two answers: RMS over the positions, or else the Euclidean
 * norm of the difference.  @pre both answer the same question */
double distance(const Answer& a, const Answer& b, const Measure& measure);

/** A row of the table of quantities, which measures, CSV files and messages
 * use. */
struct Quantity {
  const char* name;  ///< without its words
  const char* unit;  ///< "" of a pure number
  /** Its value in the present state of @a g, the cloth of @a m. @a scene, to
   * which @a g belongs, is null or not needed for all before pin-force. */
  Answer (*read)(const Model& m, const Cloth& g, const Scene* scene,
                 const Measure& what);
};
/** In the order of Measure::Quantity. */
extern const std::array<Quantity, 8> quantities;

/** As --measure takes it: "com", "max com z", "point u 0.5 v 1". */
std::string name_of(const Measure& m);
const char* unit_of(const Measure& m);
/** The columns of --csv for it: ",point_x,point_y,point_z"; none of what all
 * tables have, nor of what is no list of a few numbers at each time. */
std::string columns_of(const Measure& m);

/** The value of @a what, a quantity in front of pin-force, in the present state
 * of @a g, the cloth of @a m.
 * - positions: of 9 x 9 places on each sheet, the same on all grids; of all
 *   nodes of a mesh from files [m]
 * - drape-height: quadratic between the nodes of a sheet, so that grids with
 *   odd and even cells agree; of a mesh from files, or if the cloth has lost
 *   nodes or may tear by strain, of the lowest node [m]
 * @pre no node was removed, for positions: see check_question() */
Answer answer(const Model& m, const Cloth& g, const Measure& what);
/** The value of any quantity in the present state of @a scene; the time of a
 * tear is infinite while nothing has torn.
 * Throws SceneError: pin-force where no pin holds a node */
Answer answer(const Model& m, const Scene& scene, const Measure& what);

/** False for places on a cloth that may tear, and for what @a m does not have:
 * a tear, a pin, that sheet. */
bool can_answer(const Model& m, const Measure& what);

/** Throws SceneError if !can_answer(m, m.measure). */
void check_question(const Model& m);

/** Answers the question of a scene that runs: looks at each state, if the
 * answer depends on all of them. Steps that are taken back are forgotten. */
class Observer {
 public:
  /** Looks at the present state of @a scene, a scene of @a m.  Throws as
   * answer() */
  Observer(const Model& m, const Scene& scene);
  /** Call it after each step if m.measure.over_time().  As long as answer() */
  void look(const Model& m, const Scene& scene);
  /** The answer so far; empty if nothing has torn, whose time is asked. */
  Answer answer(const Model& m, const Scene& scene) const;
  void archive(Archive& a);

 private:
  struct Look {
    long long step;
    double value;
  };
  double best_;               // of the steps that can't be taken back any more
  std::vector<Look> recent_;  // the others

  static double better(const Measure& what, double a, double b);
};

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
  std::array<bool, 3> along = {true, true, true};  ///< x, y, z
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
