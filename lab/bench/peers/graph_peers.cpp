/** @file graph_peers.cpp
 * Measures Graph and the graphs of Boost and LEMON by Google Benchmark;
 * graphs.py prints the tables of README.md, which explains each row:
 *   make peers-deps peers-bench */
#include <benchmark/benchmark.h>
#include <malloc.h>

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "lab/bench/peers/contenders.hpp"
#include "lab/fast/Sweep.hpp"

using namespace lab;

namespace {

/** Bytes that malloc has handed out. */
std::size_t bytes_in_use() {
  auto m = mallinfo2();
  return m.uordblks + m.hblkhd;
}

/** The memory of a graph per node and per edge, without the handles that its
 * user keeps. */
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

template <typename C>
void add_row(const char* name, std::function<void(benchmark::State&)> measure) {
  benchmark::RegisterBenchmark((std::string(name) + '/' + C::name).c_str(),
                               measure);
}
/** Measure @a use on a graph with all nodes and edges. */
template <typename C>
void add_built(const char* name, std::function<void(C&)> use) {
  add_row<C>(name, [use](benchmark::State& state) {
    C c;
    c.build(square.springs, false);
    for (auto _ : state) use(c);
  });
}
/** Measure @a use on a new graph, for which @a prepare was called. */
template <typename C>
void add_new(
    const char* name, std::function<void(C&)> use,
    std::function<void(C&)> prepare = [](C&) {}) {
  add_row<C>(name, [=](benchmark::State& state) {
    for (auto _ : state) {
      state.PauseTiming();
      auto c = std::make_unique<C>();
      prepare(*c);
      state.ResumeTiming();
      use(*c);
      benchmark::ClobberMemory();
      state.PauseTiming();
      c.reset();
      state.ResumeTiming();
    }
  });
}

/** All that contender C can do. */
template <typename C>
void add_all() {
  auto build = [](C& c) { c.build(square.springs, false); };
  add_built<C>("force on each node", [](C& c) {
    static std::vector<Point> f(square.points.size());
    c.forces(f);
    benchmark::ClobberMemory();
  });
  add_built<C>("all edges", [](C& c) { benchmark::DoNotOptimize(c.energy()); });
  add_new<C>("build, each edge once", build);
  add_new<C>("build, quad by quad",
             [](C& c) { c.build(square.quad_sides, true); });
  if constexpr (requires(C & c) { c.make_room(); })
    add_new<C>("build, in room made first", [=](C& c) {
      c.make_room();
      build(c);
    });
  add_built<C>("has_edge", [](C& c) {
    benchmark::DoNotOptimize(c.count(square.questions));
  });
  if constexpr (requires { &C::remove; })
    add_new<C>(
        "remove half of the nodes", [](C& c) { c.remove(square.doomed); },
        build);
  add_row<C>("bytes", [](benchmark::State& state) {
    for (auto _ : state) continue;
    const auto [node, edge] = bytes_per_node_and_edge<C>();
    state.counters["a node"] = node;
    state.counters["an edge"] = edge;
  });
}

}  // namespace

int main(int argc, char** argv) {
  Sweep::set_threads(1);  // as the peers have
  // Memory that a graph gave back stays with the program for the next one.
  mallopt(M_TRIM_THRESHOLD, 1 << 30);
  mallopt(M_MMAP_THRESHOLD, 1 << 30);
  add_all<Ours>();
  add_all<Boost>();
  add_all<Lemon>();
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
}
