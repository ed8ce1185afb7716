#pragma once
/** @file DormandPrince.hpp
 * See RungeKutta.hpp. */
#include <array>

#include "lab/methods/RungeKutta.hpp"

namespace lab {

/** Source: J. R. Dormand, P. J. Prince, J. Comput. Appl. Math. 6 (1980) 19. */
struct DormandPrinceTableau {
  static constexpr MethodInfo info = {
      "dormand-prince",
      5,
      6,
      0.9971,
      "Dormand, Prince 1980",
      "a tolerance instead of a step",
      "springs: per force evaluation its limit is a twelfth of "
      "verlet's",
      true};
  static constexpr std::array a = {1 / 5.,
                                   3 / 40.,
                                   9 / 40.,
                                   44 / 45.,
                                   -56 / 15.,
                                   32 / 9.,
                                   19372 / 6561.,
                                   -25360 / 2187.,
                                   64448 / 6561.,
                                   -212 / 729.,
                                   9017 / 3168.,
                                   -355 / 33.,
                                   46732 / 5247.,
                                   49 / 176.,
                                   -5103 / 18656.,
                                   35 / 384.,
                                   0.,
                                   500 / 1113.,
                                   125 / 192.,
                                   -2187 / 6784.,
                                   11 / 84.};
  static constexpr std::array b = {
      35 / 384., 0., 500 / 1113., 125 / 192., -2187 / 6784., 11 / 84., 0.};
  static constexpr std::array b_low = {
      5179 / 57600.,    0.,          7571 / 16695., 393 / 640.,
      -92097 / 339200., 187 / 2100., 1 / 40.};
  static constexpr std::array c = {0., 1 / 5., 3 / 10., 4 / 5., 8 / 9., 1., 1.};
};
extern template class RungeKutta<DormandPrinceTableau>;
using DormandPrince = RungeKutta<DormandPrinceTableau>;

}  // namespace lab
