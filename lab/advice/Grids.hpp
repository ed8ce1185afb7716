#pragma once
/** @file Grids.hpp
 * GridStudy: the answer of a scene on ever finer grids; its limit, and how
 * uncertain that is; and whether the motion is chaotic. SheetGrids refines the
 * sheets, MeshSteps the steps on a mesh from files. */
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "lab/advice/Advise.hpp"
#include "lab/advice/Variation.hpp"
#include "lab/stepping/Separation.hpp"

namespace lab {

constexpr double infinite = std::numeric_limits<double>::infinity();

/** Uncertainty over the largest difference of the perturbed runs: more runs
 * would show a larger one. */
constexpr double scatter_share = 1.5;

std::size_t nodes_of(const Model& m);
/** Every quantity of a cloth of @a m; empty where it has none. */
std::vector<Answer> all_answers(const Model& m, const Cloth& g);

/** The scene, and all that its studies share. */
struct Question {
  Model scene;
  AdviceRules rules;
  double own_work;  ///< of the scene's own run; 0: not known
  Pilots pilots;
  Advice advice;  ///< each study writes its own part

  /** Throws SceneError if @a m can't answer its question. */
  Question(const Model& m, const AdviceRules& rules);
};

class GridStudy {
 public:
  /** All results of a run on a grid. */
  struct Run {
    int level;
    Model model;
    double work = 0;
    std::vector<Answer> all = {};  // for every Measure
    Track track;
  };
  /** A grid that may be chosen. */
  struct Grid {
    Sides sides;
    Effect off;  // the error by its pilot
    int level = 0;
  };
  /** The differences between sheets and a mesh from files. */
  struct Kind {
    std::size_t fewest;  ///< grids that tell an error
    double power;        ///< work increases so with the factor
    double runs;         ///< the budget is at least so many pilots
    bool chaos_first;    ///< before parts are tried: each run is long
    const char *grid, *finer_grid, *finer, *on;  ///< words
  };

  virtual ~GridStudy() = default;

  /** Run the next grid. Grids that miss a pin are skipped, those that are too
   * coarse to carry the load are forgotten.
   * @return why that is not done or ends the search; empty: it was done */
  std::string add();

  // After a run, of the limit of the grids:

  const Kind& kind() const { return kind_; }
  const Refinement& grids() const { return q_.advice.grids; }
  /** The runs on these grids, the coarsest first. */
  const std::vector<Run>& runs() const { return runs_; }
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
  bool is_certain() const {
    return grids().uncertainty() <= q_.rules.most_uncertainty * tolerance();
  }
  bool too_uncertain() const {
    return grids().uncertainty() > q_.rules.most_uncertain * tolerance();
  }
  /** True if enough grids were run to know the limit well enough. */
  bool knows_limit() const {
    return grids().size() >= kind_.fewest && !too_uncertain();
  }
  /** Not empty, with the reason, if the budget is too small to know it. */
  std::string hopeless() const;
  /** False if a finer grid can't lead to a choice, or, if one was @a found, to
   * a cheaper one. */
  virtual bool may_go_on(bool found) const = 0;
  /** The budget ended: all parts, by the pilots' method, on the coarsest grid
   * that is predicted to meet the tolerance; on a mesh from files by the
   * largest step that does. */
  std::optional<AdvisedRun> foresee() const;
  /** Why the answer of this scene needs no computation; or empty. */
  std::string trivial() const;

  // Texts for progress and refusals.
  std::string so_far() const;
  std::string over_budget(double work) const;

  // Grids that may be chosen:

  /** 1, 1.5, 2, 3, 4, 6 ..., and down from 1: steps over those of
   * the first level; sheets take cells from it. */
  static double power(int level);
  /** The cells of a level, over those of the scene. */
  virtual Sides sides_of(int /*level*/) const { return {}; }
  virtual double factor(int level) const { return power(level); }
  Model on_grid(const Sides& s) const { return refined(q_.scene, s); }
  Model on_level(int level) const { return on_grid(sides_of(level)); }
  /** @a m as pilots run it: by Verlet; or, where its limit makes a grid of few
   * cells cost more than rules.stiff, by a multirate or an implicit method if
   * that takes less than half of the work. Steps shrink with the cells. */
  Model pilot(Model m, double factor) const;
  /** Cells along a side of @a m over those of the scene, in the mean; of a mesh
   * from files, the first step over that of @a m. */
  virtual double factor_of(const Model& m) const = 0;
  /** The levels that meet the tolerance by pilots, and on twice the cells. */
  virtual std::vector<Grid> starts() const = 0;
  /** Grids that meet the tolerance by pilots and cost at most as much as that
   * of @a start, itself one of them: of fewer cells along one side.
   * Cost: about a run for each level and side */
  virtual std::vector<Grid> frontier(const Grid& start) = 0;

  // Chaos.cpp

  /** The perturbation of a start: within the plane in which the cloth moves, if
   * there is one. */
  const Shake& shake() const { return shake_; }
  /** Repeat a run from a start moved by shake(), on a grid of half the
   * cells of the finest, and compare the answers for every Measure and, over
   * time, the positions.
   * @return the reason if this or @a scatter, that of the advised run, exceeds
   *         half of the tolerance: then the motion is chaotic; else empty */
  std::string find_chaos(double scatter);
  /** Tell what square cells would change on the finest grid. */
  void try_squares();

 protected:
  GridStudy(Question& q, const Kind& kind);
  /** @param some level of a grid of some 8 cells along the shortest side, or of
   *        the only mesh
   * @return false if a pin misses that grid */
  bool choose_pilots(int some);

  Question& q_;
  double most_nodes_;
  int level_ = 0;  // of the next grid
  struct {
    const MethodEntry* method;
    TimeStep step;  // on level 0
  } pilot_;
  /** This grid with the error by its pilot, if that meets the tolerance and
   * takes less than @a most_work.  @param work is set if the grid is valid */
  std::optional<Grid> that_meets(const Sides& s, double most_work,
                                 double& work);
  /** Where the last error is, in words. */
  virtual std::string finest() const = 0;

 private:
  Kind kind_;
  int invalid_ = 0;  // grids without a scene, one after another
  std::vector<Run> runs_;
  Shake shake_ = {1e-6};

  bool know_tolerance();
  Answer answer_at_start() const;
  void find_plane(const Cloth& g);
  void find_buckling(const Run& run, const Answer& plane);
  std::string same_until(const Separation& apart) const;
};

/** The study of a scene: of its sheets or its mesh. */
std::unique_ptr<GridStudy> study_grids(Question& q);

}  // namespace lab
