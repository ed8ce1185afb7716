#pragma once
/** @file Grids.hpp
 * GridStudy: the answer of a scene on ever finer grids; its limit, and how
 * uncertain that is; whether the motion is chaotic; and which grids meet the
 * tolerance. A mesh from files is never refined: its "grids" are runs by
 * smaller steps, and its own error is unknown. */
#include <algorithm>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "lab/advice/Advise.hpp"
#include "lab/advice/Constants.hpp"
#include "lab/advice/Variation.hpp"

namespace lab {

constexpr double infinite = std::numeric_limits<double>::infinity();

std::size_t nodes_of(const Model& m);

/** The scene, and all that its studies share. */
struct Question {
  Model scene;
  AdviceRules rules;
  double own_work;  ///< of the scene's own run; 0: not known
  Pilots pilots;
  Advice advice;  ///< each study writes its own part

  /** @param runs of the scene that the budget allows, if it is not given
   * Throws SceneError if @a m can't answer its question. */
  Question(const Model& m, const AdviceRules& rules, double runs);
  bool from_files() const { return scene.sheets.empty(); }
};

class GridStudy {
 public:
  /** A grid that may be chosen. */
  struct Grid {
    Sides sides;  // none: of a mesh from files
    Effect off;   // the error by its pilot
    double work;  // of that
    int level = 0;
  };

  explicit GridStudy(Question& q);

  /** Run the next grid. Grids that miss a pin are skipped, those that are too
   * coarse to carry the load are forgotten.
   * @return why that is not done or ends the search; empty: it was done */
  std::string add();

  // After a run, of the limit of the grids:

  const Refinement& grids() const { return q_.advice.grids; }
  /** In the unit of the measure; 0 if it is a share of 0. */
  double tolerance() const { return q_.advice.tolerance; }
  double size_of(const Effect& e) const { return e.size(q_.scene.measure); }
  double distance_of(const Answer& a, const Answer& b) const {
    return distance(a, b, q_.scene.measure);
  }
  double error_of(const Trial& t) const {
    return t.ok() ? distance_of(t.answer, grids().limit()) : infinite;
  }
  /** The rule of acceptance, for an error that is uncertain by so much. */
  bool accepts(double error, double uncertainty) const {
    return error + q_.rules.counted_share * uncertainty <= tolerance();
  }
  bool accepts(double error) const {
    return accepts(error, grids().uncertainty());
  }
  /** A finer grid is not needed to know the limit. */
  bool is_certain() const {
    return grids().uncertainty() <= constant.certain * tolerance();
  }
  /** Nothing can be advised. */
  bool too_uncertain(double most = constant.most_uncertain) const {
    return grids().uncertainty() > most * tolerance();
  }
  /** Enough grids tell an error; two more, whether there is any hope. */
  bool are_enough(std::size_t more = 0) const {
    return grids().size() >= fewest() + more;
  }
  bool knows_limit(double most = constant.most_uncertain) const {
    return are_enough() && !too_uncertain(most);
  }
  /** Not empty, with the reason, if the budget is too small to know it. */
  std::string hopeless() const;
  /** False if a finer grid can't lead to a choice, or, if one was @a found, to
   * a cheaper one. */
  bool may_go_on(bool found) const;
  /** Why the answer of this scene needs no computation; or empty. */
  std::string trivial() const;

  // Texts for progress and refusals.
  std::string so_far() const;
  std::string over_budget(double work) const;
  /** The tolerance that can be reached, and the budget that the one asked for
   * needs if the observed order goes on; or a run of @a work. */
  std::string way_out(double work) const;

  // Levels.cpp: grids that may be chosen

  Model on_grid(const Sides& s) const { return refined(q_.scene, s); }
  /** The levels that meet the tolerance by pilots, and on twice the cells. */
  std::vector<Grid> starts() const;
  /** Grids that meet the tolerance by pilots and cost at most as much as that
   * of @a start, itself one of them: of fewer cells along one side. */
  std::vector<Grid> frontier(const Grid& start);

  // Moments.cpp: motion and rest

