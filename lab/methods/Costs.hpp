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
// AMD EPYC, g++ (Debian 12.2.0-14+deb12u1) 12.2.0, commit 2067fce
inline constexpr auto method_costs = std::to_array<MethodCost>({
    {"forward-euler", 1.08, 0},        //
    {"symplectic-euler", 0.747, 0},    //
    {"verlet", 1, 0},                  //
    {"respa", 0.994, 0},               //
    {"yoshida4", 2.89, 0},             //
    {"pefrl", 3.97, 0},                //
    {"srkn6b", 5.81, 0},               //
    {"srkn11b", 10.4, 0},              //
    {"rk4", 5, 0},                     //
    {"dormand-prince", 9.41, 0},       //
    {"dop853", 24.4, 0},               //
    {"implicit-euler", 42.9, 251},     //
    {"implicit-midpoint", 68.3, 233},  //
    {"tr-bdf2", 60.5, 124},            //
    {"augmented-verlet", 3.05, 3.07},  //
    {"xpbd", 62, 61.3},                //
});

}  // namespace lab
