#pragma once
/** @file Scene.hpp
 * Scene: a cloth with its forces, its constraints and a clock. The stages of
 * the assignment are scenes. */
#include <optional>
#include <string_view>
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

/** What a scene is made from besides its mesh. */
struct Parameters {
  double dt = 0.001;       ///< step [s], > 0
  double stiffness = 100;  ///< K of every spring [N/m], >= 0
  double gravity = grav;   ///< [m/s^2]
  double damping = 0;      ///< drag coefficient c [kg/s], >= 0
};

/** The constraint of a stage on @a g; none before Stage::constraints, where
 * the force or the step holds the corners. */
inline std::optional<CombinedConstraints> constraint_of(Stage stage,
                                                        const Cloth& g) {
  if (stage < Stage::constraints) return std::nullopt;
  if (stage == Stage::constraints)
    return make_combined_constraints(PinConstraint(g), PlaneConstraint(),
                                     SphereConstraint());
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
        const Parameters& with)
      : stage_(stage),
        points_(std::move(points)),
        quads_(std::move(quads)),
        with_(with) {
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
    steps_ = 0;
    failure_.clear();
  }

  /** One step of dt.
   * @return false if the run diverged: then failure() says where, and the
   *         cloth and the clock are those of the last good state.
   * @pre failure().empty()   Complexity: O(nodes + edges) */
  bool step() {
    if (constraint_)
      integrate_(cloth_, time(), with_.dt, *force_, *constraint_);
    else
      integrate_(cloth_, time(), with_.dt, *force_);
    if (guard_->accept(cloth_)) return ++steps_, true;
    using CME212::short_text;
    failure_ =
        "diverged in step " + std::to_string(steps_ + 1) +
        " with dt = " + short_text(with_.dt) + " s: " + guard_->worst(cloth_) +
        "; the last good state is that of t = " + short_text(time()) + " s";
    guard_->restore(cloth_);
    return false;
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
  SymplecticEuler integrate_;
  long long steps_ = 0;
  std::string failure_;
};
