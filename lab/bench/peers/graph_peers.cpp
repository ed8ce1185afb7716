/** @file graph_peers.cpp
 * Compares Graph with the graphs of Boost and LEMON. Prints tables of Markdown:
 *   make peers-deps peers-bench
 * README.md beside explains each row. */
#include "lab/bench/Bench.hpp"
#include "lab/bench/peers/contenders.hpp"

#include <malloc.h>

#include <array>
#include <cstdio>
#include <ctime>
#include <functional>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>

using namespace lab;
using bench::Spread;

namespace {

// -------------------------------------------------------------- Measurements

/** Time that the processor spent on this program [s]. */
double now() {
  timespec t;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return double(t.tv_sec) + 1e-9 * double(t.tv_nsec);
}
/** One run of @a f [s]. */
template <typename F>
double time_of(F f) {
  double start = now();
  f();
  benchmark::ClobberMemory();
  return now() - start;
}

/** The graph of a contender, built once for all that only reads it. */
template <typename C>
C& built() {
  static C* c = nullptr;
  if (!c) {
    c = new C;
    c->build(square.springs, false);
  }
  return *c;
}

template <typename C>
concept CanMakeRoom = requires(C& c) {
  c.make_room();
};

template <typename C>
double time_of_build(bool by_quad, bool in_room = false) {
  C c;
  return time_of([&] {
    if constexpr (CanMakeRoom<C>)
      if (in_room) c.make_room();
    c.build(by_quad ? square.quad_sides : square.springs, by_quad);
  });
}
template <typename C>
double time_of_removal() {
  C c;
  c.build(square.springs, false);
  return time_of([&] { c.remove(square.doomed); });
}

std::string program;  // as it was called

/** The time of the first build of a new process.
 * @param how "first" or "first-in-room" */
template <typename C>
double time_of_first_build(const std::string& how) {
  FILE* p = popen((program + " --" + how + " '" + C::name + "'").c_str(), "r");
  double seconds = 0;
  if (!p || std::fscanf(p, "%lf", &seconds) != 1 || pclose(p) != 0)
    throw std::runtime_error("can't run " + program);
  return seconds;
}

/** One more measurement of a table: @a run gives the time of one run [s]. */
void add(const char* row, const char* column, std::function<double()> run) {
  benchmark::RegisterBenchmark((std::string(row) + '/' + column).c_str(),
                               [run](benchmark::State& state) {
                                 for (auto _ : state)
                                   state.SetIterationTime(run());
                               })
      ->UseManualTime()
      ->Repetitions(15);
}

/** All that contender C can do. */
template <typename C>
void add_all() {
  if constexpr (requires { &C::count; }) {
    add("build, each edge once", C::name, [] { return time_of_build<C>(0); });
    add("build, quad by quad", C::name, [] { return time_of_build<C>(1); });
    add("build, first of a process", C::name,
        [] { return time_of_first_build<C>("first"); });
    add("has_edge", C::name, [] {
      return time_of([&c = built<C>()] {
        benchmark::DoNotOptimize(c.count(square.questions));
      });
    });
  }
  if constexpr (CanMakeRoom<C>) {
    add("build, in room made first", C::name,
        [] { return time_of_build<C>(0, true); });
    add("build, first of a process, in room", C::name,
        [] { return time_of_first_build<C>("first-in-room"); });
  }
  add("force on each node", C::name, [] {
    static std::vector<Point> f(square.points.size());
    return time_of([&c = built<C>()] { c.forces(f); });
  });
  add("all edges", C::name, [] {
    return time_of([&c = built<C>()] { benchmark::DoNotOptimize(c.energy()); });
  });
  if constexpr (requires { &C::remove; })
    add("remove half of the nodes", C::name, time_of_removal<C>);
}

/** Bytes that malloc has handed out. */
std::size_t bytes_in_use() {
  auto m = mallinfo2();
  return m.uordblks + m.hblkhd;
}

/** What a graph takes, the handles that the user keeps aside. */
template <typename C>
std::array<double, 2> bytes_per_node_and_edge() {
  auto bytes_of = [](const std::vector<Pair>& edges) {
    std::size_t before = bytes_in_use();
    C c;
    c.build(edges, false);
    if constexpr (requires { c.node; }) decltype(c.node)().swap(c.node);
    return double(bytes_in_use() - before);
  };
  double nodes = bytes_of({}), all = bytes_of(square.springs);
  return {nodes / double(square.points.size()),
          (all - nodes) / double(square.springs.size())};
}

// -------------------------------------------------------------------- Tables

void print_head(const char* corner, const std::vector<std::string>& columns) {
  std::printf("\n| %s |", corner);
  for (const auto& column : columns) std::printf(" %s |", column.c_str());
  std::printf("\n|---|");
  for (std::size_t i = 0; i < columns.size(); ++i) std::printf("---|");
  std::printf("\n");
}
/** A row of Markdown for each of @a rows: our median, then for each other
 * column the ratio of its median to ours, and the lowest and the highest ratio
 * of all repetitions. */
void print(bench::Times& times, const std::vector<std::string>& rows,
           const std::vector<std::string>& columns) {
  print_head("", columns);
  for (const auto& row : rows) {
    const auto& ours = times.seconds[row + "/ours"];
    if (ours.empty()) continue;
    std::printf("| %s | %.0f us |", row.c_str(), 1e6 * Spread(ours).median);
    for (const auto& column : columns) {
      if (column == "ours") continue;
      const auto& theirs = times.seconds[row + '/' + column];
      std::vector<double> ratio;
      for (std::size_t k = 0; k < theirs.size(); ++k)
        ratio.push_back(theirs[k] / ours[k]);
      if (ratio.empty())
        std::printf(" |");
      else
        std::printf(" %.2f (%.2f-%.2f) |",
                    Spread(theirs).median / Spread(ours).median,
                    Spread(ratio).low, Spread(ratio).high);
    }
    std::printf("\n");
  }
}

using BoostVec = Boost<boost::vecS, boost::vecS>;
using BoostSet = Boost<boost::setS, boost::listS>;
using Smart = Lemon<lemon::SmartGraph>;
using List = Lemon<lemon::ListGraph>;

/** Call @a f with each graph's type. */
template <typename F>
void each_graph(F f) {
  f(std::type_identity<Ours>());
  f(std::type_identity<BoostVec>());
  f(std::type_identity<BoostSet>());
  f(std::type_identity<Smart>());
  f(std::type_identity<List>());
}

}  // namespace

