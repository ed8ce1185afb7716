/** @file bench.cpp
 * The cost of a step and of each of its layers, compared with the same loop
 * over flat arrays: lab/fast/README.md explains the table.
 *
 *   make bench CXXFLAGS=-march=native
 *   taskset -c 0 lab/bench/table.py build/bench
 *   lab/bench/table.py build/bench --sides 316 --filter step
 *
 * table.py runs bench [SIDE...] [--benchmark_...], which writes times as JSON.
 * One thread, unless the name has "threads". */
#include <benchmark/benchmark.h>

#include <cstdlib>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "lab/bench/Cloths.hpp"
#include "lab/fast/FlatFlow.hpp"
#include "lab/fast/Lanes.hpp"
#include "lab/fast/Sweep.hpp"
#include "lab/methods/RungeKutta.hpp"
#include "lab/methods/Splitting.hpp"
#include "lab/methods/SymplecticEuler.hpp"
#include "lab/stability/Guard.hpp"
#include "lab/stepping/Scene.hpp"

using namespace lab;
using bench::Flat, bench::Kind, bench::cloth, bench::flat, bench::shuffle;

namespace {

/** a = b + 3 c over three arrays of @a bytes in all: the memory's bandwidth. */
struct Triad {
  std::vector<double> a, b, c;
  explicit Triad(std::size_t bytes)
      : a(bytes / 24), b(bytes / 24, 1), c(bytes / 24, 2) {}
  void run() {
    const std::ptrdiff_t n = std::ptrdiff_t(a.size());
#ifdef _OPENMP
#pragma omp parallel for schedule(static)
#endif
    for (std::ptrdiff_t i = 0; i < n; ++i) a[i] = b[i] + 3 * c[i];
  }
};

// ----------------------------------------------------------- What is measured

constexpr double dt = 1e-7;  // [s]: the cloths hardly change

/** A call to be measured, at each size. */
struct Figure {
  std::string name, beside;  // the figure to which it is compared
  std::function<std::function<void()>(unsigned side)> make;
  bool million = true;     // also with 10^6 nodes
  double bytes = 0;        // moved through memory for a node, if known
  Kind kind = Kind::grid;  // of the cloth whose nodes are counted
  int threads = 1;
  int steps = 1;  // in one call
};

/** Makes a method take @a count steps on a cloth, by default as a scene. */
template <typename M, int count = Stepper::guard_interval>
std::function<std::function<void()>(unsigned)> stepping(Kind kind) {
  return [kind](unsigned side) -> std::function<void()> {
    const ForcePlan force =
        make_combined_force(GravityForce(), MassSpringForce());
    return [=, method = std::make_shared<M>(),
            times = std::make_shared<StepTimes>(StepTimes{0, dt}),
            none = ConstraintPlan(), &g = cloth(side, kind)] {
      times->done += method->steps(g, *times, count, force, none);
    };
  };
}

/** Makes what a stage of a step does with a cloth by component. */
std::function<void()> staging(unsigned side, const FlatStage& stage) {
  const auto force = std::make_shared<ForcePlan>(MassSpringForce());
  const auto flow = std::make_shared<FlatFlow>();
  flow->begin(cloth(side, Kind::grid), *force, false);
  return [force, flow, stage] { flow->run(stage); };
}

/** A loop over the nodes through Node and Edge. */
template <typename Use>
std::function<void()> by_node(unsigned side, Kind kind, Use use) {
  auto f = std::make_shared<std::vector<Point>>(cloth(side, kind).num_nodes());
  Cloth& g = cloth(side, kind);
  return [=, &g] {
    std::size_t i = 0;
    for (Node n : g.nodes()) (*f)[i++] = use(n);
    benchmark::DoNotOptimize(f->data());
    benchmark::ClobberMemory();
  };
}
constexpr auto springs_of = [](Node n) {  // inlined, as in a program
  Point f;
  for (Edge e : n.edges())
    f += spring_force(e.node2().position() - n.position(), e.value());
  return f;
};

std::vector<Figure> figures() {
  using Make = std::function<void()>;
  std::vector<Figure> all;
  auto add = [&](Figure f) { all.push_back(std::move(f)); };

  // Whole steps of symplectic Euler: gravity and springs, no constraint.
  for (Kind kind : {Kind::grid, Kind::mixed}) {
    const std::string of = kind == Kind::grid ? "" : ", mixed";
    add({"step: flat arrays" + of, "",
         [kind](unsigned n) -> Make {
           return [&a = flat(n, kind)] { a.step(dt); };
         },
         true, 0, kind});
    add({"step: SymplecticEuler" + of, "step: flat arrays" + of,
         stepping<SymplecticEuler>(kind), true,
         sizeof(double) * (6 + 6 + 1 + (kind == Kind::grid ? 8 : 16.0)) +
             (kind == Kind::grid ? 0 : 32),
         kind, 1, Stepper::guard_interval});
  }
  add({"step: SymplecticEuler, shuffled", "step: SymplecticEuler",
       stepping<SymplecticEuler>(Kind::shuffled), true, 0, Kind::shuffled, 1,
       Stepper::guard_interval});
  add({"step: Verlet", "step: flat arrays", stepping<Verlet>(Kind::grid), true,
       0, Kind::grid, 1, Stepper::guard_interval});
  add({"step: Rk4", "step: flat arrays", stepping<Rk4>(Kind::grid), true, 0,
       Kind::grid, 1, Stepper::guard_interval});
  add({"step: symp_euler_step(), functor", "step: flat arrays",
       [](unsigned n) -> Make {
         return [&g = cloth(n, Kind::grid)] {
           symp_euler_step(g, 0, dt, [](Node node, double) {
             return springs_of(node) + Point(0, 0, -node.value().mass * grav);
           });
         };
       }});
  add({"step: SymplecticEuler, one at a time", "step: SymplecticEuler",
       stepping<SymplecticEuler, 1>(Kind::grid)});
  add({"step: scene of the assignment", "step: SymplecticEuler",
       [](unsigned n) -> Make {
         auto scene = std::make_shared<Scene>(
             assignment_scene(), Net{grid_points(n), grid_quads(n)},
             TimeStep{.dt = dt}, *default_method());
         return [scene] { scene->steps_at_once(Stepper::guard_interval); };
       },
       false, 0, Kind::grid, 1, Stepper::guard_interval});
  if (Sweep::processors() > 1)
    add({"step: SymplecticEuler, threads", "step: SymplecticEuler",
         stepping<SymplecticEuler>(Kind::grid), true, 0, Kind::grid,
         Sweep::processors(), Stepper::guard_interval});

  // The springs' forces, layer by layer.
  for (auto [kind, of] : {std::pair(Kind::grid, std::string()),
                          {Kind::torn, ", torn"},
                          {Kind::reindexed, ", reindexed"}}) {
    add({"springs: flat arrays" + of, "",
         [kind = kind](unsigned n) -> Make {
           return [&a = flat(n, kind)] { a.forces(); };
         },
         true, 0, kind});
    add({"springs: Node and Edge" + of, "springs: flat arrays" + of,
         [kind = kind](unsigned n) { return by_node(n, kind, springs_of); },
         true, 0, kind});
  }
  add({"springs: sweep", "springs: flat arrays", [](unsigned n) {
         return staging(n, {.t = 0, .kick = 0, .keep = true});
       }});

  // The check of a scene after every 32nd step.
  add({"part: guard", "step: Verlet",
       [](unsigned n) -> Make {
         Cloth& g = cloth(n, Kind::grid);
         return
             [&g, guard = std::make_shared<DivergenceGuard>(g, grav, 0.001)] {
               benchmark::DoNotOptimize(guard->accept(g));
             };
       },
       false});
  // From the text of two files to a cloth.
  add({"loading: text to numbers", "", [](unsigned n) -> Make {
         std::string nodes, tets;
         for (const Point& p : grid_points(n))
           nodes += CME212::to_text(p.x) + ' ' + CME212::to_text(p.y) + " 0\n";
         for (const Quad& q : grid_quads(n)) {
           for (unsigned i : q) tets += std::to_string(i) + ' ';
           tets += '\n';
         }
         return [nodes, tets] {
           const auto points = parse_points(nodes, "nodes");
           benchmark::DoNotOptimize(parse_quads(tets, "tets", points.size()));
         };
       }});
  for (bool shuffled : {false, true})
    add({shuffled ? "loading: build_cloth(), shuffled"
                  : "loading: build_cloth()",
         "", [shuffled](unsigned n) -> Make {
           auto points = grid_points(n);
           auto quads = grid_quads(n);
           if (shuffled) shuffle(points, quads);
           return [points, quads] {
             Cloth g;
             build_cloth(g, points, quads, MeshSprings::diagonals);
             benchmark::DoNotOptimize(g.num_edges());
           };
         }});
  add({"new layout", "springs: sweep", [](unsigned n) -> Make {
         return [none = Drag(), &g = cloth(n, Kind::grid)] {
           FlatCloth().take(g, 1, none);
         };
       }});
  return all;
}

/** Let it be measured on a cloth of @a side x @a side nodes. */
void add(const Figure& f, unsigned side) {
  const std::string group =
      std::to_string(side * side) + " nodes with diagonals";
  auto measure = [=, call = std::function<void()>()](
                     benchmark::State& state) mutable {
    Sweep::set_threads(f.threads);
    if (!call) call = f.make(side);
    call();  // fills the caches, and allocates
    for (auto _ : state) {
      call();
      benchmark::ClobberMemory();
    }
    state.counters["items"] = double(f.steps) * cloth(side, f.kind).num_nodes();
    state.counters["bytes"] = side > 100 ? f.bytes : 0;
    state.SetLabel(f.beside);
  };
  benchmark::RegisterBenchmark((group + '|' + f.name).c_str(), measure);
}
void add_triad(const char* name, std::size_t bytes, int threads) {
  const auto measure = [=](benchmark::State& state) {
    Triad triad(bytes);
    Sweep::set_threads(threads);
    for (auto _ : state) {
      triad.run();
      benchmark::ClobberMemory();
    }
    state.counters["items"] = double(triad.a.size());
  };
  benchmark::RegisterBenchmark(
      (std::string("triad, three arrays of doubles|") + name).c_str(), measure);
}

}  // namespace

int main(int argc, char** argv) {
  lanes::cpu = lanes::fastest_cpu();
  benchmark::Initialize(&argc, argv);
  benchmark::AddCustomContext("kernels", lanes::name_of(lanes::cpu));
  add_triad("in the cache", 1 << 19, 1);
  add_triad("in memory", std::size_t(192) << 20, 1);
  if (Sweep::processors() > 1)
    add_triad("in memory, all threads", std::size_t(192) << 20,
              Sweep::processors());
  for (int k = 1; k < argc; ++k)
    for (const Figure& f : figures()) add(f, unsigned(std::atoi(argv[k])));
  for (unsigned side : {25u, 100u, 1000u})  // 25: grid1, whole steps only
    for (const Figure& f : figures())
      if (argc == 1 && (side >= 100 || f.name.starts_with("step: ")) &&
          (side <= 100 || f.million))
        add(f, side);
  benchmark::RunSpecifiedBenchmarks();
}
