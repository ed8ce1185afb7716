#pragma once
/** @file Live.hpp
 * Live: a scene that is changed while it runs. A change is a request, one line
 * of text: "gravity 3", "grab 17 0.5 0.5 0.2", "method verlet". The page sends
 * such lines. A recording, as in the page's links, has the number of steps
 * instead: it repeats all bits, and steps that --dt auto takes back are made
 * again at other times. Requests.cpp lists all requests.
 *
 * A node is named by its number in the mesh, from 0, which stays the same when
 * others are removed. */
#include <algorithm>
#include <array>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "CME212/Util.hpp"
#include "lab/scenes/Requests.hpp"
#include "lab/stepping/Scene.hpp"

namespace lab {

inline std::string request_word(double a) {
  return ' ' + CME212::exact_text(a);
}
inline std::string request_word(unsigned a) { return ' ' + std::to_string(a); }
inline std::string request_word(std::string_view a) {
  return ' ' + std::string(a);
}
inline std::string request_word(const Point& p) {
  return request_word(p.x) + request_word(p.y) + request_word(p.z);
}
/** The text of a request. Numbers are written with all digits, so that a run
 * is repeated to the same bits. */
template <typename... Values>
std::string request(const char* name, const Values&... values) {
  return (std::string(name) + ... + request_word(values));
}

using CME212::Ray;
/** The edges of @a g, by the ids of their ends, that a stroke across the screen
 * crosses. A ray that moves
 * from each of @a stroke to the next one sweeps a surface; these edges meet it.
 * O(edges * rays) */
std::vector<std::array<unsigned, 2>> crossed_edges(const Cloth& g,
                                                   std::span<const Ray> stroke);

// ---- What there is to read

/** A run and what it cost. */
struct RunReadings {
  std::string_view method;
  double dt = 0;  ///< [s]
  /** The stability limit [s] in any configuration: no_limit if there is none,
   * 0 if no step is stable. */
  double safe_limit = 0;
  /** That in the present configuration [s]. */
  double sharp_limit = 0;
  /** A share of 1 of dt is this [s]: safe_limit; if that is 0 or no_limit, the
   * one of verlet; if that is no_limit, too, 1 ms. Finite, > 0. */
  double dt_unit = 0.001;
  long long steps = 0;
  double time = 0;  ///< simulated [s]
  /** Since the start, in force evaluations: work_of_step(). */
  double work = 0;
  Energies energy;  ///< [J]
  /** The change of energy since the start that no force explains [J]: the
   * method's error, and the loss in contact, which is inelastic. Left out are
   * the work of drag, of moving obstacles and pins, of the hand and of the
   * user's changes, and the energy of torn nodes. */
  double drift = 0;
  std::optional<Failure> failure;  ///< nullopt: it runs
};

struct Readings : RunReadings {
  unsigned nodes = 0, edges = 0;
  unsigned torn_nodes = 0, torn_edges = 0;  ///< removed since the start
  bool grabbed = false;  ///< the hand pulls a node that is still there
  /** Distances are the RMS over the nodes that both states have [m]. */
  struct Rival {
    RunReadings readings;
    double error;  ///< of it to the reference
  };
  std::vector<Rival> rivals;
  double error = 0;  ///< of the main run to the reference, if there are rivals
};

/** RunReadings::dt_unit of @a s, if it ran by @a m. */
double dt_unit(const Scene& s, const MethodEntry& m);

// ---- The scene

/** A scene that is changed while it runs. Its states depend only on the model
 * and on the requests, with the number of step() calls before each; what is
 * read or shown meanwhile does not change a bit.
 *
 * One thread at a time. */
class Live {
 public:
  /** At t = 0.  Throws as Scene(model) */
  explicit Live(const Model& m);
  /** The same from @a mesh, as of a Scene. */
  Live(const Model& m, Net mesh);

  /** Back to t = 0, with the parameters of @a m and all changes to come.
   * @pre it was made from @a m */
  void restart(const Model& m);

