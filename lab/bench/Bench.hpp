#pragma once
/** @file Bench.hpp
 * Bench: measures calls in turn and prints a table of their times and ratios,
 * for the programs bench and bench_*. */
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cstdio>
#include <functional>
#include <map>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "CME212/OutputFile.hpp"
#include "CME212/Point.hpp"
#include "lab/charts/Report.hpp"
#include "lab/fast/Sweep.hpp"

namespace lab {

namespace bench {

/** A call to be measured. */
struct Figure {
  std::string name;
  double items = 1;    ///< in one call: times are given for one item
  std::string group;   ///< its heading in the table; may be empty
  std::string beside;  ///< the figure of its group to which it is compared
  std::function<void()> call = {};
  double bytes = 0;  ///< moved through memory for an item; 0: not known
  int threads = 1;
};

/** Lowest, median and highest of some numbers; 0 if there are none. */
struct Spread {
  double low = 0, median = 0, high = 0;
  explicit Spread(std::vector<double> a) {
    if (a.empty()) return;
    std::sort(a.begin(), a.end());
    low = a.front(), median = a[a.size() / 2], high = a.back();
  }
};

/** Runs all registered benchmarks in turn, in random order. */
class Times : public benchmark::BenchmarkReporter {
 public:
  /** Of each repetition a call [s], by the name of the benchmark. */
  std::map<std::string, std::vector<double>> seconds;

  /** @param options more of them, as --benchmark_min_time=0.02 */
  void run(std::vector<std::string> options = {}) {
    options.insert(options.begin(),
                   {"bench", "--benchmark_enable_random_interleaving=true"});
    std::vector<char*> words;
    for (std::string& option : options) words.push_back(option.data());
    int count = int(words.size());
    benchmark::Initialize(&count, words.data());
    benchmark::RunSpecifiedBenchmarks(this);
    benchmark::ClearRegisteredBenchmarks();
  }
  bool ReportContext(const Context&) override { return true; }
  void ReportRuns(const std::vector<Run>& runs) override {
    for (const Run& run : runs)
      if (run.run_type == Run::RT_Iteration)
        seconds[run.run_name.function_name].push_back(
            run.real_accumulated_time / double(run.iterations));
  }
};

/** Measures figures in turn, in random order, so that a machine that slows down
 * slows all of them. */
class Bench {
 public:
  void add(Figure f) { figures_.push_back(std::move(f)); }

  /** @param repetitions of each figure, of at least 0.05 s and one call */
  void run(int repetitions) {
    for (const Figure& f : figures_)
      benchmark::RegisterBenchmark(
          key(f).c_str(),
          [&f](benchmark::State& state) {
            Sweep::set_threads(f.threads);
            f.call();  // fills the caches, and allocates
            for (auto _ : state) {
              f.call();
              benchmark::ClobberMemory();
            }
          })
          ->Repetitions(repetitions)
          ->MinTime(0.05);
    times_.run();
  }

  /** Seconds a call.  @pre run(); there is such a figure */
  Spread seconds(const std::string& group, const std::string& name) const {
    auto it = times_.seconds.find(group + '|' + name);
    return Spread(it == times_.seconds.end() ? std::vector<double>()
                                             : it->second);
  }

  /** @param unit of the items   @param bandwidth of the memory [GB/s], to which
   * figures with known bytes are compared */
  void print(const char* unit, double bandwidth) const {
    std::string group;
    for (const Figure& f : figures_) {
      if (f.group != group)
        std::printf("\n%-46s ns a %s (lowest-highest)   ratio\n",
                    (group = f.group).c_str(), unit);
      const Spread s = seconds(f.group, f.name);
      const double ns = 1e9 / f.items;
      std::printf("  %-44s %8.2f (%.2f-%.2f)", f.name.c_str(), ns * s.median,
                  ns * s.low, ns * s.high);
      if (const double r = ratio(f); r > 0)
        std::printf("   %.3f of %s", r, f.beside.c_str());
      if (f.bytes > 0)
        std::printf("; %.0f bytes: %.2f of the triad", f.bytes,
                    f.bytes / (ns * s.median) / bandwidth);
      std::printf("\n");
    }
  }

  /** Write the table as JSON.  Throws std::runtime_error */
  void write_json(const std::string& file) const {
    CME212::OutputFile out(file);
    std::ostringstream head;
    report::write_head(head, "bench");
    std::string about = head.str();
    std::replace(about.begin(), about.end(), '\n', ';');
    out.stream() << "{\"about\": \"" << report::cell(about)
                 << "\",\n \"real\": \""
                 << (sizeof(Real) == 8 ? "double" : "float")
                 << "\",\n \"figures\": [";
    out.stream().precision(10);
    const char* separator = "\n  ";
    for (const Figure& f : figures_) {
      const Spread s = seconds(f.group, f.name);
      out.stream() << separator << "{\"group\": \"" << f.group
                   << "\", \"name\": \"" << f.name
                   << "\", \"items\": " << f.items
                   << ", \"median_s\": " << s.median
                   << ", \"lowest_s\": " << s.low
                   << ", \"highest_s\": " << s.high;
      if (const double r = ratio(f); r > 0)
        out.stream() << ", \"beside\": \"" << f.beside
                     << "\", \"ratio\": " << r;
      out.stream() << '}';
      separator = ",\n  ";
    }
    out.stream() << "\n ]}\n";
    out.commit();
  }

 private:
  std::vector<Figure> figures_;
  Times times_;  // by key()

  static std::string key(const Figure& f) { return f.group + '|' + f.name; }

  /** The time of an item over that of the figure beside; 0: there is none. */
  double ratio(const Figure& f) const {
    const auto other = std::ranges::find_if(figures_, [&](const Figure& o) {
      return o.group == f.group && o.name == f.beside;
    });
    if (other == figures_.end()) return 0;
    const double beside = seconds(f.group, f.beside).median / other->items;
    return beside > 0 ? seconds(f.group, f.name).median / f.items / beside : 0;
  }
};

}  // namespace bench

}  // namespace lab
