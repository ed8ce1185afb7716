#pragma once
/** @file Stepper.hpp
 * Stepper: steps a cloth through time and checks its states. */
#include <cmath>
#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "lab/stability/Diagnosis.hpp"
#include "lab/stability/Guard.hpp"
#include "lab/stability/StepControl.hpp"
#include "lab/stepping/StepLimits.hpp"

namespace lab {

/** Counts steps. The time is from + (steps - from_steps) dt: in a sum of steps
 * rounding errors would add up. */
struct StepClock {
  double dt = 0, from = 0;              ///< step; time of the last change [s]
  long long steps = 0, from_steps = 0;  ///< done now; done then

  StepTimes times() const { return {from, dt, steps - from_steps}; }
  double time() const { return times()(0); }
  void set_time(double t) { from = t, from_steps = steps; }
  void set_dt(double next) {
    set_time(time());
    dt = next;
  }
  void archive(Archive& a) {
    a(dt)(from)(steps)(from_steps);
    a.require(dt > 0 && std::isfinite(dt) && from >= 0 && 0 <= from_steps &&
              from_steps <= steps && steps < 1LL << 53 &&
              std::isfinite(time()));
  }
};

/** A cloth with what acts on it. Its address must not change: pins hold handles
 * into the cloth. */
struct System {
  Cloth cloth;
  Potential potential;
  Point wind = Point();                           ///< [m/s]
  CombinedForces acting{CombinedForces::List()};  ///< without the hand
  std::optional<HandForce> hand;
  std::optional<WatchedConstraint> watched;  ///< nullopt only until it is built
  bool overlaps = false;  ///< at the start a constraint has something to do
};

/** Is told of the steps of a run: see Settled, Witness. */
class SettledReader {
 public:
  /** The steps of a run beyond @a now will come again; the first @a settled
   * ones can't be taken back any more. */
  virtual void settle(long long now, long long settled) = 0;
  /** The time of the state [s] that it wants to be told of next. */
  virtual double due() const { return no_limit; }

 protected:
  ~SettledReader() = default;
};

/** Moves a System by a method, with a clock.
 *
 * The guard checks every 32nd state, each state after a change of the graph,
 * and the last one. It checks no others, so looking at a run does not change
 * it. If a state is bad, the steps since the last check are repeated one by one
 * to find the one that failed. If the step is chosen, StepControl checks more
 * often, and a bad state is taken back: the run continues from an earlier
 * state, with its steps() and time(), by a shorter step. */
class Stepper {
 public:
  /** Steps between two checks of the guard. */
  static constexpr int guard_interval = 32;

  /** Begin a run of @a system, which must live longer, at time @a t [s].
   * Throws as StepLimits::chosen() */
  Stepper(System& system, const TimeStep& step, const MethodEntry& method,
          double t = 0);
  Stepper(const Stepper&) = delete;
  Stepper& operator=(const Stepper&) = delete;

  /** One step of dt(). Before @a t_end [s] the last two steps may be shorter,
   * of equal length; a rest of less than 1e-9 dt() is skipped.
   * @return false if the run failed: then failure() says where and why, and the
   * cloth and the clock are those of the last good state.
   * @pre !failure(), time() < t_end
   * Throws std::invalid_argument if the method can't use this force. */
  bool step(double t_end = no_limit) { return steps_at_once(1, t_end); }
  /** One to @a most steps, up to the next check. The same bits as by step(), in
   * less time with some methods.  @return, @pre and throws as step() */
  bool steps_at_once(int most, double t_end = no_limit);
  /** Step until done(@a t_end). Call @a after(), if there is one, after each
   * step, even if the step failed.
   * @return as step()
   * Throws as step(), Interrupted, and what @a after throws. */
  bool run_to(double t_end, const std::function<void()>& after = {});
  /** True at the end of a run to @a t_end [s], and if the run failed. */
  bool done(double t_end) const { return failure_ || time() >= t_end; }

  /** Check that all numbers of the present state are finite, before it is shown
   * or written.  @return as step()   O(N + springs) */
  bool check();
  /** Let the guard check the present state; later failures go back no further.
   * @return as step()   O(N + springs) */
  bool settle() { return !failure_ && guard(energy()); }

  const MethodInfo& method() const { return entry_.info; }
  const MethodEntry& method_entry() const { return entry_; }
  /** As asked for: of steps that are chosen its dt is not dt(). */
  const TimeStep& time_step() const { return step_; }
  /** The next step [s], unless t_end() shortens it. */
  double dt() const { return clock_.dt; }
  /** Steps done, and the time [s] reached. */
  long long steps() const { return clock_.steps; }
  double time() const { return clock_.time(); }
  /** The end of the present run [s]; no_limit if it is not known. */
  double t_end() const { return t_end_; }
  /** Steps that can't be taken back any more. */
  long long settled_steps() const {
    return control_ ? before_.clock.steps : checked_.steps;
  }
  /** Tell @a reader after each step, or no more. */
  void tell(SettledReader* reader) { readers_.push_back(reader); }
  void tell_no_more(SettledReader* reader) { std::erase(readers_, reader); }
  /** nullopt if the step is fixed. */
  const std::optional<StepControl>& control() const { return control_; }
  Energies energy() const {
    return energies(system_.cloth, system_.potential, flow());
  }
  bool is_finite() const;
  /** The energy that entered and left the cloth since the start. */
  const EnergyFlow& flow() const { return balance_->flow(); }
  /** From now on flow() includes the loss by linear drag, even with fixed
   * steps, summed over all steps.  Complexity: a tenth of a force evaluation a
   * step */
  void follow_drag();
  bool follows_drag() const { return follows_drag_; }
  /** The energy that linear drag took since the start [J].  @pre as drift() */
  double drag_loss() const;
  /** The energy gained by errors of the method since the start [J]; contact and
   * friction lower it.  @pre follow_drag(), or the step is chosen
   * @param now energy() */
  double drift(const Energies& now) const;
  /** The energy that drag, contact, tearing and errors of the method took since
   * the start [J].  As long as energy() */
  double lost() const;
  /** Before the guard calls a finite state diverged, it asks @a confirms: does
   * a finer run have such an energy now, too? Then the motion is fast. */
  void confirm_by(std::function<bool(const Energies&)> confirms) {
    confirms_ = std::move(confirms);
  }
  /** Call @a make in the first state from @a time [s] on, before the next step;
   * a step ends there. It may call at() for what comes next. */
  void at(double time, std::function<void()> make) {
    event_time_ = time, event_ = std::move(make);
  }
  /** DivergenceGuard::floor(): a negligible energy [J]. */
  double floor() const { return guard_->floor(); }
  /** Force evaluations since the start, without those in linear solves. */
  long long evaluations() const { return evaluations_ + force_->evaluations(); }
  /** Method::pulls(). */
  std::span<const Point> pulls() const { return method_->pulls(); }
  /** The other work of the method since the start. */
  Work work() const;
  /** What happened when step() returned false; nullopt before. */
  const std::optional<Failure>& failure() const { return failure_; }

