#include "lab/advice/Refinement.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace lab {

namespace {
// Shares of an error; by experience, see adviser_suite.cpp.
constexpr double of_limit = 0.15, of_untried = 0.2;
}  // namespace

void Refinement::add(const GridReport& next) {
  grids_.push_back(next);
  if (size() >= 3) order_ = order();
  for (GridReport& g : grids_)
    g.error = size() == 2 ? std::numeric_limits<double>::infinity()
                          : error(g.factor).size(measure_);
}

double Refinement::step_to(std::size_t k) const {
  return distance(answer(k - 1), answer(k), measure_);
}

bool Refinement::settles() const {
  const std::size_t n = size();
  return n < 3 || step_to(n - 1) <= 0.8 * step_to(n - 2);
}

Effect Refinement::error(double factor) const {
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

Answer Refinement::limit() const {
  return Effect(back().trial.answer, error(back().factor).by).by;
}

double Refinement::uncertainty_of_limit() const {
  const std::size_t k = size() - 1;
  if (k < 2) return 0;
  // The order of three grids fits them by choice; that of four has to.
  const double share = of_limit + (k > 2 ? surprise(k - 1) / 2 : of_limit);
  // What is unforeseen of one step may come again at the next ones.
  const double more = std::pow(2, order_);
  return std::min(1.0, share) * back().error +
         surprise(k) * step_to(k - 1) / more / (more - 1);
}

double Refinement::uncertainty(double factor) const {
  const bool tried = std::ranges::count(grids_, factor, &GridReport::factor);
  return uncertainty_of_limit() +
         (tried ? 0 : of_untried * error(factor).size(measure_));
}

/** The observed order, clamped to [0.8, 2]: below, extrapolation is
 * meaningless; above, no scheme here converges. */
double Refinement::order() const {
  const double d = step_to(size() - 2), e = step_to(size() - 1);
  return std::clamp(e > 0 ? std::log2(d / e) : 2.0, 0.8, 2.0);
}

/** How far the step to grid k-1 is from what the step to grid k makes expect,
 * relative to it. */
double Refinement::surprise(std::size_t k) const {
  Effect d(answer(k - 1), answer(k - 2));
  const double all = d.size(measure_);
  d.add(-std::pow(2, order_), Effect(answer(k), answer(k - 1)).by);
  return all > 0 ? d.size(measure_) / all : 0;
}

}  // namespace lab
