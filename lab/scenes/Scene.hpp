#pragma once
/** @file Scene.hpp
 * Scene: a cloth with its forces, its constraints and a clock, as a Recipe
 * makes them. */
#include <array>
#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "lab/methods/Method.hpp"
#include "lab/methods/Resonance.hpp"
#include "lab/scenes/Compose.hpp"
#include "lab/scenes/HandForce.hpp"
#include "lab/stability/Diagnosis.hpp"
#include "lab/stability/EnergyWatch.hpp"
#include "lab/stability/Guard.hpp"
#include "lab/stability/StepControl.hpp"

namespace lab {

/** A scene, ready to run. */
class Scene {
 public:
  /** Steps between two looks of the guard. */
  static constexpr int guard_interval = 32;

  /** At t = 0 and at rest, as the recipe makes it.
   * @pre step.dt > 0
   * Throws std::invalid_argument if nothing bounds the step that it is to
   * choose; and what the recipe throws. */
  Scene(Recipe recipe, const TimeStep& step, const MethodEntry& method);
  /** The scene of @a m.  Throws InputError, SceneError, and as above. */
  explicit Scene(const Model& m);
  /** The present state of @a other, and who is held and pulled, to go on by
   * another method and step: at its time, but with no step done, no force
   * evaluated and nothing in flow().
   * @pre other.recipe().holding, step.fixed() */
  Scene(const Scene& other, const TimeStep& step, const MethodEntry& method);
  Scene(const Scene&) = delete;  // pins hold handles into the cloth
  Scene& operator=(const Scene&) = delete;

  /** Back to t = 0.  Invalidates: every handle into cloth(). */
  void restart();

  /** Save or load all that steps change: what is loaded goes on to the same
   * bits as what was saved, which goes on as if nothing had been.
   * @pre failure().empty(); of loading: the same scene, at t = 0
   * Throws std::runtime_error: what is loaded is of another scene.  O(N) */
  void archive(Archive& a);

  /** One step of dt(), or less: it never passes @a t_end [s], where the run is
   * to end, and what is left for two steps they share. Less than 1e-9 dt() is
   * no step: then the time is t_end.
   *
   * The guard looks at every 32nd state, at those after which the graph is
   * another, and at that of t_end; at no other, so that nobody who looks at a
   * run changes it. If it finds one that is not good the steps since its last
   * look are made again, one by one, to find the one that failed. A step that
   * is chosen is shortened before that, and some steps are taken back: then
   * steps() and time() are those of an earlier state.
   * @return false if the run failed: then failure() says where and why, and the
   * cloth and the clock are those of the last good state.
   * @pre failure().empty(), time() < t_end
   * Throws std::invalid_argument if the method can't do with this force. */
  bool step(double t_end = no_limit) { return steps_at_once(1, t_end); }
  /** Up to @a most steps as by step(), to the same bits: as many as lie before
   * the next look at the state, whoever looks; so at least one. A method may
   * take them in less time than one by one.  @return, @pre and throws as step()
   */
  bool steps_at_once(int most, double t_end = no_limit);

  /** Make sure that all numbers of the present state are finite: whoever shows
   * it or writes it down asks for that first.  @return as step()
   * O(N + springs) */
  bool check();

  /** True at the end of a run to @a t_end [s], which it reaches to round-off;
   * and if the run failed. */
  bool done(double t_end) const { return !failure_.empty() || time() >= t_end; }
  /** Step until done(@a t_end); the second one with a call of @a after() after
   * each step, and after the one that failed, if one did.
   * @return as step()   Throws as step(), and what @a after throws. */
  bool run_to(double t_end);
  bool run_to(double t_end, const std::function<void()>& after);

