#pragma once
/** @file Refinement.hpp
 * One scene on finer and finer grids: how far each is from their limit, and how
 * sure that is. */
#include <cstddef>
#include <vector>

#include "lab/scenes/Measure.hpp"

namespace lab {

/** What changes an answer, by how much in each of its numbers: with a sign, as
 * what a coarse grid and a large step change may cancel out. */
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

/** A grid that was tried. */
struct GridReport {
  double factor = 1;  ///< cells along each side, of those named
  std::size_t nodes = 0;
  double error = 0;        ///< of the answer, estimated; infinite: not known
  Trial trial;             ///< with all parts
  double evaluations = 0;  ///< of all forces; a solve counts as what it takes
};

/** A scene on grids, each of twice as many cells along each side as the one
 * before, by steps that go down with the grid. From three grids on, the
 * observed order of convergence tells their limit: Richardson's extrapolation.
 * Grids half-way between these, of sqrt(2) times the cells, tell how far that
 * can be trusted: answers of grids scatter, as edges and contacts meet other
 * nodes on each. Sources: P. J. Roache, Verification and Validation in
 * Computational Science and Engineering, 1998, chapter 5; L. Eca, M. Hoekstra,
 * A procedure for the estimation of the numerical uncertainty of CFD
 * calculations based on grid refinement studies, J. Comput. Phys. 262, 2014:
 * scatter is a part of the uncertainty. */
class Refinement {
 public:
  explicit Refinement(Measure measure = Measure::com) : measure_(measure) {}

  /** Add the next grid, and estimate the errors of all anew. One grid alone has
   * error 0: that of a mesh from files is not known. */
  void add(const GridReport& next);
  /** Add a grid half-way between the last two.  @pre there are two */
  void add_half_way(const GridReport& next);
  void clear() { grids_.clear(), half_way_.clear(); }
  std::size_t size() const { return grids_.size(); }
  bool empty() const { return grids_.empty(); }
  const GridReport& operator[](std::size_t k) const { return grids_[k]; }
  const GridReport& back() const { return grids_.back(); }
  /** All that were tried, the coarsest first, those half-way among them. */
  std::vector<GridReport> tried() const;

  /** How far apart the answers of grids k-1 and k are. */
  double step_to(std::size_t k) const;
  /** False if the answers of the last three grids do not come closer. */
  bool settles() const;

  /** The error of the grid of @a factor, whether it was tried or not.
   * @pre size() is not 0 or 2 */
  Effect error(double factor) const;
  /** The limit of the answers.  @pre as for error() */
  Answer limit() const;
  /** How far that may be from the truth: by how far apart it and the limit of
   * the grids half-way are, and how far the last of these is from where the
   * observed order puts it; without such grids, by what the last one changed.
   */
  double uncertainty_of_limit() const;
  /** How much larger than its size the error of the grid of @a factor may be.
   */
  double uncertainty(double factor) const;

 private:
  Measure measure_;
  std::vector<GridReport> grids_, half_way_;  // the latter without a gap
  double order_ = 1;
  Answer limit_before_;  // of all grids but the last, if these are 3

  const Answer& answer(std::size_t k) const { return grids_[k].trial.answer; }
  double step_to(const std::vector<GridReport>& grids, std::size_t k) const;
  /** The grid of @a factor; nullptr if it was not tried. */
  const GridReport* find(double factor) const;
  void estimate(GridReport& g) const;
  double order_of(const std::vector<GridReport>& grids) const;
  /** True if there is one between the last two. */
  bool has_half_way() const;
  Answer limit_half_way() const;
};

}  // namespace lab
