#pragma once
/** @file Advise.hpp
 * advise(): which parts, grid, method and step a scene needs for its answer,
 * found by trial runs (pilots). README.md explains the algorithm and how often
 * it is right. */
#include "lab/advice/Advice.hpp"
#include "lab/advice/Pilots.hpp"

namespace lab {

/** What may be advised, and bounds of the pilots. */
struct AdviceRules {
  /** The work of all pilots, in spring evaluations, so that advice is the same
   * on every machine; 0: the larger of Pilots::usual and one run of the scene;
   * 24 runs of a mesh from files, and eight by assess(), which run its own
   * grid.
   */
  double budget = 0;
  /** Advise the method or the step of the scene. */
  bool keeps_method = false, keeps_step = false;
  /** Called often, with the current run and the results so far. */
  Pilots::Tell tell = [](const std::string&, double) {};
  /** Limit of a grid that is run or advised; 0: 40,000, or one per 1e4 of a
   * larger budget, as a run takes so many spring evaluations per node, up to
   * 1e6. */
  double most_nodes = 0;
  /** Once a choice is found, a finer grid is run to find a cheaper one if that
   * takes at most so many spring evaluations, or 0.3 of the scene's own run. */
  double patience = 1e7;
  /** Share of the uncertainty that is added to the error of a choice that was
   * run. All of it would take one or two more grids, and few scenes need that:
   * suite.py. */
  double counted_share = 0.45;
};

/** Find the cheapest model that answers the question of @a m. Runs @a m many
 * times: on coarser grids first, without each part, by several methods.
 * @pre @a m has a mesh: check_has_cloth()
 * Throws InputError, SceneError: also if @a m can't answer its question. */
Advice advise(const Model& m, const AdviceRules& rules = {});

/** How large the errors of the grid, the step and the method of @a m are; and
 * as advice the largest step by which they meet the tolerance, or a refusal.
 * @pre, throws as advise() */
Advice assess(const Model& m, const AdviceRules& rules = {});

}  // namespace lab
