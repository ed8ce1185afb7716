#pragma once
/** @file Failure.hpp
 * How each method fails, and a cure: a table of runs, used by documents and
 * tests, and their results as a CSV file. */
#include <array>
#include <iosfwd>
#include <span>
#include <string_view>
#include <vector>

#include "lab/charts/Problem.hpp"
#include "lab/methods/Methods.hpp"

namespace lab {

/** The quantity that is plotted against time. */
enum class Plotted {
  energy,   ///< kinetic, elastic and gravitational [J]
  height,   ///< of the center of mass [m]
  stretch,  ///< the largest l/L - 1 of a spring
  error     ///< distance() from the true motion [m]
};

/** A run of a Failure, and the label of its curve in the picture. */
struct FailureRun {
  std::string_view method;  ///< empty: the true motion
  double dt = 0;            ///< [s]
  const char* label = "";   ///< # stands for the number of force evaluations
  struct Place {
    double t, up;  ///< time [s]; lines of text above the curve
  } place = {};
  double setting = 0;  ///< tolerance [m] if adaptive; substeps or rounds

  constexpr FailureRun() = default;
  constexpr FailureRun(std::string_view method, double dt, const char* label,
                       Place place, double setting = 0)
      : method(method), dt(dt), label(label), place(place), setting(setting) {}
};

/** How a method fails, and a cure: runs[0] fails, the last run does not, those
 * in between are for comparison.
 *
 * The deviation of a run is the largest difference of its quantity to the right
 * value: for an energy the initial one (there is no drag), for a height or a
 * stretch that of the true motion, for an error 0. */
struct Failure {
  const char* title;    ///< what the picture shows
  const char* caption;  ///< the scene
  Problem (*scene)();
  double t_end;  ///< [s]
  Plotted quantity;
  double fails;  ///< runs[0] has a larger deviation
  double cured;  ///< the last run has a smaller deviation
  struct Axis {
    double low, high;
    bool log = false;
  } axis;
  std::array<FailureRun, 4> runs;

  template <typename... Runs>
  constexpr Failure(const char* title, const char* caption, Problem (*scene)(),
                    double t_end, Plotted quantity, double fails, double cured,
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

/** The quantity of a run against time. */
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

/** Run @a r of @a f, until its end or until it fails. */
Trace trace(const Failure& f, const FailureRun& r);

/** Run the known failures of the @a chosen methods and write failures.csv to
 * @a out, which failures.gp draws: titles, axes and measured numbers in the
 * head, then a row for each point of a curve.
 * @param said gets the measured numbers, too, unless null */
void write_failures(const std::vector<const MethodEntry*>& chosen,
                    std::ostream* said, std::ostream& out);

}  // namespace lab
