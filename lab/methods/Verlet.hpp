#pragma once
/** @file Verlet.hpp
 * See Splitting.hpp. */
#include <array>

#include "lab/methods/Splitting.hpp"

namespace lab {

/** Half a kick, a drift, half a kick. Symplectic Euler is this method with
 * half a kick missing at the start.
 * Source: L. Verlet, Phys. Rev. 159 (1967) 98. */
struct VerletScheme {
  static constexpr MethodInfo info = {
      "verlet",
      2,
      1,
      2,
      "Verlet 1967",
      "contact, tearing, tolerances down to 1e-3",
      "high accuracy; stiff cloth"};
  static constexpr bool kicks_first = true;
  static constexpr std::array steps = {0.5, 1.0, 0.5};
};
extern template class Splitting<VerletScheme>;
using Verlet = Splitting<VerletScheme>;

}  // namespace lab
