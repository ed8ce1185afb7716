#pragma once
/** @file Refinement.hpp
 * Refinement: estimates the error of each of several grids of one scene. */
#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "lab/stepping/Separation.hpp"
#include "lab/stepping/Trial.hpp"

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
  double size(const Measure& measure) const {
    return distance(by, Answer(by.size()), measure);
  }
};

/** A run on a grid, with all parts. */
struct GridReport {
  int level = 0;  ///< of its grid
  Model model = {};
  double factor = 1;  ///< cells along each side / those of the scene
  std::size_t nodes = 0;
  /** The estimated error of the answer; infinite: unknown. */
  double error = std::numeric_limits<double>::infinity();
  Trial trial = {};
  double work = 0;         ///< predicted, in spring evaluations
  double evaluations = 0;  ///< of the forces; solves are counted by their cost
  std::vector<Answer> all = {};  ///< by Measure; empty where it has none
  std::optional<Track> track = {};
};

/** Runs of a scene on grids of ever more cells, with steps that shrink with the
 * cells. From three grids on, a least-squares fit to the finest of them, of
 * weights that grow with the cells,
 *   a_k = a + c h_k^p,   h_k = 1 / factor,
 * gives the limit a, the error c h_k^p of each grid and the observed order p.
 * Outside of [0.5, 2.1] the order is not believed: then the better one of the
 * fits of order 1 and 2 is taken. Source: L. Eca, M. Hoekstra, A procedure for
 * the estimation of the numerical uncertainty of CFD calculations based on grid
 * refinement studies, J. Comput. Phys. 262, 2014. */
class Refinement {
 public:
  explicit Refinement(Measure measure = Measure::com) : measure_(measure) {}

  /** Add a run and update all errors: from three grids on they are known.
   * @pre next.factor > back().factor */
  void add(GridReport next);
  void clear() { grids_.clear(); }
  std::size_t size() const { return grids_.size(); }
  bool empty() const { return grids_.empty(); }
  const GridReport& operator[](std::size_t k) const { return grids_[k]; }
  const GridReport& back() const { return grids_.back(); }

  /** The observed order of convergence; or that of the fit, if not believed.
   * @pre size() > 2, as for all that follow */
  double order() const { return fit_.order; }
  /** True if the observed order is believed: the grids are in the asymptotic
   * range, where the error goes by a power of the mesh width. */
  bool asymptotic() const { return fit_.believed; }
  /** The standard deviation of the answers from the fit. */
  double deviation() const { return fit_.deviation; }
  /** The error of the grid of @a factor, measured or predicted. */
  Effect error(double factor) const;
  /** The limit of the answers. */
  const Answer& limit() const { return fit_.limit; }
  /** The uncertainty of limit() at a confidence of 95 %: a fifth of the error
   * of the finest grid, the standard deviation of the fit, and the change of
   * the limit if the finest or the coarsest grid of the fit is left out; the
   * first two 1.5 times if the order is not believed; and then, if a fit of
   * a lower order has half the deviation, how far its limit is. Of three grids,
   * which have no deviation, three times the error. */
  double uncertainty() const { return uncertainty_; }
  /** The change of the limit in it. */
  double change_of_limit() const { return moves_; }
  /** False if the answers drift apart by more than @a negligible: refinements
   * change them by more each time. */
  bool converges(double negligible) const;

 private:
  struct Fit {
    Answer limit, slower;  // slower: by a low order that fits better
    Answer slope;          // the error at the smallest h
    double order = 1, deviation = 0;
    bool believed = false;
  };
  Measure measure_;
  std::vector<GridReport> grids_;  // the coarsest first
  Fit fit_;
  double uncertainty_ = 0, moves_ = 0;

  /** O(grids * numbers) for each order */
  Fit fit_of_order(std::span<const GridReport> grids, double order) const;
  Fit best_fit(std::span<const GridReport> grids) const;
  double change(std::size_t k) const;  // of the answer from grid k-1 to k
};

}  // namespace lab
