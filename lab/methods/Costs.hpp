#pragma once
/** @file Costs.hpp
 * What a step of each method costs, as measured. Written by make method-costs;
 * what is measured: lab/bench/bench_methods.cpp. */
#include <array>
#include <string_view>

namespace lab {

/** The time of a step, in steps of Verlet. */
struct MethodCost {
  std::string_view method;
  double at_limit;  ///< at 0.99 of Verlet's stability limit
  double at_ten;    ///< at 10 times the limit; 0: not for this method
};
// AMD EPYC, g++ (Debian 12.2.0-14+deb12u1) 12.2.0, commit dac979e
inline constexpr auto method_costs = std::to_array<MethodCost>({
    //
    {"forward-euler", 1.1, 0},         //
    {"symplectic-euler", 0.765, 0},    //
    {"verlet", 1, 0},                  //
    {"respa", 1.01, 0},                //
    {"yoshida4", 2.93, 0},             //
    {"pefrl", 3.94, 0},                //
    {"srkn6b", 5.76, 0},               //
    {"srkn11b", 10.6, 0},              //
    {"rk4", 5.08, 0},                  //
    {"dormand-prince", 9.37, 0},       //
    {"dop853", 24, 0},                 //
    {"implicit-euler", 42, 249},       //
    {"implicit-midpoint", 66.9, 233},  //
    {"tr-bdf2", 60.1, 122},            //
    {"augmented-verlet", 3.02, 3.05},  //
    {"xpbd", 63, 62.6},                //
});

}  // namespace lab
