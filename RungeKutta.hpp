#pragma once
/** @file RungeKutta.hpp
 * Runge-Kutta methods for a cloth: forward Euler, RK4 and Dormand-Prince. They
 * treat positions and velocities alike, and drag as a force like others. */
#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "Integrator.hpp"

/** An explicit Runge-Kutta method for x' = v, v' = F(x, v, t)/m.
 *
 * @tparam Tableau has info; a, the lower triangle row by row, b and c. With
 *         also b_low, the weights of a lower order, it controls its error:
 *         then step() makes as many steps inside [t, t + dt] as it needs.
 *
 * Error control: in each inner step the RMS over the nodes of the estimated
 * error stays below tolerance(), for positions in [m] and for velocities times
 * 1 s. The next step is 0.9 (tolerance/error)^(1/p) times as long, at least
 * 0.2 and at most 5 times. Source: Hairer, Norsett, Wanner, Solving Ordinary
 * Differential Equations I, II.4. */
template <typename Tableau>
class RungeKutta : public Method {
 public:
  static constexpr MethodInfo info = Tableau::info;
  static constexpr bool adaptive = requires { Tableau::b_low; };

  /** @param tolerance [m] > 0; infinite: one inner step for each step(). Only
   * an adaptive method has one. */
  explicit RungeKutta(double tolerance = adaptive ? 1e-6 : no_limit)
      : tolerance_(tolerance) {}
  double tolerance() const { return tolerance_; }

