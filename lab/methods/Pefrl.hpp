#pragma once
/** @file Pefrl.hpp
 * See Splitting.hpp. */
#include <array>

#include "lab/methods/Splitting.hpp"

namespace lab {

/** Source: I. P. Omelyan, I. M. Mryglod, R. Folk, Comput. Phys. Commun. 146
 * (2002) 188, "PEFRL". */
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
  static constexpr double xi = 0.1786178958448091;
  static constexpr double lambda = -0.2123418310626054;
  static constexpr double chi = -0.06626458266981849;
  static constexpr std::array steps = {xi,     0.5 - lambda,       chi,
                                       lambda, 1 - 2 * (chi + xi), lambda,
                                       chi,    0.5 - lambda,       xi};
};
extern template class Splitting<PefrlScheme>;
using Pefrl = Splitting<PefrlScheme>;

}  // namespace lab
