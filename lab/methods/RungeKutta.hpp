#pragma once
/** @file RungeKutta.hpp
 * Explicit Runge-Kutta methods: ForwardEuler, Rk4, Rkn64 are their tableaus. A
 * new tableau needs a line at the end of RungeKutta.cpp. */
#include <array>
#include <cstddef>
#include <cstdint>

#include "lab/fast/FlatFlow.hpp"
#include "lab/methods/Method.hpp"

namespace lab {

/** The tolerance of inner steps, as a share of the tolerance of a run. On six
 * smooth problems the error at the end was then 1e-4 to 0.5 of the tolerance,
 * from 1e-3 to 1e-9 m (test_cloth_tolerance). In chaotic motion, as of a cloth
 * that buckles for long, no local tolerance bounds that error. */
inline constexpr double tolerance_share = 0.25;

/** An explicit Runge-Kutta method for x' = v, v' = F(x, v, t)/m.
 *
 * Since x' = v, and v is a sum of accelerations a_k, a stage stores only these:
 *   v = v_0 + h sum_k w_k a_k,  x = x_0 + c h v_0 + h^2 sum_k (w A)_k a_k
 * where w is a row of the tableau's A, or b: its Nystroem form (II.14 of the
 * source). Drag is a force like others.
 *
 * A Runge-Kutta-Nystroem method is one for x'' = F(x)/m: its rows of A weigh
 * the accelerations for x, the last one for x at the end; b weighs them for v
 * there. The last stage is the first one of the next step. Drag r = c/m that
 * all nodes share is solved exactly: with s = (1 - e^(-r t))/r,
 *   d^2 x/ds^2 = F/m/(1 - r s)^2,   v = (1 - r s) dx/ds.
 * In the stages, v is of order 1 only: that is the order with forces that
 * depend on v in another way.
 *
 * @tparam Tableau has info; a, the lower triangle row by row; b and c. A
 * Nystroem method has x_low and b_low, too, the weights of order 4 for x and v,
 * and its error is controlled: step() makes as many inner steps in [t, t + dt]
 * as necessary.
 *
 * Error control: in each inner step the RMS over the nodes of the estimated
 * error stays below the tolerance, for positions in [m] and for velocities
 * times 1 s. The next step is 0.9 (tolerance/error)^(1/5) times as long, at
 * least 0.2 and at most 5 times. Source: Hairer, Norsett, Wanner, Solving
 * Ordinary Differential Equations I, II.4. */
template <typename Tableau>
class RungeKutta : public BatchMethod {
 public:
  static constexpr MethodInfo info = Tableau::info;

  /** @param tolerance [m] > 0; infinite: one inner step for each step(). Only
   * a Nystroem method has one. */
  explicit RungeKutta(double tolerance = nystroem ? 1e-6 : no_limit)
      : tolerance_(tolerance) {}
  void set_tolerance(double tolerance) override {
    if (nystroem) tolerance_ = tolerance;
  }

  int steps(Cloth& g, const StepTimes& times, int count, const ForcePlan& force,
            const ConstraintPlan& constraint) override;
  void restart() override { inner_ = 0, has_end_ = false; }
  Work work() const override { return {.inner = attempts_}; }
  void archive(Archive& a, const Cloth& g) override;

 private:
  static constexpr std::size_t stages = Tableau::b.size();
  static_assert(stages <= kernels::StageSum::most);
  static constexpr bool nystroem = requires { Tableau::x_low; };

  // Columns of the cloth: x and v at the start of a step, and at its end; the
  // accelerations of each stage.
  static constexpr unsigned start = FlatCloth::columns, end = start + 6,
                            first = nystroem ? end + 6 : end;
  static constexpr unsigned acceleration(std::size_t stage) {
    return first + 3 * unsigned(stage);
  }

  double tolerance_;
  double inner_ = 0;  // next inner step [s]; 0: not chosen yet
  double drag_ = 0;   // r of a Nystroem method [1/s]
  long long attempts_ = 0;
  FlatFlow flow_{acceleration(stages) - FlatCloth::columns};
  kernels::StageSum sum_;
  bool has_end_ = false;  // whether columns `end` and the last stage are valid,
  double end_t_ = 0;      // for this time
  std::uint64_t end_version_ = 0;

