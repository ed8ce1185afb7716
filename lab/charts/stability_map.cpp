/** @file stability_map.cpp
 * Maps of the stability of methods: measured and predicted limits. A map
 * consists of independent runs, its cells, each with a file of its own. They
 * can be run in any order; joined they give the same bytes.
 *
 *   build/stability_map --list                # all cells: name, cost, content
 *   build/stability_map --cell NAME --out DIR/NAME.csv
 *   build/stability_map --map limits          # the head of a map
 *
 * `make stability` runs and joins all.
 * The columns: lab/charts/README.md. Exit status: 0 done; 2 an option or an
 * input that can't be used, or an output that can't be written. */
#include <algorithm>
#include <cmath>
#include <functional>
#include <iostream>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "CME212/OutputFile.hpp"
#include "lab/charts/Growth.hpp"
#include "lab/charts/Report.hpp"
#include "lab/fast/Sweep.hpp"
#include "lab/methods/Methods.hpp"
#include "lab/stability/Spectrum.hpp"
#include "lab/stability/StepLimit.hpp"

using namespace lab;

using CME212::short_text;
using report::cell;

namespace {

/** The amount of work: for the charts, for a first look, for a test. */
enum class Effort { full, quick, tiny };

/** One of three values, by effort. */
template <typename T>
T by(Effort e, T full, T quick, T tiny) {
  return e == Effort::full ? full : e == Effort::quick ? quick : tiny;
}

/** A part of a map, with runs of its own. Its name begins with the map's. */
struct Cell {
  std::string name;
  double cost;       // estimated seconds on a core of 2.4 GHz
  std::string what;  // its parameters, for people
  std::function<void(std::ostream&)> run;  // writes its rows
};

struct Map {
  const char* name;
  const char* about;
  const char* columns;
};
constexpr std::array maps = {
    Map{"limits",
        "the largest stable step on a sheet stretched to 1.5 times its size "
        "and held at its rim; drag 1 1/s",
        "side,mesh,method,predicted [s],measured [s],safe [s]"},
    Map{"growth",
        "ln of the growth per step of a tiny disturbance of a stretched sheet, "
        "plain mesh, no drag",
        "method,stretch,dt/safe,predicted limit/safe,growth"}};

constexpr const char* name_of(MeshSprings::Kind mesh) {
  return mesh == MeshSprings::plain ? "plain" : "diagonals";
}
const std::vector<const char*> explicit_methods = {"symplectic-euler", "verlet",
                                                   "pefrl", "rk4"};

/** omega_safe() and a good SharpOmega of @a p at its start [1/s]. */
std::pair<double, double> frequencies(const Problem& p) {
  Start s(p);
  return {omega_safe(s.cloth, s.force, s.constraint),
          SharpOmega()(s.cloth, s.force, s.constraint, 80)};
}

// ----------------------------------------------------------------------- Maps

/** Limit against the number of nodes. A large cloth can't be run for seconds,
 * but a stretched sheet shows its limit within a few hundred steps. */
void add_limits(std::vector<Cell>& cells, Effort effort) {
  using Sides = std::vector<unsigned>;
  const auto sides = by<Sides>(effort, {5, 10, 25, 50, 100, 200, 500, 1000},
                               {5, 10, 25, 50, 100}, {5});
  for (unsigned side : sides)
    for (MeshSprings::Kind mesh : {MeshSprings::plain, MeshSprings::diagonals})
      for (const char* name : {"symplectic-euler", "verlet", "rk4"}) {
        const int steps = side >= 500 ? 150 : 300;
        const MethodEntry& m = *find_method(name);
        auto run = [=, &m](std::ostream& out) {
          const Problem p = stretched_sheet(side, mesh, 1.5, 1);
          auto [safe, sharp] = frequencies(p);
          const double least = step_limit(m, safe, 1);
          out << side << ',' << name_of(mesh) << ',' << name << ','
              << cell(step_limit(m, sharp, 1)) << ','
              << cell(measured_sheet_limit(p, m, 0.8 * least, 1.6 * least,
                                           steps))
              << ',' << cell(least) << '\n';
        };
        cells.push_back({"limits-" + std::to_string(side) + '-' +
                             name_of(mesh) + '-' + name,
                         1e-7 * side * side * steps * (m.info.sweeps + 0.5) *
                             (mesh == MeshSprings::plain ? 0.6 : 1),
                         "stretch=1.5 gamma=1 precision=0.01 steps=" +
                             std::to_string(steps),
                         run});
      }
}

/** Growth against stretch and step: a cell is a column of the map, one method
 * at one stretch. */
void add_growth(std::vector<Cell>& cells, Effort effort) {
  constexpr unsigned side = 15;
  const int columns = by(effort, 40, 16, 2), rows = by(effort, 60, 24, 3);
  const int steps = by(effort, 600, 200, 20);
  constexpr double low = 0.9, high = 2.5;  // stretch
  constexpr double least = 0.5, most = 2;  // dt/safe
  for (const char* name : explicit_methods)
    for (int k = 0; k < columns; ++k) {
      const double stretch = low + (high - low) * (k + 0.5) / columns;
      const MethodEntry& m = *find_method(name);
      auto run = [=, &m](std::ostream& out) {
        const Problem p = stretched_sheet(side, MeshSprings::plain, stretch, 0);
        auto [safe, sharp] = frequencies(p);
        for (int row = 0; row < rows; ++row) {
          const double of_safe = least + (most - least) * (row + 0.5) / rows;
          const double dt = of_safe * step_limit(m, safe);
          out << name << ',' << cell(stretch) << ',' << cell(of_safe) << ','
              << cell(safe / sharp) << ',';
          char text[32];
          std::snprintf(text, sizeof text, "%.3g\n",
                        std::min(99.0, growth(p, m, dt, steps).per_step));
          out << text;
        }
      };
      cells.push_back(
          {std::string("growth-") + name + '-' + short_text(stretch),
           4e-6 * (m.info.sweeps + 1) * rows * steps,
           "side=15 steps=" + std::to_string(steps) +
               " rows=" + std::to_string(rows),
           run});
    }
}

/** All cells, in the order in which they are joined. */
std::vector<Cell> make_cells(Effort effort) {
  std::vector<Cell> cells;
  add_limits(cells, effort);
  add_growth(cells, effort);
  return cells;
}

// -------------------------------------------------------------------- Options

struct Options {
  bool list = false, quick = false, tiny = false;
  std::string cell, map, out;
};

/** The one of @a all called @a name; throws std::runtime_error if none is. */
template <typename All>
const auto& find(const All& all, const std::string& name, const char* what,
                 const std::string& see) {
  for (const auto& a : all)
    if (a.name == name) return a;
  throw std::runtime_error(std::string(what) + ": there is no '" + name +
                           "'; " + see);
}

void run(const Options& o) {
  const auto cells = make_cells(o.quick  ? Effort::quick
                                : o.tiny ? Effort::tiny
                                         : Effort::full);
  auto map_of = [](const std::string& name) {
    return find(maps, name, "--map", "there are: limits growth");
  };
  std::optional<CME212::OutputFile> file;
  if (!o.out.empty()) file.emplace(o.out);  // fail before the run, not after
  std::ostream& out = file ? file->stream() : std::cout;
  if (o.list) {
    for (const Cell& c : cells)
      out << c.name << ' ' << short_text(c.cost) << ' ' << c.what << '\n';
  } else if (!o.cell.empty()) {
    const Cell& chosen = find(cells, o.cell, "--cell", "--list prints all");
    out << map_of(o.cell.substr(0, o.cell.find('-'))).columns << '\n';
    chosen.run(out);
  } else {
    const Map map = map_of(o.map);
    report::write_head(out, "stability; columns: lab/charts/README.md");
    out << "# map " << map.name << ": " << map.about << '\n'
        << map.columns << '\n';
  }
  if (file) file->commit();
}

/** Read the command line.  @return the exit status to end with, or -1 */
int parse(int argc, char** argv, Options& o) {
  CLI::App app("Measures where methods are stable; writes CSV.",
               "stability_map");
  auto* what = app.add_option_group("what", "one of");
  what->add_flag("--list", o.list,
                 "print the cells: name, cost [s], parameters");
  what->add_option("--cell", o.cell, "run this cell")->type_name("NAME");
  what->add_option("--map", o.map, "print the head of this map")
      ->type_name("NAME");
  what->require_option(1);
  app.add_option("--out", o.out, "file to write; the terminal if none")
      ->type_name("FILE");
  auto* quick = app.add_flag("--quick", o.quick, "fewer and smaller cells");
  app.add_flag("--tiny", o.tiny, "next to none, for a test")->excludes(quick);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    return app.exit(e) == 0 ? 0 : 2;
  }
  return -1;
}

}  // namespace

int main(int argc, char** argv) {
  Sweep::set_threads(1);  // runs stand beside runs
  Options o;
  try {
    if (int status = parse(argc, argv, o); status >= 0) return status;
    run(o);
    return 0;
  } catch (const std::exception& e) {
    std::cerr << "stability_map: " << e.what() << '\n';
  }
  return 2;
}
