#pragma once
/** @file ForwardEuler.hpp
 * See RungeKutta.hpp. */
#include <array>

#include "lab/methods/RungeKutta.hpp"

namespace lab {

/** Source: L. Euler, Institutionum calculi integralis I (1768). */
struct ForwardEulerTableau {
  static constexpr MethodInfo info = {
      "forward-euler",
      1,
      1,
      0,
      "Euler 1768",
      "negative control",
      "every spring without drag: its energy grows"};
  static constexpr std::array<double, 0> a = {};
  static constexpr std::array b = {1.0};
  static constexpr std::array c = {0.0};
};
extern template class RungeKutta<ForwardEulerTableau>;
using ForwardEuler = RungeKutta<ForwardEulerTableau>;

}  // namespace lab
