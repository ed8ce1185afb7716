#pragma once
/** @file Adviser.hpp
 * How advise() finds out: Advise.cpp has the course of it, grids and chaos,
 * Choose.cpp parts, methods and the choice among them. */
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

/** What counts as uncertain of the largest difference of some runs that should
 * give the same: a few runs don't show the largest of all. */
constexpr double scatter_share = 1.5;

/** A finer grid takes at most this share of the budget that is left, and this
 * one as long as nothing is found: the one half-way to it takes a third of
 * that, and what is found is tried. */
constexpr double most_left = 0.6, most_for_any = 0.73;

/** What is uncertain of the error of a run, at least, as a share of it. */
constexpr double of_itself = 0.06;

inline std::size_t nodes_of(const Model& m) { return mesh_of(m).points.size(); }

/** Finds an Advice. */
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
  struct Less {
    std::vector<std::string> gone;
    Effect effect;
    double springs;  // of a step without them, to one with them
  };
  /** Method and step on the grid of base(). */
  struct Step {
    const MethodEntry* method;
    double dt, work;   // its largest; of a run with all parts
    Effect effect[2];  // of its largest step, and of the half of that
    bool works[2];
    double uncertainty = 1;  // of what it changes, relative to that
    std::size_t less = 0;    // of less_, from which on it holds
  };

  struct Choice {
    Model model;
    std::vector<std::string> gone;
    double factor, error, uncertainty, work;
    double effects = 0;  // how much of its error parts and step may make
    double seconds = 0;
    bool long_shot = false;  // it is not foreseen to do
    bool checked = false;
    Robustness robustness = {};
    Answer answer = {}, half = {};  // if it was run: also by half the step
    double scatter = 0;             // of runs that should give the same
  };

  Model scene_;
  AdviceRules rules_;
  Pilots pilots_;
  Advice advice_;
  std::vector<Answer> still_;    // of the finest grid, to all questions
  std::optional<Track> track_;   // of its run
  double first_ = 1;             // factor of the first grid
  std::optional<Model> method_;  // of pilots, and its step on the first grid
  double first_work_ = 0;        // of a pilot there
  Answer reference_;             // of base(), by small steps; with all parts
  std::size_t base_ = no_base;   // the grid on which parts and steps are tried
  std::optional<StepCosts> costs_;       // there
  std::vector<Less> less_;               // the first one: all parts
  double rest_ = 0;                      // [s], from then on it is at rest
  Effect rest_effect_;                   // of ending then
  std::vector<Step> steps_;              // the first one: the pilots'
  std::optional<Choice> found_, lucky_;  // lucky_: not robust
  static constexpr std::size_t no_base = ~std::size_t(0);

  static double budget_of(const Model& m, const AdviceRules& rules);

  // ----------------------------------------------------------------- Pilots

  /** How pilots run: by Verlet; or, where its limit makes the first grid take
   * more than a hundredth of the budget, by a multirate or an implicit method
   * if that takes less than half of it. Steps go down with the grid. */
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

  /** The first grid has whole cells, and every other one twice as many as the
   * one before. */
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
  /** Where parts and steps are best tried: on the coarsest grid that may do,
   * and on none that takes more than an eighth of the finest one's work. */
  std::size_t find_base() const;

  /** Go on to grids of twice as many cells each time, until one is fine enough,
   * or it can be foreseen that the next one is. The step goes down with the
   * grid, so its error is in it. */
  bool find_grid();
  /** Run a grid half-way between the last two, if it is a scene. */
  void try_half_way();
  GridReport report(double factor, const Model& on, const Trial& t) const;
  double first_factor() const;
  /** Choices of a grid are this many from one that is tried to the next one, of
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
           rules_.most_unsure * advice_.tolerance;
  }

  /** What the grids tell. */
  std::string so_far() const;
  std::string too_dear(double work) const;
  std::string unsettled() const;
  std::string too_unsure() const;
  std::string too_coarse(std::size_t nodes) const;

  // ------------------------------------------------------------------ Chaos

  /** Puts the answers to all questions into @a into, by Measure; nothing where
   * @a m can't answer. */
  static std::function<void(const Cloth&)> all_answers(
      const Model& m, std::vector<Answer>& into);

  /** What the answer, and others that could be asked for, make of a start that
   * is off by a millionth of a meter, on the finest grid, as chaos grows, and
   * until when positions stay together; and what the advised run makes of that
   * and of a slightly smaller step: all of these should give the same. */
  bool look_for_chaos();
  std::string same_until(const Separation& apart) const;
  /** Run @a c from starts that are off, and by a step between its own and half
   * of it, for which both of these tell what to expect. */
  void perturb(Choice& c);
  /** What it changes to keep positions and velocities in single precision. */
  void try_floats(const Choice& c);

  // ------------------------------------------------------------------ Parts

  /** Leave out each part in turn; then one more each time, as long as together
   * they change little: first those that save springs or steps, of these and of
   * the others those that change least. */
  void find_parts();
  static double springs_of(const Model& m);
  /** When the scene comes to rest: from then on its answer keeps within a tenth
   * of the tolerance. Only drag and friction bring that about. */
  void find_rest();
  static bool dissipates(const Model& m);

  // ------------------------------------------------------------------- Step

  /** Each method by two steps: the pilots' own first, then those that take less
   * than four times of it; implicit ones by as few steps as may do. */
  bool try_steps();
  /** Without the parts of less_ that make it stiff a scene takes longer steps:
   * these are tried, too. */
  void try_longer_steps();
  struct Try {
    const char* method;
    double dt;
  };
  /** The @a tries on @a on, which has not got the parts of less_[@a less], held
   * against small steps of a fine method.  @return as refuse() */
  bool try_methods(const Model& on, const StepCosts& costs,
                   const std::vector<Try>& tries, std::size_t less);

  /** What @a share of the largest step of @a s changes on a grid of @a finer
   * times the cells. Never beyond the largest step: what lies there was not
   * tried. On a finer grid an explicit step is as much smaller. */
  static Effect of_step(const Step& s, double share, double finer);

  // ----------------------------------------------------------------- Choice

  /** The cheapest of all choices that meets the tolerance, and does so by half
   * of its step and on a grid of twice the cells, too: else it meets it by
   * accident. One that the budget affords is run and looked at, so that it may
   * be uncertain; another one must not be. */
  void choose();
  Model refined_without(double factor,
                        const std::vector<std::string>& gone) const {
    return without_all(on_grid(factor), gone).value_or(on_grid(factor));
  }
  /** Not looked at: all parts, as pilots run, on the coarsest grid that the
   * errors of those that were tried foretell to do. */
  void foresee();
  /** False if the nodes of a grid that was not tried miss a pin. */
  static bool is_scene(const Model& m);
  /** True if there is no choice yet, or if it may be made a better one. */
  bool goes_on() const;
  /** True if there are less than five grids, or much of the tolerance is
   * uncertain, and a finer grid does not take long. Its work is kept while
   * choices are run. */
  bool may_go_on() const;
  /** Of the next grid, and of the one half-way to it. */
  double next_work() const;
  void take(const Choice& c);

  /** All grids, sets of parts, methods and steps of which the effects, added
   * up, are within the tolerance, uncertainties aside, and long shots: the
   * cheapest first. */
  std::vector<Choice> choices() const;
  /** With a step of which t-end is a multiple, so that a run ends there. */
  std::optional<Model> scene_with(double factor, const Less& less,
                                  const Step& s, double dt) const;
};

}  // namespace lab::adviser_detail
