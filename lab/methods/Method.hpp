#pragma once
/** @file Method.hpp
 * Method: a step in time from t to t + dt, and the properties that each method
 * declares. The order within a step: positions, constraints, forces,
 * velocities. */
#include <array>
#include <concepts>
#include <limits>
#include <memory>
#include <span>
#include <string_view>
#include <type_traits>

#include "lab/fast/Archive.hpp"
#include "lab/fast/ConstraintPlan.hpp"
#include "lab/fast/ForcePlan.hpp"
#include "lab/fast/GraphArrays.hpp"

namespace lab {

/** The card of a method: all that programs, charts and pages say of it. The
 * tests measure its numbers. Python reads it as text. */
struct MethodInfo {
  std::string_view name;
  /** Its dash in charts: splitting solid, runge-kutta dashed, implicit dashed
   * and dotted. Colors of one family differ for the color-blind, too; all
   * differ in normal sight, and stand out on white by 3 to 1. */
  const char *family, *color;
  int order;               ///< error ~ dt^order
  int sweeps;              ///< force evaluations a step, without linear solves
  double limit;            ///< stable while dt omega < limit, without drag
  bool adaptive = false;   ///< makes inner steps, so dt may be of any length
  bool multirate = false;  ///< limit is that of soft_stiffness()
  /** The time of a step, in steps of Verlet: at 0.99 of Verlet's limit, and at
   * 10 times the limit (of methods without one). `make method-costs` writes it,
   * lab/bench/bench_methods.cpp says how it is measured. */
  struct Cost {
    double at_limit, at_ten = 0;
  } cost;
  // AMD EPYC, g++ (Debian 12.2.0-14+deb12u1) 12.2.0, commit 3c13c1b
  /** dt omega of the longest step on each course of tests/test_orders.cpp:
   * there the next term of the error is small, and three decades lower
   * round-off is. rk4 needs short steps on linear springs, as its errors of
   * amplitude and phase are one order apart only; Newton's methods start at
   * long ones, as their tolerance adds up over many short ones. */
  std::array<double, 5> first_steps = {0.5, 0.5, 0.5, 0.5, 0.5};
  const char *source, *good_for, *fails_when;
  /** Explicit of order 1: its velocities are a step ahead of positions. */
  bool ahead() const { return order == 1 && std::isfinite(limit); }
};
inline constexpr double no_limit = std::numeric_limits<double>::infinity();

/** The times of many steps [s]: multiples of one dt, because in a sum of steps
 * rounding errors would add up. */
struct StepTimes {
  double from, dt;
  long long done = 0;  ///< steps since @a from
  double operator()(long long k) const { return from + double(done + k) * dt; }
};

/** The work of a method besides force evaluations, since it was made. It is the
 * same on every machine. */
struct Work {
  long long inner = 0;     ///< inner steps, with rejected ones
  long long newton = 0;    ///< linear systems
  long long products = 0;  ///< with the matrix A; each costs a force evaluation
  long long factors = 0;   ///< Cholesky factors of A
  Work& operator+=(const Work& w) {
    inner += w.inner, newton += w.newton;
    products += w.products, factors += w.factors;
    return *this;
  }
};

/** A method: each call of step() takes a cloth from t to t + dt.
 *
 * It applies the constraint once a step: after the positions have reached
 * t + dt, before the force is evaluated there. A nodewise constraint may be
 * projected part by part. At each stage, held nodes are at their places at the
 * time of the stage. The constraint may remove nodes, and so may the caller
 * between steps. Only the first step, and one after the cloth grew, allocates.
 *
 * A method may keep the force at the end of a step for the next one: call
 * restart() after moving nodes between two steps. */
class Method {
 public:
  virtual ~Method() = default;

  /** One step from @a t by @a dt [s].  @return t + dt   @pre dt > 0
   * Throws StepError if the method can't make it; std::invalid_argument if it
   * can't handle this force. */
  virtual double step(Cloth& g, double t, double dt, const ForcePlan& force,
                      const ConstraintPlan& constraint) = 0;
  /** Steps number 0, ..., @a count - 1 of @a times, with the same bits as by
   * step(). The graph is current at the end, but maybe not in between. A step
   * that removed nodes or edges is the last one.
   * @return the number of steps: 1 to @a count   @pre @a count > 0
   * Throws as step(). */
  virtual int steps(Cloth& g, const StepTimes& times, int count,
                    const ForcePlan& force, const ConstraintPlan& constraint) {
    const auto version = arrays(g).version();
    int k = 0;
    do step(g, times(k), times.dt, force, constraint);
    while (++k < count && arrays(g).version() == version);
    return k;
  }
  /** Forget what was kept from the last step. */
  virtual void restart() {}
  /** Save what was kept from the last step; or load it, so that the next step
   * gives the same bits as that of the method that saved it. By default nothing
   * is kept.  @pre of loading: @a g is as it was when saved */
  virtual void archive(Archive& /*a*/, const Cloth& /*g*/) {}
  virtual Work work() const { return {}; }
  /** By edge id: the mean force of each spring in the last step on the first of
   * its ends [N]. Empty: it was K (l - L) along the spring. */
  virtual std::span<const Point> pulls() const { return {}; }
  /** Keep the estimated error of each inner step below @a tolerance [m] > 0;
   * infinite: one inner step a step. Only adaptive methods have one. */
  virtual void set_tolerance(double /*tolerance*/) {}

  /** step() with the arguments of symp_euler_step(): any force, any constraint.
   * Plans can be passed, too; then they are not made in each step. */
  template <typename F, typename C = ZeroConstraint>
  double operator()(Cloth& g, double t, double dt, F&& force,
                    C&& constraint = C()) {
    return step(
        g, t, dt, as<ForcePlan, ZeroForce, FunctionForce>(force),
        as<ConstraintPlan, ZeroConstraint, FunctionConstraint>(constraint));
  }

 private:
  /** @a x itself if it is a Plan or overrides the call of Base, else a Base
   * that calls it. */
  template <typename Plan, typename Base, template <typename> class Adapter,
            typename T>
  static decltype(auto) as(T& x) {
    if constexpr (std::derived_from<std::remove_const_t<T>, Plan>)
      return static_cast<const Plan&>(x);
    else if constexpr (Overrides<std::remove_const_t<T>, Base>)
      return static_cast<const Base&>(x);
    else
      return Adapter([&x]<typename... Args>(Args&&... args) {
        return x(std::forward<Args>(args)...);
      });
  }
};

/** A method that implements steps(); step() is a batch of one. */
class BatchMethod : public Method {
 public:
  double step(Cloth& g, double t, double dt, const ForcePlan& force,
              const ConstraintPlan& constraint) override {
    steps(g, {t, dt}, 1, force, constraint);
    return t + dt;
  }
  int steps(Cloth& g, const StepTimes& times, int count, const ForcePlan& force,
            const ConstraintPlan& constraint) override = 0;
};

/** A line of the table of methods in Methods.hpp. */
struct MethodEntry {
  MethodInfo info;
  std::unique_ptr<Method> (*make)();
  /** The part of a force whose stiffness bounds the step; null: all of it. */
  ForcePlan (*bounding)(const Cloth& g, const ForcePlan& force,
                        const ConstraintPlan& constraint) = nullptr;
};
template <typename M>
constexpr MethodEntry entry_of() {
  MethodEntry e = {M::info, [] { return std::unique_ptr<Method>(new M()); }};
  if constexpr (M::info.multirate) e.bounding = M::bounding;
  return e;
}

}  // namespace lab
