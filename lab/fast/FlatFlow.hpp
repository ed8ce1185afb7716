#pragma once
/** @file FlatFlow.hpp
 * FlatFlow: the drifts and kicks of methods, on a cloth stored by component,
 * for many steps without the graph. */
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

/** One pass over the cloth. It does, if a member asks for it, in this order:
 *   v += first_kick a, with the kept accelerations a;
 *   the flow of x' = v over drift, and of m v' = -c v if drag is exact;
 *   or x and v become a weighted sum;
 *   held nodes are put to their places; the constraint is applied;
 *   a = F/m at time t;  v += kick a;
 *   held nodes get the velocities of their places. */
struct FlatStage {
  double t;  ///< time of places, constraint and forces: after the drift [s]
  double first_kick = 0;                    ///< [s]
  std::optional<double> drift = {};         ///< [s]
  const kernels::StageSum* sum = nullptr;   ///< null: none
  const ConstraintPlan* held = nullptr;     ///< puts held nodes; null: none
  bool held_move = false;                   ///< they have velocities; else 0
  const ConstraintPlan* project = nullptr;  ///< null: none
  std::optional<double> kick = {};          ///< [s]
  bool keep = false;                        ///< a, for a later first_kick,
  unsigned keep_in = FlatCloth::AX;         ///< in columns from this one on
  /** At the end of a step: its held nodes get velocities; null: none. */
  const ConstraintPlan* last = nullptr;
};

/** Runs stages on a cloth by component, between begin() and end(). All methods
 * evaluate forces by it.
 *
 * If all forces and constraints can be evaluated by component, the graph is not
 * used until end(). Any other force finds the current positions and velocities
 * in the graph; any other constraint gets a current graph and may change it.
 *
 * If only springs connect nodes, stages overlap: a part goes through several
 * stages while it is in a cache, each stage a few parts behind the one before
 * (wavefront, temporal blocking). A constraint that may need all nodes at once,
 * such as tearing, is run like that, too; if it is not idle, the batch is
 * repeated without overlap. Source: M. Wittmann, G. Hager, G. Wellein,
 * doi:10.1109/IPDPSW.2010.5470813.
 *
 * One thread computes the whole force on a node, in an order that depends
 * neither on the number of threads nor on the overlap. So results are bitwise
 * the same. */
class FlatFlow {
 public:
  /** @param more additional columns: see FlatCloth */
  explicit FlatFlow(unsigned more = 0) : cloth_(more) {}
  FlatFlow(FlatFlow&&) = default;
  /** Copies what is kept, too, but no rings: they point into @a a. */
  FlatFlow(const FlatFlow& a) : cloth_(a.cloth_) {}

  /** The number of stages that overlap in one thread. */
  static constexpr std::size_t group = 4;

  /** Read the state of @a g. Kept accelerations stay if the version() of @a g
   * has not changed.
   * @param exact true if a drift solves drag; else drag is one of the forces
   * @pre @a g and @a force outlive end()   O(N + springs) */
  void begin(Cloth& g, const ForcePlan& force, bool exact);
  /** Run @a stages, but none after a step that removed nodes or edges.
   * @return the number of stages run
   * Throws what forces and constraints throw; then the cloth is undefined. */
  std::size_t run(std::span<const FlatStage> stages);
  void run(const FlatStage& stage) { run(std::span(&stage, 1)); }
  /** Keep the accelerations in the present state of @a g; its positions and
   * velocities do not change. */
  void accelerate(Cloth& g, double t, const ForcePlan& force, bool exact) {
    begin(g, force, exact);
    run({.t = t, .kick = 0, .keep = true});
  }
  /** The state between two calls of run(). */
  FlatCloth& cloth() { return cloth_; }
  /** The kept acceleration of a node [m/s^2]. */
  Point acceleration(unsigned id) const { return cloth_.acceleration(id); }
  /** Write positions and velocities to the graph. */
  void end();

  /** Save or load the kept accelerations by node id [m/s^2], or other columns,
   * of @a g. Throws std::runtime_error if those loaded are of another cloth or
   * not finite. */
  void archive_kept(Archive& a, const Cloth& g, unsigned x = FlatCloth::AX);

 private:
  /** Nodes of consecutive ids with the same c/m, up to round-off. */
  struct DragRun {
    unsigned last;
    double gamma;  // [1/s]
  };
  /** The factors of a drift over @a time, for each DragRun. */
  struct Drift {
    double time;
    std::vector<DragFlow> of_run;
  };
  /** A held node, and its place or velocity. */
  struct Held {
    unsigned id;
    std::size_t order;  // of two places of a node the later one wins
    Point value;
  };
  /** A stage with all that is the same for each part. */
  struct Level {
    FlatStage stage;
    const Drift* drift;             // null: no drag
    std::vector<Held> held, ended;  // sorted: places, end velocities
  };
  /** Ring buffers of the springs of rows, up to node next. */
  struct Rings {
    std::vector<kernels::RowRing> rings;
    std::vector<double> numbers;
    std::vector<Point> others;  // other forces on a part
    unsigned next = 0;
  };

  FlatCloth cloth_;
  Cloth* g_ = nullptr;
  const ForcePlan* force_ = nullptr;
  bool exact_ = false, by_graph_ = false;
  std::uint64_t version_ = 0;  // of the graph, for rings_ and drag_
  std::vector<DragRun> drag_;
  std::deque<Drift> drifts_;  // this batch uses the first num_drifts_
  std::size_t num_drifts_ = 0;
  std::vector<Rings> rings_;  // a group for each thread
  std::vector<Level> levels_;
  std::vector<std::atomic<int>> done_;  // parts, by group
  static constexpr int longest_wait = 64;
  int waiting_ = 0, wait_ = 1;  // batches without overlap: now, next time
  std::vector<double> before_;

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
