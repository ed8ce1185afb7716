#pragma once
/** @file Matrix3.hpp
 * Matrix3: a 3 x 3 block of a linear system. */
#include <cmath>

#include "CME212/Point.hpp"

namespace lab {

// All functions are inlined, so the ABI of vector arguments does not matter.
#pragma GCC diagnostic ignored "-Wpsabi"

// Three coordinates in one register; the fourth lane is unused.
typedef double Four __attribute__((vector_size(32), aligned(32)));

/** 3 x 3 numbers by columns of three and a zero. Sums run from the first column
 * to the last, so that every compiler and processor gets the same bits: in
 * Eigen the order depends on the processor's registers. */
struct Matrix3 {
  Four column[3] = {};
};

[[gnu::always_inline]] inline Four four(const Point& a) {
  return Four{a.x, a.y, a.z, 0};
}
[[gnu::always_inline]] inline Point point(const Four& a) {
  return Point(a[0], a[1], a[2]);
}

[[gnu::always_inline]] inline void add(Matrix3& to, const Matrix3& a) {
  for (int c = 0; c < 3; ++c) to.column[c] += a.column[c];
}
/** to += a I */
[[gnu::always_inline]] inline void add_identity(Matrix3& to, double a) {
  for (int c = 0; c < 3; ++c) to.column[c][c] += a;
}

/** a x */
[[gnu::always_inline]] inline Four times(const Matrix3& a, const Four& x) {
  return a.column[0] * x[0] + a.column[1] * x[1] + a.column[2] * x[2];
}
/** a^T x */
[[gnu::always_inline]] inline Four transposed_times(const Matrix3& a,
                                                    const Four& x) {
  const Four p = a.column[0] * x, q = a.column[1] * x, r = a.column[2] * x;
  return Four{p[0] + p[1] + p[2], q[0] + q[1] + q[2], r[0] + r[1] + r[2], 0};
}

/** to -= from by^T */
[[gnu::always_inline]] inline void subtract(Matrix3& to, const Matrix3& from,
                                            const Matrix3& by) {
  for (int c = 0; c < 3; ++c)
    to.column[c] -= from.column[0] * by.column[0][c] +
                    from.column[1] * by.column[1][c] +
                    from.column[2] * by.column[2][c];
}
/** a = a by^T */
[[gnu::always_inline]] inline void multiply(Matrix3& a, const Matrix3& by) {
  Four product[3];
  for (int c = 0; c < 3; ++c)
    product[c] = a.column[0] * by.column[0][c] + a.column[1] * by.column[1][c] +
                 a.column[2] * by.column[2][c];
  for (int c = 0; c < 3; ++c) a.column[c] = product[c];
}

/** Replace d = L L^T, of which the lower triangle is read, by L^-1.
 * @return false if the square of a diagonal entry of L is not finite, or is
 * only round-off compared to that entry of @a before */
[[gnu::always_inline]] inline bool invert_factor(Matrix3& d,
                                                 const Matrix3& before) {
  Four* const c = d.column;
  double l[3][3] = {}, inverse[3][3] = {};
  bool good = true;
  for (int j = 0; j < 3; ++j) {
    for (int i = j; i < 3; ++i) {
      double sum = c[j][i];
      for (int m = 0; m < j; ++m) sum -= l[i][m] * l[j][m];
      if (i == j) {
        good = good && sum > 1e-15 * before.column[j][j] && sum < HUGE_VAL;
        l[j][j] = std::sqrt(sum);
      } else {
        l[i][j] = sum / l[j][j];
      }
    }
  }
  for (int j = 0; j < 3; ++j)
    for (int i = j; i < 3; ++i) {
      double sum = i == j ? 1 : 0;
      for (int m = j; m < i; ++m) sum -= l[i][m] * inverse[m][j];
      inverse[i][j] = sum / l[i][i];
    }
  for (int j = 0; j < 3; ++j)
    c[j] = Four{inverse[0][j], inverse[1][j], inverse[2][j], 0};
  return good;
}

}  // namespace lab
