/** @file work_precision.cpp
 * Work-precision diagrams: runs every method on every problem with many steps,
 * and writes the cost and the error of each run as CSV.
 *
 *   build/work_precision --out FILE.csv
 *   build/work_precision --quick --scenes grid0,chain --methods verlet,pefrl
 *   build/work_precision --grid-refinement
 *
 * The columns: lab/charts/README.md; make.sh adds machine and commit. Exit
 * status: 0 done; 2 an option or an input that can't be used, or an output that
 * can't be written. */
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <CLI/CLI.hpp>

#include "CME212/OutputFile.hpp"
#include "CME212/Util.hpp"
#include "lab/charts/Cell.hpp"
#include "lab/charts/Problem.hpp"
#include "lab/fast/Sweep.hpp"
#include "lab/methods/Methods.hpp"
#include "lab/methods/Splitting.hpp"
#include "lab/methods/StiffSplit.hpp"
#include "lab/run/Progress.hpp"
#include "lab/stability/Spectrum.hpp"

using namespace lab;

namespace {

struct Options {
  std::vector<std::string> scenes, methods;
  std::string out;
  int repeats = 7;
  bool grid_refinement = false, quick = false, quiet = false;
};

/** The limits of a ladder of steps. */
struct Effort {
  double springs;  // most spring evaluations of a run
  double seconds;  // most seconds of a run
};
constexpr Effort full = {6e7, 0.6}, rough = {2e6, 0.05};

// -------------------------------------------------------------- Work-precision

/** A method with a step or a tolerance, on a problem. */
struct Case {
  const MethodEntry* method;
  long long steps = 1;
  double tolerance = 0;  // [m]; 0: the method has none
  double of_limit = 0;   // dt omega_max/limit; 0: the method has no limit
  Outcome first = {};
  double error = 0;                  // [m]
  std::vector<double> seconds = {};  // of the repeats