  const StepLimits& limits() const { return limits_; }
  /** As in StepLimits [s], for @a method or for the present method. */
  double safe_limit(const MethodEntry& method) const {
    return limits_.safe(method);
  }
  double safe_limit() const { return limits_.safe(entry_); }
  double sharp_limit(int products = 15) const {
    return limits_.sharp(entry_, products);
  }

  /** Save or load all that steps change. After saving and after loading the run
   * continues with the same bits.
   * @pre !failure(); of loading: the same scene, at t = 0
   * Throws std::runtime_error if another scene is loaded.  O(N) */
  void archive(Archive& a);

  // Changes of the system between two steps: of its present state or, after a
  // failure, of the last good one. O(N + springs) each.

  /** Begin anew, from the present state and at time @a t [s], with all counts
   * and flow() at 0.  Throws as the constructor */
  void restart(double t = 0);
  /** Let @a change do anything to the system. The energy that it adds counts as
   * work in flow(). The guard starts anew. */
  template <typename Change>
  void edit(Change change) {
    settle();
    const double before = energy().total();
    change();
    EnergyFlow flow = this->flow();
    flow.work += energy().total() - before;
    start(flow);
  }
  /** Another method and step.  Throws as the constructor; then nothing has
   * changed. */
  void change_method(const MethodEntry& method, const TimeStep& step);
  /** Another hand. The guard is kept: if every move of the hand restarted it,
   * slow divergence would go unnoticed. */
  void set_hand(std::optional<HandForce> hand);
  /** To call in an edit() of masses, stiffnesses or held nodes. */
  void forget_limits() { limits_.forget(); }
  /** To call in an edit() of stiffnesses: methods keep matrices. */
  void make_method();
  /** One step, or up to @a most steps of dt, without any check. Only the last
   * one may change the graph.  @return false if a step can't be made */
  bool advance(int most = 1);
  /** A copy of a failed run has failed, too. */
  void set_failure(const std::optional<Failure>& f) { failure_ = f; }

 private:
  /** A state of the cloth to go back to. */
  struct Snapshot {
    NodeStates nodes;
    StepClock clock;
    EnergyFlow flow;
    StepControl::State control;
    std::size_t version = 0;
  };

  System& system_;
  TimeStep step_;
  MethodEntry entry_;
  StepClock clock_;
  bool follows_drag_ = false;  // in every step
  std::optional<Failure> failure_;
  std::optional<ForcePlan> force_;
  ConstraintPlan constraint_;
  StepLimits limits_{system_.cloth, force_, constraint_, system_.hand};
  std::unique_ptr<Method> method_;
  std::optional<EnergyBalance> balance_;
  std::optional<DivergenceGuard> guard_;
  double t_end_ = no_limit;  // of the present step [s]
  // Clock, flow and version of the cloth when the guard last accepted a state.
  StepClock checked_;
  EnergyFlow flow_;
  std::size_t version_ = 0;
  std::optional<StepControl> control_;
  Snapshot before_, latest_;  // at the ends of the last two rounds of control_
  double looked_ = 0;         // time of the last look of control_ [s]
  Drag drag_;                 // none if its loss is not followed
  double largest_gamma_ = 0;  // of drag_ [1/s]
  double sampled_ = 0, drag_power_ = 0;  // time of last sample [s]; then [W]
  std::function<bool(const Energies&)> confirms_;
  double event_time_ = no_limit;  // [s]
  std::function<void()> event_;   // then
  long long evaluations_ = 0;     // besides those of force_
  Work work_;                     // of earlier methods
  double start_energy_ = 0;       // [J]
  std::string error_;             // of the method
  std::vector<SettledReader*> readers_;

  double remove_overlaps();
  void start(const EnergyFlow& flow);
  void hand_changed();
  void plan();
  void start_control();
  void start_drag();
  int steps_to_check(int most) const;
  int drag_interval() const;
  void sample_drag(bool now);
  void keep_sample();
  bool some_steps(int most);
  bool judge(const Energies& e);
  void keep(Snapshot& s) const;
  void keep_both();
  bool guard(const Energies& e);
  bool not_good(long long last);
  bool take_back();
  bool replay(long long last);
  bool fail(Failure::Kind kind);
  void back_to_checked();
  void go_on(const StepClock& clock, const EnergyFlow& flow);
  void keep_checked();
};

}  // namespace lab
