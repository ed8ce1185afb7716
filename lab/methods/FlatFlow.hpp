#pragma once
/** @file FlatFlow.hpp
 * What explicit methods are composed of, drift and kick, on the state of a
 * cloth by component: for many steps, between which nobody looks. */
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <span>
#include <vector>

#include "lab/fast/ConstraintPlan.hpp"
#include "lab/fast/FlatCloth.hpp"
#include "lab/fast/FlatKernels.hpp"
#include "lab/fast/ForcePlan.hpp"

namespace lab {

/** One way through a cloth. In this order, as far as a stage has them:
 *   v += first_kick a, by the accelerations a that were kept;
 *   the flow of x' = v over drift, of m v' = -c v, too, if drag is exact;
 *   or the state that is a sum;
 *   held nodes to their places, at rest if they do not move; the constraint;
 *   a = F/m at time t;  v += kick a;
 *   held nodes get the velocities of their places. */
struct FlatStage {
  double t;  ///< after the drift: of places, constraint and forces [s]
  double first_kick = 0;                    ///< [s]
  std::optional<double> drift = {};         ///< [s]
  const kernels::StageSum* sum = nullptr;   ///< null: none
  const ConstraintPlan* held = nullptr;     ///< whose held nodes; null: none
  bool held_move = false;                   ///< with their places
  const ConstraintPlan* project = nullptr;  ///< null: none
  std::optional<double> kick = {};          ///< [s]
  bool keep = false;                        ///< a, for a first_kick to come,
  unsigned keep_in = FlatCloth::AX;         ///< or elsewhere: the column of x
  /** Whose held nodes get their velocities: the stage ends a step. */
  const ConstraintPlan* last = nullptr;
};

/** Stages of a cloth by component, between begin() and end(): what all methods
 * evaluate forces by.
 *
 * If everything that acts can be evaluated by component, the graph is not
 * touched until end(). Other forces see positions and velocities that are as
 * they should be; constraints are called with a graph that is current, and may
 * change anything in it.
 *
 * Where nothing but springs joins nodes, stages overlap: a part goes through
 * several of them while a cache has it, each stage a few parts behind the one
 * before (a wavefront; temporal blocking). A constraint that may need all nodes
 * at once, as one that tears, is tried like that, too: if it turns out not to
 * be idle, the batch begins again without overlap. Source: M. Wittmann, G.
 * Hager, G. Wellein, doi:10.1109/IPDPSW.2010.5470813.
 *
 * One thread computes all of a node's force, in an order that depends neither
 * on the number of threads nor on the overlap. So the results are the same, bit
 * by bit. */
class FlatFlow {
 public:
  /** @param more columns of the method: as FlatCloth */
  explicit FlatFlow(unsigned more = 0) : cloth_(more) {}
  FlatFlow(FlatFlow&&) = default;
  /** What is kept, too; rings, which point into the other one, come anew. */
  FlatFlow(const FlatFlow& a) : cloth_(a.cloth_) {}

  /** The number of stages that overlap in one thread. */
  static constexpr std::size_t group = 4;

  /** Take the state of @a g. Kept accelerations are those of before if the
   * version() of @a g is, too.
   * @param exact whether a drift solves drag; else it is one of the forces
   * @pre @a g and @a force outlive end()   O(N + springs) */
  void begin(Cloth& g, const ForcePlan& force, bool exact);
  /** All of @a stages, but none after a step that removed nodes or edges.
   * @return how many were run
   * Throws what forces and constraints throw; then the cloth is undefined. */
  std::size_t run(std::span<const FlatStage> stages);
  void run(const FlatStage& stage) { run(std::span(&stage, 1)); }
  /** The accelerations of the present state of @a g, whose positions and
   * velocities stay: begin(), and a stage that keeps them. */
  void accelerate(Cloth& g, double t, const ForcePlan& force, bool exact) {
    begin(g, force, exact);
    run({.t = t, .kick = 0, .keep = true});
  }
  /** The state between two calls of run(). */
  FlatCloth& cloth() { return cloth_; }
  /** That which was kept of a node [m/s^2]. */
  Point acceleration(unsigned id) const { return cloth_.acceleration(id); }
  /** Give positions and velocities to the graph. */
  void end();

  /** The accelerations kept, by node id [m/s^2]; or another column. */
  std::vector<Point> kept(unsigned x = FlatCloth::AX) const;
  /** Throws std::runtime_error: they are of another cloth, or not finite. */
  void set_kept(const Cloth& g, const std::vector<Point>& a,
                unsigned x = FlatCloth::AX);

 private:
  /** Nodes of consecutive ids with the same c/m, but for round-off. */
  struct DragRun {
    unsigned last;
    double gamma;  // [1/s]
  };
  /** What a drift by so much time does with the nodes of each DragRun. */
  struct Drift {
    double time;
    struct Factors {
      Real way, decay;
    };
    std::vector<Factors> of_run;
  };
  /** A node that is held, and its place or velocity. */
  struct Held {
    unsigned id;
    std::size_t order;  // of two places of a node the later one counts
    Point value;
  };
  /** A stage, with what does not depend on the part. */
  struct Level {
    FlatStage stage;
    const Drift* drift;             // nullptr: no drag in it
    std::vector<Held> held, ended;  // sorted: places before, velocities after
  };
  /** The rows' springs, up to node next. */
  struct Rings {
    std::vector<kernels::RowRing> rings;
    std::vector<Real> numbers;
    std::vector<Point> others;  // forces of a part
    unsigned next = 0;
  };

  FlatCloth cloth_;
  Cloth* g_ = nullptr;
  const ForcePlan* force_ = nullptr;
  bool exact_ = false, by_graph_ = false;
  std::uint64_t version_ = 0;  // that rings_ and drag_ are of
  std::vector<DragRun> drag_;
  std::deque<Drift> drifts_;  // the first num_drifts_ are of this batch
  std::size_t num_drifts_ = 0;
  std::vector<Rings> rings_;  // a group for each thread
  std::vector<Level> levels_;
  std::vector<std::atomic<int>> done_;  // by group: parts
  static constexpr int longest_wait = 64;
  int waiting_ = 0, wait_ = 1;  // batches without overlap; the next time
  std::vector<Real> before_;

  void prepare();
  void find_drag();
  const Drift& drift_by(double time);
  void prepare(Level& level, const FlatStage& stage);
  bool may_overlap(std::span<const FlatStage> stages);
  void run_alone(Level& level);
  bool run_overlapping(std::span<const FlatStage> stages);
  void run_group(std::span<Level> group, Rings* rings,
                 const std::atomic<int>* before, std::atomic<int>& done,
                 std::atomic<bool>& good);
  bool move(const Level& level, unsigned first, unsigned last, bool project);
  void kick(const Level& level, Rings& mine, unsigned first, unsigned last);
  void set_velocities(const Level& level, unsigned first, unsigned last);
  void find_rings(Rings& r, unsigned first);
};

}  // namespace lab
