#pragma once
/** @file Growth.hpp
 * How fast a tiny disturbance grows: measured on a sheet at rest, whose
 * frequencies do not change, and by theory for an oscillator. */
#include <string_view>

#include "lab/charts/Problem.hpp"

namespace lab {

/** The factor by which a step makes an oscillator grow, x'' + gamma x' +
 * omega^2 x = 0: what amplification() should measure.
 * Runge-Kutta: the larger |R(z)| of z^2 + d z + y^2 = 0, R the Taylor
 * polynomial of exp of the method's order; others: the spectral radius of the
 * product of their stages.
 * @param y dt omega > 0   @param d dt gamma >= 0
 * Throws std::invalid_argument for a method whose formula is not here. */
double amplification_by_theory(std::string_view method, double y, double d);

/** A square of side x side nodes of 1 kg together, K = 100 N/m, stretched
 * evenly to @a stretch times its size and held at its whole rim, without
 * gravity: at rest for ever, if @a stretch >= 1; else it buckles.
 * @param gamma drag c/m [1/s] */
Problem stretched_sheet(unsigned side, Mesh mesh, double stretch, double gamma);

/** How a disturbance grew. */
struct Growth {
  double total = 0;     ///< ln of its size at the end over that at the start
  double per_step = 0;  ///< ln of its growth per step in the later half
};

/** Give @a p, which is at rest, random velocities and measure their growth.
 * The size of a disturbance is the root of its energy, kinetic and, in the
 * springs as they are at rest, elastic; motion that is exact keeps it (or, with
 * drag, lowers it). It is kept small: below a thousandth of a spring's length.
 * @param steps how many, at least 2
 * @param every steps between two measurements of the size, in which it should
 *        not grow by more than 1e4
 * @param enough stop when its ln has grown by so much
 * Not finite: an infinite growth.  Complexity: the steps, and the springs once
 * for each measurement. */
Growth growth(const Problem& p, const MethodEntry& method, double dt, int steps,
              int every = 1, double enough = no_limit);

/** The largest step [s] with which a disturbance of @a p grows no more than
 * tenfold within @a steps, found as measured_limit() does. */
double measured_sheet_limit(const Problem& p, const MethodEntry& method,
                            double low, double high, int steps,
                            double precision = 0.01);

}  // namespace lab
