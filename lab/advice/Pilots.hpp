#pragma once
/** @file Pilots.hpp
 * Pilots: trial runs within a budget. StepCosts: predicts the work of a run. */
#include <algorithm>
#include <array>
#include <functional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "lab/methods/Method.hpp"
#include "lab/stepping/Trial.hpp"

namespace lab {

/** The cost of a step on a grid, in spring evaluations. That of linear solves
 * is from method_costs, so that comparisons do not depend on a clock. */
class StepCosts {
 public:
  /** Measure the cloth of @a m.
   * Throws InputError, SceneError   Complexity: as omega_safe(), twice */
  explicit StepCosts(const Model& m);

  double springs() const { return springs_; }
  /** The largest stable step [s] of Verlet. */
  double verlet() const { return verlet_; }
  /** The largest stable step [s] of a method; no_limit if it has none. */
  double limit(const MethodInfo& method) const;
  /** Work of a step of @a dt [s] by @a method, on a grid of @a finer times the
   * cells along each side. */
  double of_step(const MethodEntry& method, double dt, double finer = 1) const;
  /** The step [s] of @a m on this grid, and the work of a whole run; no_limit
   * if no step is given and none is stable. */
  double step(const Model& m) const;
  double of_run(const Model& m) const;
  /** Force evaluations that take @a work. */
  double evaluations(double work) const {
    return work / std::max(1., springs_);
  }

 private:
  double springs_ = 0, side_ = 0, verlet_ = no_limit, multirate_ = no_limit;
  double stiff_ = 0, inner_ = no_limit;  // stiff springs; inner step [s]
};

/** The spring evaluations of a run of @a m, predicted without running it.
 * Throws as StepCosts */
double work_of_run(const Model& m);

/** Makes trial runs of one scene within a budget, and adds up their work. */
class Pilots {
 public:
  /** @param done spent share of the budget, up to 1 */
  using Tell = std::function<void(const std::string& doing, double done)>;

  /** @param budget in spring evaluations; 0: usual, or what is allowed */
  Pilots(double budget, Tell tell)
      : fixed_(budget > 0),
        budget_(fixed_ ? budget : usual),
        tell_(std::move(tell)) {}
  static constexpr double usual = 4e8;

  double budget() const { return budget_; }
  /** Let the budget be at least @a work, unless it was given. */
  void allow(double work) {
    if (!fixed_) budget_ = std::max(budget_, work);
  }
  double spent() const { return spent_; }
  double left() const { return budget_ - spent_; }
  /** Is a run of @a work within @a share of the remaining budget? If not, @a
   * what is added to left_out(). */
  bool affords(double work, const std::string& what, double share = 1);
  /** Each thing once. */
  const std::vector<std::string>& left_out() const { return left_out_; }
  /** Results so far: reported with each run. */
  void knows(const std::string& so_far) { known_ = so_far; }

  /** Run @a m, or return its earlier result. A scene that is not valid, a
   * method that can't use its forces and a step that can't be made count as
   * failed, like a run that diverges.
   * @param doing description for progress   @param work added to spent()
   * @param removed parts that @a m lacks
   * @param look, after as for try_out(): with them earlier results are not
   *        used; with a look, later runs use this one
   * Throws Interrupted, and all other exceptions of try_out() */
  Trial run(const Model& m, const std::string& doing, double work,
            const std::vector<std::string>& removed = {},
            const Shake& shake = {},
            const std::function<void(const Cloth&)>& look = nullptr,
            const std::function<void(Scene&)>& after = nullptr);

 private:
  /** Two runs of a scene differ in this, or in nothing. */
  struct Key {
    std::vector<std::array<unsigned, 2>> grid;  // nodes of each sheet
    std::vector<std::string> removed;           // sorted
    const MethodEntry* method;
    std::tuple<StepRule, double, double, double> step;  // all of a TimeStep
    double t_end;
    bool operator==(const Key&) const = default;
  };
  using Done = std::pair<Key, Trial>;

  bool fixed_;
  double budget_, spent_ = 0;
  std::vector<std::string> left_out_;
  std::string known_;
  std::vector<Done> done_;
  Tell tell_;
};

}  // namespace lab
