#pragma once
/** @file Srkn.hpp
 * See Splitting.hpp. */
#include <array>

#include "lab/methods/Splitting.hpp"

namespace lab {

/** Runge-Kutta-Nystroem splitting of order 4 with 6 kicks.
 * Source: S. Blanes, P. C. Moan, J. Comput. Appl. Math. 142 (2002) 313. */
struct Srkn6bScheme {
  static constexpr MethodInfo info = {
      "srkn6b",
      4,
      6,
      5.0269,
      "Blanes, Moan 2002",
      "smooth motion, errors from 1e-5 to 1e-9",
      "contact and tearing; near dt omega = 3.16 without drag"};
  static constexpr bool kicks_first = true;
  static constexpr double b1 = .0829844064174052, a1 = .245298957184271,
                          b2 = .396309801498368, a2 = .604872665711080,
                          b3 = -.0390563049223486, a3 = 0.5 - a1 - a2,
                          b4 = 1 - 2 * (b1 + b2 + b3);
  static constexpr std::array steps = {b1, a1, b2, a2, b3, a3, b4,
                                       a3, b3, a2, b2, a1, b1};
};
extern template class Splitting<Srkn6bScheme>;
using Srkn6b = Splitting<Srkn6bScheme>;

/** Runge-Kutta-Nystroem splitting of order 6 with 11 kicks. Source: as above.
 */
struct Srkn11bScheme {
  static constexpr MethodInfo info = {
      "srkn11b",
      6,
      11,
      9.0736,
      "Blanes, Moan 2002",
      "references: errors below 1e-8",
      "contact and tearing; near dt omega = pi, 2 pi without drag"};
  static constexpr bool kicks_first = true;
  static constexpr double b1 = .0414649985182624, b2 = .198128671918067,
                          b3 = -.0400061921041533, b4 = .0752539843015807,
                          b5 = -.0115113874206879,
                          b6 = 0.5 - (b1 + b2 + b3 + b4 + b5);
  static constexpr double a1 = .123229775946271, a2 = .290553797799558,
                          a3 = -.127049212625417, a4 = -.246331761062075,
                          a5 = .357208872795928,
                          a6 = 1 - 2 * (a1 + a2 + a3 + a4 + a5);
  static constexpr std::array steps = {b1, a1, b2, a2, b3, a3, b4, a4,
                                       b5, a5, b6, a6, b6, a5, b5, a4,
                                       b4, a3, b3, a2, b2, a1, b1};
};
extern template class Splitting<Srkn11bScheme>;
using Srkn11b = Splitting<Srkn11bScheme>;

}  // namespace lab
