#pragma once
/** @file Adviser.hpp
 * The class behind advise(). Advise.cpp has find(), the grids and the test for
 * chaos; Choose.cpp has the parts, the methods and the choice. */
#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "lab/advice/Advise.hpp"
#include "lab/advice/Variation.hpp"
#include "lab/scenes/Compose.hpp"
#include "lab/scenes/Separation.hpp"

namespace lab::adviser_detail {

constexpr double infinite = std::numeric_limits<double>::infinity();

/** Uncertainty over the largest difference of the perturbed runs: more runs
 * would show a larger one. */
constexpr double scatter_share = 1.5;

/** Shares of the remaining budget that a finer grid may take if a choice has
 * been found, and if none has. The rest is for the intermediate grid, which
 * takes a third of that, and for running choices. */
constexpr double most_left = 0.6, most_for_any = 0.73;

/** Least relative uncertainty of the error of a run. */
constexpr double of_itself = 0.06;

inline std::size_t nodes_of(const Model& m) { return mesh_of(m).points.size(); }

class Adviser {
 public:
  Adviser(const Model& m, const AdviceRules& rules)
      : scene_(m), rules_(rules), pilots_(budget_of(m, rules), rules.tell) {
    advice_.measure = m.measure;
    advice_.tolerance = m.tolerance;
    advice_.grids = Refinement(advice_.measure);
  }

  Advice find();

 private:
  /** Parts left out together. */
  struct Reduction {
    std::vector<std::string> removed;
    Effect effect;
    double springs;  // of a step without them / with them
  };
  /** A method and its largest step on the grid of base(). */
  struct Step {
    const MethodEntry* method;
    double dt, work;            // work: of a run with all parts
    Effect effect[2];           // of dt and of dt/2
    bool works[2];              // the runs with dt and dt/2 did not fail
    double uncertainty = 1;     // of effect, relative
    std::size_t reduction = 0;  // the first of reductions_ that allows dt
  };

  struct Choice {
    Model model;
    std::vector<std::string> removed;
    double factor, error, uncertainty, work;
    double effects = 0;  // upper bound of the error by parts and step
    double seconds = 0;
    bool long_shot = false;  // not predicted to meet the tolerance
    bool checked = false;
    Robustness robustness = {};
    Answer answer = {}, half = {};  // if it was run; half: by half the step
    double scatter = 0;             // of perturbed runs
  };

  Model scene_;
  AdviceRules rules_;
  Pilots pilots_;
  Advice advice_;
  std::vector<Answer> finest_answers_;  // of the finest grid, for every Measure
  std::optional<Track> track_;          // of the run on the finest grid
  double first_ = 1;                    // factor of the first grid
  std::optional<Model> method_;  // of pilots, with the step on the first grid
  double first_work_ = 0;        // of a pilot on the first grid
  Answer reference_;             // of base() by small steps, with all parts
  std::size_t base_ = no_base;   // the grid on which parts and steps are tried
  std::optional<StepCosts> costs_;     // on base()
  std::vector<Reduction> reductions_;  // the first has all parts
  double rest_time_ = 0;               // [s]: the cloth is at rest afterwards
  Effect rest_effect_;                 // of ending the run then
  std::vector<Step> steps_;            // the first one is that of the pilots
  std::optional<Choice> found_;
  std::optional<Choice> fragile_;  // meets the tolerance by accident
  static constexpr std::size_t no_base = ~std::size_t(0);

  static double budget_of(const Model& m, const AdviceRules& rules);

  // ----------------------------------------------------------------- Pilots

  /** How pilots run: by Verlet; or, where its limit makes the first grid take
   * more than a hundredth of the budget, by a multirate or an implicit method
   * if that takes less than half of the work. Steps shrink with the cells. */
  void choose_pilots(const Model& first);
  Model pilot(Model m, double factor) const {
    m.method = method_->method;
    m.step = method_->step;
    if (m.step.fixed()) m.step.dt *= first_ / factor;
    return m;
  }
  /** Work of a pilot on the grid of @a factor. */
  double pilot_work(double factor) const {
    return first_work_ * std::pow(factor / first_, 3);
  }

  /** The scene on the grid of @a factor. Rounds the cells of the first grid, so
   * that each later one has exactly twice as many as the one before. */
  Model on_grid(double factor) const {
    if (scene_.sheets.empty()) return scene_;
    return refined(refined(scene_, first_), factor / first_);
  }
  bool refuse(const std::string& why) {
    advice_.refusal = why;
    return false;
  }
  double size_of(const Effect& e) const { return e.size(advice_.measure); }

  // ------------------------------------------------------------------- Grid

  const GridReport& base() const { return advice_.grids[base_]; }
  /** The grid for trying parts and steps: the coarsest that may be sufficient,
   * but none that takes more than an eighth of the finest one's work. */
  std::size_t find_base() const;

