#pragma once
/** @file Precision.hpp
 * How far single precision (REAL=float) ends from double: the float build
 * writes the ends of its runs, the double build makes the same runs and
 * compares. The error of the method cancels; round-off is left. */
#include <iosfwd>
#include <string>
#include <vector>

#include "lab/charts/Problem.hpp"

namespace lab {

/** Write where runs of @a problems end, a line each: "scene method steps",
 * energy [J], center of mass [m], and, where the norm asks for them, the
 * positions [m]. By Verlet and srkn11b, at 1/2, 1/8 and 1/32 of their largest
 * stable steps.
 * Throws std::runtime_error if a run does not reach its end. */
void write_ends(const std::vector<Problem>& problems, std::ostream& out);

/** A line of write_ends() and the same run here. */
struct Compared {
  std::string scene, method;
  Norm norm;
  double dt;  ///< [s]
  long long steps;
  double distance;  ///< [m], in the scene's norm
};

/** Make the runs whose ends are in @a text, in the form of write_ends().
 * @param file the name of the text, for messages
 * Throws InputError for a line that is not the end of a run of @a problems. */
std::vector<Compared> compare_ends(const std::vector<Problem>& problems,
                                   const std::string& text,
                                   const std::string& file);

/** A table of the runs. In its head the floor of each scene: the least
 * distance, as no run in single precision can be trusted to be nearer. */
void write_compared(const std::vector<Compared>& all, std::ostream& out);

}  // namespace lab
