#pragma once
/** @file StepLimit.hpp
 * The longest step with which a method is stable. */
#include "lab/methods/Method.hpp"
#include "lab/stability/Spectrum.hpp"

namespace lab {

/** The spectral radius of the matrix (a b; c d). */
double spectral_radius(double a, double b, double c, double d);

/** The factor per step by which @a method amplifies the oscillator
 * x'' + gamma x' + omega^2 x = 0: the spectral radius of the step's matrix. The
 * matrix is found by stepping a mass on a spring of rest length 0, which is
 * linear, from two states.
 * @param dt [s] > 0   @param omega [1/s] > 0   @param gamma [1/s] >= 0
 * Throws what the method throws. */
double amplification(Method& method, double dt, double omega, double gamma = 0);

/** The largest step [s] with which @a method is stable at all frequencies up
 * to @a omega [1/s] with drag @a gamma = c/m [1/s]; no_limit if it is stable
 * with any step. Without drag this is info.limit/omega. Drag that the method
 * solves exactly does not lower it; drag that is treated as a force does:
 * symplectic Euler needs (dt omega)^2 + 2 dt gamma < 4, forward Euler dt <
 * gamma/omega^2. Then a bisection finds where amplification() exceeds 1. */
double step_limit(const MethodEntry& method, double omega, double gamma = 0);

/** The longest step [s] <= @a dt with which @a method damps a wave of @a omega
 * [1/s] at most (1 + @a share) times as much as drag @a gamma > 0 [1/s] does;
 * no_limit if @a dt itself does; at least dt/16. Splitting methods have no
 * damping of their own; rk4 removes (dt omega)^6/72 of the energy a step. */
double mild_step(const MethodEntry& method, double dt, double omega,
                 double gamma, double share);

/** The largest c/m [1/s] of the nodes of @a g with drag @a c.  O(N) */
double largest_gamma(const Cloth& g, const Drag& c);

/** `--dt auto` starts with safe_share of the safe limit, `--dt auto:sharp` with
 * sharp_share of the sharp limit; then StepControl adapts the step.
 *
 * The safe limit holds for oscillations about one configuration. A cloth that
 * moves violently without drag changes its configuration, and can gain energy
 * below that limit. The sharp share also covers the error of SharpOmega. */
inline constexpr double safe_share = 0.6, sharp_share = 0.9;

}  // namespace lab
