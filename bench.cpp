/** @file bench.cpp
 * Throughput of the graph: the loop over all springs of a square cloth, once
 * through Node and Edge, once over flat arrays made by hand for that loop.
 *
 *   make bench
 *   ./bench --benchmark_enable_random_interleaving=true \
 *           --benchmark_min_time=0.1
 *
 * Graphs: side x side nodes, the four sides and both diagonals of each quad;
 *   whole     as built
 *   torn      after a random half of the nodes was removed
 *   reindexed torn, then Graph::reindex()
 * The flat arrays hold the same graph in the order of the ids. */
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <map>
#include <random>
#include <utility>
#include <vector>

#include "Graph.hpp"

namespace {

struct NodeData {
  Point vel;
  double mass = 1;
};
struct EdgeData {
  double K = 100;  // [N/m]
  double L = 0;    // [m]
};
using Cloth = Graph<NodeData, EdgeData>;

enum class Kind { whole, torn, reindexed };

void add_spring(Cloth& g, unsigned i, unsigned j) {
  Cloth::Edge e = g.add_edge(g.node(i), g.node(j));
  e.value() = {100, 0.9 * e.length()};
}

void build(Cloth& g, unsigned side, Kind kind) {
  for (unsigned r = 0; r < side; ++r)
    for (unsigned c = 0; c < side; ++c)
      g.add_node(Point(double(c) / side, double(r) / side, 0));
  for (unsigned r = 0; r < side; ++r)
    for (unsigned c = 0; c < side; ++c) {
      unsigned n = r * side + c;
      bool right = c + 1 < side, down = r + 1 < side;
      if (right) add_spring(g, n, n + 1);
      if (down) add_spring(g, n, n + side);
      if (right && down) {
        add_spring(g, n, n + side + 1);
        add_spring(g, n + 1, n + side);
      }
    }
  if (kind == Kind::whole) return;
  std::vector<Cloth::Node> nodes(g.node_begin(), g.node_end());
  std::shuffle(nodes.begin(), nodes.end(), std::mt19937(212));
  for (std::size_t k = 0; k < nodes.size() / 2; ++k) g.remove_node(nodes[k]);
  if (kind == Kind::reindexed) g.reindex();
}

/** One graph of each sort for all benchmarks: both loops see the same one. */
const Cloth& cloth(unsigned side, Kind kind) {
  static std::map<std::pair<unsigned, Kind>, Cloth> made;
  auto [it, is_new] = made.try_emplace({side, kind});
  if (is_new) build(it->second, side, kind);
  return it->second;
}

/** Force on x by a spring to y [N]. */
inline Point pull(const Point& x, const Point& y, double K, double L) {
  Point u = y - x;
  double l = norm(u);
  return K * (l - L) / l * u;
}

/** The loop as a student writes it. */
struct Proxies {
  explicit Proxies(const Cloth& cloth) : g(cloth), force(g.num_nodes()) {}
  void operator()() {
    std::size_t i = 0;
    for (auto n : g.nodes()) {
      Point f;
      for (auto e : n.edges())
        f += pull(n.position(), e.node2().position(), e.value().K, e.value().L);
      force[i++] = f;
    }
  }
  const Cloth& g;
  std::vector<Point> force;  // by index
};

/** The same over arrays that hold nothing else, in the order of the loop. */
struct Flat {
  explicit Flat(const Cloth& g) : row{0}, force(g.num_nodes()) {
    std::vector<unsigned> place(g.node_slots());
    for (unsigned id = 0, i = 0; id < g.node_slots(); ++id)
      if (g.node_in_use(id)) place[id] = i++;
    for (unsigned id = 0; id < g.node_slots(); ++id) {
      if (!g.node_in_use(id)) continue;
      auto n = g.node_with_id(id);
      position.push_back(n.position());
      for (auto e : n.edges()) {
        neighbor.push_back(place[e.node2().id()]);
        K.push_back(e.value().K);
        L.push_back(e.value().L);
      }
      row.push_back(unsigned(neighbor.size()));
    }
  }
  void operator()() {
    for (std::size_t i = 0; i < position.size(); ++i) {
      Point f;
      for (unsigned k = row[i]; k < row[i + 1]; ++k)
        f += pull(position[i], position[neighbor[k]], K[k], L[k]);
      force[i] = f;
    }
  }
  std::vector<Point> position;
  std::vector<unsigned> row, neighbor;
  std::vector<double> K, L;
  std::vector<Point> force;
};

template <typename Loop, Kind kind>
void spring_loop(benchmark::State& state) {
  Loop loop(cloth(unsigned(state.range(0)), kind));
  for (auto _ : state) {
    loop();
    benchmark::DoNotOptimize(loop.force.data());
    benchmark::ClobberMemory();
  }
  state.SetItemsProcessed(state.iterations() * std::int64_t(loop.force.size()));
}

void settings(benchmark::internal::Benchmark* b) {
  b->Arg(100)->Arg(1000)->Unit(benchmark::kMicrosecond)->Repetitions(11);
}
BENCHMARK_TEMPLATE(spring_loop, Proxies, Kind::whole)->Apply(settings);
BENCHMARK_TEMPLATE(spring_loop, Flat, Kind::whole)->Apply(settings);
BENCHMARK_TEMPLATE(spring_loop, Proxies, Kind::torn)->Apply(settings);
BENCHMARK_TEMPLATE(spring_loop, Flat, Kind::torn)->Apply(settings);
BENCHMARK_TEMPLATE(spring_loop, Proxies, Kind::reindexed)->Apply(settings);
BENCHMARK_TEMPLATE(spring_loop, Flat, Kind::reindexed)->Apply(settings);

}  // namespace

BENCHMARK_MAIN();
