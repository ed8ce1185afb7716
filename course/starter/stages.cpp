/** @file stages.cpp
 * All five stages of mass_spring.cpp in one program, which `make graphs` builds
 * and runs with Graph.hpp of the root and of each folder here. */
#include <cmath>
#include <exception>
#include <future>
#include <iostream>
#include <optional>
#include <stdexcept>
#include <string>

#include "CME212/SDLViewer.hpp"
#include "mass_spring.hpp"

#define main run
#include "course/tests/stages.hpp"
#undef main

int main(int argc, char** argv) {
  return kit_problem1::run(argc, argv) + kit_diagonals::run(argc, argv) +
         kit_forces::run(argc, argv) + kit_constraints::run(argc, argv) +
         kit_tear::run(argc, argv);
}
