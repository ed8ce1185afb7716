#pragma once
/** @file Measure.hpp
 * The answer to the question about a scene, as numbers that can be compared
 * between grids. */
#include <array>
#include <span>
#include <string>
#include <vector>

#include "lab/scenes/Compose.hpp"

namespace lab {

/** Numbers in the unit of a measure. */
using Answer = std::vector<double>;

/** The distance of two answers: RMS over the positions, or else the Euclidean
 * norm of the difference.  @pre both answer the same question */
double distance(const Answer& a, const Answer& b, const Measure& measure);

/** The state that a quantity is read of: the cloth of a model at a time. The
 * last three are null or 0, and the time is 0, if there is no run. */
struct Measured {
  const Model& model;
  const Cloth& cloth;
  double time = 0;  ///< [s]
  const std::vector<HeldNodes>* held = nullptr;
  const CombinedForces* force = nullptr;
  double lost = 0;  ///< energy lost until then [J]
  /** By edge id, of a method that does not use K (l - L): the force of each
   * spring on its first end [N]. */
  std::span<const Point> pulls = {};
};

/** A row of the table of quantities, which measures, CSV files and messages
 * use. */
struct Quantity {
  const char* name;  ///< without its words
  const char* unit;  ///< "" of a pure number
  /** Its value in the present state; all before lost-energy need no run. */
  Answer (*read)(const Measured& now, const Measure& what);
};
/** In the order of Measure::Quantity. */
extern const std::array<Quantity, 18> quantities;

/** As --measure takes it: "com", "max com z", "point u 0.5 v 1",
 * "first com z below -1". */
std::string name_of(const Measure& m);
const char* unit_of(const Measure& m);
/** The columns of --csv for it: ",point_x,point_y,point_z"; none of what all
 * tables have, nor of what is no list of a few numbers at each time. */
std::string columns_of(const Measure& m);

/** The value of @a what, a quantity in front of lost-energy, in the present
 * state of @a g, the cloth of @a m.
 * - positions: of 9 x 9 places on each sheet, the same on all grids; of all
 *   nodes of a mesh from files [m]
 * - drape-height: quadratic between the nodes of a sheet, so that grids with
 *   odd and even cells agree; of a mesh from files, or if the cloth has lost
 *   nodes or may tear by strain, of the lowest node [m]
 * @pre no node was removed, for positions: see check_question() */
Answer answer(const Model& m, const Cloth& g, const Measure& what);

/** The strain l/L - 1 of a spring; 0 without a rest length. */
double strain_of(Edge e);
/** The mean of those at @a n: above 0 if it is taut; 0 without springs. */
double strain_at(Node n);

/** False for places on a cloth that may tear, and for what @a m does not have:
 * a tear, an obstacle, that sheet. */
bool can_answer(const Model& m, const Measure& what);

/** Throws SceneError if !can_answer(m, m.measure). */
void check_question(const Model& m);

}  // namespace lab
