/** @file stages.cpp
 * All five stages of mass_spring.cpp in one program, which `make graphs` builds
 * and runs with each graph of this folder. */
#include <cmath>
#include <exception>
#include <future>
#include <iostream>
#include <optional>
#include <stdexcept>
#include <string>

#include "CME212/viewer/NoViewer.hpp"
#include "mass_spring.hpp"

#define main run
#define STAGE problem1
namespace problem1 {
#include "mass_spring.cpp"
}
#undef STAGE
#define STAGE diagonals
namespace diagonals {
#include "mass_spring.cpp"
}
#undef STAGE
#define STAGE forces
namespace forces {
#include "mass_spring.cpp"
}
#undef STAGE
#define STAGE constraints
namespace constraints {
#include "mass_spring.cpp"
}
#undef STAGE
#define STAGE tear
namespace tear {
#include "mass_spring.cpp"
}
#undef STAGE
#undef main

int main(int argc, char** argv) {
  std::cout.precision(12);
  return problem1::run(argc, argv) + diagonals::run(argc, argv) +
         forces::run(argc, argv) + constraints::run(argc, argv) +
         tear::run(argc, argv);
}
