#pragma once
/** @file Adviser.hpp
 * The class behind advise(). Advise.cpp has find(), the grids and the test for
 * chaos; Choose.cpp has the parts, the methods and the choice. */
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "CME212/Util.hpp"
#include "lab/advice/Advise.hpp"
#include "lab/advice/Variation.hpp"
#include "lab/scenes/Compose.hpp"
#include "lab/stepping/Separation.hpp"

namespace lab::adviser_detail {

constexpr double infinite = std::numeric_limits<double>::infinity();

/** Uncertainty over the largest difference of the perturbed runs: more runs
 * would show a larger one. */
constexpr double scatter_share = 1.5;

inline std::size_t nodes_of(const Model& m) { return mesh_of(m).points.size(); }

class Adviser {
 public:
  Adviser(const Model& m, const AdviceRules& rules, bool assesses = false);

  Advice find();
  Advice assess();

 private:
  /** Parts left out together. */
  struct Reduction {
    std::vector<std::string> removed;
    Effect effect;
  };
  struct Choice : AdvisedRun {
    std::vector<std::string> removed = {};
    Sides sides = {};
    double step = 1;  // over the largest stable one; if there is none, [s]
    double scatter = 0;
    Answer half = {};  // by half the step
  };
  /** All results of a run on a grid. */
  struct Seen {
    std::vector<Answer> all;  // for every Measure
    Track track;
    Model model;
    double work;
  };

  Model scene_;
  AdviceRules rules_;
  double run_work_;  // of the scene's own run
  Pilots pilots_;
  Advice advice_;
  // A mesh from files is never refined: its "grids" are runs by smaller steps.
  int level_ = 0, first_level_ = 0;  // of the next grid and of the first one
  int invalid_ = 0;                  // grids without a scene, one after another
  std::vector<int> levels_;          // of the grids that were run
  std::vector<Seen> seen_;           // on these grids
  std::optional<Model> method_;      // of pilots, with the step on level 0
  Answer limit_;                     // of the grids
  double uncertainty_ = 0;           // of limit_
  std::size_t base_ = no_base;       // the grid on which parts are tried
  std::vector<Reduction> reductions_;  // of more parts each time
  double rest_time_ = 0;               // [s]: the cloth is at rest afterwards
  std::optional<Choice> found_;
  Shake shake_ = {1e-6};  // within the plane in which the cloth moves, if any
  static constexpr std::size_t no_base = ~std::size_t(0);

  bool from_files() const { return scene_.sheets.empty(); }
  /** Grids, or steps on a mesh from files, that tell an error. */
  std::size_t fewest() const { return from_files() ? 3 : 5; }
  bool refuse(const std::string& why) {
    advice_.refusal = why;
    return false;
  }
  double size_of(const Effect& e) const { return e.size(advice_.measure); }
  double error_of(const Trial& t) const {
    return t.ok() ? distance(t.answer, limit_, advice_.measure) : infinite;
  }
  /** The rule of acceptance, for an error that is uncertain by so much. */
  bool accepts(double error, double uncertainty) const {
    return error + rules_.counted_share * uncertainty <= advice_.tolerance;
  }

  // ------------------------------------------------------------------- Grids

  /** Cells over those of the scene: 1, 1.5, 2, 3, 4, 6 ..., and down from 1. */
  static double factor(int level);
  Model on_grid(const Sides& s) const {
    return from_files() ? scene_ : refined(scene_, s);
  }
  /** The same factor along all sides. */
  Sides all_sides(double u, double v) const {
    return Sides(scene_.sheets.size(), {u, v});
  }
  Model on_level(int level) const {
    return on_grid(all_sides(factor(level), factor(level)));
  }
  /** The cells of the largest sheet along u (0) or v (1). */
  double cells(double factor, int side) const;
  /** Cells along a side of @a m over those of the scene, in the mean; of a mesh
   * from files, the first step over that of @a m. */
  double over(const Model& m) const;
  /** @a m as pilots run it: by Verlet; or, where its limit makes a grid of few
   * cells cost more than rules_.stiff, by a multirate or an implicit method if
   * that takes less than half of the work. Steps shrink with the cells. */
  Model pilot(Model m, double factor) const;
  void choose_pilots();
  /** Run the next grid. Grids that miss a pin are skipped, those that are too
   * coarse to carry the load are forgotten.
   * @return as refuse(), also if there are no finer grids */
  bool add_grid();
  bool is_certain() const {
    return uncertainty_ <= rules_.most_uncertainty * advice_.tolerance;
  }
  bool too_uncertain() const {
    return uncertainty_ > rules_.most_uncertain * advice_.tolerance;
  }
  /** True, with a refusal, if the budget is too small to know the limit. */
  bool hopeless();
  /** True if a finer grid is cheap and may lead to a cheaper choice. */
  bool may_go_on() const;