  /** The cloth; between two steps it may be changed in any way. */
  Cloth& cloth() { return cloth_; }
  const Cloth& cloth() const { return cloth_; }
  const Recipe& recipe() const { return recipe_; }
  const MethodInfo& method() const { return entry_.info; }
  StepRule step_rule() const { return step_.rule; }
  /** The next step [s], but for the last ones; it changes only if it is chosen.
   */
  double dt() const { return clock_.dt; }
  /** Steps done, and the time [s] reached. */
  long long steps() const { return clock_.steps; }
  double time() const { return clock_.time(); }
  /** Steps that can't be taken back any more. */
  long long settled_steps() const {
    return control_ ? before_.clock.steps : checked_.steps;
  }
  /** Who chooses the step, if anybody does. */
  const std::optional<StepControl>& control() const { return control_; }
  /** What came into its energy and went out since the start. */
  const EnergyFlow& flow() const { return balance_->flow(); }
  /** From now on flow() has what linear drag takes, also at fixed steps.
   * Complexity: up to a tenth of a force evaluation a step */
  void follow_drag();
  /** The energy that linear drag took since the start [J].  @pre as drift() */
  double drag_loss() const;
  /** The energy that came from nothing since the start [J]; what contact and
   * friction took lowers it.  @pre follow_drag(), or drag() takes part
   * @param now energies() of the present state */
  double drift(const Energies& now) const;
  /** From now on energy_watch() tells how far the energy is off.
   * @pre no step is done, and nothing changes the energy: see EnergyWatch
   * @param t_end [s] of the run: it looks 64 times until then, or each
   * guard_interval steps.  Complexity: 0.7 of a force evaluation a look */
  void watch_energy(double t_end);
  const std::optional<EnergyWatch>& energy_watch() const { return watch_; }
  /** Evaluations of all forces since the start, without linear solves. */
  long long evaluations() const { return evaluations_ + force_->evaluations(); }
  /** What else the method has done since the start. */
  Work work() const;
  /** What happened when step() returned false; empty before. And where. */
  const std::string& failure() const { return failure_; }
  /** Why that happened, and what works: the first call runs the scene anew by
   * up to 10 other methods and steps, each until t_end or for trial_work spring
   * evaluations, which is about a second; and those that do not fail by half of
   * the step, too.  @pre !failure().empty()
   * Throws what the recipe throws. */
  const Diagnosis& diagnosis() const;
  /** Both in one line; if a signal came before a cure was found, without it.
   * @pre and throws as diagnosis(), which throws Interrupted then */
  std::string explanation() const;
  static constexpr double trial_work = 3e8;
  /** The failed run some steps later, had nobody stopped it: when a node is
   * @a distance [m] from where the last good state has it, or after 1000 steps.
   * For pictures.  @pre !failure().empty(), recipe().holding
   * @return a scene in that state, with the same failure(); all is finite */
  std::unique_ptr<Scene> beyond_failure(double distance) const;
  const std::optional<WorstPlace>& failed_at() const { return worst_; }
  /** What would have tunnelled through an obstacle. */
  const WatchedConstraint& watched() const { return *watched_; }

  /** The stability limit [s] of @a method, or of this scene's, in every
   * configuration of the cloth; no_limit if there is none, 0 if no step is
   * stable.
   * Complexity: the first call as omega_safe(). */
  double safe_limit(const MethodEntry& method) const;
  double safe_limit() const { return safe_limit(entry_); }
  /** Below it, the steps that resonate, if the method is a multirate one and
   * splits off stiff springs.  Complexity: as safe_limit() */
  std::optional<Resonances> resonances() const;
  /** That of this scene's method in the present configuration, by so many
   * @a products of SharpOmega. */
  double sharp_limit(int products = 15) const;

  // Changes between two steps: SceneChanges.cpp. The scene goes on from its
  // present state; one that failed, from its last good one. What a change gives
  // to the energy is work in flow(); the guard starts anew.
  // Complexity: O(N + springs) each, and the first step after it may allocate.

  /** Let the guard look now, and not go back beyond this state.
   * @return as step()   O(N + springs) */
  bool settle() { return failure_.empty() && look(energy()); }
  /** Another method and step.  Throws as the constructor; then nothing has
   * changed. */
  void change_method(const MethodEntry& method, const TimeStep& step);
  /** The forces, K and gravity of @a recipe, of the same cloth. Rest lengths,
   * masses and constraints stay.
   * Invalidates: references into recipe().  O(a new cloth) */
  void change_forces(const Recipe& recipe);
  /** Hold a node where it is, at rest; or let go of it, whatever pin holds it.
   * @return false: it was held, or free, already, or it is gone
   * @pre recipe().holding */
  bool pin(unsigned node);
  bool unpin(unsigned node);
  /** O(log pins) for each pin of the model. */
  bool is_pinned(unsigned node) const;
  const std::vector<HeldNodes>& held() const { return held_; }
  /** Remove edges, by the ids of their ends.  @return how many there were */
  unsigned cut(std::span<const std::array<unsigned, 2>> edges);
  /** Pull a node towards @a target [m]: HandForce, k an eighth of the sum of K
   * at the node, the force at most twice the weight of the cloth on Earth. As
   * no K/m at a node is above omega^2, that raises omega by 6 % at most; limits
   * count it.  @return false: the node is gone */
  bool grab(unsigned node, const Point& target);
  /** @pre hand() */
  void move_hand(const Point& target);
  void release();
  /** nullopt: no hand. Its node may be gone. */
  const std::optional<HandForce>& hand() const { return hand_; }

