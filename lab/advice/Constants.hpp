#pragma once
/** @file Constants.hpp
 * The numbers of the adviser. Behind each stands the test that fails if it is
 * doubled. */

namespace lab {

struct Constants {
  /** A cloth whose kinetic energy is at most this share of its largest one is
   * at rest [1]. (Advise.OfAClothAtRestIsItsRest) */
  double still = 1e-4;
  /** Cholesky factors that a cloth takes to its rest: a guess for the budget
   * [1]. */
  double rest_factors = 30;
  /** Runs of a mesh from files that the budget allows: pilots take five, a
   * choice with its checks and its witness up to 19 [1].
   * (Advise.AMeshFromFilesTakesAFewRuns) */
  double mesh_runs = 24;
};
inline constexpr Constants constant;

}  // namespace lab
