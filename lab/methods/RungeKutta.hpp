#pragma once
/** @file RungeKutta.hpp
 * Explicit Runge-Kutta methods: ForwardEuler, Rk4, DormandPrince, Dop853 are
 * their tableaus. They treat positions and velocities alike, and drag as a
 * force like others. A new tableau needs a line at the end of RungeKutta.cpp.
 */
#include <array>
#include <cstddef>
#include <vector>

#include "lab/methods/FlatFlow.hpp"
#include "lab/methods/Method.hpp"

namespace lab {

/** What share of a tolerance for the end of a run its inner steps get. On six
 * smooth problems the error at the end was then 1e-4 to 0.5 of the tolerance,
 * from 1e-3 to 1e-9 m (test_cloth_tolerance). Where motions diverge, as in a
 * cloth that buckles for long, nothing local bounds it. */
inline constexpr double tolerance_share = 0.25;

/** An explicit Runge-Kutta method for x' = v, v' = F(x, v, t)/m.
 *
 * @tparam Tableau has info; a, the lower triangle row by row, b and c. With
 *         also b_low, the weights of a lower order, it controls its error:
 *         then step() makes as many steps inside [t, t + dt] as it needs. With
 *         b_third, too, a third order, the estimate is e^2/sqrt(e^2 + e3^2/100)
 *         of the differences e and e3 to both: it scales as order 8 does if
 *         they are of 5 and 3 (II.10 of the source).
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
  void set_tolerance(double tolerance) override {
    if (adaptive) tolerance_ = tolerance;
  }

  double step(Cloth& g, double t, double dt, const ForcePlan& force,
              const ConstraintPlan& constraint) override;
  void restart() override { inner_ = 0, end_x_.clear(); }
  void archive(CME212::Archive& a, const Cloth& /*g*/) override {
    a(inner_)(end_t_)(end_x_)(end_v_)(v_.back())(a_.back());
  }

 private:
  static constexpr std::size_t stages = Tableau::b.size();
  // Dormand-Prince: the last stage is the first one of the next step.
  static constexpr bool first_same_as_last =
      Tableau::b.back() == 0 && stages > 1;

  double tolerance_;
  double inner_ = 0;  // next inner step [s]; 0: not chosen yet
  FlatFlow flow_;
  std::vector<Point> x0_, v0_;
  std::array<std::vector<Point>, stages> v_, a_;  // derivatives, by stage
  std::vector<Point> end_x_, end_v_;  // where the last stage was taken
  double end_t_ = 0;

  double attempt(Cloth& g, double t, double h, const ForcePlan& force,
                 const ConstraintPlan& constraint);
  bool at_end_of_last_step(double t) const;
  void set_state(Cloth& g, double t, double h, const double* weights,
                 std::size_t count, const ConstraintPlan& constraint);
  void derive(Cloth& g, double t, const ForcePlan& force,
              const ConstraintPlan& constraint, std::size_t s);
  double error_rate(const Cloth& g) const;
  double rms(const Cloth& g, const double* other) const;
};

}  // namespace lab
