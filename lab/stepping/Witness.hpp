#pragma once
/** @file Witness.hpp
 * Witness: judges a run by a second one with half of its step. */
#include <algorithm>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "lab/scenes/Measure.hpp"
#include "lab/stepping/Stepper.hpp"

namespace lab {

class Observer;
class Scene;

/** How a run differs from one of half of its step. A difference of energies is
 * that of the run less that of the other, times 1/(1 - 2^-order): the error of
 * the run where errors fall with the step. */
struct Verdict {
  bool whole = true;    ///< all of the run was repeated; else windows of it
  bool failed = false;  ///< the finer run did, or can't be made
  double gain = 0;      ///< the most energy [J] that the run had in excess
  double loss = 0;      ///< the most that it lacked [J]
  double off = 0;       ///< its energy in excess at the end [J]
  double scale = 0;     ///< the largest internal energy of the finer run [J]
  double mine = 0;      ///< that of the run [J]
  double slack = 0;     ///< a difference that says nothing [J]
  bool loose = false;   ///< energies are internal: the cloth moves freely
  bool sudden = false;  ///< parts were removed, which comes at once: errors
                        ///< of order 1
  double apart = 0;     ///< largest distance of a node from its place in the
                        ///< finer run, by the size of the cloth or its way
  std::string asked;    ///< the quantity that was compared; "": none
  double answer = 0;    ///< the change of its value, as a share
  double cost = 0;      ///< force sweeps of the finer run, by those of the run

  bool has_place() const { return apart <= 4 * Attempt::same_place; }
  bool has_answer() const { return answer <= Attempt::same_answer; }
  /** The energy is off by more than half of what --dt auto tolerates: at the
   * end, or at any time. */
  bool is_off() const { return failed || exceeds(std::abs(off), 0.5); }
  bool was_off() const { return failed || exceeds(std::max(gain, loss), 0.5); }
  /** The method has added more energy than is tolerated, or 5 times that if
   * changes are sudden, and the run has not forgotten it. */
  bool gains() const {
    return exceeds(gain, sudden ? 5 : 1) &&
           (is_off() || apart > Attempt::same_place);
  }
  /** Positions are known, but the answer is another by more than half: it can't
   * be trusted at all. */
  bool has_no_answer() const {
    return apart <= Attempt::same_place && answer > 0.5;
  }
  /** The run is not the motion of its scene, or does not answer its question:
   * ./cloth ends with status 3. */
  bool wrong() const { return gains() || has_no_answer(); }
  bool fine() const { return !wrong() && !is_off() && is_close(); }
  bool is_close() const { return has_place() && has_answer(); }

  /** All numbers, on one line; what is too large; what was gained. */
  std::string text() const;
  std::string difference() const;
  std::string wrong_text() const;

 private:
  bool exceeds(double joules, double share) const {
    return joules > share * energy_tolerance * scale + slack;
  }
};

/** Repeats a run with half of its step and compares energy, positions and the
 * answer to its question. No flow of energy is modelled: whatever acts, acts in
 * both runs.
 *
 * A run that is cheap is repeated from its start; both are compared at 32 to 64
 * times, which do not depend on its end, so that a restart may choose another.
 * Of any other 8 windows are repeated, each a 64th of the run and from
 * its own state there, the last one up to the end: that costs a quarter of the
 * run. The differences that grow within the windows, summed, estimate the error
 * of the energy of the whole; the largest of them is what was seen. Contact and
 * tearing come at other times with another step, so differences are medians of
 * some looks in a row. */
class Witness final : public SettledReader {
 public:
  /** @param scene outlives this   @param t_end end of the run [s]; no_limit:
   * windows as of a run of 5 s, again and again
   * @param whole repeat all; else the cost decides */
  Witness(Scene& scene, double t_end, bool whole);
  ~Witness();

  /** Looks at the present state, if that is due; at the end of a window,
   * repeats it. */
  void settle(long long now, long long settled) override;
  double due() const override { return std::min(look_due_, window_due_); }
  /** The run begins anew. */
  void restart();
  /** Something was changed: what was kept is of another motion. */
  void change();
  /** A finer run that began in an earlier state of this motion; or null. */
  const Scene* kept() const { return kept_.get(); }
  /** The verdict on the run until now, once for each number of steps.
   * @param asked has the answer of the run to its question, which is compared,
   * too, unless it is all positions; null: none was asked
   * Throws Interrupted.  Complexity: twice the run; O(1) of windows */
  const Verdict& verdict(const Observer* asked = nullptr) const;
  /** Save or load what a repetition of all is compared with.
   * @param w null: save nothing, or forget what is loaded */
  static void archive(Archive& a, Witness* w);
  /** The last verdict, or null. */
  const Verdict* said() const { return said_ ? &*said_ : nullptr; }

 private:
  struct Look {
    long long step;
    double time;                      // [s]
    double total, internal, kinetic;  // [J]
    double loose;                     // EnergyFlow::loose
    Look() = default;
    explicit Look(const Scene& s);
  };
  Scene& scene_;
  double t_end_;
  const bool asked_whole_;
  bool whole_ = false;
  double each_ = 0;                       // time between looks [s]
  double look_due_ = 0, window_due_ = 0;  // next [s]
  int next_ = 0;                          // look at a window: 9 in each
  double begin_ = 0;                      // of the run [s]
  Point from_;                            // the center of mass then [m]
  unsigned edges_ = 0;                    // then
  std::vector<Look> looks_, window_looks_;
  std::unique_ptr<Scene> kept_;
  std::vector<double> drifts_;  // of the windows [J]
  Verdict windows_;             // what they showed so far
  double sweeps_ = 0;           // of the windows
  mutable std::optional<Verdict> said_;
  mutable long long said_at_ = -1;  // steps

  double size() const;
  void look();
  void begin_windows();
  void next_in_window();
  void window();
  std::vector<double> repeat(Scene& finer, const std::vector<Look>& looks,
                             Verdict& v, double& slack,
                             const std::function<void()>& after = {}) const;
  Verdict judge_whole(const Observer* asked) const;
  Verdict judge_windows() const;
};

}  // namespace lab