  /** Run grids of twice as many cells each time, until one is fine enough, or
   * the next one is predicted to be. The step shrinks with the cells, so the
   * error of the grid includes that of the step. */
  bool find_grid();
  /** Run a grid between the last two, if it makes a valid scene. */
  void try_intermediate();
  GridReport report(double factor, const Model& on, const Trial& t) const;
  double first_factor() const;
  /** How many grids may be chosen from one that is tried to the next one, of
   * twice the cells: each takes 1.4 times the work of the one before. */
  static constexpr int between = 6;
  static double next_factor(double factor, int k) {
    return factor * std::pow(2, double(k) / between);
  }
  /** The grids to choose from, the coarsest first: those that were tried, those
   * between them, and the next one. */
  std::vector<double> factors() const;
  bool may_suffice() const;
  bool too_uncertain() const {
    return advice_.grids.uncertainty_of_limit() >
           rules_.most_uncertain * advice_.tolerance;
  }

  // Texts for progress and refusals.
  std::string so_far() const;
  std::string over_budget(double work) const;
  std::string not_converging() const;
  std::string limit_uncertain() const;
  std::string too_many_nodes(std::size_t nodes) const;

  // ------------------------------------------------------------------ Chaos

  /** A visitor that puts the answer for every Measure into @a into; an empty
   * one where @a m can't answer. */
  static std::function<void(const Cloth&)> all_answers(
      const Model& m, std::vector<Answer>& into);

  /** Repeat the run on the finest grid from a start moved by rules_.shake, and
   * compare the answers for every Measure and, over time, the positions. False,
   * with a refusal, if this or the scatter of the advised run exceeds half of
   * the tolerance: then the motion is chaotic. */
  bool look_for_chaos();
  std::string same_until(const Separation& apart) const;
  /** Run @a c from perturbed starts, and by a step between its own and half of
   * it; the answers by these two steps predict that by the third. */
  void perturb(Choice& c);
  /** Run @a c with positions and velocities rounded to floats. */
  void try_floats(const Choice& c);

  // ------------------------------------------------------------------ Parts

  /** Leave out each part alone; then one more each time, as long as together
   * they change little: first the parts that save springs or steps; within each
   * group, those that change least. */
  void find_parts();
  static double springs_of(const Model& m);
  /** Find the time after which the answer stays within a tenth of the
   * tolerance. Only drag and friction bring a cloth to rest. */
  void find_rest();
  static bool dissipates(const Model& m);

  // ------------------------------------------------------------------- Step

  /** Run each method with two steps: that of the pilots first, then those that
   * take less than four times its work; implicit methods with very few steps.
   */
  bool try_steps();
  /** Run longer steps where leaving out stiff parts allows them. */
  void try_longer_steps();
  struct Try {
    const char* method;
    double dt;
  };
  /** Run @a tries on @a on, which is without the parts of
   * reductions_[@a reduction]; their errors are those against small steps of an
   * accurate method.  @return as refuse() */
  bool try_methods(const Model& on, const StepCosts& costs,
                   const std::vector<Try>& tries, std::size_t reduction);

  /** Predict the effect of @a share <= 1 of the largest step of @a s on a grid
   * of @a finer times the cells, where explicit steps are as much smaller. */
  static Effect of_step(const Step& s, double share, double finer);

  // ----------------------------------------------------------------- Choice

  /** Find the cheapest choice that meets the tolerance, also by half of its
   * step and on a grid of twice the cells (otherwise it meets it by accident).
   * Choices that fit into the budget are run. One that does not is taken only
   * if its predicted error plus its uncertainty is within the tolerance. */
  void choose();
  Model refined_without(double factor,
                        const std::vector<std::string>& removed) const {
    return without_all(on_grid(factor), removed).value_or(on_grid(factor));
  }
  /** Without a run: take all parts, by the pilots' method, on the coarsest grid
   * that is predicted to meet the tolerance. */
  void foresee();
  /** False if no Scene can be made of @a m: a pin may hold no node. */
  static bool is_scene(const Model& m);
  /** True if no choice is found yet, or a finer grid may give a cheaper one. */
  bool goes_on() const;
  /** True if there are fewer than five grids or the limit is still uncertain,
   * and if a finer grid is cheap enough. Its work is reserved while choices are
   * run. */
  bool may_go_on() const;
  /** Work of the next grid and of the intermediate one. */
  double next_work() const;
  void take(const Choice& c);

  /** All combinations of grid, parts, method and step whose predicted errors
   * add up to at most the tolerance (uncertainties are not added), and long
   * shots: the cheapest first. */
  std::vector<Choice> choices() const;
  /** The step divides t-end, so that the run ends there. nullopt: a part of
   * @a without can't be left out. */
  std::optional<Model> scene_with(double factor, const Reduction& without,
                                  const Step& s, double dt) const;
};

}  // namespace lab::adviser_detail
