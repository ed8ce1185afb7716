#pragma once
/** @file Refinement.hpp
 * Refinement: estimates the error of each of several grids of one scene. */
#include <cstddef>
#include <vector>

#include "lab/scenes/Measure.hpp"

namespace lab {

/** A change of an answer, in each of its numbers: with a sign, as the errors of
 * a coarse grid and of a large step may cancel. */
struct Effect {
  Answer by;
  Effect() = default;
  explicit Effect(std::size_t size) : by(size) {}
  Effect(const Answer& to, const Answer& from) : by(to) { add(-1, from); }
  Effect& add(double factor, const Answer& b) {
    for (std::size_t k = 0; k < by.size(); ++k) by[k] += factor * b[k];
    return *this;
  }
  double size(Measure measure) const {
    return distance(by, Answer(by.size()), measure);
  }
};

/** A run on a grid. */
struct GridReport {
  double factor = 1;  ///< cells along each side / those of the scene
  std::size_t nodes = 0;
  double error = 0;        ///< of the answer, estimated; infinite: unknown
  Trial trial;             ///< with all parts
  double evaluations = 0;  ///< of the forces; solves are counted by their cost
};

/** Runs of a scene on grids, each of twice as many cells along each side as the
 * one before, with steps that shrink with the cells. From three grids on, the
 * observed order of convergence gives their limit: Richardson's extrapolation.
 * Intermediate grids, of sqrt(2) times the cells, show how reliable that is:
 * answers scatter, as the nodes at edges and contacts differ from grid to grid.
 * Sources: P. J. Roache, Verification and Validation in Computational Science
 * and Engineering, 1998, chapter 5; L. Eca, M. Hoekstra, A procedure for the
 * estimation of the numerical uncertainty of CFD calculations based on grid
 * refinement studies, J. Comput. Phys. 262, 2014: scatter is a part of the
 * uncertainty. */
class Refinement {
 public:
  explicit Refinement(Measure measure = Measure::com) : measure_(measure) {}

  /** Add the next grid and update all errors. The error of a single grid is 0:
   * that of a mesh from files is unknown. */
  void add(const GridReport& next);
  /** Add an intermediate grid of the last two.  @pre there are two */
  void add_intermediate(const GridReport& next);
  void clear() { grids_.clear(), intermediate_.clear(); }
  std::size_t size() const { return grids_.size(); }
  bool empty() const { return grids_.empty(); }
  const GridReport& operator[](std::size_t k) const { return grids_[k]; }
  const GridReport& back() const { return grids_.back(); }
  /** All grids, also intermediate ones, the coarsest first. */
  std::vector<GridReport> tried() const;

  /** The distance between the answers of grids k-1 and k. */
  double step_to(std::size_t k) const;
  /** False if the answers of the last three grids do not converge. */
  bool settles() const;

  /** The error of the grid of @a factor, measured or predicted.
   * @pre size() is not 0 or 2 */
  Effect error(double factor) const;
  /** The limit of the answers.  @pre as for error() */
  Answer limit() const;
  /** The uncertainty of limit(): from its distance to the limit of the
   * intermediate grids, and from the distance of the last of these to its value
   * by the observed order; without them, from the change by the last grid. */
  double uncertainty_of_limit() const;
  /** The uncertainty of error(@a factor). */
  double uncertainty(double factor) const;

 private:
  Measure measure_;
  std::vector<GridReport> grids_,
      intermediate_;  // the latter to the last but one grid
  double order_ = 1;
  Answer limit_before_;  // without the last grid, if 3 others are left

  const Answer& answer(std::size_t k) const { return grids_[k].trial.answer; }
  double step_to(const std::vector<GridReport>& grids, std::size_t k) const;
  /** The grid of @a factor; nullptr if it was not run. */
  const GridReport* find(double factor) const;
  void estimate(GridReport& g) const;
  double order_of(const std::vector<GridReport>& grids) const;
  /** True if there is an intermediate grid of the last two. */
  bool has_intermediate() const;
  Answer limit_of_intermediate() const;
};

}  // namespace lab