  Outcome run_on(const Problem& p, bool guarded) const {
    auto made = method->make();
    if (tolerance > 0) made->set_tolerance(tolerance);
    return run(p, *made, steps, guarded);
  }
};

/** The cases of a method on a problem: explicit methods start at twice their
 * largest stable step, methods without a limit at 1/8 of the time; then the
 * step is halved. Adaptive methods have tolerances. The ladder ends when the
 * error is below 10 floors, or the effort is spent: so its length depends on
 * the machine, but its steps do not. */
std::vector<Case> ladder(const Problem& p, const Reference& r,
                         const MethodEntry& method, double omega,
                         std::size_t springs, Effort effort) {
  std::vector<Case> cases;
  if (p.rests) effort.springs *= 4, effort.seconds *= 4;
  const MethodInfo& info = method.info;
  auto go_on = [&](double finer) {
    Case& c = cases.back();
    c.first = c.run_on(p, true);
    if (c.first.ok()) c.error = distance(p, c.first.end, r.end);
    if (!c.first.ok()) return true;
    return c.error > 10 * r.floor && c.first.seconds * finer < effort.seconds &&
           double(c.first.sweeps) * double(springs) * finer < effort.springs;
  };
  if (info.adaptive) {
    for (double tolerance = 1e-2; tolerance > 1e-14; tolerance /= 10) {
      cases.push_back({&method, 1, tolerance});
      if (!go_on(1.6)) break;
    }
    return cases;
  }
  const bool limited = info.limit != no_limit;
  // A method without any stable step starts where Verlet does.
  const double limit = info.limit > 0 ? info.limit : 2;
  double steps = limited ? p.t_end * omega / limit / 2 : 8;
  for (int k = 0; k < 24; ++k, steps *= 2) {
    Case& c = cases.emplace_back(
        Case{&method, static_cast<long long>(std::ceil(steps))});
    if (limited && info.limit > 0)
      c.of_limit = p.t_end / double(c.steps) * omega / limit;
    if (k > 0 &&
        double(c.steps) * info.sweeps * double(springs) > 2 * effort.springs)
      return cases.pop_back(), cases;
    if (!go_on(2)) break;
  }
  return cases;
}

/** How the reference was made, and its center of mass and energy. */
void write_reference(std::ostream& out, const Problem& p, const Reference& r) {
  char text[160];
  const Point& c = r.end.center;
  std::snprintf(text, sizeof text,
                ": agree to %.2g m; center of mass %.14g %.14g %.14g m, "
                "energy %.14g J\n",
                r.floor, c.x, c.y, c.z, r.end.energy);
  out << "# reference " << p.name << ": " << r.made << text;
}

void write_case(std::ostream& out, const Problem& p, const Reference& r,
                const Case& c) {
  constexpr const char* statuses[] = {"ok", "diverged", "failed"};
  const bool ok = c.first.ok();
  auto s = c.seconds;
  std::sort(s.begin(), s.end());
  const double least = ok ? s.front() : NAN;
  const double median = ok ? s[s.size() / 2] : NAN;
  const bool by_tolerance = c.tolerance > 0;
  // A failed run is plotted at the cost that it would have had.
  double sweeps =
      ok ? double(c.first.sweeps) : double(c.steps) * c.method->info.sweeps;
  out << p.name << ',' << c.method->info.name << ','
      << (by_tolerance ? "" : cell(p.t_end / double(c.steps))) << ','
      << (by_tolerance ? cell(c.tolerance) : "") << ','
      << (c.of_limit > 0 ? cell(c.of_limit) : "") << ',' << c.steps << ','
      << std::llround(sweeps) << ',' << c.first.work.inner << ','
      << c.first.work.newton << ',' << c.first.work.products << ','
      << c.first.work.factors << ',' << cell(least) << ',' << cell(median)
      << ',' << (ok ? cell(c.error) : "") << ',' << cell(r.floor) << ','
      << name_of(p.norm) << ',' << statuses[static_cast<int>(c.first.status)]
      << ',' << cell(c.first.reason) << '\n';
}

void work_precision(const std::vector<Problem>& problems,
                    const std::vector<const MethodEntry*>& chosen,
                    const Options& o, std::ostream& out, Progress& progress) {
  out << "# work and precision; columns: lab/charts/README.md\n";
  for (const Problem& p : problems)
    out << "# scene " << p.name << ": " << p.about
        << "; error: " << name_of(p.norm) << '\n';
  out << "scene,method,dt [s],tolerance "
         "[m],dt/limit,steps,sweeps,inner,systems,"
         "products,factors,seconds_min [s],seconds_median [s],error [m],floor "
         "[m],norm,status,"
         "reason\n";
  double parts = double(problems.size()), part = 0;
  for (const Problem& p : problems) {
    progress.show(p.name + ": reference", part / parts);
    const Reference r = reference(p, o.quick ? 8 : 16);
    write_reference(out, p, r);
    Start start(p);
    const auto omega_of = [&start](const ForcePlan& force) {
      return omega_safe(start.cloth, force, start.constraint);
    };
    const double omega = omega_of(start.force);
    const double soft =
        omega_of(soft_stiffness(start.cloth, start.force, start.constraint));
    std::vector<Case> cases;
    for (std::size_t k = 0; k < chosen.size(); ++k) {
      const bool multirate = chosen[k]->info.multirate;
      if (multirate && soft == omega) continue;  // it is verlet here
      progress.show(p.name + ": first runs",
                    (part + .2 * double(k) / double(chosen.size())) / parts);
      for (Case& c : ladder(p, r, *chosen[k], multirate ? soft : omega,
                            start.cloth.num_edges(), o.quick ? rough : full))
        cases.push_back(std::move(c));
    }
    // The first runs were the warm-up. Runs are interleaved, so that a machine
    // that slows down for a while slows all methods.
    for (int k = 0; k < o.repeats; ++k) {
      progress.show(p.name + ": repeats",
                    (part + .2 + .8 * k / double(o.repeats)) / parts);
      for (Case& c : cases)
        if (c.first.ok()) c.seconds.push_back(c.run_on(p, false).seconds);
    }
    for (const Case& c : cases) write_case(out, p, r, c);
    part += 1;
  }
  progress.end();
}

// ----------------------------------------------------------- Grid refinement

/** The height of the center of mass of the assignment's cloth at 0.25 s, by
 * Verlet: its error when the grid, the step, or both are refined. Against the
 * finest grid at a quarter of its stable step. */
void grid_refinement(const Options& o, std::ostream& out, Progress& progress) {
  const std::vector<unsigned> sides =
      o.quick ? std::vector<unsigned>{5, 10, 20}
              : std::vector<unsigned>{5, 10, 20, 40, 80};
  const unsigned finest = o.quick ? 40 : 240, fixed = sides[1];
  auto steps_of = [](unsigned side) {  // the stable step: 0.0577 s/side
    return static_cast<long long>(std::ceil(0.25 * side / 0.0577));
  };
  out << "# refining the grid, the step, or both; Verlet\n"
         "# scene: the assignment's cloth with drag, by verlet; height of the "
         "center of mass at "
         "0.25 s\n# reference: "
      << finest << " nodes a side, 1/4 of the stable step\n"
      << "refined,side,dt [s],sweeps,seconds [s],error [m]\n";
  Verlet verlet;
  auto grid = [](unsigned side) { return grid_problem("", "", 0.25, side); };
  progress.show("reference", 0);
  const double right =
      run(grid(finest), verlet, 4 * steps_of(finest), false).end.center.z;
  double done = 0;
  auto add = [&](const char* refined, unsigned side, long long steps) {
    progress.show("grids", 0.5 + done++ / 40);
    Outcome r = run(grid(side), verlet, steps, false);
    for (int k = 1; k < std::min(o.repeats, 3); ++k)
      r.seconds =
          std::min(r.seconds, run(grid(side), verlet, steps, false).seconds);
    out << refined << ',' << side << ',' << cell(0.25 / double(steps)) << ','
        << r.sweeps << ',' << cell(r.seconds) << ','
        << cell(std::abs(r.end.center.z - right)) << '\n';
  };
  for (std::size_t k = 0; k < sides.size(); ++k)
    add("step", fixed, steps_of(fixed) << k);
  for (unsigned side : sides) add("grid", side, steps_of(sides.back()));
  for (unsigned side : sides) add("both", side, steps_of(side));
  progress.end();
}

// -------------------------------------------------------------------- Options

/** Read the command line.  @return the exit status to end with, or -1 */
int parse(int argc, char** argv, Options& o) {
  CLI::App app("Measures what methods cost and how wrong they are; writes CSV.",
               "work_precision");
  app.option_defaults()->always_capture_default();
  for (const Problem& p : make_problems()) o.scenes.push_back(p.name);
  for (const MethodEntry& m : methods) o.methods.emplace_back(m.info.name);
  app.add_option("--scenes", o.scenes, "problems to run, a,b,...")
      ->delimiter(',')
      ->check(CLI::IsMember(o.scenes));
  app.add_option("--methods", o.methods, "methods to run, a,b,...")
      ->delimiter(',')
      ->check(CLI::IsMember(o.methods));
  app.add_flag("--quick", o.quick, "rough: few steps, one repeat");
  app.add_option("--repeats", o.repeats, "timed runs of each case")
      ->check(CLI::Range(1, 1000));
  app.add_option("--out", o.out, "file to write; the terminal if none")
      ->type_name("FILE");
  app.add_flag("--grid-refinement", o.grid_refinement,
               "refine the grid, the step, or both instead");
  app.add_flag("--quiet", o.quiet, "print nothing but errors");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    return app.exit(e) == 0 ? 0 : 2;
  }
  if (o.quick && app.count("--repeats") == 0) o.repeats = 1;
  return -1;
}

void run(Options o) {
  const auto is_in = [](const auto& names, std::string_view name) {
    return std::ranges::find(names, name) != names.end();
  };
  std::vector<Problem> problems = make_problems();
  std::erase_if(problems,
                [&](const Problem& p) { return !is_in(o.scenes, p.name); });
  std::vector<const MethodEntry*> chosen;
  for (const MethodEntry& m : methods)
    if (is_in(o.methods, m.info.name)) chosen.push_back(&m);
  std::optional<CME212::OutputFile> file;
  if (!o.out.empty()) file.emplace(o.out);
  std::ostream& out = file ? file->stream() : std::cout;
  Progress progress(o.quiet || !file);
  if (o.grid_refinement)
    grid_refinement(o, out, progress);
  else
    work_precision(problems, chosen, o, out, progress);
  if (file) file->commit();
}

}  // namespace

int main(int argc, char** argv) {
  Sweep::set_threads(1);  // runs stand beside runs
  Options o;
  try {
    if (int status = parse(argc, argv, o); status >= 0) return status;
    run(std::move(o));
    return 0;
  } catch (const std::exception& e) {
    std::cerr << "work_precision: " << e.what() << '\n';
  }
  return 2;
}