  /** Three looks of Trial::earlier, from 1 on. The question draws two, in the
   * second quarter and in the second half of the time in which it moves; at the
   * third one the answer is the farthest from that at the end. */
  std::array<std::size_t, 3> moments() const;
  /** Is a run to @a t_end [s] the motion of the scene at these moments? */
  bool follows(const Trial& t, double t_end) const;
  /** Is @a a the answer at look @a k, to the tolerance and at most as much for
   * the uncertainty of the limit then? */
  bool follows(const Answer& a, std::size_t k) const;
  /** The distance of two answers at look @a k. If one event has not happened
   * yet, it is how long ago the other one did; infinite if it is no event. */
  double apart(const Answer& a, const Answer& b, std::size_t k) const;
  /** Of look @a k [s]. */
  double time_of(std::size_t k) const {
    return double(k) / Trial::looks * q_.scene.t_end;
  }
  /** The scene at rest, with the proof as advice.at_rest: if the finest pilot
   * does not move at the end and at two moments of the last quarter, has this
   * answer there, and the rest is stable. */
  std::optional<AdvisedRun> at_rest();

  // Refusals.cpp: chaos, and notes

  /** The perturbation of a start: within the plane in which the cloth moves, if
   * there is one. */
  const Shake& shake() const { return shake_; }
  /** Repeat a run from a start moved by shake(), on a grid of half the
   * cells of the finest, and compare the answers for every Measure.
   * @return the reason if this or @a scatter, that of the advised run, exceeds
   *         half of the tolerance: then the motion is chaotic; else empty */
  std::string find_chaos(double scatter = 0);

 private:
  Question& q_;
  double most_nodes_;
  double shortest_ = infinite;  // cells along the shortest side of the scene
  std::vector<Sides> levels_;   // the coarsest first; none: a mesh from files
  int level_ = 0;               // of the next grid
  struct {
    const MethodEntry* method;
    TimeStep step;  // on level 0
  } pilot_;
  int invalid_ = 0;  // grids without a scene, one after another
  Shake shake_ = {1e-6};

  std::size_t fewest() const { return q_.from_files() ? 3 : 5; }
  /** The work increases so with the factor of a grid. */
  double power_of_work() const { return q_.from_files() ? 1 : 3; }

  /** Of about 8 cells along the shortest side, or of the only mesh. */
  int some_level() const { return std::clamp(int(levels_.size()) - 1, 0, 3); }
  void choose_pilots();
  /** @a m as pilots run it: by Verlet; or, where its limit makes a grid of few
   * cells cost too much, by a multirate or an implicit method if that takes
   * less than half of the work. Steps shrink with the cells. */
  Model pilot(Model m, double factor) const;
  bool know_tolerance();
  Answer answer_at_start() const;

  void make_levels(double cells, double most_ratio);
  /** The cells of a level over those of the scene. */
  Sides sides_of(int level) const;
  Model on_level(int level) const { return on_grid(sides_of(level)); }
  /** Cells along a side over those of the scene, in the mean; of a mesh from
   * files, the first step over that of the level. */
  double factor(int level) const;
  int lowest(unsigned side) const;
  std::optional<Grid> that_meets(const Sides& s, double most_work);
  void thin(Grid grid, std::vector<Grid>& all);

  double drawn(unsigned k) const;
  bool is_still(std::size_t k) const;

  void find_plane(const Cloth& g);
  void find_buckling(const GridReport& run);
};

// Refusals.cpp: their causes, and what can be answered instead

/** Why the answer of @a m has no limit on finer grids, and what to ask instead;
 * empty if no reason is known.  Throws InputError, SceneError */
std::string diverging(const Model& m);

/** Why the answers of @a m converge slowly, and which pins would be better: the
 * end of a sentence, or empty.  Throws InputError, SceneError */
std::string converging_slowly(const Model& m);

/** Every quantity of a cloth of @a m; empty where it has none. */
std::vector<Answer> all_answers(const Model& m, const Cloth& g);

/** Questions that can be answered at the end of @a m although its motion is
 * chaotic: the measures that are known to a tenth of the size of the cloth or
 * better, or what to change if there are none.
 * @param answers,shaken by Measure, of a run and of one from a perturbed start;
 *        an empty one: unknown */
std::string offers(const Model& m, const std::vector<Answer>& answers,
                   const std::vector<Answer>& shaken);

}  // namespace lab
