/** @file bodies.hpp
 * A cloth in plain arrays, of no submission. */
#ifndef KIT_BODIES_HPP
#define KIT_BODIES_HPP
#include "check.hpp"

namespace kit {

/** The assignment's K [N/m]. */
inline constexpr double given_K = 100;

struct Spring {
  int a, b;
  double K, L;  ///< [N/m], [m]
};
/** The bodies that a graph is filled with and compared with. (Plain arrays,
 * as every class template that a test uses costs time to compile.) */
struct Bodies {
  static constexpr int most = 32;
  Point x[most], v[most];
  double m[most] = {};
  Spring springs[2 * most] = {};
  int size = 0, num_springs = 0;

  /** @return the number of the new one */
  int add(const Point& place, double mass = 1, const Point& velocity = {}) {
    assert(size < most);
    x[size] = place, v[size] = velocity, m[size] = mass;
    return size++;
  }
  void join(int a, int b, double K, double L) {
    assert(num_springs < 2 * most);
    springs[num_springs++] = {a, b, K, L};
  }

  /** In the grader's second run they are others, each up to @a far away. */
  void vary(double far = 1) {
    for (int i = 0; i < size; ++i) {
      x[i] = drawn_near(x[i], far), v[i] = drawn_near(v[i], 4);
      m[i] = drawn(m[i], 0.5, 3);
    }
  }
  /** The same bodies with other numbers: in the order of their ranks. */
  void reorder(const double* rank) {
    const Bodies old = *this;
    int number_of[most] = {};
    for (int i = 0; i < size; ++i) {
      for (int j = 0; j < size; ++j) number_of[i] += rank[j] < rank[i];
      const int at = number_of[i];
      x[at] = old.x[i], v[at] = old.v[i], m[at] = old.m[i];
    }
    for (int k = 0; k < num_springs; ++k) {
      springs[k].a = number_of[old.springs[k].a];
      springs[k].b = number_of[old.springs[k].b];
    }
  }
  /** The number of the body at @a p, which has one. */
  int at(const Point& p) const {
    int i = 0;
    while (!(x[i] == p)) ++i;
    return i;
  }
  static bool is_corner(const Point& p) {
    return p == Point(0, 0, 0) || p == Point(1, 0, 0);
  }

  /** The springs' force on body @a i, by Hooke's law. */
  Point pull(int i) const {
    Point sum(0, 0, 0);
    for (int k = 0; k < num_springs; ++k) {
      const Spring& s = springs[k];
      if (s.a != i && s.b != i) continue;
      const Point u = x[s.a == i ? s.b : s.a] - x[i];
      const double length = std::sqrt(u.x * u.x + u.y * u.y + u.z * u.z);
      if (length > 0) sum += s.K * (length - s.L) / length * u;
    }
    return sum;
  }
};

}  // namespace kit
#endif