/** graph_peers [--benchmark_...], or --first NAME or --first-in-room NAME:
 * build one, print [s]. */
int main(int argc, char** argv) {
  if (argc == 3 && std::string(argv[1]).starts_with("--first")) {
    each_graph([&]<typename C>(std::type_identity<C>) {
      if (argv[2] != std::string(C::name)) return;
      std::printf("%g\n", time_of_build<C>(
                              0, argv[1] == std::string("--first-in-room")));
    });
    return 0;
  }
  program = argv[0];
  Sweep::set_threads(1);  // as the peers have
  std::vector<std::array<double, 2>> memory;
  each_graph([&]<typename C>(std::type_identity<C>) {
    memory.push_back(bytes_per_node_and_edge<C>());
  });
  // Memory that a graph gave back stays with the program for the next one:
  // what the system takes to hand out pages is in the row of first builds.
  mallopt(M_TRIM_THRESHOLD, 1 << 30);
  mallopt(M_MMAP_THRESHOLD, 1 << 30);

  each_graph([]<typename C>(std::type_identity<C>) { add_all<C>(); });
  add_all<Flat>();
  std::vector<std::string> options(argv + 1, argv + argc);
  options.insert(options.begin(), "--benchmark_min_time=0.02");
  bench::Times times;
  times.run(options);

  std::vector<std::string> graphs;
  each_graph(
      [&]<typename C>(std::type_identity<C>) { graphs.push_back(C::name); });
  auto all = graphs;
  all.push_back(Flat::name);
  print(times,
        {"force on each node", "all edges", "build, each edge once",
         "build, quad by quad", "build, in room made first",
         "build, first of a process", "build, first of a process, in room",
         "has_edge", "remove half of the nodes"},
        all);
  print_head("bytes", graphs);
  for (int k : {0, 1}) {
    std::printf("| %s |", k == 0 ? "a node" : "an edge");
    for (auto m : memory) std::printf(" %.0f |", m[std::size_t(k)]);
    std::printf("\n");
  }
}
