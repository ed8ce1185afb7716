#pragma once
/** @file Pefrl.hpp
 * pefrl_step() of methods.hpp. */
#include <array>

#include "lab/methods/Splitting.hpp"

namespace lab {

struct PefrlScheme {
  static constexpr MethodInfo info = {
      "pefrl",
      4,
      4,
      2.9894,
      "Omelyan, Mryglod, Folk 2002",
      "smooth motion, errors from 1e-3 to 1e-8",
      "contact and tearing: no better than verlet, at 4 times the cost"};
  static constexpr bool kicks_first = false;
  static const std::array<double, 9> steps;
};
extern template class Splitting<PefrlScheme>;
using Pefrl = Splitting<PefrlScheme>;

}  // namespace lab
