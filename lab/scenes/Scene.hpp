#pragma once
/** @file Scene.hpp
 * Scene: a cloth that a Recipe makes, a Stepper that moves it, and the changes
 * that may be made between two steps. */
#include <array>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "lab/scenes/Compose.hpp"
#include "lab/scenes/Stepper.hpp"

namespace lab {

/** A scene, ready to run: Stepper.hpp has its steps and what to ask of it. */
class Scene : public Stepper {
 public:
  /** At t = 0 and at rest, as the recipe makes it.
   * @pre step.dt > 0
   * Throws std::invalid_argument if the step is to be chosen and nothing
   * bounds it; and what the recipe throws. */
  Scene(Recipe recipe, const TimeStep& step, const MethodEntry& method);
  /** The scene of @a m.  Throws InputError, SceneError, and as above. */
  explicit Scene(const Model& m);
  /** A copy of the present state of @a other, its pins and its hand, to go on
   * by another method and step: at its time, but with no step done, no force
   * evaluated and nothing in flow().
   * @pre other.recipe().holding, step.fixed() */
  Scene(const Scene& other, const TimeStep& step, const MethodEntry& method);

  /** Back to t = 0.  Invalidates: every handle into cloth(). */
  void restart();

  const Recipe& recipe() const { return recipe_; }

  // Changes between two steps. The scene goes on from its present state; one
  // that failed, from its last good one. The energy that a change gives is work
  // in flow(); the guard starts anew.
  // Complexity: O(N + springs) each, and the first step after it may allocate.

  /** Another method and step.  Throws as the constructor; then nothing has
   * changed. */
  void change_method(const MethodEntry& method, const TimeStep& step);
  /** The forces, K and gravity of @a recipe, of the same cloth. Rest lengths,
   * masses and constraints stay.
   * Invalidates: references into recipe().  O(a new cloth) */
  void change_forces(const Recipe& recipe);
  /** Hold a node where it is, at rest; or release it from every pin.
   * @return false: it was held, or free, already, or it was removed
   * @pre recipe().holding */
  bool pin(unsigned node);
  bool unpin(unsigned node);
  /** O(log pins) for each pin of the model. */
  bool is_pinned(unsigned node) const;
  const std::vector<HeldNodes>& held() const { return held_; }
  /** Remove edges, by the ids of their ends.  @return how many there were */
  unsigned cut(std::span<const std::array<unsigned, 2>> edges);
  /** Pull a node towards @a target [m] by a HandForce: k is an eighth of the
   * sum of K at the node, the force at most twice the weight of the cloth on
   * Earth. As no K/m at a node is above omega^2, that raises omega by 6 % at
   * most; limits count it.  @return false: the node was removed */
  bool grab(unsigned node, const Point& target);
  /** @pre hand() */
  void move_hand(const Point& target);
  void release();
  /** nullopt: no hand. Its node may have been removed. */
  const std::optional<HandForce>& hand() const { return hand_; }

  // After a failure:

  /** Why it failed, and what works: diagnose(*this), which the first call does.
   * @pre !failure().empty() */
  const Diagnosis& diagnosis() const;
  /** Failure and diagnosis in one line; the failure alone if a signal came
   * before the diagnosis was done.
   * @pre and throws as diagnosis(), which throws Interrupted then */
  std::string explanation() const;
  /** Spring evaluations of a trial for a cure: about a second. */
  static constexpr double trial_work = 3e8;
  /** The scene by the method and step of @a cure: from its start; or from the
   * present state, if it was changed since. */
  std::unique_ptr<Scene> anew(const Cure& cure) const;
  /** A copy of the failed run some steps later, without the guard: when a node
   * is @a distance [m] from where the last good state has it, or after 1000
   * steps. For pictures.  @pre !failure().empty(), recipe().holding
   * @return a scene in that state, with the same failure(); all is finite */
  std::unique_ptr<Scene> beyond_failure(double distance) const;

 private:
  Recipe recipe_;
  std::vector<HeldNodes> held_;
  bool changed_ = false;                        // since the start
  mutable std::optional<Diagnosis> diagnosis_;  // if it was asked for

  template <typename Change>
  void edit(Change change);
  void pull(std::optional<HandForce> hand);
};

}  // namespace lab
