#pragma once
/** @file Scene.hpp
 * Scene: the cloth of a Model, a Stepper that moves it, and the changes that
 * may be made between two steps. */
#include <array>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "lab/rest/Equilibrium.hpp"
#include "lab/scenes/Compose.hpp"
#include "lab/stepping/Changes.hpp"
#include "lab/stepping/Stepper.hpp"
#include "lab/stepping/Witness.hpp"

namespace lab {

/** A scene, ready to run. */
class Scene {
 public:
  /** The scene of @a m at t = 0. If nodes lie inside obstacles, or springs are
   * strained so that they break, all constraints act once: their work is in
   * flow().
   * @pre m.step.dt > 0
   * Throws std::invalid_argument if the step is to be chosen and nothing
   * bounds it; InputError, SceneError. */
  explicit Scene(const Model& m);
  /** The same from @a mesh: mesh_of(m), or any other net, for example one in
   * memory. Then @a m may have no sheets and no files.
   * @pre masses are above 0; springs and faces have different nodes, all there
   */
  Scene(const Model& m, Net mesh);
  /** The same by another step and method than those of @a m. */
  Scene(const Model& m, Net mesh, const TimeStep& step,
        const MethodEntry& method);
  /** A copy of the present state of @a other, its pins and its hand, to
   * continue with another method and step: at its time, but with no step done,
   * no force evaluated and nothing in flow(). Changes of Model::at are still to
   * come, but those to another method only if @a method is that of @a other.
   * @pre step.fixed() */
  Scene(const Scene& other, const TimeStep& step, const MethodEntry& method);

  /** Back to t = 0.  Invalidates: every handle into cloth(). */
  void restart();

  /** Its model, with the changes of forces. */
  const Model& model() const { return model_; }
  const BuiltMesh& mesh() const { return mesh_; }
  /** How it was put to rest, if its model begins there. */
  const std::optional<Rest>& rest() const { return rest_; }
  /** The id of the node of this number in the mesh. */
  unsigned id_of(unsigned number) const {
    return number < mesh_.ids.size() ? mesh_.ids[number] : unsigned(-1);
  }
  /** The forces of the model, without the hand. */
  const CombinedForces& force() const { return built_.acting; }
  /** The cloth; between two steps it may be changed in any way. */
  Cloth& cloth() { return built_.cloth; }
  const Cloth& cloth() const { return built_.cloth; }
  /** Counts the nodes that it stopped from tunnelling through obstacles. */
  const WatchedConstraint& watched() const { return *built_.watched; }
  /** A warning about the first of them, right after its step; else "". */
  std::string missed_text(CureName name = &Cure::options) const;

  /** The number of changes of Model::at that are still to be made. Each is made
   * in the first state from its time on, at which a step ends. */
  std::size_t changes_left() const { return changes_.size() - made_; }
  /** A stability limit [s], and the time of the change that brings it [s]. */
  struct Limit {
    double limit, since = 0;
  };
  /** The shortest limit of the run: safe_limit() at the start, and after each
   * change of Model::at, made without a step.
   * Complexity: a scene from the mesh; for each change, as safe_limit() */
  Limit least_limit() const;
  /** As that of Stepper. What was changed by hand is not saved. */
  void archive(Archive& a);

  /** What moves it: for all that is asked of a run. Below is what most ask. */
  Stepper& stepper() { return stepper_; }
  const Stepper& stepper() const { return stepper_; }
  bool step(double t_end = no_limit) { return stepper_.step(t_end); }
  bool steps_at_once(int most, double t_end = no_limit) {
    return stepper_.steps_at_once(most, t_end);
  }
  bool run_to(double t_end, const std::function<void()>& after = {}) {
    return stepper_.run_to(t_end, after);
  }
  bool done(double t_end) const { return stepper_.done(t_end); }
  bool check() { return stepper_.check(); }
  const std::optional<Failure>& failure() const { return stepper_.failure(); }
  const MethodInfo& method() const { return stepper_.method(); }
  double safe_limit() const { return stepper_.safe_limit(); }
  double safe_limit(const MethodEntry& m) const {
    return stepper_.safe_limit(m);
  }
  double dt() const { return stepper_.dt(); }
  const std::optional<StepControl>& control() const {
    return stepper_.control();
  }
  long long steps() const { return stepper_.steps(); }
  double time() const { return stepper_.time(); }
  long long evaluations() const { return stepper_.evaluations(); }
  Energies energy() const { return stepper_.energy(); }
  const EnergyFlow& flow() const { return stepper_.flow(); }

