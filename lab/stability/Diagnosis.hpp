#pragma once
/** @file Diagnosis.hpp
 * How and where a run failed, why, and a remedy that works. */
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "lab/stability/StepLimit.hpp"

namespace lab {

/** The first node whose state is not finite, or else the fastest node, and its
 * longest spring. The numbers stay those of the state that it was found in. */
struct WorstPlace {
  Node node;          ///< invalid if the cloth has none
  Edge spring;        ///< invalid if the node has none
  double speed = 0;   ///< of the node [m/s]; infinite if not finite
  double length = 0;  ///< of the spring [m]; infinite if not finite
  double rest = 0;    ///< its rest length [m]
  /** Indices of the node and of the spring's other end; -1: there is none. */
  long long index = -1, other = -1;

  /** @pre @a g has all its nodes */
  explicit WorstPlace(const Cloth& g);
  /** In words. */
  std::string text() const;
};

/** How a run failed, and where: known immediately. */
struct Failure {
  enum class Kind {
    start,     ///< the energy at the start is not finite
    diverged,  ///< the guard found energy that came from nothing
    refused,   ///< the method or a constraint could not make the step
  };
  Kind kind;
  WorstPlace place;         ///< in the bad state
  std::string method;       ///< its name
  double time = 0;          ///< of the last good state [s]
  double dt = 0;            ///< of the step that failed [s]
  long long step = 0;       ///< its number, from 1; 0: Kind::start
  std::string reason = {};  ///< Kind::refused: of StepError

  /** The kind, with the reason; the place with step and time; and both. */
  std::string what() const;
  std::string where() const;
  std::string text() const;
};
/** The text of a failure; "" if there is none. */
inline std::string text_of(const std::optional<Failure>& f) {
  return f ? f->text() : "";
}

/** Why a run fails. */
enum class Cause {
  step,       ///< dt is longer than the stability limit
  drag,       ///< dt is too long for drag that is treated as a force
  no_step,    ///< the method has no stable step
  nonlinear,  ///< dt is below the limit, but motion is large
  flat,       ///< one linear solve sees no stiffness across a flat cloth
  linear,     ///< one linear solve for nodes that move far in a step
  rounds,     ///< too few rounds to solve the equations of a step
  waves,      ///< fast waves are not resolved, and nothing damps them
  error,      ///< a method without a limit fails in another way
  solver,     ///< the method or a constraint could not make the step
  start,      ///< the initial state is at fault
};

/** What diagnose() needs to know about a failed run. */
struct FailedRun {
  MethodEntry method;
  double dt = 0;        ///< [s]
  double time = 0;      ///< at the end of the step that failed [s];
                        ///< no_limit if the initial state is at fault
  bool solver = false;  ///< the step could not be made: StepError
  double sharp = 0;     ///< the stability limit [s] in the last good state
  double safe = 0;      ///< the limit in every configuration [s]
  double safe_without_drag = 0;  ///< [s]
  double verlet = 0;             ///< Verlet's safe limit [s]
  bool flat = false;             ///< the last good state is: is_flat()
  bool rigid = false;      ///< it gained more energy than its springs ever had
  std::string asked = {};  ///< the answer that is wrong; "": none is
  double apart = 0;        ///< Attempt::apart, if it is that alone; else 0
};

/** Do all nodes lie in a plane, to 1e-9 of the size of the cloth?  O(N) */
bool is_flat(const Cloth& g);

/** Another way to compute the same scene. */
struct Cure {
  MethodEntry method;
  double dt;  ///< [s]
  /** As options of ./cloth; --method only if it differs from @a before. */
  std::string options(const MethodEntry& before) const;
  /** For who has no command line: the method, too, and the step [ms]. */
  std::string in_words(const MethodEntry& before) const;
};
/** How a door names a cure. */
using CureName = std::string (Cure::*)(const MethodEntry& before) const;

/** The result of running the scene from its start with a cure. */
struct Attempt {
  bool passed;  ///< it did not fail, and half the step has the same energy
  double time;  ///< at its end [s]
  /** Then, of a node from that with half the step, at most, by the size of the
   * cloth. */
  double apart = 0;
  double answer = 0;  ///< what half the step changes of it, as a share
  static constexpr double same_place = 0.01;   ///< apart, of equal positions
  static constexpr double same_answer = 0.05;  ///< answer, of equal ones
  /** An error of @a run besides that of its energy is left. */
  bool is_no_better(const FailedRun& run) const {
    return (!run.asked.empty() && answer > same_answer) ||
           (run.apart > 0 && apart > run.apart / 2);
  }
};
using TryOut = std::function<Attempt(const Cure&)>;

/** Why a run failed, and a cure that works. */
struct Diagnosis {
  FailedRun run;
  Cause cause;
  std::optional<Cure> cure = {};   ///< one that passed a trial
  Attempt trial = {};              ///< of the cure
  std::vector<Cure> failed = {};   ///< cures that did not pass
  std::vector<Cure> stopped = {};  ///< whose trial ended before the failure
  bool grows = false;  ///< positions alone are wrong, and as much in two trials

  std::string cause_text() const;
  std::string remedy_text(CureName name = &Cure::options) const;
};

/** Find out why @a run failed, and a cure. Tries shorter steps and other
 * methods, the cheapest that can hold first, until a trial passes the time of
 * the failure or 10 trials have not. The cure that it returns has passed: its
 * energy is that of half of its step, and so is the answer, if that was wrong;
 * if only positions were, it halves their difference, and two trials that do
 * not are enough: small errors grow in such a motion. */
Diagnosis diagnose(const FailedRun& run, const TryOut& try_out);

/** A message about a failure: its sentences in their order. */
struct Explanation {
  static constexpr const char* interrupted =
      "a signal ended the search for a remedy";
  std::string cause, remedy, place;

  /** @param diagnosis null if a signal ended it */
  Explanation(const Failure& failure, const Diagnosis* diagnosis);
  /** One line. */
  std::string text() const { return cause + "; " + remedy + "; " + place; }
};

}  // namespace lab
