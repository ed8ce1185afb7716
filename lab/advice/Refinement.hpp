#pragma once
/** @file Refinement.hpp
 * One scene on finer and finer grids: how far each is from what they tend to,
 * and how sure that is. */
#include <algorithm>
#include <cmath>
#include <limits>
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
  double error = 0;  ///< of the answer, estimated; infinite: not known
  Trial trial;       ///< all parts, by Verlet at safe_share of its limit
};

namespace refinement_detail {

constexpr double infinite = std::numeric_limits<double>::infinity();

}  // namespace refinement_detail

/** A scene on grids, each of twice as many cells along each side as the one
 * before, by steps that go down with the grid. From three grids on, the order
 * in which their answers come closer shows what they tend to: Richardson's
 * extrapolation. Source: P. J. Roache, Verification and Validation in
 * Computational Science and Engineering, 1998, chapter 5. */
class Refinement {
 public:
  explicit Refinement(Measure measure = Measure::com) : measure_(measure) {}

  /** Add the next grid, and estimate the errors of all anew. One grid alone has
   * error 0: that of a mesh from files is not known. */
  void add(const GridReport& next) {
    grids_.push_back(next);
    if (size() >= 3) order_ = order();
    for (GridReport& g : grids_)
      g.error = size() == 2 ? refinement_detail::infinite
                            : error(g.factor).size(measure_);
  }
  void clear() { grids_.clear(); }
  std::size_t size() const { return grids_.size(); }
  bool empty() const { return grids_.empty(); }
  const GridReport& operator[](std::size_t k) const { return grids_[k]; }
  const GridReport& back() const { return grids_.back(); }
  auto begin() const { return grids_.begin(); }
  auto end() const { return grids_.end(); }

  /** How far apart the answers of grids k-1 and k are. */
  double step_to(std::size_t k) const {
    return distance(answer(k - 1), answer(k), measure_);
  }
  /** False if the answers of the last three grids do not come closer. */
  bool settles() const {
    const std::size_t n = size();
    return n < 3 || step_to(n - 1) <= 0.8 * step_to(n - 2);
  }

  /** The error of the grid of @a factor, whether it was tried or not.
   * @pre size() is not 0 or 2 */
  Effect error(double factor) const {
    Effect all(answer(size() - 1).size());
    if (size() < 2) return all;
    const GridReport &last = back(), &before = grids_[size() - 2];
    all.add(1 / (std::pow(2, order_) - 1),
            Effect(before.trial.answer, last.trial.answer).by);
    for (const GridReport& g : grids_)
      if (g.factor == factor)
        return all.add(1, Effect(g.trial.answer, last.trial.answer).by);
    return Effect(all.by.size())
        .add(std::pow(last.factor / factor, order_), all.by);
  }
  /** What all answers tend to.  @pre as for error() */
  Answer limit() const {
    return Effect(back().trial.answer, error(back().factor).by).by;
  }
  /** How far that may be from the truth. */
  double doubt_of_limit() const {
    const std::size_t k = size() - 1;
    if (k < 2) return 0;
    // The order of three grids fits them by choice; that of four has to.
    const double share = of_limit + (k > 2 ? surprise(k - 1) / 2 : of_limit);
    // What is unforeseen of one step may come again at the next ones.
    const double more = std::pow(2, order_);
    return std::min(1.0, share) * back().error +
           surprise(k) * step_to(k - 1) / more / (more - 1);
  }
  /** How much larger than its size the error of the grid of @a factor may be.
   */
  double doubt(double factor) const {
    const bool tried = std::ranges::count(grids_, factor, &GridReport::factor);
    return doubt_of_limit() +
           (tried ? 0 : of_untried * error(factor).size(measure_));
  }

 private:
  // Shares of an error; by experience, see adviser_suite.cpp.
  static constexpr double of_limit = 0.15, of_untried = 0.2;

  Measure measure_;
  std::vector<GridReport> grids_;
  double order_ = 1;

  const Answer& answer(std::size_t k) const { return grids_[k].trial.answer; }

  /** Slower than the least foresees nothing; faster than the largest goes no
   * scheme here. */
  double order() const {
    const double d = step_to(size() - 2), e = step_to(size() - 1);
    return std::clamp(e > 0 ? std::log2(d / e) : 2.0, 0.8, 2.0);
  }
  /** How far the step to grid k-1 is from what the step to grid k makes expect,
   * relative to it. */
  double surprise(std::size_t k) const {
    Effect d(answer(k - 1), answer(k - 2));
    const double all = d.size(measure_);
    d.add(-std::pow(2, order_), Effect(answer(k), answer(k - 1)).by);
    return all > 0 ? d.size(measure_) / all : 0;
  }
};

}  // namespace lab
