/** @file step.hpp
 * A bridge to the step of page 8, mine.hpp, and cloths to try it on. A test of
 * that step includes this file and nothing else. */
#ifndef KIT_STEP_HPP
#define KIT_STEP_HPP

#if __has_include("mine.hpp")
#include "mine.hpp"
#endif
#include "cloth.hpp"
#include "trial.hpp"

namespace kit_missing {
template <typename... T>
Missing my_step(T&&...) {
  return {};
}
}  // namespace kit_missing

namespace kit {

/** A run of a net by my_step. */
class TrialRun {
 public:
  Cloth g;
  double t;
  long asked = 0;     ///< forces so far
  bool late = false;  ///< was a pin elsewhere when a force was asked for?

  /** @param most  forces beyond so many are zero */
  explicit TrialRun(const Net& of, long most = LONG_MAX)
      : t(of.begin), net_(of), most_(most) {
    Bodies bodies = of.start;
    bodies.num_springs = 0;
    fill(g, bodies);
  }
  Point at(int i) { return place(g, i); }
  void step(double dt) {
    const auto pull = [this](ClothNode n, double time) {
      const auto x = [this](int i) { return at(i); };
      for (int i : {0, Net::wide - 1})
        late = late || !near(x(i), net_.pin(i, time), 1e-9);
      return ++asked > most_ ? Point() : net_.force(int(n.index()), time, x);
    };
    const auto hold = [this](Cloth& cloth, double time) {
      for (int i : {0, Net::wide - 1})
        node_of(cloth, i).position() = net_.pin(i, time);
    };
    TestForce force(pull);
    TestConstraint constraint(hold);
    if constexpr (must_compile || requires {
                    {
                      ::my_step(g, t, dt, force, constraint)
                      } -> std::convertible_to<double>;
                  })
      t = ::my_step(g, t, dt, force, constraint);
    else
      fail("double my_step(g, t, dt, force, constraint) to compile",
           "an error");
  }
  /** All steps to the end. */
  void finish(int steps) {
    for (int step = 0; step < steps; ++step) this->step(Net::seconds / steps);
  }
  /** Largest distance from @a exact along an axis [m]. */
  double error(const Bodies& exact) {
    Bodies b = exact;
    for (int i = 0; i < b.size; ++i) b.x[i] = at(i);
    return distance(b, exact);
  }

 private:
  const Net& net_;
  const long most_;
};

/** How many steps of my_step ask for at most @a forces on each node. */
inline int steps_of(const Net& net, int forces) {
  TrialRun one(net);
  one.step(Net::seconds / forces);
  check(one.asked > 0, "the step calls the force");
  const int steps = int(long(forces) * Net::size / one.asked);
  check(steps > 0,
        words("the step asks for less than ", forces, " forces on each node"));
  return steps;
}

}  // namespace kit
#endif

#include "check.hpp"