  void one_step(Cloth& g, double t, double dt,
                const ConstraintPlan& constraint);
  double attempt(Cloth& g, double t, double h,
                 const ConstraintPlan& constraint);
  bool at_end_of_last_step(double t);
  void weigh(std::size_t stage, double h);
  double stretch(std::size_t stage, double h) const;
  static double of_accelerations(const double* weights, std::size_t count,
                                 std::size_t k);
  double error_rate(const Cloth& g, double h);
};

/** Source: L. Euler, Institutionum calculi integralis I (1768). */
struct ForwardEulerTableau {
  static constexpr MethodInfo info = {
      .name = "forward-euler",
      .family = "runge-kutta",
      .color = "#888888",
      .order = 1,
      .sweeps = 1,
      .limit = 0,
      .cost = {1.34},
      .first_steps = {0.1, 0.1, 0.4, 0.1, 0.2},
      .source = "Euler 1768",
      .good_for = "negative control",
      .fails_when = "every spring without drag: its energy grows"};
  static constexpr std::array<double, 0> a = {};
  static constexpr std::array b = {1.0};
  static constexpr std::array c = {0.0};
};
extern template class RungeKutta<ForwardEulerTableau>;
using ForwardEuler = RungeKutta<ForwardEulerTableau>;

/** Source: W. Kutta, Z. Math. Phys. 46 (1901) 435. */
struct Rk4Tableau {
  static constexpr MethodInfo info = {
      .name = "rk4",
      .family = "runge-kutta",
      .color = "#1B5E20",
      .order = 4,
      .sweeps = 4,
      .limit = 2.8284,
      .cost = {3.78},
      .first_steps = {0.09, 0.3, 0.8, 0.09, 0.3},
      .source = "Kutta 1901",
      .good_for = "textbook baseline",
      .fails_when = "long runs: it loses (dt omega)^6/72 of the energy a step"};
  static constexpr std::array a = {0.5, 0.0, 0.5, 0.0, 0.0, 1.0};
  static constexpr std::array b = {1 / 6., 1 / 3., 1 / 3., 1 / 6.};
  static constexpr std::array c = {0.0, 0.5, 0.5, 1.0};
};
extern template class RungeKutta<Rk4Tableau>;
using Rk4 = RungeKutta<Rk4Tableau>;

/** A pair of orders 6 and 4 for x'' = F(x)/m, "RKN6(4)6FM".
 * Source: J. R. Dormand, M. E. A. El-Mikkawy, P. J. Prince, IMA J. Numer. Anal.
 * 7 (1987) 235, doi:10.1093/imanum/7.2.235. */
struct Rkn64Tableau {
  // Without drag an oscillation grows in each step, by 1e-7 at dt omega = 1 and
  // 2e-3 at 3: it is for error control.
  static constexpr MethodInfo info = {
      .name = "rkn64",
      .family = "runge-kutta",
      .color = "#7B4FA3",
      .order = 6,
      .sweeps = 5,
      .limit = 0,
      .adaptive = true,
      .cost = {6.23},
      .first_steps = {1, 1, 1.15, 1, 1},
      .source = "Dormand, El-Mikkawy, Prince 1987",
      .good_for = "smooth motion to a tolerance, from 1e-4 m down",
      .fails_when =
          "contact, tearing, friction: it makes tiny steps there, of low "
          "order; drag over mass that differs from node to node"};
  static constexpr std::array a = {
      1 / 200.,        -1 / 2200.,      1 / 22.,           637 / 6600.,
      -7 / 110.,       7 / 33.,         225437 / 1968750., -30073 / 281250.,
      65569 / 281250., -9367 / 984375., 151 / 2142.,       5 / 116.,
      385 / 1368.,     55 / 168.,       -6250 / 28101.};
  static constexpr std::array b = {151 / 2142., 25 / 522.,        275 / 684.,
                                   275 / 252.,  -78125 / 112404., 1 / 12.};
  static constexpr std::array c = {0., 0.1, 0.3, 0.7, 0.68, 1.};
  // Of order 4.
  static constexpr std::array x_low = {1349 / 157500., 7873 / 50000.,
                                       192199 / 900000., 521683 / 2100000.,
                                       -16 / 125.};
  static constexpr std::array b_low = {1349 / 157500., 7873 / 45000.,
                                       27457 / 90000., 521683 / 630000.,
                                       -2 / 5.,        1 / 12.};
};
extern template class RungeKutta<Rkn64Tableau>;
using Rkn64 = RungeKutta<Rkn64Tableau>;

}  // namespace lab
