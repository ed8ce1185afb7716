/** @file stability_map.cpp
 * Measured and predicted limits of methods. The map consists of independent
 * runs, its cells, each with a file of its own. A cell whose file is there is
 * not run again: so a map that was interrupted goes on where it stopped, to the
 * same bytes.
 *
 *   build/stability_map FOLDER --effort quick   # FOLDER/stability_limits.csv
 *
 * `make stability` runs it and draws. The columns: lab/charts/README.md. Exit
 * status: 0 done; 2 an option that can't be used, or an output that can't be
 * written. */
#include <algorithm>
#include <atomic>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iostream>
#include <map>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include <CLI/CLI.hpp>

#include "CME212/OutputFile.hpp"
#include "lab/charts/Cell.hpp"
#include "lab/charts/Growth.hpp"
#include "lab/fast/Sweep.hpp"
#include "lab/methods/Methods.hpp"
#include "lab/run/Progress.hpp"
#include "lab/stability/Spectrum.hpp"
#include "lab/stability/StepLimit.hpp"

using namespace lab;

namespace {

/** The amount of work: for the charts, for a first look. */
enum Effort { full, quick };

/** A part of the map, with a run of its own. */
struct Cell {
  std::string name;
  double cost;  // estimated seconds on a core of 2.4 GHz
  std::function<void(std::ostream&)> run;  // writes its row
};

constexpr const char* name_of(MeshSprings::Kind mesh) {
  return mesh == MeshSprings::plain ? "plain" : "diagonals";
}

/** omega_safe() and a good SharpOmega of @a p at its start [1/s]. */
std::pair<double, double> frequencies(const Problem& p) {
  Start s(p);
  return {omega_safe(s.cloth, s.force, s.constraint),
          SharpOmega()(s.cloth, s.force, s.constraint, 80)};
}

/** Limit against the number of nodes. A large cloth can't be run for seconds,
 * but a stretched sheet shows its limit within a few hundred steps. */
void add_limits(std::vector<Cell>& cells, Effort effort) {
  const std::vector<unsigned> sides[] = {{5, 10, 25, 50, 100, 200, 500, 1000},
                                         {5, 10, 25, 50, 100}};
  for (unsigned side : sides[effort])
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
                         run});
      }
}

// ----------------------------------------------------------------- Running

/** Run @a cells on all processors, costly ones first. Those whose file is in
 * @a folder are left out. */
void run(std::vector<Cell> cells, const std::filesystem::path& folder) {
  std::ranges::stable_sort(cells, std::greater(), &Cell::cost);
  Progress progress;
  std::mutex one_at_a_time;
  Sweep::FirstError error;
  std::atomic<std::size_t> next = 0;
  const auto work = [&] {
    try {
      for (std::size_t k; (k = next++) < cells.size();) {
        const std::string file = folder / (cells[k].name + ".csv");
        if (std::filesystem::exists(file)) continue;
        CME212::OutputFile out(file);
        cells[k].run(out.stream());
        out.commit();
        const std::lock_guard lock(one_at_a_time);
        progress.tell(cells[k].name, double(k) / double(cells.size()));
      }
    } catch (const std::exception&) {
      error.keep();
      next = cells.size();
    }
  };
  std::vector<std::jthread> threads;
  for (int k = 0; k < Sweep::processors(); ++k) threads.emplace_back(work);
  threads.clear();  // joins them
  progress.end();
  error.rethrow();
}

/** Write the file of the map from those of @a cells. */
void join(const std::vector<Cell>& cells, const std::filesystem::path& folder) {
  CME212::OutputFile file(folder / "stability_limits.csv");
  file.stream() << "# stability; columns: lab/charts/README.md\n"
                   "# map limits: the largest stable step on a sheet stretched "
                   "to 1.5 times its size and held at its rim; drag 1 1/s\n"
                   "side,mesh,method,predicted [s],measured [s],safe [s]\n";
  for (const Cell& cell : cells)
    file.stream() << std::ifstream(folder / (cell.name + ".csv")).rdbuf();
  file.commit();
}

}  // namespace

int main(int argc, char** argv) {
  Sweep::set_threads(1);  // runs stand beside runs
  CLI::App app("Measures where methods are stable; writes CSV.",
               "stability_map");
  std::string folder;
  Effort effort = full;
  app.add_option("FOLDER", folder, "for the map, and a file for each cell")
      ->required();
  app.add_option("--effort", effort, "fewer and smaller cells than in full")
      ->transform(CLI::CheckedTransformer(
          std::map<std::string, Effort>{{"full", full}, {"quick", quick}}));
  try {
    app.parse(argc, argv);
    std::filesystem::create_directories(folder);
    std::vector<Cell> cells;
    add_limits(cells, effort);
    run(cells, folder);
    join(cells, folder);
    return 0;
  } catch (const CLI::ParseError& e) {
    return app.exit(e) == 0 ? 0 : 2;
  } catch (const std::exception& e) {
    std::cerr << "stability_map: " << e.what() << '\n';
  }
  return 2;
}
