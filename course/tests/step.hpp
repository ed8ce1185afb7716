/** @file step.hpp
 * A bridge to the step of page 8, mine.hpp, and cloths to try it on. A test of
 * that step includes this file and nothing else. */
#ifndef KIT_STEP_HPP
#define KIT_STEP_HPP

#if __has_include("mine.hpp")
#include "mine.hpp"
#endif
#include "cloth.hpp"

namespace kit_missing {
template <typename... T>
Missing my_step(T&&...) {
  return {};
}
}  // namespace kit_missing

namespace kit {

/** The largest distance along an axis; NaN if one is. */
inline double distance(const Bodies& a, const Bodies& b) {
  double most = 0;
  for (int i = 0; i < b.size; ++i) {
    const Point u = a.x[i] - b.x[i];
    for (double one : {u.x, u.y, u.z})
      if (!(std::abs(one) <= most)) most = std::abs(one);
  }
  return most;
}

/** A net that hangs from two moving pins in a changing wind. Its graph has no
 * edges: only the force knows the springs, so a step has to ask for each. */
struct Trial {
  static constexpr int wide = 4, high = 3, size = wide * high;
  static constexpr double seconds = 1;
  static constexpr int forces = 1600;  ///< on each node, in a run
  Bodies start;
  double begin = 0;            ///< [s]
  Point wind, swing;           ///< amplitudes [N], [m]
  double omega = 5, rate = 4;  ///< of wind and pins [1/s]

  /** @param number  a function of two bounds: some number between them */
  template <typename Number>
  explicit Trial(Number number) {
    for (int i = 0; i < size; ++i) {
      const double x = i % wide, y = i / wide, up = number(-0.05, 0.05);
      start.add(Point(0.25 * x + number(-0.05, 0.05), 0.25 * y, up),
                number(0.05, 0.1));
      for (int j : {i - 1, i - wide, i - wide - 1})
        if (j >= 0 && (j == i - wide || i % wide > 0))
          start.join(j, i, number(5, 15),
                     number(0.8, 1) * norm(start.x[i] - start.x[j]));
    }
    begin = number(0, 1);
    wind = Point(number(0.05, 0.15), number(0.05, 0.15), 0);
    swing = Point(number(0.05, 0.1), 0, number(0.05, 0.1));
  }

  static bool is_pin(int i) { return i == 0 || i == wide - 1; }
  /** Where a pin is at time @a t. */
  Point pin(int i, double t) const {
    return start.x[i] + std::sin(rate * (t - begin)) * swing;
  }
  /** The force on body @a i, with the bodies at x(0), x(1), ... */
  template <typename Places>
  Point force(int i, double t, const Places& x) const {
    Point sum = outer(i, t);
    for (int k = 0; k < start.num_springs; ++k) {
      const Spring& s = start.springs[k];
      if (s.a == i) sum += pull(s, x(s.b) - x(i));
      if (s.b == i) sum += pull(s, x(s.a) - x(i));
    }
    return sum;
  }

  /** The bodies at the end of a run by Yoshida's method of order 4. With 400
   * steps its error is at most 1 % of what the tests allow. */
  Bodies exact(int steps = 400) const {
    Bodies b = start;
    const double dt = seconds / steps, forth = 1 / (2 - std::cbrt(2.0));
    for (int step = 0; step < steps; ++step) {
      double t = begin + step * dt;
      for (double share : {forth, 1 - 2 * forth, forth}) {
        advance(b, t, share * dt, 0.5);
        t += share * dt;
      }
    }
    return b;
  }
  /** The error [m] of symplectic Euler with `forces`. */
  double error_of_euler(const Bodies& exact) const {
    Bodies b = start;
    const double dt = seconds / forces;
    for (int step = 0; step < forces; ++step)
      advance(b, begin + step * dt, dt, 1);
    return distance(b, exact);
  }

 private:
  Point outer(int i, double t) const {
    return Point(0, 0, -9.81 * start.m[i]) + std::sin(omega * t) * wind;
  }
  static Point pull(const Spring& s, const Point& u) {
    const double length = norm(u);
    return s.K * (length - s.L) / length * u;
  }
  /** Drift over a part of the step, kick, drift over the rest of it. */
  void advance(Bodies& b, double t, double dt, double first) const {
    drift(b, first * dt, t + first * dt);
    Point f[size];
    for (int i = 0; i < size; ++i) f[i] = outer(i, t + first * dt);
    for (int k = 0; k < b.num_springs; ++k) {
      const Spring& s = b.springs[k];
      const Point on_a = pull(s, b.x[s.b] - b.x[s.a]);
      f[s.a] += on_a, f[s.b] -= on_a;
    }
    for (int i = 0; i < size; ++i) b.v[i] += dt / b.m[i] * f[i];
    drift(b, (1 - first) * dt, t + dt);
  }
  void drift(Bodies& b, double h, double t) const {
    for (int i = 0; i < size; ++i)
      b.x[i] = is_pin(i) ? pin(i, t) : b.x[i] + h * b.v[i];
  }
};

/** A run of a Trial by my_step. */
class TrialRun {
 public:
  Cloth g;
  double t;
  long asked = 0;     ///< forces so far
  bool late = false;  ///< was a pin elsewhere when a force was asked for?

  /** @param most  forces beyond so many are zero */
  explicit TrialRun(const Trial& of, long most = LONG_MAX)
      : t(of.begin), trial_(of), most_(most) {
    Bodies bodies = of.start;
    bodies.num_springs = 0;
    fill(g, bodies);
  }
  Point at(int i) { return place(g, i); }
  void step(double dt) {
    const auto x = [this](int i) { return at(i); };
    const auto pull = [this, &x](ClothNode n, double time) {
      for (int i : {0, Trial::wide - 1})
        late = late || !near(at(i), trial_.pin(i, time), 1e-9);
      return ++asked > most_ ? Point() : trial_.force(int(n.index()), time, x);
    };
    const auto hold = [this](Cloth& cloth, double time) {
      for (int i : {0, Trial::wide - 1})
        node_of(cloth, i).position() = trial_.pin(i, time);
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
    for (int step = 0; step < steps; ++step) this->step(Trial::seconds / steps);
  }
  /** Largest distance from @a exact along an axis [m]. */
  double error(const Bodies& exact) {
    Bodies b = exact;
    for (int i = 0; i < b.size; ++i) b.x[i] = at(i);
    return distance(b, exact);
  }

 private:
  const Trial& trial_;
  const long most_;
};

/** How many steps of my_step ask for at most @a forces on each node. */
inline int steps_of(const Trial& trial, int forces) {
  TrialRun one(trial);
  one.step(Trial::seconds / forces);
  check(one.asked > 0, "the step calls the force");
  const int steps = int(long(forces) * Trial::size / one.asked);
  check(steps > 0,
        words("the step asks for less than ", forces, " forces on each node"));
  return steps;
}

}  // namespace kit
#endif

#include "check.hpp"
