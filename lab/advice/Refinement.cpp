#include "lab/advice/Refinement.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace lab {

namespace {
// Shares of an error, and of how far two limits are apart: by experience, see
// adviser_suite.cpp.
constexpr double of_limit = 0.05, of_untried = 0.2, of_spread = 1.8;
}  // namespace

void Refinement::add(const GridReport& next) {
  if (size() >= 3) limit_before_ = limit();
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

/** What the error a h + b h^2 of mesh width h makes the limit of three grids:
 * Romberg's extrapolation.
 * @pre k is at least 2, and a grid */
Answer Refinement::limit_by_powers(std::size_t k) const {
  const Answer &a = answer(k - 2), &b = answer(k - 1), &c = answer(k);
  return Effect(a.size()).add(1 / 3., a).add(-2, b).add(8 / 3., c).by;
}

double Refinement::uncertainty_of_limit() const {
  const std::size_t n = size();
  if (n < 3) return 0;
  const double by_law = distance(limit(), limit_by_powers(n - 1), measure_);
  // The order of three grids fits them by choice; that of four has to. Limits
  // come nearer to each other, too, if five grids tell so.
  const double by_grids =
      n > 3 ? distance(limit(), limit_before_, measure_) / (n > 4 ? 2 : 1)
            : back().error / 4;
  return of_limit * back().error + of_spread * std::max(by_law, by_grids);
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

}  // namespace lab
