#pragma once
/** @file Growth.hpp
 * The growth of a small perturbation, measured on a sheet at rest, whose
 * frequencies do not change. */
#include "lab/charts/Problem.hpp"

namespace lab {

/** A square of side x side nodes of 1 kg together, K = 100 N/m, stretched
 * evenly to @a stretch times its size and held along its boundary, without
 * gravity. It stays at rest if @a stretch >= 1; otherwise it buckles.
 * @param gamma drag c/m [1/s] */
Problem stretched_sheet(unsigned side, MeshSprings::Kind mesh, double stretch,
                        double gamma);

/** Give @a p, which is at rest, random velocities and measure their growth.
 * The size of a perturbation is the square root of its energy: kinetic, and
 * elastic with the stiffness at rest. The exact motion conserves it; drag
 * lowers it. The size is kept below a thousandth of a spring's length.
 * @param steps number of steps, at least 2
 * @param every steps between two measurements of the size, in which it should
 *        not grow by more than 1e4
 * @param enough stop when ln of the size has grown by so much
 * @return ln of the size at the end over that at the start; infinite: it was
 * enough, or the state is not finite.  Complexity: the steps,
 * and one pass over the springs for each measurement. */
double growth(const Problem& p, const MethodEntry& method, double dt, int steps,
              int every = 1, double enough = no_limit);

/** The largest step [s] with which a perturbation of @a p grows at most tenfold
 * in @a steps: by bisection between @a low, with which it does, and @a high,
 * with which it does not, to a relative @a precision. */
double measured_sheet_limit(const Problem& p, const MethodEntry& method,
                            double low, double high, int steps,
                            double precision = 0.01);

}  // namespace lab
