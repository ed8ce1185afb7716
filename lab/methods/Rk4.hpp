#pragma once
/** @file Rk4.hpp
 * See RungeKutta.hpp. */
#include <array>

#include "lab/methods/RungeKutta.hpp"

namespace lab {

/** Source: W. Kutta, Z. Math. Phys. 46 (1901) 435. */
struct Rk4Tableau {
  static constexpr MethodInfo info = {
      "rk4",
      4,
      4,
      2.8284,
      "Kutta 1901",
      "textbook baseline",
      "long runs: it loses (dt omega)^6/72 of the energy a step"};
  static constexpr std::array a = {0.5, 0.0, 0.5, 0.0, 0.0, 1.0};
  static constexpr std::array b = {1 / 6., 1 / 3., 1 / 3., 1 / 6.};
  static constexpr std::array c = {0.0, 0.5, 0.5, 1.0};
};
extern template class RungeKutta<Rk4Tableau>;
using Rk4 = RungeKutta<Rk4Tableau>;

}  // namespace lab