  // Texts for progress and refusals.
  std::string so_far() const;
  std::string over_budget(double work) const;
  /** The tolerance in the unit of the measure, if it is a share of the change
   * since t = 0, or of the answer.  @return as refuse(), if that is 0 */
  bool know_tolerance();
  Answer answer_at_start() const;
  void check() const;
  void end(const CME212::Clock& clock);
  /** Why the answer of this scene needs no computation; or empty. */
  std::string trivial() const;

  // ------------------------------------------------------------------- Chaos

  /** Let shake_ move no node along an axis along which none has moved until the
   * end, @a g: a motion that is symmetric stays so. */
  void find_plane(const Cloth& g);
  /** Say if a cloth that moves in a plane would buckle. */
  void find_buckling(const Model& m, double work, const Answer& plane);
  /** Repeat a run from a start moved by shake_, on a grid of half the
   * cells of the finest, and compare the answers for every Measure and, over
   * time, the positions.
   * @return as refuse(), if this or @a scatter, that of the advised run,
   * exceeds half of the tolerance: then the motion is chaotic */
  bool look_for_chaos(double scatter);
  std::string same_until(const Separation& apart) const;
  /** Run @a c from perturbed starts, and by a step between its own and half of
   * it; the answers by these two steps predict that by the third.
   * @return the largest difference from what was expected */
  double perturb(const Choice& c);
  /** Say if the answer on the finest grid depends on the shape of its cells. */
  void try_squares();

  // ------------------------------------------------------------------- Parts

  /** Leave out each part alone; then one more each time, as long as together
   * they change little: first the parts that save springs or steps; within each
   * group, those that change least. */
  void find_parts();
  static double springs_of(const Model& m);
  /** Find the time after which the answer stays within a tenth of the
   * tolerance. Only drag and friction bring a cloth to rest. */
  void find_rest();
  static bool dissipates(const Model& m);

  // ------------------------------------------------------------------ Choice

  /** Find the cheapest choice that meets the tolerance, also by half of its
   * step and on a grid of twice the cells: otherwise it meets it by accident.
   * The one found before stays if there is none. */
  void choose();
  /** The levels that meet the tolerance by pilots, and on twice the cells. */
  std::vector<int> starts() const;
  /** Up to three grids that meet the tolerance by pilots, the cheapest first:
   * that of level @a start, and those of fewer cells along one side.
   * Cost: about a run for each level and side */
  std::vector<Sides> frontier(int start);
  /** @a s, whose pilot takes @a work, with fewer cells along one side of one
   * sheet more each time, as long as that meets the tolerance and is cheaper.
   */
  std::vector<Sides> thinned(Sides s, double work);
  /** True if the pilot on this grid meets the tolerance. */
  bool suffices(const Sides& s, double most_work, double& work);
  /** All methods and steps with these parts on this grid, the cheapest first.
   */
  std::vector<Choice> choices(const Sides& s) const;
  /** Run @a c, which meets the tolerance if its error and a share of the
   * uncertainty do; then its refinements and, last, from perturbed starts. */
  bool holds(Choice& c);
  /** The budget ended: take all parts, by the pilots' method, on the coarsest
   * grid that is predicted to meet the tolerance; on a mesh from files by the
   * largest step that does. */
  void foresee();
  void take(const Choice& c);
};

}  // namespace lab::adviser_detail
