#include "lab/methods/RungeKutta.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "lab/methods/Dop853.hpp"
#include "lab/methods/DormandPrince.hpp"
#include "lab/methods/ForwardEuler.hpp"
#include "lab/methods/Rk4.hpp"

namespace lab {

template <typename Tableau>
double RungeKutta<Tableau>::step(Cloth& g, double t, double dt,
                                 const ForcePlan& force,
                                 const ConstraintPlan& constraint) {
  if (!adaptive || tolerance_ == no_limit) {
    attempt(g, t, dt, force, constraint);
    constraint(g, t + dt);
    return t + dt;
  }
  if (inner_ == 0) inner_ = dt;
  const double end = t + dt;
  for (double now = t; now < end;) {
    // A last step that leaves a splinter takes it along.
    // It ends where a held node changes its velocity.
    const double goal = std::min(end, constraint.next_kink(now));
    const bool last = now + 1.01 * inner_ >= goal;
    const double h = last ? goal - now : inner_;
    double error = attempt(g, now, h, force, constraint) / tolerance_;
    // Written so that an error that is not finite makes the step smaller.
    bool good = error <= 1;
    double factor = 0.2;
    if (std::isfinite(error))
      factor = std::clamp(0.9 * std::pow(error, -1.0 / info.order), 0.2, 5.0);
    if (good) {
      now = last ? goal : now + h;
      constraint(g, now);
      if (h >= inner_ || factor < 1) inner_ = h * factor;
    } else {
      std::copy(x0_.begin(), x0_.end(), g.positions().begin());
      for (unsigned i = 0; i < g.node_slots(); ++i)
        g.node_values()[i].vel = v0_[i];
      inner_ = h * std::min(factor, 0.9);
      if (inner_ < 1e-13 * std::max(1.0, end))
        throw StepError(std::string(info.name) +
                        ": no step meets the "
                        "tolerance at t = " +
                        std::to_string(now) + " s");
    }
  }
  return end;
}

/** One step without error control; takes no constraint but held nodes, which
 * have no error.
 * @return the estimated error [m]; 0 if the method has no estimate */
template <typename Tableau>
double RungeKutta<Tableau>::attempt(Cloth& g, double t, double h,
                                    const ForcePlan& force,
                                    const ConstraintPlan& constraint) {
  const unsigned n = g.node_slots();
  auto x = g.positions();
  auto node = g.node_values();
  constraint.place_held(g, t);
  x0_.assign(x.begin(), x.end());
  v0_.resize(n);
  for (unsigned i = 0; i < n; ++i) v0_[i] = node[i].vel;
  for (std::size_t s = 0; s < stages; ++s) {
    const double now = t + Tableau::c[s] * h;
    if (s > 0)
      set_state(g, now, h, &Tableau::a[s * (s - 1) / 2], s, constraint);
    if (s == 0 && first_same_as_last && at_end_of_last_step(t)) {
      std::swap(v_[0], v_[stages - 1]);
      std::swap(a_[0], a_[stages - 1]);
    } else {
      derive(g, now, force, constraint, s);
    }
  }
  if constexpr (first_same_as_last) {
    // The last stage stands at the end of the step already.
    end_x_.assign(x.begin(), x.end());
    end_v_.resize(n);
    for (unsigned i = 0; i < n; ++i) end_v_[i] = node[i].vel;
    end_t_ = t + h;
  } else {
    set_state(g, t + h, h, Tableau::b.data(), stages, constraint);
  }
  if constexpr (adaptive) return h * error_rate(g);
  return 0;
}

template <typename Tableau>
bool RungeKutta<Tableau>::at_end_of_last_step(double t) const {
  return end_t_ == t && end_x_ == x0_ && end_v_ == v0_;
}

/** State 0 plus h times the weighted derivatives of @a count stages: that at
 * time @a t. */
template <typename Tableau>
void RungeKutta<Tableau>::set_state(Cloth& g, double t, double h,
                                    const double* weights, std::size_t count,
                                    const ConstraintPlan& constraint) {
  auto x = g.positions();
  auto node = g.node_values();
  for (unsigned i = 0; i < g.node_slots(); ++i) {
    Point dx, dv;
    for (std::size_t s = 0; s < count; ++s) {
      dx += weights[s] * v_[s][i];
      dv += weights[s] * a_[s][i];
    }
    x[i] = x0_[i] + h * dx;
    node[i].vel = v0_[i] + h * dv;
  }
  constraint.place_held(g, t);
}

/** The derivatives of the present state as those of stage @a s. */
template <typename Tableau>
void RungeKutta<Tableau>::derive(Cloth& g, double t, const ForcePlan& force,
                                 const ConstraintPlan& constraint,
                                 std::size_t s) {
  flow_.accelerate(g, t, force, false);
  auto node = g.node_values();
  v_[s].resize(g.node_slots());
  a_[s].resize(g.node_slots());
  for (unsigned i = 0; i < g.node_slots(); ++i) {
    v_[s][i] = node[i].vel;
    a_[s][i] = flow_.acceleration(i);
  }
  constraint.each_held(
      g, [&](Node n) { v_[s][n.id()] = a_[s][n.id()] = Point(); });
}

/** The estimated error, RMS over the nodes, for h = 1. */
template <typename Tableau>
double RungeKutta<Tableau>::error_rate(const Cloth& g) const {
  double error = 0;
  if constexpr (adaptive) error = rms(g, Tableau::b_low.data());
  if constexpr (requires { Tableau::b_third; }) {
    if (!(error > 0)) return error;
    const double third = rms(g, Tableau::b_third.data());
    error *= error / std::sqrt(error * error + 0.01 * third * third);
  }
  return error;
}

/** Of the difference to the weights @a other. */
template <typename Tableau>
double RungeKutta<Tableau>::rms(const Cloth& g, const double* other) const {
  double x = 0, v = 0;
  for (unsigned i = 0; i < g.node_slots(); ++i) {
    if (!g.node_in_use(i)) continue;
    Point dx, dv;
    for (std::size_t s = 0; s < stages; ++s) {
      const double w = Tableau::b[s] - other[s];
      dx += w * v_[s][i];
      dv += w * a_[s][i];
    }
    x += normSq(dx);
    v += normSq(dv);
  }
  return std::sqrt(std::max(x, v) / std::max(1u, g.num_nodes()));
}

template class RungeKutta<ForwardEulerTableau>;
template class RungeKutta<Rk4Tableau>;
template class RungeKutta<DormandPrinceTableau>;
template class RungeKutta<Dop853Tableau>;

}  // namespace lab
