#include "lab/advice/Refinement.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "lab/advice/Constants.hpp"

namespace lab {

void Refinement::add(GridReport next) {
  grids_.push_back(std::move(next));
  if (size() == 1) fit_.limit = back().trial.answer;
  if (size() < 3) return;
  std::size_t from = size() - std::min(size(), constant.fewest);
  while (!slow_ && from > 0 &&
         back().factor <= constant.widest * grids_[from - 1].factor)
    --from;
  const std::span<const GridReport> all = grids_, used = all.subspan(from);
  fit_ = best_fit(used, true);
  for (GridReport& g : grids_) g.error = error(g.factor).size(measure_);
  double moves = 0;
  const auto compare = [&, this](std::span<const GridReport> others) {
    const Fit fit = fit_.order < constant.believed_from
                        ? fit_of_order(others, fit_.order)
                        : best_fit(others, false);
    moves = std::max(moves, distance(fit.limit, fit_.limit, measure_));
  };
  if (slow_ && from > 0)
    compare(
        all.subspan(from - 1, constant.fewest));  // the fit before this grid
  else if (used.size() > 3)
    compare(used.first(used.size() - 1)), compare(used.last(used.size() - 1));
  const double error =
      distance(fit_.slope, Answer(fit_.slope.size()), measure_);
  uncertainty_ = (fit_.believed ? 1 : constant.not_believed) *
                     (constant.of_error * error + fit_.deviation) +
                 moves + distance(fit_.faster, fit_.limit, measure_);
  if (used.size() == 3) uncertainty_ = constant.of_three_grids * error;
}

Refinement::Fit Refinement::fit_of_order(std::span<const GridReport> grids,
                                         double order) const {
  const std::size_t n = grids.size(), numbers = fit_.limit.size();
  double all = 0, mean = 0, spread = 0;
  for (const GridReport& g : grids) all += g.factor;
  auto weight = [&](const GridReport& g) { return g.factor / all; };
  auto power = [&](const GridReport& g) {  // (h_k / smallest h)^p
    return std::pow(grids.back().factor / g.factor, order);
  };
  for (const GridReport& g : grids) mean += weight(g) * power(g);
  for (const GridReport& g : grids)
    spread += weight(g) * (power(g) - mean) * (power(g) - mean);
  Effect center(numbers), slope(numbers);
  for (const GridReport& g : grids) {
    center.add(weight(g), g.trial.answer);
    slope.add(weight(g) * (power(g) - mean) / spread, g.trial.answer);
  }
  const Answer limit = Effect(center).add(-mean, slope.by).by;
  Fit fit{limit, limit, slope.by, order};
  for (const GridReport& g : grids) {
    const double off = Effect(g.trial.answer, fit.limit)
                           .add(-power(g), slope.by)
                           .size(measure_);
    fit.deviation += weight(g) * off * off;
  }
  fit.deviation = std::sqrt(fit.deviation * double(n) /
                            double(std::max<std::size_t>(n, 4) - 3));
  return fit;
}

Refinement::Fit Refinement::best_fit(std::span<const GridReport> grids,
                                     bool may_be_slow) const {
  const Fit one = fit_of_order(grids, 1), two = fit_of_order(grids, 2);
  if (slow_) {
    Fit half = fit_of_order(grids, 0.5);
    half.faster = one.limit;
    return half;
  }
  Fit best = fit_of_order(grids, constant.lowest);
  for (double p = constant.lowest + constant.apart;
       p < constant.believed_to + 1.5 * constant.apart; p += constant.apart)
    if (Fit f = fit_of_order(grids, p); f.deviation < best.deviation) best = f;
  best.believed = best.order >= constant.believed_from &&
                  best.order <= constant.believed_to;
  const Fit& usual = one.deviation <= two.deviation ? one : two;
  if (best.order < 1) best.faster = one.limit;
  const bool slow = may_be_slow && best.order < constant.believed_from &&
                    best.deviation <= constant.fits_better * usual.deviation;
  return best.believed || slow ? best : usual;
}

Effect Refinement::error(double factor) const {
  for (const GridReport& g : grids_)
    if (g.factor == factor) return Effect(g.trial.answer, fit_.limit);
  return Effect(fit_.slope.size())
      .add(std::pow(back().factor / factor, fit_.order), fit_.slope);
}

bool Refinement::converges(double negligible) const {
  const std::size_t n = size();
  auto change = [&](std::size_t k) {  // from grid k-1 to k
    return distance(grids_[k - 1].trial.answer, grids_[k].trial.answer,
                    measure_);
  };
  return n < 5 || change(n - 1) <= negligible ||
         change(n - 1) + change(n - 2) <= change(n - 3) + change(n - 4);
}

}  // namespace lab
