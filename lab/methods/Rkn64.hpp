#pragma once
/** @file Rkn64.hpp
 * See RungeKutta.hpp. */
#include <array>

#include "lab/methods/RungeKutta.hpp"

namespace lab {

/** A pair of orders 6 and 4 for x'' = F(x)/m, "RKN6(4)6FM".
 * Source: J. R. Dormand, M. E. A. El-Mikkawy, P. J. Prince, IMA J. Numer. Anal.
 * 7 (1987) 235, doi:10.1093/imanum/7.2.235. */
struct Rkn64Tableau {
  // Without drag an oscillation grows in each step, by 1e-7 at dt omega = 1 and
  // 2e-3 at 3: it is for error control.
  static constexpr MethodInfo info = {
      "rkn64",
      6,
      5,
      0,
      "Dormand, El-Mikkawy, Prince 1987",
      "smooth motion to a tolerance, from 1e-4 m down",
      "contact, tearing, friction: it makes tiny steps there, of low order; "
      "drag over mass that differs from node to node",
      true};
  static constexpr std::array a = {
      1 / 200.,        -1 / 2200.,      1 / 22.,           637 / 6600.,
      -7 / 110.,       7 / 33.,         225437 / 1968750., -30073 / 281250.,
      65569 / 281250., -9367 / 984375., 151 / 2142.,       5 / 116.,
      385 / 1368.,     55 / 168.,       -6250 / 28101.};
  static constexpr std::array b = {151 / 2142., 25 / 522.,        275 / 684.,
                                   275 / 252.,  -78125 / 112404., 1 / 12.};
  static constexpr std::array c = {0., 0.1, 0.3, 0.7, 0.68, 1.};
  // Of order 4.
  static constexpr std::array x_low = {1349 / 157500., 7873 / 50000.,
                                       192199 / 900000., 521683 / 2100000.,
                                       -16 / 125.};
  static constexpr std::array b_low = {1349 / 157500., 7873 / 45000.,
                                       27457 / 90000., 521683 / 630000.,
                                       -2 / 5.,        1 / 12.};
};
extern template class RungeKutta<Rkn64Tableau>;
using Rkn64 = RungeKutta<Rkn64Tableau>;

}  // namespace lab
