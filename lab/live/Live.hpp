#pragma once
/** @file Live.hpp
 * Live: a scene that a user changes while it runs: method, step, parameters;
 * grabbed, cut, pinned; beside a second method and a finer reference; recorded,
 * and run again to the same bits. Without a window; README.md of lab/.
 *
 * Nodes are named by their id, Node::id(), which no removal of others changes.
 */
#include <array>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "lab/scenes/Scene.hpp"

namespace lab {

struct Breakage;

// ---- What a user asks for. Plain data.

struct SetMethod {
  const MethodEntry* method;  ///< not null; dt stays as it is
};
/** From now on steps are of one length.
 * @see Readings::dt_unit */
struct SetStepShare {
  double share;  ///< dt / dt_unit, > 0
};
/** Rest lengths stay. The modulus [N/m] of a scene that has one. */
struct SetStiffness {
  double K;  ///< [N/m], >= 0
};
/** The drag by area [kg/(s m^2)] of a scene that has that. */
struct SetDrag {
  double c;  ///< of each node [kg/s], >= 0
};
struct SetGravity {
  double g;  ///< [m/s^2]
};
struct LoadScene {
  Model model;
};
struct BreakIt {
  const Breakage* failure;  ///< one of breakages()
};
struct Restart {};
struct Grab {
  unsigned node;
  Point target;  ///< [m]
};
struct MoveGrab {
  Point target;  ///< [m]
};
struct Release {};
/** Remove edges, each by the ids of its ends: those of crossed_edges(). */
struct Cut {
  std::vector<std::array<unsigned, 2>> edges;
};
/** Hold a node where it is, at rest. */
struct PinNode {
  unsigned node;
};
/** Let go of a node, whatever pin holds it. */
struct UnpinNode {
  unsigned node;
};
/** Run a copy of the present state beside it by another method. */
struct Compare {
  enum class At {
    equal_time,  ///< by the step asked for
    equal_work,  ///< by the step at which both cost the same a simulated
                 ///< second, and share is not used
  };
  const MethodEntry* method;  ///< not null
  double share;               ///< of the rival's dt_unit, > 0
  At at = At::equal_time;
};
struct StopComparing {};

using Request =
    std::variant<SetMethod, SetStepShare, SetStiffness, SetDrag, SetGravity,
                 LoadScene, BreakIt, Restart, Grab, MoveGrab, Release, Cut,
                 PinNode, UnpinNode, Compare, StopComparing>;

/** A scene that fails, of the gallery in lab/stability/README.md. */
struct Breakage {
  const char* name;   ///< one word
  const char* title;  ///< what is seen
  Model (*model)();
};
/** All but tunnel, which Scene::watched() counts, end with a failure. */
std::span<const Breakage> breakages();

/** What the eye sees at a point of the screen: a line from the near plane to
 * the far one [m]. */
struct Ray {
  Point near, far;
};
/** The edges of @a g that a stroke across the screen crosses: those that meet
 * the surface that a ray sweeps from each of @a stroke to the next one.
 * O(edges * rays) */
std::vector<std::array<unsigned, 2>> crossed_edges(const Cloth& g,
                                                   std::span<const Ray> stroke);

// ---- What there is to read

/** A run and what it cost. */
struct RunReadings {
  const char* method = "";
  int order = 0;
  double dt = 0;  ///< [s]
  /** The stability limit [s] in any configuration: no_limit if there is none,
   * 0 if no step is stable. */
  double safe_limit = 0;
  /** That in the present configuration [s]. */
  double sharp_limit = 0;
  /** What a share of 1 is [s]: safe_limit; or that of verlet, if safe_limit is
   * 0 or none; or 1 ms if verlet has none, either. Finite, > 0. */
  double dt_unit = 0.001;
  long long steps = 0;
  double time = 0;            ///< simulated [s]
  long long evaluations = 0;  ///< of all forces, since the start
  /** Force evaluations a simulated second: of the present dt, as counted. */
  double evaluations_rate = 0;
  Energies energy;  ///< [J]
  /** The energy that came from nothing since the start [J]: the method's error,
   * and what contact took, which is inelastic. What drag took, what moved
   * things and the hand gave, what changes of the user gave, and what torn
   * nodes took along is not in it. */
  double drift = 0;
  std::string failure;  ///< what, where, why, and what works; empty: it runs
};

/** Distances between two states, over the nodes that both have [m]. */
struct Distances {
  double largest = 0, rms = 0;
};

struct Readings : RunReadings {
  unsigned nodes = 0, edges = 0;
  unsigned torn_nodes = 0, torn_edges = 0;  ///< gone since the start
  unsigned touching = 0;                    ///< nodes on an obstacle
  bool grabbed = false;
  bool done = false;  ///< t-end is reached, or it failed
  struct Comparison {
    RunReadings rival;
    Compare::At at;
    Distances apart;               ///< of the two
    Distances error, rival_error;  ///< of each to the reference
    const char* reference;         ///< its method
    double reference_dt;           ///< [s]
  };
  std::optional<Comparison> comparison;
};

// ---- The scene

/** A scene that a user changes while it runs. What it does is a function of
 * its model and of the requests, with the number of step() calls before each:
 * the same bits whatever is read or shown meanwhile.
 *
 * One thread at a time. A window's thread leaves requests in a RequestQueue.
 */
class Live {
 public:
  /** At t = 0.  Throws as Scene(model). */
  explicit Live(Model m);
  ~Live();
  Live(const Live&) = delete;
  Live& operator=(const Live&) = delete;

  /** Change the scene between two steps. It goes on from its present state:
   * positions, velocities, what is torn, time. One that failed goes on from its
   * last good state; but for Grab, Cut and pins, which then do nothing, as
   * they do for nodes and edges that are gone. A change of what acts is one of
   * the rival and of the reference, too.
   * Throws as Live(m) if the scene asked for can't be made, and
   * std::invalid_argument if the method can't choose its step here; then
   * nothing has changed. */
  void apply(const Request& r);

  /** One step; while comparing a round: the fewest steps after which both are
   * at the same time, which is to 2 % of the rival's step asked for; no scene
   * takes more than 10^4 steps in it. A signal cuts a round short.
   * @return false if done() */
  bool step();
  /** Scene::check() of all that runs: before it is shown. */
  bool check();
  /** At t-end of the model, or failed. */
  bool done() const;
  /** Calls of step() since it was made that found it not done(). */
  long long calls() const;

  /** The model as requests left it: what is to be seen on sliders. */
  const Model& model() const;
  const Scene& scene() const;
  /** Null unless comparing. */
  const Scene* rival() const;
  const Scene* reference() const;
  /** Where the hand pulls to and the node it holds; nullopt: no hand. */
  std::optional<Grab> hand() const;
  /** Does a pin hold or move the node? */
  bool is_pinned(unsigned node) const;

  /** @param sharp find sharp_limit anew; else it is that of the last time
   * Complexity: O(N + springs), as one force evaluation; sharp 30 of them; and
   * the first reading of a failure up to some seconds, to find what works. */
  Readings readings(bool sharp = true);

  /** All requests so far, with calls() at each: a file for Replay. O(its
   * length) */
  std::string recording() const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

/** Requests on their way to the thread that steps. */
class RequestQueue {
 public:
  /** Any thread. A request that overrides the last one, as of a slider that
   * moves, takes its place. */
  void push(Request r);
  /** All that came since the last call, in order. */
  std::vector<Request> take() {
    const std::lock_guard lock(mutex_);
    return std::exchange(waiting_, {});
  }

 private:
  std::mutex mutex_;
  std::vector<Request> waiting_;
};

}  // namespace lab
