#pragma once
/** @file Failure.hpp
 * How each method fails, and a cure: a table of runs, which documents and tests
 * quote, and their results as a CSV file. */
#include <array>
#include <iosfwd>
#include <span>
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

/** A run of a failure, and the text at its curve in the picture. */
struct FailureRun {
  std::string_view method;  ///< empty: the true motion itself
  double dt = 0;            ///< [s]
  const char* label = "";   ///< # stands for the number of force evaluations
  struct Place {
    double t, up;  ///< [s], and lines of text above the curve
  } place = {};
  double setting = 0;  ///< tolerance [m] of an adaptive one, substeps of xpbd

  constexpr FailureRun() = default;
  constexpr FailureRun(std::string_view method, double dt, const char* label,
                       Place place, double setting = 0)
      : method(method), dt(dt), label(label), place(place), setting(setting) {}
};

/** How a method fails, and a cure: runs[0] fails, the last one does not, those
 * in between are for comparison.
 *
 * The deviation of a run is the largest distance of its quantity from the right
 * value: of an energy from that at the start (there is no drag), of a height or
 * a stretch from that of the true motion, of an error from 0. */
struct Failure {
  const char* title;    ///< what is seen
  const char* caption;  ///< the scene
  Problem (*scene)();
  double t_end;  ///< [s]
  Quantity quantity;
  double fails;  ///< the deviation of runs[0] is larger
  double cured;  ///< that of the last run is smaller
  struct Axis {
    double low, high;
    bool log = false;
  } axis;
  std::array<FailureRun, 4> runs;

  template <typename... Runs>
  constexpr Failure(const char* title, const char* caption, Problem (*scene)(),
                    double t_end, Quantity quantity, double fails, double cured,
                    Axis axis, const Runs&... runs)
      : title(title),
        caption(caption),
        scene(scene),
        t_end(t_end),
        quantity(quantity),
        fails(fails),
        cured(cured),
        axis(axis),
        runs{runs...} {}

  constexpr std::string_view method() const { return runs[0].method; }
  /** Number of runs. */
  constexpr std::size_t size() const {
    std::size_t n = 0;
    while (n < runs.size() && runs[n].dt > 0) ++n;
    return n;
  }
};

/** At most one failure for each method. */
extern const std::span<const Failure> failures;

/** That of the method called @a name; nullptr if none is known. */
const Failure* failure_of(std::string_view name);

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

/** Make the runs of those of @a chosen that have a failure and write
 * failures.csv, which failures.gp draws, to @a out: titles, axes and measured
 * numbers in the head, then a row for each point of a curve.
 * @param said the measured numbers go there as well, if not nullptr */
void write_failures(const std::vector<const MethodEntry*>& chosen,
                    std::ostream* said, std::ostream& out);

}  // namespace lab
