#pragma once
/** @file Failure.hpp
 * How each method fails, and a cure: a table of runs, and the making of them.
 * FailureChart.hpp draws it, documents and tests quote it. */
#include <array>
#include <string_view>
#include <vector>

#include "lab/charts/Problem.hpp"
#include "lab/methods/Methods.hpp"

namespace lab {

/** What is looked at in a run, against time. */
enum class Quantity {
  energy,   ///< kinetic, of springs and of gravity [J]
  height,   ///< of the center of mass [m]
  stretch,  ///< of the spring for which it is largest
  error     ///< distance() from the true motion [m]
};

/** A run of a failure. */
struct FailureRun {
  std::string_view method;  ///< empty: the true motion itself
  double dt;                ///< [s]
  double setting = 0;  ///< tolerance [m] of an adaptive one, substeps of xpbd
};

/** How a method fails, and a cure: runs[0] fails, the last one does not, those
 * in between are for comparison.
 *
 * The deviation of a run is the largest distance of what is looked at from what
 * is right: an energy from that at the start (there is no drag), a height or a
 * stretch from that of the true motion, an error from 0. */
struct Failure {
  const char* title;    ///< what is seen
  const char* caption;  ///< on what
  Problem (*scene)();
  double t_end;  ///< [s]
  Quantity quantity;
  double fails;  ///< the deviation of runs[0] is more
  double cured;  ///< and that of the last run less
  std::array<FailureRun, 4> runs;

  constexpr std::string_view method() const { return runs[0].method; }
  /** Number of runs. */
  constexpr std::size_t size() const {
    std::size_t n = 0;
    while (n < runs.size() && runs[n].dt > 0) ++n;
    return n;
  }
};

/** One failure for each method, in the order of `methods`. */
extern const std::array<Failure, methods.size()> failures;

/** @pre there is a method called @a name */
const Failure& failure_of(std::string_view name);

/** A run against time. */
struct Trace {
  struct Sample {
    double t;             // [s]
    double value, right;  // in the unit of the failure's quantity
  };
  std::vector<Sample> samples;  // at the start, and after each step
  Outcome::Status status = Outcome::Status::ok;
  long long sweeps = 0;
  double deviation = 0;
};

/** Make the run @a r of @a f, until its end or until it fails. */
Trace trace(const Failure& f, const FailureRun& r);

}  // namespace lab
