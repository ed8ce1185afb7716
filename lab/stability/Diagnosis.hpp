#pragma once
/** @file Diagnosis.hpp
 * Where a run failed, why, and what works instead. */
#include <functional>
#include <optional>
#include <string>

#include "lab/stability/StepLimit.hpp"

namespace lab {

/** The place where the state of a cloth is worst: the first node that is not
 * finite, or else the fastest one, and the most stretched spring there. */
struct WorstPlace {
  Node node;          ///< not valid if the cloth has none
  Edge spring;        ///< not valid if the node has none
  double speed = 0;   ///< of the node [m/s]; infinite if it has no number
  double length = 0;  ///< of the spring [m]; the same

  explicit WorstPlace(const Cloth& g);
  /** The same in words. */
  std::string text(const Cloth& g) const;
};

/** Why a run fails. */
enum class Cause {
  step,       ///< beyond the stability limit
  drag,       ///< beyond it for its drag, which the method takes as a force
  no_step,    ///< the method has no stable step
  resonance,  ///< within the limit; it resonates with stiff springs
  nonlinear,  ///< within the limit, which is that of small oscillations
  method,     ///< one without a limit fails all the same
  solver,     ///< a method or a constraint could not make the step
  start,      ///< the start is at fault
};

/** What to know of a run that failed. */
struct FailedRun {
  MethodEntry method;
  double dt = 0;        ///< [s]
  double time = 0;      ///< that the step which failed was to reach [s];
                        ///< no_limit if the start is at fault
  bool solver = false;  ///< the step could not be made
  double sharp = 0;     ///< the stability limit [s] in the last good state
  double safe = 0;      ///< that in any state
  double safe_without_drag = 0;
  double verlet = 0;           ///< Verlet's, in any state
  std::string resonance = {};  ///< how dt resonates, in words, if it does
  double clear = 0;            ///< a shorter step that does not [s]
};

/** Another way to compute the same scene. */
struct Cure {
  MethodEntry method;
  double dt;  ///< [s]
  /** As options of ./cloth, without the method if it is that of @a before. */
  std::string options(const MethodEntry& before) const;
};

/** A trial of a cure: the scene from its start. */
struct Attempt {
  bool passed;  ///< it did not fail, and half of its step has its energy
  double time;  ///< that it reached [s]
};
using TryOut = std::function<Attempt(const Cure&)>;

/** Why a run failed, and what works. */
struct Diagnosis {
  Cause cause;
  std::string text;          ///< the cause and the cure in words
  std::optional<Cure> cure;  ///< one whose trial passed
  Attempt trial = {};        ///< of it
};

/** Find out why @a run failed, and a cure. What it takes for one is tried:
 * shorter steps, other methods, the likeliest first, until a trial gets beyond
 * the time of the failure. So a cure that it names works as far as it says.
 * Calls @a try_out up to 10 times. */
Diagnosis diagnose(const FailedRun& run, const TryOut& try_out);

}  // namespace lab
