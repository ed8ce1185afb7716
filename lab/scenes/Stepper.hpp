#pragma once
/** @file Stepper.hpp
 * Stepper: takes a cloth through time and makes sure that its states are good.
 */
#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "lab/scenes/StepClock.hpp"
#include "lab/scenes/StepLimits.hpp"
#include "lab/stability/Diagnosis.hpp"
#include "lab/stability/EnergyWatch.hpp"
#include "lab/stability/Guard.hpp"
#include "lab/stability/StepControl.hpp"

namespace lab {

/** A cloth with what acts on it, a method and a clock.
 *
 * The guard checks every 32nd state, those after which the graph has changed,
 * and the last one; never another one, so looking at a run does not change it.
 * If a state is bad, the steps since the last check are repeated one by one to
 * find the one that failed. If the step is chosen, StepControl checks more
 * often; a bad state then takes some steps back, to go on with shorter ones:
 * steps() and time() become those of an earlier state. */
class Stepper {
 public:
  /** Steps between two checks of the guard. */
  static constexpr int guard_interval = 32;

  Stepper(const Stepper&) = delete;  // pins hold handles into the cloth
  Stepper& operator=(const Stepper&) = delete;

  /** One step of dt(). Near @a t_end [s], where the run is to end, it is
   * shorter: two steps share what is left for two, and less than 1e-9 dt() is
   * skipped.
   * @return false if the run failed: then failure() says where and why, and the
   * cloth and the clock are those of the last good state.
   * @pre failure().empty(), time() < t_end
   * Throws std::invalid_argument if the method can't do with this force. */
  bool step(double t_end = no_limit) { return steps_at_once(1, t_end); }
  /** At least one step, up to @a most: those before the next check. Same bits
   * as by step(), in less time with some methods.  @return, @pre and throws as
   * step() */
  bool steps_at_once(int most, double t_end = no_limit);
  /** Step until done(@a t_end); the second one calls @a after() after each
   * step, also after one that failed.
   * @return as step()   Throws as step(), and what @a after throws. */
  bool run_to(double t_end);
  bool run_to(double t_end, const std::function<void()>& after);
  /** True at the end of a run to @a t_end [s], and if the run failed. */
  bool done(double t_end) const { return !failure_.empty() || time() >= t_end; }

  /** Make sure that all numbers of the present state are finite, before it is
   * shown or written.  @return as step()   O(N + springs) */
  bool check();
  /** Let the guard check the present state, and never go back beyond it.
   * @return as step()   O(N + springs) */
  bool settle() { return failure_.empty() && guard(energy()); }

  /** The cloth; between two steps it may be changed in any way. */
  Cloth& cloth() { return cloth_; }
  const Cloth& cloth() const { return cloth_; }
  const MethodInfo& method() const { return entry_.info; }
  const MethodEntry& method_entry() const { return entry_; }
  StepRule step_rule() const { return step_.rule; }
  /** Of the inner steps of an adaptive method [m]: TimeStep::tolerance. */
  double step_tolerance() const { return step_.tolerance; }
  /** The next step [s], if it is not shortened to end in time. */
  double dt() const { return clock_.dt; }
  /** Steps done, and the time [s] reached. */
  long long steps() const { return clock_.steps; }
  double time() const { return clock_.time(); }
  /** Where the present run is to end [s]; no_limit if that is not known. */
  double t_end() const { return t_end_; }
  /** Steps that can't be taken back any more. */
  long long settled_steps() const {
    return control_ ? before_.clock.steps : checked_.steps;
  }
  /** What chooses the step, if it is chosen. */
  const std::optional<StepControl>& control() const { return control_; }
  Energies energy() const { return energies(cloth_, gravity_, flow()); }
  bool is_finite() const;
  /** What came into the energy and what left it since the start. */
  const EnergyFlow& flow() const { return balance_->flow(); }
  /** From now on flow() has the loss by linear drag, also at fixed steps.
   * Complexity: up to a tenth of a force evaluation a step */
  void follow_drag();
  /** The energy that linear drag took since the start [J].  @pre as drift() */
  double drag_loss() const;
  /** The energy that came from nothing since the start [J]; contact and
   * friction lower it.  @pre follow_drag(), or the step is chosen
   * @param now energy() */
  double drift(const Energies& now) const;
  /** From now on energy_watch() follows the error of the energy.
   * @pre no step is done, and nothing changes the energy: see EnergyWatch
   * @param t_end [s] of the run: it looks 64 times until then, or each
   * guard_interval steps.  Complexity: 0.7 of a force evaluation a look */
  void watch_energy(double t_end);
  const std::optional<EnergyWatch>& energy_watch() const { return watch_; }
  /** The energy of springs strained by round-off [J]. */
  double round_off() const { return guard_->round_off(); }
  /** Evaluations of all forces since the start, without linear solves. */
  long long evaluations() const { return evaluations_ + force_->evaluations(); }
  /** What else the method has done since the start. */
  Work work() const;
  /** What happened when step() returned false; empty before. And where. */
  const std::string& failure() const { return failure_; }
  const std::optional<WorstPlace>& failed_at() const { return worst_; }
  /** True if it failed because the method could not make the step. */
  bool step_was_refused() const { return !error_.empty(); }
  /** Nodes that were stopped before they tunnelled through an obstacle. */
  const WatchedConstraint& watched() const { return *watched_; }

