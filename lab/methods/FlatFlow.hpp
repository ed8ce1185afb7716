#pragma once
/** @file FlatFlow.hpp
 * What explicit methods are composed of, drift and kick, on the state of a
 * cloth by component: for many steps, between which nobody looks. */
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "lab/fast/ConstraintPlan.hpp"
#include "lab/fast/FlatCloth.hpp"
#include "lab/fast/FlatKernels.hpp"

namespace lab {

/** One way through a cloth. In this order, as far as a stage has them:
 *   v += first_kick a, by the accelerations a that were kept;
 *   the flow of x' = v over drift, of m v' = -c v, too, if drag is exact;
 *   held nodes to their places at rest; the constraint;
 *   a = F/m at time t;  v += kick a. */
struct FlatStage {
  double t;  ///< after the drift: of places, constraint and forces [s]
  double first_kick = 0;                    ///< [s]
  std::optional<double> drift = {};         ///< [s]
  const ConstraintPlan* held = nullptr;     ///< whose held nodes; null: none
  const ConstraintPlan* project = nullptr;  ///< null: none
  std::optional<double> kick = {};          ///< [s]
  bool keep = false;                        ///< a, for a first_kick to come
};

/** Stages of a cloth by component, between begin() and end().
 *
 * If everything that acts can be evaluated by component, the graph is not
 * touched until end(). Other forces see positions and velocities that are as
 * they should be; constraints are called with a graph that is current, and may
 * change anything in it.
 *
 * One thread computes all of a node's force, in an order that does not depend
 * on the number of threads. So the results are the same, bit by bit. */
class FlatFlow {
 public:
  FlatFlow() = default;
  FlatFlow(FlatFlow&&) = default;
  /** What is kept, too; rings, which point into the other one, come anew. */
  FlatFlow(const FlatFlow& a) : cloth_(a.cloth_) {}

  /** Take the state of @a g. Kept accelerations are those of before if the
   * version() of @a g is, too.
   * @param exact whether a drift solves drag; else it is one of the forces
   * @pre @a g and @a force outlive end()   O(N + springs) */
  void begin(Cloth& g, const ForcePlan& force, bool exact);
  /** Throws what forces and constraints throw; then the cloth is undefined. */
  void run(const FlatStage& stage);
  /** Only sets velocities of held nodes to those of their places at @a t. */
  void set_held_velocities(const ConstraintPlan& constraint, double t);
  /** Give positions and velocities to the graph. */
  void end();

  /** The accelerations kept, by node id [m/s^2]. */
  std::vector<Point> kept() const;
  void set_kept(const Cloth& g, const std::vector<Point>& a);

 private:
  /** Nodes of consecutive ids with the same c/m, but for round-off; and what a
   * drift does with them. */
  struct DragRun {
    unsigned last;
    double gamma;  // [1/s]
    Real way = 0, decay = 1;
  };
  struct Held {
    unsigned id;
    std::size_t order;  // of two places of a node the later one counts
    Point at;
  };
  /** Of one thread: the rows' springs, up to node next. */
  struct Rings {
    std::vector<kernels::RowRing> rings;
    std::vector<Real> numbers;
    std::vector<Point> others;  // forces of a part
    unsigned next = 0;
  };

  FlatCloth cloth_;
  Cloth* g_ = nullptr;
  const ForcePlan* force_ = nullptr;
  std::optional<FlatStage> stage_;
  bool exact_ = false, by_graph_ = false;
  std::uint64_t version_ = 0;  // that rings_ and drag_ are of
  std::vector<DragRun> drag_;
  std::vector<Rings> rings_;  // by thread
  std::vector<Held> held_;    // sorted

  void prepare();
  void find_drag();
  void move(unsigned first, unsigned last);
  void kick(unsigned first, unsigned last);
  void find_rings(Rings& r, unsigned first);
};

}  // namespace lab