  /** From now on witness() looks at the run, unless its method was added: that
   * may not run twice.  @param t_end, whole as there */
  void watch(double t_end, bool whole = false);
  /** Null: there is none. */
  const Witness* witness() const { return witness_.get(); }
  /** The verdict on a run of fixed steps, if it is wrong: ./cloth ends with
   * status 3. Else null.  Throws Interrupted */
  const Verdict* wrong() const;
  /** Was there a change since the start that model() does not tell? */
  bool was_changed() const { return changed_; }
  /** This run with half of its step: from its start, or from the present state
   * if it was_changed(). Its guard stops it only if it is not finite. */
  std::unique_ptr<Scene> finer() const;
  /** The present state, to continue with @a share of its step and such a guard.
   */
  std::unique_ptr<Scene> branch(double share) const;

  // Changes between two steps: of the present state or, after a failure, of the
  // last good one. The energy that a change adds counts as work in flow(). All
  // changes but those of the hand restart the guard.
  // Complexity: O(N + springs) each, and the first step after it may allocate.

  /** Another method and step.  Throws as the constructor; then nothing has
   * changed. */
  void change_method(const MethodEntry& method, const TimeStep& step);
  /** Another method by the present step: fixed, if it can choose none. */
  void take_method(const MethodEntry& method);
  /** Choose a chosen step anew if it is above the limit now. */
  void fit_step();
  /** Take the forces, K and gravity of @a m, which has the same cloth. Rest
   * lengths, masses and constraints stay.  O(building the cloth) */
  void change_forces(const Model& m);
  /** Hold a node where it is, at rest; or release it from every pin.
   * @return false if it was already held or free, or was removed */
  bool pin(unsigned node);
  bool unpin(unsigned node);
  /** O(log of its nodes) for each pin of the model. */
  bool is_pinned(unsigned node) const;
  const std::vector<HeldNodes>& held() const { return held_; }
  /** Remove edges, by the ids of their ends.  @return the number removed */
  unsigned cut(std::span<const std::array<unsigned, 2>> edges);
  /** Pull a node towards @a target [m] by a HandForce: k is an eighth of the
   * sum of K at the node, the force at most twice the weight of the cloth on
   * Earth. Since sum K/m at a node is at most omega^2, omega rises by at most
   * 6 %; limits() includes it.  @return false if the node was removed */
  bool grab(unsigned node, const Point& target);
  /** @pre hand() */
  void move_hand(const Point& target);
  void release();
  /** nullopt if there is no hand. Its node may have been removed. */
  const std::optional<HandForce>& hand() const { return built_.hand; }

  // After a failure:

  /** The cause and a cure, found in the first call: the scene is run with other
   * methods and steps, each to t_end() or for trial_work; without a t_end() to
   * 5 s or longer, or for a sixteenth of that. Trials that do not fail are
   * repeated with half the step.
   * @pre failure(), or witness() has found that the run is wrong
   * Throws Interrupted. */
  const Diagnosis& diagnosis() const;
  /** Failure and diagnosis in words; only the failure if a signal interrupts
   * the diagnosis.
   * @pre and throws as diagnosis(), but not Interrupted */
  Explanation explanation() const;
  /** The remedy in words.  @pre and throws as explanation() */
  std::string remedy(CureName name = &Cure::options) const;
  /** Spring evaluations of a trial: about a second. */
  static constexpr double trial_work = 3e8;
  /** About as many as @a steps of its method take; each of an implicit one,
   * with its linear systems, as a hundred. */
  double work_of(double steps) const {
    return steps * method().sweeps * (method().limit == no_limit ? 100 : 1) *
           (cloth().num_nodes() + cloth().num_edges());
  }
  /** The scene with the method and step of @a cure: from its start, or from the
   * present state if there was a change since the start. */
  std::unique_ptr<Scene> anew(const Cure& cure) const;
  /** For pictures: a copy of the failed run, continued without the guard until
   * a node is @a distance [m] away from its last good position, or for 1000
   * steps.  @pre failure()
   * @return a scene in that state, finite, with the same failure() */
  std::unique_ptr<Scene> beyond_failure(double distance) const;

 private:
  Model made_of_, model_;  // at the start; now
  BuiltMesh mesh_;
  std::vector<HeldNodes> held_;
  System built_;
  std::optional<Rest> rest_;  // of a model that begins there
  Stepper stepper_;
  MethodEntry first_;                           // before changes_
  std::vector<Change> changes_;                 // of Model::at
  std::size_t made_ = 0;                        // of changes_
  bool makes_ = false;                          // one of them is being made
  bool changed_ = false;                        // by hand, since the start
  mutable std::optional<Diagnosis> diagnosis_;  // if it was asked for
  std::unique_ptr<Witness> witness_;

  System& build();
  System& hold();
  void take_forces(CombinedForces acting);
  void begin();
  template <typename Change>
  void edit(Change change);
  void pull(std::optional<HandForce> hand);
  TimeStep finer_step(double share) const;
  bool confirms(const Energies& e) const;
  void note_change(bool by_hand);
  void await_change();
  void make_change();
};

}  // namespace lab
