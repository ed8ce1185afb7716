#pragma once
/** @file Advise.hpp
 * advise(): which parts, grid, method and step a scene needs for its answer,
 * found by trial runs (pilots). README.md explains the algorithm and how often
 * it is right. */
#include "lab/advice/Advice.hpp"
#include "lab/advice/Pilots.hpp"

namespace lab {

/** Safety margins of the estimates, and bounds of the pilots. */
struct AdviceRules {
  /** Relative uncertainty of the change by a part or a step. */
  double uncertainty_of_effects = 0.2;
  double for_parts = 0.7;     ///< share of the tolerance for parts left out
  double first_cells = 5;     ///< along the shortest side of the first grid
  double most_nodes = 40000;  ///< of a grid that is run or advised
  /** Once a choice is found, a finer grid is run to find a cheaper one if that
   * takes at most so many spring evaluations, about a second. */
  double patience = 1e8;
  double shake = 1e-6;    ///< [m], perturbation of the start
  int most_checked = 24;  ///< choices that are run
  /** Predictions between coarse grids are often wrong: choices with a predicted
   * error of up to long_shot_error tolerances are run, too, if their work is at
   * most the share long_shot_work of the remaining budget. */
  double long_shot_error = 8, long_shot_work = 5e-4;
  /** The work of all pilots, in spring evaluations, so that advice is the same
   * on every machine; 0: the larger of 2e8, about 2 s, and one run of the
   * scene. */
  double budget = 0;
  double rate = 1e8;  ///< spring evaluations per second, for messages
  /** Called often, with the current run and the results so far. */
  Pilots::Tell tell = [](const std::string&, double) {};
  /** Finer grids are run until the limit of the grids is known to this share of
   * the tolerance. */
  double most_uncertainty = 0.2;
  /** Share of the uncertainty that is added to the error of a choice that was
   * run. All of it would take one or two more grids, and few scenes need that:
   * adviser_suite.cpp. */
  double counted_share = 0.45;
  /** Nothing is advised if the limit of the grids is uncertain by more than
   * this share of the tolerance. */
  double most_uncertain = 0.6;
};

/** Rules with a budget of @a seconds on this machine; 0: the larger of 2 s and
 * the time of one run of @a m. The budget also limits the nodes of a grid.
 * Throws as measured_rate() */
AdviceRules rules_of(const Model& m, double seconds);

/** @a m by Verlet with the step that is safe in every configuration: how pilots
 * run unless the scene is stiff. */
Model as_pilot(Model m);

/** Find the cheapest model that answers the question of @a m. Runs @a m many
 * times: on coarser grids first, without each part, by several methods.
 * @pre @a m has a mesh: check_has_cloth()
 * Throws InputError, SceneError: also if @a m can't answer its question. */
Advice advise(const Model& m, const AdviceRules& rules = {});

}  // namespace lab
