#pragma once
/** @file Choice.hpp
 * ChoiceSearch: the cheapest grid, parts, method and step that meet the
 * tolerance. */
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "lab/advice/Parts.hpp"

namespace lab {

struct Choice : AdvisedRun {
  std::vector<std::string> removed = {};  // parts
  GridStudy::Grid grid = {};
  double step = 1;  // over the largest stable one; if there is none, [s]
  int kind = 0;     // equal for choices of the same grid, parts and end
  double scatter = 0;
  Answer half = {};  // by half the step
};

class ChoiceSearch {
 public:
  ChoiceSearch(Question& q, GridStudy& grids, PartStudy& parts)
      : q_(q), grids_(grids), parts_(parts) {}

  /** Find the cheapest choice that meets the tolerance, also by half of its
   * step and on a grid of twice the cells: otherwise it meets it by accident.
   * The one found before stays if there is none. */
  void search();
  /** Find the largest step that meets the tolerance on the scene's own grid by
   * its own method, with all parts. */
  void search_steps();

  const std::optional<Choice>& found() const { return found_; }
  /** Why choices that meet the tolerance were not taken; or empty. */
  const std::string& objection() const { return objection_; }

 private:
  /** A choice that was run: its step added this to the error by the pilot on
   * its grid; nothing: the run failed. */
  struct StepError {
    const MethodEntry* method;
    std::vector<std::string> removed;
    double t_end, step, dt;  // [s]; Choice::step; [s]
    std::optional<Effect> error;
  };

  Question& q_;
  GridStudy& grids_;
  PartStudy& parts_;
  std::optional<Choice> found_;
  std::string objection_;
  std::vector<StepError> step_errors_;
  /** Where the work depends on the motion: that of the last run over what was
   * predicted. */
  std::map<const MethodEntry*, double> real_work_;

  /** All parts, methods and steps on these grids, the cheapest first by
   * prediction. */
  std::vector<Choice> choices(const std::vector<GridStudy::Grid>& grids) const;
  /** False if a step that is not longer than that of @a c was too long for an
   * error as that by the pilot. */
  bool may_hold(const Choice& c) const;
  /** Whether @a c may take less work than @a most. A method of varying work is
   * tried once to know that. */
  bool may_be_cheaper(const Choice& c, double most) const;
  /** Replace @a best by the cheapest choice that holds, if one is cheaper. */
  void try_all(const std::vector<GridStudy::Grid>& grids,
               std::optional<Choice>& best);
  /** Smaller steps may mend what `misses`; `by_accident`: refinements miss. */
  enum Outcome { holds, misses, by_accident };
  /** Run @a c, which meets the tolerance if its error and a share of the
   * uncertainty do; then its refinements, its motion before the end, from
   * perturbed starts and, last, as ./cloth does.
   * @param most the work from which @a c is not wanted */
  Outcome judge(Choice& c, double most);
  bool holds_on_finer_grids(Choice& c);
  Trial run(const Choice& c, const Model& m, double work, const std::string& by,
            const Shake& shake = {});
  void learn(const Choice& c, const Trial& t, double share);
  /** Run @a c from perturbed starts, and by a step between its own and half of
   * it; the answers by these two steps predict that by the third.
   * @return the largest difference from what was expected */
  double perturb(const Choice& c);
};

}  // namespace lab
