#pragma once
/** @file Method.hpp
 * Method: a step in time from t to t + dt, and what each method says about
 * itself. The order within a step: positions, constraints, forces,
 * velocities. */
#include <concepts>
#include <limits>
#include <memory>
#include <type_traits>

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
};
inline constexpr double no_limit = std::numeric_limits<double>::infinity();

/** A method: takes a cloth from t to t + dt, as often as it is called.
 *
 * Its constraint is called once a step, when the positions have reached t +
 * dt, and before the force there is taken; held nodes stay at rest in between.
 * Or else, if it mends by node, part by part, each before a force sees it.
 * Nodes may be removed by it, and between steps. No allocation in a step, but
 * for the first one and when the cloth grew.
 *
 * A method may keep the force at the end of a step for the next one: whoever
 * moves nodes between two steps calls restart(). */
class Method {
 public:
  virtual ~Method() = default;

  /** One step from @a t by @a dt [s].  @return t + dt   @pre dt > 0
   * Throws StepError if the method can't make it; std::invalid_argument if it
   * can't do with this force. */
  virtual double step(Cloth& g, double t, double dt, const ForcePlan& force,
                      const ConstraintPlan& constraint) = 0;
  /** Forget what was kept from the last step. */
  virtual void restart() {}

  /** The call of symp_euler_step(): any force, any constraint. */
  template <typename F, typename C = ZeroConstraint>
  double operator()(Cloth& g, double t, double dt, F&& force,
                    C&& constraint = C()) {
    return step(g, t, dt, as<ZeroForce, FunctionForce>(force),
                as<ZeroConstraint, FunctionConstraint>(constraint));
  }

 private:
  /** @a x itself if it is a Base, else a Base that calls it. */
  template <typename Base, template <typename> class Adapter, typename T>
  static decltype(auto) as(T& x) {
    if constexpr (std::derived_from<std::remove_const_t<T>, Base>)
      return static_cast<const Base&>(x);
    else
      return Adapter([&x]<typename... Args>(Args&&... args) {
        return x(std::forward<Args>(args)...);
      });
  }
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
