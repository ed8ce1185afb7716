#pragma once
/** @file Choice.hpp
 * ChoiceSearch: the cheapest grid, parts, method and step that meet the
 * tolerance. */
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "lab/advice/Parts.hpp"

namespace lab {

struct Choice : AdvisedRun {
  std::vector<std::string> removed = {};
  Sides sides = {};  // none of a mesh from files
  double step = 1;   // over the largest stable one; if there is none, [s]
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

 private:
  Question& q_;
  GridStudy& grids_;
  PartStudy& parts_;
  std::optional<Choice> found_;
  std::map<std::string, double> too_long_;  // by method: Choice::step

  /** All methods and steps with these parts on this grid, the cheapest first.
   */
  std::vector<Choice> choices(const Sides& s) const;
  /** Replace @a best by the first of these choices that holds, if one is
   * cheaper. */
  void try_all(const Sides& s, std::optional<Choice>& best);
  /** Run @a c, which meets the tolerance if its error and a share of the
   * uncertainty do; then its refinements and, last, from perturbed starts. */
  bool holds(Choice& c);
  bool holds_on_finer_grids(Choice& c);
  Trial run(const Choice& c, const Model& m, double work, const std::string& by,
            const Shake& shake = {});
  /** Run @a c from perturbed starts, and by a step between its own and half of
   * it; the answers by these two steps predict that by the third.
   * @return the largest difference from what was expected */
  double perturb(const Choice& c);
};

}  // namespace lab