  /** Change the scene between two steps, as @a request says. It continues from
   * its present state: positions, velocities, what is torn, time. A scene that
   * failed continues from its last good state; but grab, cut and pins do
   * nothing then. They also do nothing if the node or the edge was removed. A
   * change of forces applies to the rivals and to the reference, too.
   * Throws std::invalid_argument: error_in(request), or the method can't choose
   * its step here. Then nothing has changed. */
  void apply(const std::string& request);
  /** The error in the text of a request; "" if there is none. */
  static std::string error_in(std::string_view request);
  /** Does this request replace the last one, if that has the same name? True of
   * what a slider or the hand sends as it moves. */
  static bool overrides(std::string_view request);
  /** The parameters of @a m that requests set: each one's name and value. */
  static std::vector<std::pair<std::string_view, double>> parameters(Model m);

  /** One step; while comparing, one round:
   * the fewest steps after which all runs are at the same time. For that a
   * rival's step is the one asked for to 2 %; no scene takes more than 10^4
   * steps in a round. A signal cuts a round short.
   * @return false if done()   Throws as apply() */
  bool step();
  /** Scene::check() of all that runs, needed before it is shown. */
  bool check();
  /** It failed, or is at the end of its model. */
  bool done() const { return scene().done(model().t_end); }
  /** The number of step() calls so far that found it not done(). */
  long long calls() const { return calls_; }
  /** The model with all changes of forces: what sliders show. */
  const Model& model() const { return scene().model(); }
  const Scene& scene() const { return *main_->scene; }
  /** To be changed by requests alone. The same object until the destructor. */
  Scene& scene() { return *main_->scene; }
  static constexpr std::size_t most_rivals = 3;
  struct Lane {
    const MethodEntry* method;
    double share;  ///< its step, of its RunReadings::dt_unit
  };
  /** Number @a k of those that run beside it; null if there are fewer. */
  const Scene* rival(std::size_t k = 0) const {
    return k < rivals_.size() ? rivals_[k].scene.get() : nullptr;
  }
  const Scene* reference() const {
    return reference_ ? reference_->scene.get() : nullptr;
  }

  /** @param sharp compute sharp_limit anew; else it is the last one computed
   * Complexity: O(N + springs), as one force evaluation; 30 of them if sharp.
   */
  Readings readings(bool sharp = true);

  /** All requests so far, but Model::at, as lines of changes, then the line
   * "N end" with calls().  O(its length) */
  std::string recording() const;

 private:
  /** A scene, and what its readings need. */
  struct Side {
    std::unique_ptr<Scene> scene;
    double dt_unit, safe_limit, sharp_limit;  // [s]; sharp: when last asked for
    double asked = 0;              // the step of a rival that was asked for [s]
    double work = 0, of_step = 0;  // until a step; of each one after it
    long long counted = 0;         // that step
    std::size_t changes_left = 0;  // of the scene, when it was marked

    explicit Side(std::unique_ptr<Scene> s);
    const MethodEntry& method() const {
      return scene->stepper().method_entry();
    }
    void mark();
    void count();
    bool runs() const { return !scene->failure(); }
    RunReadings readings(bool sharp);
  };

  std::optional<Side> main_, reference_;
  std::vector<Side> rivals_;
  int round_ = 1;  // steps of the main scene in one
  unsigned start_nodes_ = 0, start_edges_ = 0;
  long long calls_ = 0;
  std::string recording_;

  /** All that there are: the main one first, the reference last. */
  std::vector<Side*> sides();
  /** Call use(scene) for all that runs; the rivals and the reference of a scene
   * that failed wait for it. */
  void each_running(auto use) {
    if (!main_->runs()) return;
    for (Side* side : sides())
      if (side->runs()) use(*side->scene);
  }
  static const Requests<Live>& requests();
  static Requests<Live> make_requests();
  unsigned number_of(unsigned id) const {
    const auto& ids = scene().mesh().ids;
    return unsigned(std::ranges::find(ids, id) - ids.begin());
  }
  void set_step(const MethodEntry& method, const TimeStep& step);
  void fit_steps();
  void compare(const std::vector<Lane>& rivals);
  std::vector<Lane> at_equal_work(
      const std::vector<const MethodEntry*>& methods) const;
  Side copy(const MethodEntry& method) const;
  void tune();
};

}  // namespace lab