 private:
  /** Steps and time: those of the last change of dt, and multiples of it, as
   * sums of steps would depend on rounding. */
  struct Clock {
    double dt = 0, from = 0;  // [s]
    long long steps = 0, from_steps = 0;
    double time() const { return from + double(steps - from_steps) * dt; }
    void set_time(double t) { from = t, from_steps = steps; }
    void set_dt(double next) {
      set_time(time());
      dt = next;
    }
    void archive(Archive& a);
  };

  /** A state of the cloth to go back to. */
  struct Snapshot {
    NodeStates nodes;
    Clock clock;
    EnergyFlow flow;
    StepControl::State control;
    std::size_t version = 0;
  };

  Recipe recipe_;
  TimeStep step_;
  MethodEntry entry_;
  Cloth cloth_;
  CombinedForces acting_{CombinedForces::List()};  // of the recipe
  std::optional<HandForce> hand_;
  std::optional<ForcePlan> force_;  // of both
  std::vector<HeldNodes> held_;
  bool changed_ = false;  // by a user, since the start
  std::optional<WatchedConstraint> watched_;
  ConstraintPlan constraint_;
  std::optional<EnergyBalance> balance_;
  std::optional<DivergenceGuard> guard_;
  std::unique_ptr<Method> method_;
  double t_end_ = no_limit;  // of the present step [s]
  Clock clock_, checked_;    // checked_: when the guard kept the state
  EnergyFlow flow_;          // then
  std::size_t version_ = 0;  // of the cloth, then
  std::optional<StepControl> control_;
  Snapshot before_, latest_;  // of the last two rounds of control_
  double looked_ = 0;         // time of its last look [s]
  bool follows_drag_ = false;
  Drag drag_;
  std::optional<EnergyWatch> watch_;
  int watch_interval_ = 1;
  long long evaluations_ = 0;  // before a checkpoint; besides force_'s
  Work work_;                  // of methods before this one
  double start_energy_ = 0;    // [J]
  double largest_gamma_ = 0;   // of it [1/s]
  double sampled_ = 0, drag_power_ = 0;  // at that time [s, W]
  mutable double safe_omega_ = -1;       // [1/s]; negative: not known yet
  mutable SharpOmega sharp_;
  std::string failure_, error_;  // error_: of the method
  std::optional<WorstPlace> worst_;
  mutable std::optional<Diagnosis> diagnosis_;  // if it was asked for

  void plan_forces();
  void start_control();
  double longest_step() const;
  void start_drag();
  double begin_change();
  void end_change(double before);
  void plan_changed(const EnergyFlow& flow);
  void make_method();
  bool is_there(unsigned node) const;
  void hand_changed();
  void watch_hand();
  double with_hand(double omega) const;
  void keep_clock();
  void watch_paths();
  ForcePlan bounding(const MethodEntry& method) const;
  double without_resonance(double dt) const;
  void choose_step();
  bool is_finite() const;
  bool advance(int most = 1);
  int steps_to_look(int most) const;
  int drag_interval() const;
  void sample_drag(bool now);
  Energies energy() const;
  bool judge(const Energies& e);
  bool take_back();
  void keep(Snapshot& s) const;
  void keep_both();
  bool look(const Energies& e);
  bool replay(long long last);
  void rewind();
  bool fail(const std::string& what);
  std::unique_ptr<Scene> anew(const Cure& cure) const;
  Attempt attempt(const Cure& cure, double t_end) const;
};

}  // namespace lab
