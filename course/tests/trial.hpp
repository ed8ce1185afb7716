/** @file trial.hpp
 * The nets that a step of page 8 is tried on. */
#ifndef KIT_TRIAL_HPP
#define KIT_TRIAL_HPP
#include "bodies.hpp"

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
struct Net {
  static constexpr int wide = 4, high = 3, size = wide * high;
  static constexpr double seconds = 1;
  static constexpr int forces = 1600;  ///< on each node, in a run
  Bodies start;
  double begin = 0;  ///< [s]

  static bool is_pin(int i) { return i == 0 || i == wide - 1; }
  /** Where a pin is at time @a t. */
  virtual Point pin(int i, double t) const = 0;
  /** The force on body @a i, with the bodies at x(0), x(1), ... */
  using Places = std::function<Point(int)>;
  virtual Point force(int i, double t, const Places& x) const = 0;
};

/** A net whose springs and wind are known in this process. */
struct Trial : Net {
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

  Point pin(int i, double t) const override {
    return start.x[i] + std::sin(rate * (t - begin)) * swing;
  }
  Point force(int i, double t, const Places& x) const override {
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

}  // namespace kit
#endif
