#pragma once
/** @file Scene.hpp
 * Scene: a cloth with its forces, its constraints and a clock. The stages of
 * the assignment are scenes. */
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "Cloth.hpp"
#include "Constraint.hpp"
#include "Force.hpp"
#include "Integrator.hpp"
#include "Stability.hpp"

/** The stages, by the section of the assignment. */
enum class Stage {
  problem1,     // 3.2  uniform springs, corners held by a zero force
  diagonals,    // 4.2  each edge its own K and L, diagonals added
  forces,       // 5.2  combined forces, corners skipped by the step
  constraints,  // 6.2  pins, a floor and a ball
  tear,         // 7.2  pins, a floor and a ball that tears
};

/** The name of a stage, as it is spelt above. */
constexpr const char* name_of(Stage stage) {
  constexpr const char* names[] = {"problem1", "diagonals", "forces",
                                   "constraints", "tear"};
  return names[static_cast<int>(stage)];
}

/** What a scene is made from besides its mesh. */
struct Parameters {
  double dt = 0.001;       ///< step [s], > 0
  double stiffness = 100;  ///< K of every spring [N/m], >= 0
  double gravity = grav;   ///< [m/s^2]
  double damping = 0;      ///< drag coefficient c [kg/s], >= 0
};

/** The constraint of a stage on @a g. The two first stages have none: there the
 * force holds the corners. In stage `forces` the assignment's step skips them;
 * a pin is the same for every method. */
inline CombinedConstraints constraint_of(Stage stage, const Cloth& g) {
  switch (stage) {
    case Stage::problem1:
    case Stage::diagonals:
      return make_combined_constraints();
    case Stage::forces:
      return make_combined_constraints(PinConstraint(g));
    case Stage::constraints:
      return make_combined_constraints(PinConstraint(g), PlaneConstraint(),
                                       SphereConstraint());
    case Stage::tear:
      break;
  }
  return make_combined_constraints(PinConstraint(g), PlaneConstraint(),
                                   TearConstraint());
}

/** The force of a stage on @a g. */
inline CombinedForces force_of(Stage stage, const Cloth& g,
                               const Parameters& with) {
  if (stage == Stage::problem1)
    return make_combined_force(Problem1Force(
        with.stiffness, g.num_edges() > 0 ? g.edge(0).value().L : 0,
        with.gravity));
  if (stage == Stage::diagonals)
    return make_combined_force(Problem1Force(with.gravity));
  return make_combined_force(GravityForce(with.gravity), MassSpringForce(),
                             DampingForce(with.damping));
}

/** A stage of the assignment, ready to run. */
class Scene {
 public:
  /** At t = 0 and at rest, as build_cloth() makes it.
   * @pre @a quads index @a points; the parameters are in range */
  Scene(Stage stage, std::vector<Point> points, std::vector<Quad> quads,
        const Parameters& with,
        std::unique_ptr<Method> method = std::make_unique<SymplecticEuler>())
      : stage_(stage),
        points_(std::move(points)),
        quads_(std::move(quads)),
        with_(with),
        method_(std::move(method)) {
    restart();
  }
  Scene(const Scene&) = delete;  // pins hold handles into the cloth
  Scene& operator=(const Scene&) = delete;

  /** Back to t = 0.  Invalidates: every handle into cloth(). */
  void restart() {
    cloth_.clear();
    build_cloth(cloth_, points_, quads_,
                stage_ == Stage::problem1 ? Mesh::plain : Mesh::diagonals,
                with_.stiffness);
    force_ = force_of(stage_, cloth_, with_);
    constraint_ = constraint_of(stage_, cloth_);
    guard_.emplace(cloth_, with_.gravity);
    method_->restart();
    steps_ = 0;
    failure_.clear();
  }

  /** One step of dt.
   * @return false if the run diverged or the method failed: then failure() says
   * where, and the cloth and the clock are those of the last good state.
   * @pre failure().empty()
   * Throws std::invalid_argument if the method can't do with this force. */
  bool step() {
    try {
      method_->step(cloth_, time(), with_.dt, *force_, *constraint_);
    } catch (const StepError& e) {
      return fail(std::string("failed (") + e.what() + ")");
    }
    if (guard_->accept(cloth_)) return ++steps_, true;
    return fail("diverged");
  }

  /** The cloth; between two steps it may be changed in any way. */
  Cloth& cloth() { return cloth_; }
  const Cloth& cloth() const { return cloth_; }
  Stage stage() const { return stage_; }
  const Parameters& parameters() const { return with_; }
  /** Steps done, and the time [s] reached: steps() dt. */
  long long steps() const { return steps_; }
  double time() const { return double(steps_) * with_.dt; }
  /** Why step() returned false; empty before. */
  const std::string& failure() const { return failure_; }

 private:
  Stage stage_;
  std::vector<Point> points_;
  std::vector<Quad> quads_;
  Parameters with_;
  Cloth cloth_;
  std::optional<CombinedForces> force_;
  std::optional<CombinedConstraints> constraint_;
  std::optional<DivergenceGuard> guard_;
  std::unique_ptr<Method> method_;
  long long steps_ = 0;
  std::string failure_;

  /** Say what happened to the step, and go back to before it. */
  bool fail(const std::string& what) {
    using CME212::short_text;
    failure_ =
        what + " in step " + std::to_string(steps_ + 1) +
        " with dt = " + short_text(with_.dt) + " s: " + guard_->worst(cloth_) +
        "; the last good state is that of t = " + short_text(time()) + " s";
    guard_->restore(cloth_);
    method_->restart();
    return false;
  }
};
