#pragma once
/** @file Refinement.hpp
 * Refinement: estimates the error of each of several grids of one scene. */
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

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
};

/** Runs of a scene on grids of ever more cells, with steps that shrink with the
 * cells. From three grids on, the least-squares fit to the finest of them that
 * README.md describes gives their limit a, the error c h^p of each grid, h =
 * 1 / factor, and the observed order p. */
class Refinement {
 public:
  /** @param slow a pin holds one node: the order is taken to be 1/2, by the
   * four finest grids, as coarser ones can show any other */
  explicit Refinement(Measure measure = Measure::com, bool slow = false)
      : measure_(measure), slow_(slow) {}

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
  /** The order was not observed, but taken to be 1/2. */
  bool slow() const { return slow_; }
  /** The standard deviation of the answers from the fit. */
  double deviation() const { return fit_.deviation; }
  /** The error of the grid of @a factor, measured or predicted. */
  Effect error(double factor) const;
  /** The limit of the answers. */
  const Answer& limit() const { return fit_.limit; }
  /** The uncertainty of limit() at a confidence of 95 %: u of README.md; of
   * three grids, which have no deviation, three times the error. */
  double uncertainty() const { return uncertainty_; }
  /** False if the answers drift apart by more than @a negligible: refinements
   * change them by more each time. */
  bool converges(double negligible) const;

 private:
  struct Fit {
    Answer limit, faster;  // faster: by order 1, if the order is lower
    Answer slope;          // the error at the smallest h
    double order = 1, deviation = 0;
    bool believed = false;
  };
  Measure measure_;
  bool slow_;
  std::vector<GridReport> grids_;  // the coarsest first
  Fit fit_;
  double uncertainty_ = 0;

  /** O(grids * numbers) for each order */
  Fit fit_of_order(std::span<const GridReport> grids, double order) const;
  /** @param may_be_slow of an order that is too low to be believed, if that
   * fits much better than 1 and 2 */
  Fit best_fit(std::span<const GridReport> grids, bool may_be_slow) const;
};

}  // namespace lab
