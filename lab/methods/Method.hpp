#pragma once
/** @file Method.hpp
 * Method: a step in time from t to t + dt, and what each method says about
 * itself. The order within a step: positions, constraints, forces,
 * velocities. */
#include <concepts>
#include <limits>
#include <memory>
#include <type_traits>

#include "lab/Archive.hpp"
#include "lab/fast/ConstraintPlan.hpp"
#include "lab/fast/ForcePlan.hpp"

namespace lab {

/** What a method says about itself; the tests hold it to that. */
struct MethodInfo {
  const char* name;
  int order;     ///< error ~ dt^order
  int sweeps;    ///< force evaluations a step, without linear solves
  double limit;  ///< bounded while dt omega < limit, without drag
  const char* source;
  const char* good_for;
  const char* fails_when;
  bool adaptive = false;  ///< steps inside a step: dt does not bound them
  /** Takes stiff springs in inner steps: limit is that of the others, see
   * soft_stiffness(). */
  bool multirate = false;
};
inline constexpr double no_limit = std::numeric_limits<double>::infinity();

/** The times of many steps [s]: multiples of one dt, as sums depend on
 * rounding.
 */
struct StepTimes {
  double from, dt;
  long long done = 0;  ///< steps since @a from
  double operator()(long long k) const { return from + double(done + k) * dt; }
};

/** What a method has done besides evaluating forces, since it was made: the
 * same on every machine. */
struct Work {
  long long inner = 0;     ///< steps inside its steps, those refused, too
  long long newton = 0;    ///< linear systems
  long long products = 0;  ///< with the matrix A, each about a force evaluation
  long long factors = 0;   ///< Cholesky factors of A
  Work& operator+=(const Work& w) {
    inner += w.inner, newton += w.newton;
    products += w.products, factors += w.factors;
    return *this;
  }
};

/** A method: takes a cloth from t to t + dt, as often as it is called.
 *
 * It applies the constraint once a step: when the positions have reached t +
 * dt, and before the force there is evaluated. A nodewise constraint it may
 * project part by part. In between, held nodes are where they are held at the
 * time of each stage. The constraint may remove nodes, and so may the caller
 * between steps. Only the first step allocates, and one after the cloth grew.
 *
 * A method may keep the force at the end of a step for the next one: whoever
 * moves nodes between two steps calls restart(). */
class Method {
 public:
  virtual ~Method() = default;

  /** One step from @a t by @a dt [s].  @return t + dt   @pre dt > 0
   * Throws StepError if the method can't make it; std::invalid_argument if it
   * can't handle this force. */
  virtual double step(Cloth& g, double t, double dt, const ForcePlan& force,
                      const ConstraintPlan& constraint) = 0;
  /** Steps number 0, ..., @a count - 1 of @a times, to the same bits as by
   * step(); the graph need not be current in between, but is at the end. A step
   * that removed nodes or edges is the last one.
   * @return how many were made: 1 to @a count   @pre @a count > 0
   * Throws as step(). */
  virtual int steps(Cloth& g, const StepTimes& times, int count,
                    const ForcePlan& force, const ConstraintPlan& constraint) {
    const auto version = g.version();
    int k = 0;
    do step(g, times(k), times.dt, force, constraint);
    while (++k < count && g.version() == version);
    return k;
  }
  /** Forget what was kept from the last step. */
  virtual void restart() {}
  /** Save what was kept from the last step; or load it, so that the next step
   * gives the same bits as that of the method that saved it.
   * @pre of loading: @a g is as it was then. The default: nothing is kept */
  virtual void archive(Archive& /*a*/, const Cloth& /*g*/) {}
  virtual Work work() const { return {}; }
  /** Keep the estimated error of each inner step below @a tolerance [m] > 0;
   * infinite: one inner step a step. Only adaptive methods have one. */
  virtual void set_tolerance(double /*tolerance*/) {}

  /** The call of symp_euler_step(): any force, any constraint; or their plans,
   * which save making them in each step. */
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

/** A method whose step is a batch of one. */
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

/** A method by its name: a line of the table in Methods.hpp. */
struct MethodEntry {
  MethodInfo info;
  std::unique_ptr<Method> (*make)();
};
template <typename M>
constexpr MethodEntry entry_of() {
  return {M::info, [] { return std::unique_ptr<Method>(new M()); }};
}

}  // namespace lab
