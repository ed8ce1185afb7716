/** @file 4.2.build_cloth.cpp
 * The cloth that its test looked at, whose points the grader moves at random.
 */
#include "asked.hpp"

ASKED("4.2.build_cloth", cloth_asked) {
  Start start = start_of_test;
  const auto before = [](const Point& a, const Point& b) {
    return std::tie(a.x, a.y) < std::tie(b.x, b.y);
  };
  std::sort(start.bodies.begin(), start.bodies.end(),
            [&](const auto& a, const auto& b) { return before(a.x, b.x); });
  for (auto& s : start.springs)
    if (before(s.b, s.a)) std::swap(s.a, s.b);
  std::sort(start.springs.begin(), start.springs.end(),
            [&](const auto& s, const auto& r) {
              return before(s.a, r.a) || (s.a == r.a && before(s.b, r.b));
            });
  for (const auto& b : start.bodies) {
    answer("node", b.x);
    answer("velocity", b.v);
    answer("mass", b.m, 1e-7);
  }
  for (const auto& s : start.springs) {
    answer("ends", s.a);
    answer("ends", s.b);
    answer("L", s.L);
    if (s.has_K) answer("K~", s.K);
  }
}
