#pragma once
/** @file Pilots.hpp
 * Runs that find something out, within a budget, and what a run will cost
 * before it is made. */
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "lab/methods/Method.hpp"
#include "lab/scenes/Measure.hpp"

namespace lab {

/** What a step costs on a grid, in spring evaluations. Methods that solve cost
 * what method_costs says, so that a comparison depends on no clock. */
class StepCosts {
 public:
  /** Of the cloth of @a m.
   * Throws InputError, SceneError   Complexity: as omega_safe(), twice */
  explicit StepCosts(const Model& m);

  double springs() const { return springs_; }
  /** Verlet's largest stable step [s]; that of a multirate method. */
  double verlet() const { return verlet_; }
  double multirate() const { return multirate_; }
  /** The largest stable step [s] of a method; no_limit if any is. */
  double limit(const MethodInfo& method) const;
  /** A step of @a dt [s] by @a method, there or on a grid of @a finer times the
   * cells along each side. */
  double of_step(const MethodEntry& method, double dt, double finer = 1) const;
  /** The step [s] of @a m there, and a whole run of @a m; no_limit if the step
   * isn't given and nothing is stable. */
  double step(const Model& m) const;
  double of_run(const Model& m) const;

 private:
  double springs_ = 0, factor_ = 0, verlet_ = no_limit, multirate_ = no_limit;
  double stiff_ = 0, inner_ = no_limit;  // springs; their step [s]
};

/** Spring evaluations of a run of @a m as it stands, foreseen without running
 * it.  Throws as StepCosts */
double work_of_run(const Model& m);

/** Spring evaluations a second of this machine in the cloth and the contacts of
 * @a m, from some steps on a grid of about 25 x 25 nodes. Takes about 20 ms.
 * The best of what was measured: other programs take their share of the others.
 */
double measured_rate(const Model& m);

/** What a run takes besides its steps, in force evaluations: building the cloth
 * and finding its largest frequency. */
inline constexpr double start_work = 100;

/** Makes runs and counts what they take. */
class Pilots {
 public:
  /** @param done share of the budget that is spent, up to 1 */
  using Tell = std::function<void(const std::string& doing, double done)>;

  /** @param budget in spring evaluations */
  Pilots(double budget, Tell tell) : budget_(budget), tell_(std::move(tell)) {}

  double budget() const { return budget_; }
  double spent() const { return spent_; }
  double left() const { return budget_ - spent_ - kept_; }
  /** From now on keep @a work for later: what it leaves out is only put off. */
  void keep(double work) { kept_ = work; }
  bool keeps() const { return kept_ > 0; }
  /** Is a run of @a work within @a share of what is left? If not, the budget
   * has left out @a what. */
  bool affords(double work, const std::string& what, double share = 1);
  bool cut_short() const { return !left_out_.empty(); }
  /** Each thing once. */
  const std::vector<std::string>& left_out() const { return left_out_; }
  /** What is known so far: told with all that is done. */
  void knows(const std::string& so_far) { known_ = so_far; }

  /** Run @a m, or tell what it gave before. What is no scene fails, like what
   * blows up.
   * @param doing what for, in words   @param work what it counts
   * @param look, after as for try_out(): then it is run anew each time
   * Throws Interrupted */
  Trial run(const Model& m, const std::string& doing, double work,
            const Shake& shake = {},
            const std::function<void(const Cloth&)>& look = nullptr,
            const std::function<void(Scene&)>& after = nullptr);

 private:
  double budget_, spent_ = 0, kept_ = 0;
  std::vector<std::string> left_out_;
  std::string known_;
  std::map<std::string, Trial> done_;  // by scene file
  Tell tell_;
};

}  // namespace lab
