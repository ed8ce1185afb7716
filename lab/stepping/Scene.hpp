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

#include "lab/scenes/Compose.hpp"
#include "lab/stepping/Stepper.hpp"

namespace lab {

/** About how many force evaluations a step of a method costs; an implicit one,
 * with its linear systems, a hundred. */
inline double evaluations_of(const MethodInfo& m) {
  return m.sweeps * (m.limit == no_limit ? 100 : 1);
}

/** A scene, ready to run. */
class Scene {
 public:
  /** The scene of @a m at t = 0. If nodes lie inside obstacles, all constraints
   * act once: their work is in flow().
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
   * no force evaluated and nothing in flow().  @pre step.fixed() */
  Scene(const Scene& other, const TimeStep& step, const MethodEntry& method);

  /** Back to t = 0.  Invalidates: every handle into cloth(). */
  void restart();

  /** Its model, with the changes of forces. */
  const Model& model() const { return model_; }
  const BuiltMesh& mesh() const { return mesh_; }
  /** The forces of the model, without the hand. */
  const CombinedForces& force() const { return system_.acting; }
  /** The cloth; between two steps it may be changed in any way. */
  Cloth& cloth() { return system_.cloth; }
  const Cloth& cloth() const { return system_.cloth; }
  /** Counts the nodes that it stopped from tunnelling through obstacles. */
  const WatchedConstraint& watched() const { return *system_.watched; }
  /** A warning about the first of them, right after its step; else "". */
  std::string missed_text() const;

  // As in Stepper.hpp:
  static constexpr int guard_interval = Stepper::guard_interval;
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
  bool settle() { return stepper_.settle(); }
  const MethodInfo& method() const { return stepper_.method(); }
  double dt() const { return stepper_.dt(); }
  long long steps() const { return stepper_.steps(); }
  double time() const { return stepper_.time(); }
  long long settled_steps() const { return stepper_.settled_steps(); }
  const std::optional<StepControl>& control() const {
    return stepper_.control();
  }
  Energies energy() const { return stepper_.energy(); }
  const EnergyFlow& flow() const { return stepper_.flow(); }
  void follow_drag() { stepper_.follow_drag(); }
  double drift(const Energies& now) const { return stepper_.drift(now); }
  double lost() const { return stepper_.lost(); }
  void watch_energy(double t_end) { stepper_.watch_energy(t_end); }
  const std::optional<EnergyWatch>& energy_watch() const {
    return stepper_.energy_watch();
  }
  long long evaluations() const { return stepper_.evaluations(); }
  const std::optional<Failure>& failure() const { return stepper_.failure(); }
  double safe_limit(const MethodEntry& m) const {
    return stepper_.safe_limit(m);
  }
  double safe_limit() const { return stepper_.safe_limit(); }
  void archive(Archive& a) { stepper_.archive(a); }

  // Changes between two steps: of the present state or, after a failure, of the
  // last good one. The energy that a change adds counts as work in flow(). All
  // changes but those of the hand restart the guard.
  // Complexity: O(N + springs) each, and the first step after it may allocate.

  /** Another method and step.  Throws as the constructor; then nothing has
   * changed. */
  void change_method(const MethodEntry& method, const TimeStep& step);
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
  const std::optional<HandForce>& hand() const { return system_.hand; }

  // After a failure:

  /** The cause and a cure, found in the first call: the scene is run with other
   * methods and steps, each to t_end() or for trial_work; without a t_end() to
   * 5 s or longer, or for a sixteenth of that. Trials that do not fail are
   * repeated with half the step.
   * @pre failure(), or energy_watch() has found that the run is wrong
   * Throws Interrupted. */
  const Diagnosis& diagnosis() const;
  /** Failure and diagnosis in words; only the failure if a signal interrupts
   * the diagnosis.
   * @pre and throws as diagnosis(), but not Interrupted */
  Explanation explanation() const;
  /** The remedy in words.  @pre and throws as explanation() */
  std::string remedy() const;
  /** This run, compared with one of half of its step: passed if the energies
   * are the same, to 2.5 % of the largest. nullopt: it fails, or would take
   * more than @a work, or there was a change since the start.
   * @pre energy_watch(), no failure()   Throws Interrupted. */
  std::optional<Attempt> half_step(double work) const;
  /** Spring evaluations of a trial: about a second. */
  static constexpr double trial_work = 3e8;
  /** The scene with the method and step of @a cure: from its start, or from the
   * present state if there was a change since the start. */
  std::unique_ptr<Scene> anew(const Cure& cure) const;
  /** For pictures: a copy of the failed run, continued without the guard until
   * a node is @a distance [m] away from its last good position, or for 1000
   * steps.  @pre failure()
   * @return a scene in that state, finite, with the same failure() */
  std::unique_ptr<Scene> beyond_failure(double distance) const;

 private:
  Model model_;
  BuiltMesh mesh_;
  System system_;
  std::vector<HeldNodes> held_;
  bool changed_ = false;                        // since the start
  mutable std::optional<Diagnosis> diagnosis_;  // if it was asked for
  Stepper stepper_;

  System& build();
  void take_forces(CombinedForces acting);
  System& hold();
  template <typename Change>
  void edit(Change change);
  void pull(std::optional<HandForce> hand);
};

}  // namespace lab
