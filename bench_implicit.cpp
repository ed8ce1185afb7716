/** @file bench_implicit.cpp
 * What a step of mass-augmented Verlet costs, beside one force sweep: the
 * course's cloth with diagonals. The time of a step over that of a sweep, the
 * counter `sweeps`, is that of the medians only in a quiet moment: compare the
 * lines of a run that was interleaved.
 *
 *   make bench_implicit
 *   ./bench_implicit --benchmark_enable_random_interleaving=true
 */
#include <benchmark/benchmark.h>

#include <vector>

#include "Implicit.hpp"

namespace {

/** The cloth of side x side nodes that is asked for, and a method that has its
 * factor. */
struct Course {
  Cloth g;
  CombinedForces force = make_combined_force(GravityForce(), MassSpringForce());
  explicit Course(const benchmark::State& state) {
    const auto side = unsigned(state.range(0));
    build_cloth(g, grid_points(side), grid_quads(side), Mesh::diagonals);
  }
};

void sweep(benchmark::State& state) {
  Course c(state);
  std::vector<Point> f;
  for (auto _ : state) {
    integrator_detail::sweep(c.g, 0, c.force, f);
    benchmark::DoNotOptimize(f.data());
  }
}

void step(benchmark::State& state) {
  Course c(state);
  PinConstraint pin(c.g);
  AugmentedVerlet method;
  double t = method.step(c.g, 0, 1e-3, c.force, pin);  // with a factor
  for (auto _ : state) t = method.step(c.g, t, 1e-3, c.force, pin);
}
void settings(benchmark::internal::Benchmark* b) {
  for (int side : {50, 100, 316, 1000}) b->Arg(side);
  b->Unit(benchmark::kMillisecond)->Repetitions(7);
}
BENCHMARK(sweep)->Apply(settings);
BENCHMARK(step)->Apply(settings);
}  // namespace

BENCHMARK_MAIN();
