#pragma once
/** @file Constants.hpp
 * Numbers of the adviser: what each is, its unit, and in parentheses the test
 * that fails if it is doubled, where one does, or without it. */
#include <cstddef>

namespace lab {

struct Constants {
  // The fit of grids. Source: L. Eca, M. Hoekstra, A procedure for the
  // estimation of the numerical uncertainty of CFD calculations based on grid
  // refinement studies, J. Comput. Phys. 262, 2014.

  /** The widest mesh of a fit, over the finest one [1].
   * (Refinement.ForgetsGridsThatAreMuchCoarser) */
  double widest = 6.5;
  /** Grids of a fit, at least [1].
   * (Refinement.IsNotDeceivedWhereAPinHoldsOneNode) */
  std::size_t fewest = 4;
  /** The lowest order that is tried [1].
   * (Refinement.KnowsThatASlowConvergenceMayGoOn) */
  double lowest = 0.1;
  /** The distance of two orders that are tried [1].
   * (Refinement.KnowsThatASlowConvergenceMayGoOn) */
  double apart = 0.05;
  /** The lowest order that is believed [1].
   * (Refinement.DoesNotBelieveEveryOrder) */
  double believed_from = 0.5;
  /** The highest one [1]. (Refinement.DoesNotBelieveEveryOrder) */
  double believed_to = 2.1;
  /** A lower order is taken if its deviation is at most this share of that of
   * orders 1 and 2 [1]. (Refinement.DoesNotBelieveEveryOrder) */
  double fits_better = 0.5;
  /** Share of the finest grid's error in the uncertainty [1].
   * (Refinement.FindsTheLimitOfWhatGoesByAnOrder) */
  double of_error = 0.2;
  /** Factor of the uncertainty without an order [1].
   * (Refinement.IsNotDeceivedWhereAPinHoldsOneNode) */
  double not_believed = 1.5;
  /** The uncertainty of three grids over the error of the finest [1].
   * (Refinement.IsUncertainOfWhatGoesByNoOrder) */
  double of_three_grids = 3;

  // Known, in shares of the tolerance

  /** The limit is known if it is uncertain by at most this [1].
   * (Budget.ARefusalNamesTheToleranceAndTheWorkThatAreEnough) */
  double most_uncertain = 0.6;
  /** It needs no finer grid if it is uncertain by at most this [1].
   * (Without it: Assess.TellsTheErrorOfTheGrid) */
  double certain = 0.25;
  /** A run may end once its answer stays as near to that at the end [1].
   * (Without it lines 14 and 20 of by_hand.txt cost 4.6 and 2.4 times as
   * much.) */
  double negligible = 0.1;
  /** A cloth whose kinetic energy is at most this share of its largest one is
   * at rest [1]. (Without it: Advise.OfAClothAtRestIsItsRest) */
  double still = 1e-4;

  // Work

  /** A run by Verlet on 8 cells that takes more makes pilots implicit or
   * multirate [spring evaluations]. */
  double too_much = 2e6;
  /** Cells along the short side of one sheet over those of another, at most
   * [1]. (Without it: Advise.CoarsensEachSheetOnItsOwn) */
  double most_ratio = 3;
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
