#pragma once
/** @file Pilots.hpp
 * Pilots: trial runs within a budget. StepCosts: predicts the work of a run. */
#include <algorithm>
#include <array>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "lab/methods/Method.hpp"
#include "lab/stepping/Trial.hpp"

namespace lab {

/** The cost of a step on a grid, in spring evaluations. That of linear solves
 * is from the cards, so that comparisons do not depend on a clock. */
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
  /** The step of @a m over the largest stable one; 0 if there is none. */
  double of_stable(const Model& m) const;
  /** The work of a run of @a m on this grid, predicted without running it;
   * no_limit if no step is given and none is stable. */
  double of_run(const Model& m) const;
  /** Force evaluations that take @a work. */
  double evaluations(double work) const {
    return work / std::max(1., springs_);
  }

 private:
  double springs_ = 0, side_ = 0, verlet_ = no_limit, multirate_ = no_limit;
  double stiff_ = 0, inner_ = no_limit;  // stiff springs; inner step [s]
};

/** StepCosts::of_run() of @a m.  Throws as StepCosts */
double work_of_run(const Model& m);

/** About the work of putting @a m to rest.  Throws InputError, SceneError */
double work_at_rest(const Model& m);

/** The costs of @a m; nothing if it is no scene: some pins lie between the
 * nodes of its grid, or nodes are nearer than the thickness of self-collision.
 * @param why is then set to the reason, unless it is null */
std::optional<StepCosts> costs_of(const Model& m, std::string* why = nullptr);

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
  /** Why runs could not be made, each reason once. */
  const std::vector<std::string>& impossible() const { return impossible_; }
  /** Results so far: reported with each run. */
  void knows(const std::string& so_far) { known_ = so_far; }

  /** Run @a m, or return its earlier result. If without a part the question has
   * no answer, or the method can't use the forces, the run has failed, and
   * impossible() says why.
   * @param doing description for progress   @param work added to spent()
   * @param removed parts that @a m lacks
   * @param look as for try_out(): then earlier results are not used
   * Throws Interrupted, and all other exceptions of try_out() */
  Trial run(const Model& m, const std::string& doing, double work,
            const std::vector<std::string>& removed = {},
            const Shake& shake = {},
            const std::function<void(const Cloth&)>& look = nullptr);

  /** What ./cloth would warn of if it ran @a m as its options say: its Witness
   * is asked. Nothing counts of which @a scene warns, too; "" if nothing is
   * left.
   * @param work of the run, of which it takes three times as much
   * Throws Interrupted, and all other exceptions of Scene */
  std::string warning_of(const Model& m, const Model& scene, double work);

 private:
  /** Two runs of a scene differ in this, or in nothing: the nodes of each
   * sheet, the removed parts, sorted, the method, all of its step, and t_end.
   */
  using Key =
      std::tuple<std::vector<std::array<unsigned, 2>>, std::vector<std::string>,
                 const MethodEntry*, StepRule, double, double, double, double>;

  bool fixed_;
  double budget_, spent_ = 0;
  std::vector<std::string> left_out_, impossible_;
  std::string known_;
  std::vector<std::pair<Key, Trial>> done_;
  std::map<std::string, std::string> warnings_;  // by options
  Tell tell_;
};

}  // namespace lab
