#pragma once
/** @file Yoshida4.hpp
 * See Splitting.hpp. */
#include <array>

#include "lab/methods/Splitting.hpp"

namespace lab {

/** Three Verlet steps, the middle one backwards.
 * Source: H. Yoshida, Phys. Lett. A 150 (1990) 262; E. Forest, R. D. Ruth,
 * Physica D 43 (1990) 105. */
struct Yoshida4Scheme {
  static constexpr MethodInfo info = {
      "yoshida4",
      4,
      3,
      1.5734,
      "Yoshida 1990",
      "textbook baseline",
      "any comparison with pefrl: more error, shorter steps"};
  static constexpr bool kicks_first = true;
  static constexpr double w1 = 1.3512071919596578;  // 1/(2 - 2^(1/3))
  static constexpr double w0 = 1 - 2 * w1;
  static constexpr std::array steps = {w1 / 2,        w1, (w0 + w1) / 2, w0,
                                       (w0 + w1) / 2, w1, w1 / 2};
};
extern template class Splitting<Yoshida4Scheme>;
using Yoshida4 = Splitting<Yoshida4Scheme>;

}  // namespace lab
