#pragma once
/** @file StepLimit.hpp
 * How long a step of a method may be. */
#include "lab/methods/Method.hpp"
#include "lab/stability/Spectrum.hpp"

namespace lab {

/** The larger size of the eigenvalues of the matrix (a b; c d). */
double spectral_radius(double a, double b, double c, double d);

/** By what factor a step of @a method makes an oscillator grow, x'' + gamma x'
 * + omega^2 x = 0, when it is repeated: the spectral radius of the step's
 * matrix. Found by stepping a mass on a spring of rest length 0, which is
 * exactly linear, from two states.
 * @param dt [s] > 0   @param omega [1/s] > 0   @param gamma [1/s] >= 0
 * Throws what the method throws. */
double amplification(Method& method, double dt, double omega, double gamma = 0);

/** The largest step [s] with which @a method stays bounded on all frequencies
 * up to @a omega [1/s], with a drag of @a gamma = c/m [1/s]; no_limit if all
 * do. Without drag info.limit/omega. Drag that is treated exactly does not
 * lower that; drag as a force does: symplectic Euler needs (dt omega)^2 + 2 dt
 * gamma < 4, forward Euler dt < gamma/omega^2. So the limit is the smaller one
 * of that without drag and of what amplification() says with it. */
double step_limit(const MethodEntry& method, double omega, double gamma = 0);

/** The longest step [s] with which @a method damps a wave of @a omega [1/s] by
 * at most @a share more than a drag of @a gamma > 0 [1/s] does; no_limit if
 * @a dt is one, and no less than a 16th of it. Splittings damp nothing by
 * themselves; rk4 takes (dt omega)^6/72 of the energy in every step. */
double mild_step(const MethodEntry& method, double dt, double omega,
                 double gamma, double share);

/** The largest c/m [1/s] of a node of a cloth with drag @a c.  O(N) */
double largest_gamma(const Cloth& g, const Drag& c);

/** The share of a safe limit that `--dt auto` begins with, and of a sharp one;
 * StepControl goes on from there.
 *
 * The safe limit is that of oscillations about any one configuration. A cloth
 * without drag that moves violently also gains energy from its changes of
 * configuration, below the limit, too. The sharp share also covers what
 * SharpOmega misses. */
inline constexpr double safe_share = 0.6, sharp_share = 0.9;

}  // namespace lab
