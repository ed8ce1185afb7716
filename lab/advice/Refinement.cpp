#include "lab/advice/Refinement.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace lab {

namespace {
// Weights in the uncertainty, tuned by adviser_suite.cpp: README.md.
constexpr double of_limit = 0.2, of_untried = 0.2, of_spread = 1.5;

/** By what an error of @a order is multiplied on a grid of @a finer times the
 * cells. */
double error_ratio(double order, double finer) {
  return std::pow(finer, -order);
}
}  // namespace

void Refinement::add(const GridReport& next) {
  if (size() >= 3) limit_before_ = limit();
  if (!has_intermediate()) intermediate_.clear();
  grids_.push_back(next);
  if (size() >= 3) order_ = order_of(grids_);
  for (GridReport& g : grids_) estimate(g);
  for (GridReport& g : intermediate_) estimate(g);
}

void Refinement::add_intermediate(const GridReport& next) {
  intermediate_.push_back(next);
  estimate(intermediate_.back());
}

void Refinement::estimate(GridReport& g) const {
  g.error = size() == 2 ? std::numeric_limits<double>::infinity()
                        : error(g.factor).size(measure_);
}

std::vector<GridReport> Refinement::tried() const {
  std::vector<GridReport> all = grids_;
  all.insert(all.end(), intermediate_.begin(), intermediate_.end());
  std::ranges::sort(all, {}, &GridReport::factor);
  return all;
}

const GridReport* Refinement::find(double factor) const {
  for (const auto* grids : {&grids_, &intermediate_})
    for (const GridReport& g : *grids)
      if (g.factor == factor) return &g;
  return nullptr;
}

bool Refinement::has_intermediate() const {
  return size() > 1 && !intermediate_.empty() &&
         intermediate_.back().factor > grids_[size() - 2].factor;
}

double Refinement::step_to(std::size_t k) const { return step_to(grids_, k); }

double Refinement::step_to(const std::vector<GridReport>& grids,
                           std::size_t k) const {
  return distance(grids[k - 1].trial.answer, grids[k].trial.answer, measure_);
}

bool Refinement::settles() const {
  const std::size_t n = size();
  return n < 3 || step_to(n - 1) <= 0.8 * step_to(n - 2);
}

Effect Refinement::error(double factor) const {
  Effect all(answer(size() - 1).size());
  if (size() < 2) return all;
  const Answer &last = back().trial.answer, &before = answer(size() - 2);
  const double next = error_ratio(order_, 2);
  all.add(next / (1 - next), Effect(before, last).by);
  if (const GridReport* g = find(factor))
    return all.add(1, Effect(g->trial.answer, last).by);
  return Effect(all.by.size())
      .add(error_ratio(order_, factor / back().factor), all.by);
}

Answer Refinement::limit() const {
  return Effect(back().trial.answer, error(back().factor).by).by;
}

/** If there are only two, by the order of the main grids. */
Answer Refinement::limit_of_intermediate() const {
  const Answer &last = intermediate_.back().trial.answer,
               &before = intermediate_[intermediate_.size() - 2].trial.answer;
  const double next = error_ratio(
      intermediate_.size() > 2 ? order_of(intermediate_) : order_, 2);
  return Effect(last, Effect(before.size())
                          .add(next / (1 - next), Effect(before, last).by)
                          .by)
      .by;
}

double Refinement::uncertainty_of_limit() const {
  const std::size_t n = size();
  if (n < 3) return 0;
  // Any three grids have an order that fits; four grids confirm it or not.
  const double last = back().error, own = n > 3 ? of_limit * last : last;
  double other = n > 3 ? 2 * distance(limit(), limit_before_, measure_) : last;
  if (has_intermediate() && intermediate_.size() > 1) {
    const GridReport& g = intermediate_.back();
    Effect deviation = error(g.factor);
    deviation.add(-error_ratio(order_, g.factor / back().factor),
                  error(back().factor).by);
    other = distance(limit(), limit_of_intermediate(), measure_) +
            deviation.size(measure_);
  }
  return of_spread * (own + other);
}

double Refinement::uncertainty(double factor) const {
  return uncertainty_of_limit() +
         (find(factor) ? 0 : of_untried * error(factor).size(measure_));
}

/** The observed order, limited to [0.8, 2]: extrapolation with a smaller order
 * is meaningless, and no scheme here has a larger one.  @pre three grids */
double Refinement::order_of(const std::vector<GridReport>& grids) const {
  const double d = step_to(grids, grids.size() - 2),
               e = step_to(grids, grids.size() - 1);
  return std::clamp(e > 0 ? std::log2(d / e) : 2.0, 0.8, 2.0);
}

}  // namespace lab
