#pragma once
/** @file Precision.hpp
 * The difference between single precision (REAL=float) and double: the float
 * build writes the final states of its runs, the double build repeats the runs
 * and compares. The error of the method cancels; round-off is left. */
#include <iosfwd>
#include <string>
#include <vector>

#include "lab/charts/Problem.hpp"

namespace lab {

/** Write the final states of runs of @a problems, a line each: "scene method
 * steps", energy [J], center of mass [m], and the positions [m] if the norm
 * uses them. Methods: Verlet and srkn11b, at 1/2, 1/8 and 1/32 of their
 * largest stable steps.
 * Throws std::runtime_error if a run does not reach its end. */
void write_ends(const std::vector<Problem>& problems, std::ostream& out);

/** The comparison of a line of write_ends() with the same run here. */
struct Compared {
  std::string scene, method;
  Norm norm;
  double dt;  ///< [s]
  long long steps;
  double distance;  ///< [m], in the scene's norm
};

/** Repeat the runs whose final states are in @a text, written by write_ends().
 * @param file the name of the text, for messages
 * Throws InputError for a line that is not the end of a run of @a problems. */
std::vector<Compared> compare_ends(const std::vector<Problem>& problems,
                                   const std::string& text,
                                   const std::string& file);

/** Write a table of the runs. Its head has the floor of each scene: the least
 * distance, since no run in single precision is known to be more accurate. */
void write_compared(const std::vector<Compared>& all, std::ostream& out);

}  // namespace lab
