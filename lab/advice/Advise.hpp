#pragma once
/** @file Advise.hpp
 * What a scene needs for its answer, found by short runs of it: which parts,
 * which grid, which method and step. README.md tells how, and how often it is
 * right. */
#include "lab/advice/Advice.hpp"
#include "lab/advice/Pilots.hpp"

namespace lab {

/** How far estimates are trusted; how far pilots go. */
struct AdviceRules {
  double uncertainty_of_effects = 0.2;  ///< of what parts and steps change
  double for_parts = 0.7;               ///< of the tolerance, at most
  double first_cells = 5;     ///< along the shortest side of the first grid
  double most_nodes = 40000;  ///< of a grid that is tried or advised
  /** A finer grid than advice needs, to make it cheaper, is run if that takes
   * at most so many spring evaluations, about a second. */
  double patience = 1e8;
  double shake = 1e-6;    ///< [m], of starts that should change nothing
  int most_checked = 24;  ///< choices that are run to see if they do
  /** What is foreseen between coarse grids is often wrong: choices of up to so
   * many times the tolerance are run, too, if that takes at most this share of
   * the budget that is left. */
  double hope = 8, long_shots = 5e-4;
  /** What all pilots may take, in spring evaluations, so that advice is the
   * same on every machine; 0: the larger of 2e8, about 2 s, and a run of the
   * scene as it stands. */
  double budget = 0;
  double rate = 1e8;  ///< spring evaluations a second: budgets in words
  /** Called often, with what is done and what is known. */
  Pilots::Tell tell = [](const std::string&, double) {};
  double most_uncertainty = 0.2;  ///< of the tolerance, in the limit of all
                                  ///< grids
  /** Share of its uncertainty for which a choice that was run must leave room:
   * to leave room for all of it takes a grid or two more, and few scenes need
   * it: adviser_suite.cpp. */
  double counted = 0.45;
  /** With more than this share of the tolerance uncertain in the limit of all
   * grids nothing is advised. */
  double most_unsure = 0.6;
};

/** With a budget of so many @a seconds of this machine; of 0: the larger of 2 s
 * and what a run of @a m takes as it stands. Grids may have as many nodes as
 * that affords.  Throws as measured_rate() */
AdviceRules rules_of(const Model& m, double seconds);

/** @a m as pilots compute it, unless it is stiff: by Verlet, with the step that
 * is safe in every configuration. */
Model as_pilot(Model m);

/** Find out what @a m needs for its answer. Runs it many times: on coarser
 * grids first, without each part, by several methods.
 * @pre @a m has a mesh: check_has_cloth()
 * Throws InputError, SceneError: also if @a m can't answer its question. */
Advice advise(const Model& m, const AdviceRules& rules = {});

}  // namespace lab
