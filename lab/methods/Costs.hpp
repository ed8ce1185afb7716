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
// AMD EPYC, g++ (Debian 12.2.0-14+deb12u1) 12.2.0, commit e9b2404-dirty
inline constexpr auto method_costs = std::to_array<MethodCost>({
    {"forward-euler", 1.2, 0},         //
    {"symplectic-euler", 0.908, 0},    //
    {"verlet", 1, 0},                  //
    {"respa", 1.05, 0},                //
    {"yoshida4", 2.59, 0},             //
    {"pefrl", 3.41, 0},                //
    {"srkn6b", 4.87, 0},               //
    {"srkn11b", 8.98, 0},              //
    {"rk4", 3.91, 0},                  //
    {"dop853", 16.1, 0},               //
    {"rkn64", 6.6, 0},                 //
    {"implicit-euler", 50.3, 269},     //
    {"implicit-midpoint", 85.5, 271},  //
    {"tr-bdf2", 79.2, 150},            //
    {"augmented-verlet", 4.69, 4.68},  //
    {"fast-mass-spring", 52.2, 52.4},  //
    {"xpbd", 65.1, 65.3},              //
});

}  // namespace lab