  double step(Cloth& g, double t, double dt, const ZeroForce& force,
              const ZeroConstraint& constraint) override {
    if (!adaptive || tolerance_ == no_limit) {
      attempt(g, t, dt, force, constraint);
      constraint(g, t + dt);
      return t + dt;
    }
    if (inner_ == 0) inner_ = dt;
    const double end = t + dt;
    for (double now = t; now < end;) {
      // A last step that leaves a splinter takes it along.
      double h = now + 1.01 * inner_ >= end ? end - now : inner_;
      double error = attempt(g, now, h, force, constraint) / tolerance_;
      // Written so that an error that is not finite makes the step smaller.
      bool good = error <= 1;
      double factor = 0.2;
      if (std::isfinite(error))
        factor = std::clamp(0.9 * std::pow(error, -1.0 / info.order), 0.2, 5.0);
      if (good) {
        now = h == end - now ? end : now + h;
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
  void restart() override { inner_ = 0, end_x_.clear(); }

 private:
  static constexpr std::size_t stages = Tableau::b.size();
  // Dormand-Prince: the last stage is the first one of the next step.
  static constexpr bool first_same_as_last =
      Tableau::b.back() == 0 && stages > 1;

  double tolerance_;
  double inner_ = 0;  // next inner step [s]; 0: not chosen yet
  Sweep sweep_;
  std::vector<Point> x0_, v0_, force_;
  std::array<std::vector<Point>, stages> v_, a_;  // derivatives, by stage
  std::vector<Point> end_x_, end_v_;  // where the last stage was taken
  double end_t_ = 0;

  /** One step without error control; takes no constraint but held nodes.
   * @return the estimated error [m]; 0 if the method has no estimate */
  double attempt(Cloth& g, double t, double h, const ZeroForce& force,
                 const ZeroConstraint& constraint) {
    const unsigned n = g.node_slots();
    auto x = g.positions();
    auto node = g.node_values();
    x0_.assign(x.begin(), x.end());
    v0_.resize(n);
    for (unsigned i = 0; i < n; ++i) v0_[i] = node[i].vel;
    for (std::size_t s = 0; s < stages; ++s) {
      if (s > 0) set_state(g, h, &Tableau::a[s * (s - 1) / 2], s, constraint);
      if (s == 0 && first_same_as_last && at_end_of_last_step(t)) {
        std::swap(v_[0], v_[stages - 1]);
        std::swap(a_[0], a_[stages - 1]);
      } else {
        derive(g, t + Tableau::c[s] * h, force, constraint, s);
      }
    }
    if constexpr (first_same_as_last) {
      // The last stage stands at the end of the step already.
      end_x_.assign(x.begin(), x.end());
      end_v_.resize(n);
      for (unsigned i = 0; i < n; ++i) end_v_[i] = node[i].vel;
      end_t_ = t + h;
    } else {
      set_state(g, h, Tableau::b.data(), stages, constraint);
    }
    if constexpr (adaptive) return h * error_rate(g);
    return 0;
  }

  bool at_end_of_last_step(double t) const {
    return end_t_ == t && end_x_ == x0_ && end_v_ == v0_;
  }

  /** State 0 plus h times the weighted derivatives of @a count stages. */
  void set_state(Cloth& g, double h, const double* weights, std::size_t count,
                 const ZeroConstraint& constraint) {
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
    stop_held(g, constraint);
  }

  /** The derivatives of the present state as those of stage @a s. */
  void derive(Cloth& g, double t, const ZeroForce& force,
              const ZeroConstraint& constraint, std::size_t s) {
    sweep_(g, t, force, force_);
    constraint.each_held(g, [this](Node n) { force_[n.id()] = Point(); });
    auto node = g.node_values();
    v_[s].resize(g.node_slots());
    a_[s].resize(g.node_slots());
    for (unsigned i = 0; i < g.node_slots(); ++i) {
      v_[s][i] = node[i].vel;
      a_[s][i] = force_[i] / node[i].mass;
    }
  }

  /** RMS of the difference to the lower order, for h = 1. */
  double error_rate(const Cloth& g) const {
    double x = 0, v = 0;
    for (unsigned i = 0; i < g.node_slots(); ++i) {
      if (!g.node_in_use(i)) continue;
      Point dx, dv;
      for (std::size_t s = 0; s < stages; ++s) {
        double w = Tableau::b[s] - Tableau::b_low[s];
        dx += w * v_[s][i];
        dv += w * a_[s][i];
      }
      x += normSq(dx);
      v += normSq(dv);
    }
    return std::sqrt(std::max(x, v) / std::max(1u, g.num_nodes()));
  }
};

/** Source: L. Euler, Institutionum calculi integralis I (1768). */
struct ForwardEulerTableau {
  static constexpr MethodInfo info = {
      "forward-euler",
      1,
      1,
      0,
      "Euler 1768",
      "nothing: it is the control that must fail",
      "always, without drag: it feeds energy in"};
  static constexpr std::array<double, 0> a = {};
  static constexpr std::array b = {1.0};
  static constexpr std::array c = {0.0};
};
using ForwardEuler = RungeKutta<ForwardEulerTableau>;

/** Source: W. Kutta, Z. Math. Phys. 46 (1901) 435. */
struct Rk4Tableau {
  static constexpr MethodInfo info = {
      "rk4",
      4,
      4,
      2.8284,
      "Kutta 1901",
      "being known to everyone",
      "long runs: it takes (dt omega)^6/72 of the energy a step"};
  static constexpr std::array a = {0.5, 0.0, 0.5, 0.0, 0.0, 1.0};
  static constexpr std::array b = {1 / 6., 1 / 3., 1 / 3., 1 / 6.};
  static constexpr std::array c = {0.0, 0.5, 0.5, 1.0};
};
using Rk4 = RungeKutta<Rk4Tableau>;

/** Source: J. R. Dormand, P. J. Prince, J. Comput. Appl. Math. 6 (1980) 19. */
struct DormandPrinceTableau {
  static constexpr MethodInfo info = {
      "dormand-prince",
      5,
      6,
      0.9971,
      "Dormand, Prince 1980",
      "a tolerance instead of a step",
      "springs: its limit per sweep is a twelfth of verlet's",
      true};
  static constexpr std::array a = {1 / 5.,
                                   3 / 40.,
                                   9 / 40.,
                                   44 / 45.,
                                   -56 / 15.,
                                   32 / 9.,
                                   19372 / 6561.,
                                   -25360 / 2187.,
                                   64448 / 6561.,
                                   -212 / 729.,
                                   9017 / 3168.,
                                   -355 / 33.,
                                   46732 / 5247.,
                                   49 / 176.,
                                   -5103 / 18656.,
                                   35 / 384.,
                                   0.,
                                   500 / 1113.,
                                   125 / 192.,
                                   -2187 / 6784.,
                                   11 / 84.};
  static constexpr std::array b = {
      35 / 384., 0., 500 / 1113., 125 / 192., -2187 / 6784., 11 / 84., 0.};
  static constexpr std::array b_low = {
      5179 / 57600.,    0.,          7571 / 16695., 393 / 640.,
      -92097 / 339200., 187 / 2100., 1 / 40.};
  static constexpr std::array c = {0., 1 / 5., 3 / 10., 4 / 5., 8 / 9., 1., 1.};
};
using DormandPrince = RungeKutta<DormandPrinceTableau>;