  const StepLimits& limits() const { return limits_; }
  /** The limits [s] of StepLimits of @a method, or of the present method. */
  double safe_limit(const MethodEntry& method) const {
    return limits_.safe(method);
  }
  double safe_limit() const { return limits_.safe(entry_); }
  double sharp_limit(int products = 15) const {
    return limits_.sharp(entry_, products);
  }
  std::optional<Resonances> resonances() const {
    return limits_.resonances(entry_);
  }

  /** Save or load all that steps change. The run goes on to the same bits,
   * after saving as after loading.
   * @pre failure().empty(); of loading: the same scene, at t = 0
   * Throws std::runtime_error: what is loaded is of another scene.  O(N) */
  void archive(Archive& a);

 protected:
  Cloth cloth_;
  double gravity_ = grav;                          // [m/s^2]
  CombinedForces acting_{CombinedForces::List()};  // without the hand
  std::optional<HandForce> hand_;
  std::optional<WatchedConstraint> watched_;
  TimeStep step_;
  MethodEntry entry_;
  StepClock clock_;
  bool follows_drag_ = false;
  std::string failure_;

  /** Before begin() only what is protected may be called.  @param g copied */
  Stepper(const TimeStep& step, const MethodEntry& method, const Cloth& g);
  /** Begin a run from the present state at time @a t [s]. No step is done, no
   * force is evaluated, nothing is in flow().
   * @pre cloth_, gravity_, acting_, hand_ and watched_ are set
   * Throws as StepLimits::chosen() */
  void begin(double t);
  /** Go on from the present state, in which anything may have changed, with
   * what came into the energy until now. */
  void start(const EnergyFlow& flow);
  /** The hand has changed. The guard goes on: a hand that moves all the time
   * would hide from a new one what diverges slowly. */
  void hand_changed();
  void make_method();
  void forget_limits() { limits_.forget(); }
  /** One step, or up to @a most steps of dt, of which only the last one may
   * change the graph; without any check.
   * @return false if one of them can't be made */
  bool advance(int most = 1);

 private:
  /** A state of the cloth to go back to. */
  struct Snapshot {
    NodeStates nodes;
    StepClock clock;
    EnergyFlow flow;
    StepControl::State control;
    std::size_t version = 0;
  };

  std::optional<ForcePlan> force_;
  ConstraintPlan constraint_;
  StepLimits limits_{cloth_, force_, constraint_, hand_};
  std::unique_ptr<Method> method_;
  std::optional<EnergyBalance> balance_;
  std::optional<DivergenceGuard> guard_;
  double t_end_ = no_limit;  // of the present step [s]
  // When the guard last accepted a state: clock, flow, version of the cloth.
  StepClock checked_;
  EnergyFlow flow_;
  std::size_t version_ = 0;
  std::optional<StepControl> control_;
  Snapshot before_, latest_;  // at the ends of the last two rounds of control_
  double looked_ = 0;         // time of its last look [s]
  Drag drag_;                 // none: its loss is not followed
  double largest_gamma_ = 0;  // of it [1/s]
  double sampled_ = 0, drag_power_ = 0;  // at that time [s, W]
  std::optional<EnergyWatch> watch_;
  int watch_interval_ = 1;
  long long evaluations_ = 0;  // besides those of force_
  Work work_;                  // of methods before this one
  double start_energy_ = 0;    // [J]
  std::string error_;          // of the method
  std::optional<WorstPlace> worst_;

  void plan();
  void start_control();
  void start_drag();
  int steps_to_check(int most) const;
  int drag_interval() const;
  void sample_drag(bool now);
  bool judge(const Energies& e);
  void keep(Snapshot& s) const;
  void keep_both();
  bool guard(const Energies& e);
  bool not_good(long long last);
  bool take_back();
  bool replay(long long last);
  bool fail(const std::string& what);
  void go_on(const StepClock& clock, const EnergyFlow& flow);
  void keep_checked();
};

}  // namespace lab
