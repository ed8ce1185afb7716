#pragma once
/** @file Costs.hpp
 * The measured cost of a step of each method, written by make method-costs.
 * lab/bench/bench_methods.cpp says how it is measured. */
#include <array>
#include <string_view>

namespace lab {

/** The time of a step, in steps of Verlet. */
struct MethodCost {
  std::string_view method;
  double at_limit;  ///< at 0.99 of Verlet's stability limit
  double at_ten;    ///< at 10 times the limit; 0: not for this method
};
// AMD EPYC, g++ (Debian 12.2.0-14+deb12u1) 12.2.0, commit 3c13c1b
inline constexpr auto method_costs = std::to_array<MethodCost>({
    {"forward-euler", 1.34, 0},        //
    {"symplectic-euler", 0.967, 0},    //
    {"verlet", 1, 0},                  //
    {"mollified-impulse", 0.996, 0},   //
    {"pefrl", 3.07, 0},                //
    {"srkn11b", 7.85, 0},              //
    {"rk4", 3.78, 0},                  //
    {"rkn64", 6.23, 0},                //
    {"implicit-euler", 43, 223},       //
    {"implicit-midpoint", 79.1, 231},  //
    {"tr-bdf2", 71.8, 134},            //
    {"xpbd", 50.5, 50.9},              //
});

}  // namespace lab
