#include "lab/methods/RungeKutta.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

#include "lab/fast/GraphArrays.hpp"

namespace lab {

namespace {

/** c/m of all nodes [1/s].
 * Throws std::invalid_argument, for @a method, if it differs from node to node.
 * O(N) */
double common_drag(const Cloth& g, const Drag& c, std::string_view method) {
  double r = 0;
  if (c.none()) return r;
  for (Node n : g.nodes()) {
    const double own = c[n.id()] / n.value().mass;
    if (n.index() == 0) r = own;
    if (!DragFlow::is_same(r, own) || !DragFlow::is_same(own, r))
      throw std::invalid_argument(
          std::string(method) +
          ": drag over mass differs from node to node, expected the same at "
          "all: use rk4, or verlet with --dt auto");
  }
  return r;
}

}  // namespace

template <typename Tableau>
int RungeKutta<Tableau>::steps(Cloth& g, const StepTimes& times, int count,
                               const ForcePlan& force,
                               const ConstraintPlan& constraint) {
  const auto version = arrays(g).version();
  flow_.begin(g, force, nystroem);
  if constexpr (nystroem) drag_ = common_drag(g, force.drag(), info.name);
  int k = 0;
  do one_step(g, times(k), times.dt, constraint);
  while (++k < count && arrays(g).version() == version);
  flow_.end();
  return k;
}

template <typename Tableau>
void RungeKutta<Tableau>::one_step(Cloth& g, double t, double dt,
                                   const ConstraintPlan& constraint) {
  if (tolerance_ == no_limit) {
    attempt(g, t, dt, constraint);
    flow_.run({.t = t + dt, .project = &constraint});
    return;
  }
  if (inner_ == 0) inner_ = dt;
  const double end_of_step = t + dt;
  for (double now = t; now < end_of_step;) {
    // An inner step ends where a held node changes its velocity. It is
    // lengthened if the rest up to there would be less than 1 %.
    const double goal =
        std::min(end_of_step, constraint.next_velocity_jump(now));
    const bool last = now + 1.01 * inner_ >= goal;
    const double h = last ? goal - now : inner_;
    double error = attempt(g, now, h, constraint) / tolerance_;
    ++attempts_;
    // Written so that an error that is not finite makes the step smaller.
    bool good = error <= 1;
    double factor = 0.2;
    if (std::isfinite(error))
      factor = std::clamp(0.9 * std::pow(error, -0.2), 0.2, 5.0);
    if (good) {
      now = last ? goal : now + h;
      flow_.run({.t = now, .project = &constraint});
      if (h >= inner_ || factor < 1) inner_ = h * factor;
    } else {
      flow_.cloth().copy(start, FlatCloth::X, 6);
      inner_ = h * std::min(factor, 0.9);
      if (inner_ < 1e-13 * std::max(1.0, end_of_step))
        throw StepError(std::string(info.name) +
                        ": no step meets the "
                        "tolerance at t = " +
                        std::to_string(now) + " s");
    }
  }
}

/** One inner step, which applies no constraint but to held nodes; these have no
 * error.
 * @return the estimated error [m]; 0 if the method has no estimate */
template <typename Tableau>
double RungeKutta<Tableau>::attempt(Cloth& g, double t, double h,
                                    const ConstraintPlan& constraint) {
  FlatCloth& cloth = flow_.cloth();
  flow_.run({.t = t, .held = &constraint, .held_move = true});
  cloth.copy(FlatCloth::X, start, 6);
  const double way = DragFlow(drag_, h).way;  // h in the time s
  for (std::size_t s = 0; s < stages; ++s) {
    const double part = Tableau::c[s] * way;
    FlatStage stage = {.t = t + Tableau::c[s] * h};
    if (drag_ > 0 && Tableau::c[s] < 1)
      stage.t = t - std::log1p(-drag_ * part) / drag_;
    if (s == 0 && nystroem && at_end_of_last_step(t)) {
      cloth.copy(acceleration(stages - 1), acceleration(0), 3);
      continue;
    }
    if (s > 0) {
      weigh(s, way);
      stage.sum = &sum_, stage.held = &constraint, stage.held_move = true;
    }
    stage.kick = 0, stage.keep = true, stage.keep_in = acceleration(s);
    flow_.run(stage);
    const auto rest = [&cloth, s](Node n) {
      cloth.set(acceleration(s), n.id(), Point());
    };
    constraint.each_held(g, std::ref(rest));  // nothing on the heap
  }
  weigh(stages, way);
  flow_.run({.t = t + h, .sum = &sum_, .held = &constraint, .held_move = true});
  if (!nystroem) return 0;
  cloth.copy(FlatCloth::X, end, 6);
  has_end_ = true, end_t_ = t + h, end_version_ = cloth.version();
  return way * error_rate(g, way);
}

template <typename Tableau>
bool RungeKutta<Tableau>::at_end_of_last_step(double t) {
  const FlatCloth& cloth = flow_.cloth();
  bool same = has_end_ && end_t_ == t && end_version_ == cloth.version();
  for (unsigned c = 0; c < 6 && same; ++c)
    same = std::equal(cloth.nodes()[start + c],
                      cloth.nodes()[start + c] + cloth.slots(),
                      cloth.nodes()[end + c]);
  return same;
}

/** sum_ for the state of a @a stage, or at the end of a step of @a h if it is
 * the number of stages. */
template <typename Tableau>
void RungeKutta<Tableau>::weigh(std::size_t stage, double h) {
  const bool last = stage == stages;
  const double c = last ? 1 : Tableau::c[stage];
  // In a Nystroem method the last row of a also gives the end positions.
  const std::size_t row = nystroem && last ? stages - 1 : stage;
  const double* weights =
      last && !nystroem ? Tableau::b.data() : &Tableau::a[row * (row - 1) / 2];
  sum_ = {start, c * h, {}, 0, 1 - drag_ * c * h};
  for (std::size_t k = 0; k < stage; ++k) {
    double to_x, to_v;
    if constexpr (nystroem) {
      to_x = k < row ? stretch(k, h) * weights[k] : 0;
      to_v = last ? stretch(k, h) * Tableau::b[k] : k == 0 ? c : 0;
    } else {
      to_x = of_accelerations(weights, stage, k), to_v = weights[k];
    }
    if (to_x != 0 || to_v != 0)
      sum_.term[sum_.count++] = {acceleration(k), h * h * to_x, h * to_v};
  }
}

/** The factor of the acceleration of @a stage, 1/(1 - r s)^2. */
template <typename Tableau>
double RungeKutta<Tableau>::stretch(std::size_t stage, double h) const {
  const double decay = 1 - drag_ * Tableau::c[stage] * h;
  return 1 / (decay * decay);
}

/** The derivative of x by weights w is v_0 sum(w) + h sum_k (w A)_k a_k.
 * @return (w A)_k */
template <typename Tableau>
double RungeKutta<Tableau>::of_accelerations(const double* weights,
                                             std::size_t count, std::size_t k) {
  double sum = 0;
  for (std::size_t j = k + 1; j < count; ++j)
    sum += weights[j] * Tableau::a[j * (j - 1) / 2 + k];
  return sum;
}

/** The estimated error of a Nystroem method, RMS over the nodes, for h = 1. */
template <typename Tableau>
double RungeKutta<Tableau>::error_rate(const Cloth& g, double h) {
  std::array<double, stages> w{}, to_x{};  // differences of the weights
  if constexpr (nystroem) {
    const double* x = &Tableau::a[(stages - 1) * (stages - 2) / 2];
    for (std::size_t k = 0; k < stages; ++k) {
      if (k + 1 < stages) to_x[k] = x[k] - Tableau::x_low[k];
      w[k] = Tableau::b[k] - Tableau::b_low[k];
      to_x[k] *= h * stretch(k, h), w[k] *= stretch(k, h);
    }
  }
  const Columns& nodes = flow_.cloth().nodes();
  constexpr unsigned tile = FlatCloth::tile;
  double x = 0, v = 0;
  for (unsigned begin = 0; begin < arrays(g).node_slots(); begin += tile) {
    double x2[tile] = {}, v2[tile] = {};
    for (unsigned c = 0; c < 3; ++c) {
      double dx[tile] = {}, dv[tile] = {};
      for (std::size_t k = 0; k < stages; ++k) {
        const double* a = nodes[acceleration(k) + c] + begin;
        for (unsigned i = 0; i < tile; ++i)
          dx[i] += to_x[k] * a[i], dv[i] += w[k] * a[i];
      }
      for (unsigned i = 0; i < tile; ++i)
        x2[i] += dx[i] * dx[i], v2[i] += dv[i] * dv[i];
    }
    const unsigned count = std::min(tile, arrays(g).node_slots() - begin);
    for (unsigned i = 0; i < count; ++i)
      if (arrays(g).node_in_use(begin + i)) x += x2[i], v += v2[i];
  }
  return std::sqrt(std::max(x, v) / std::max(1u, g.num_nodes()));
}

template <typename Tableau>
void RungeKutta<Tableau>::archive(Archive& a, const Cloth& g) {
  bool has = has_end_ && end_version_ == arrays(g).version();
  a(inner_)(has).require(inner_ >= 0 && std::isfinite(inner_));
  has_end_ = has;
  if (!has) return;
  end_version_ = arrays(g).version();
  const unsigned last = acceleration(stages - 1);
  for (unsigned column : {end, end + 3, last}) flow_.archive_kept(a, g, column);
  a(end_t_);
}

template class RungeKutta<ForwardEulerTableau>;
template class RungeKutta<Rk4Tableau>;
template class RungeKutta<Rkn64Tableau>;

}  // namespace lab
