#pragma once
/** @file Srkn11b.hpp
 * srkn11b_step() of methods.hpp. */
#include <array>

#include "lab/methods/Splitting.hpp"

namespace lab {

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
  static const std::array<double, 23> steps;
};
extern template class Splitting<Srkn11bScheme>;
using Srkn11b = Splitting<Srkn11bScheme>;

}  // namespace lab
