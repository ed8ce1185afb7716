/** @file bench_stability.cpp
 * What the estimates of the largest step and the guard cost, beside one force
 * evaluation and one step of Verlet: the course's cloth with diagonals, at
 * rest.
 *
 *   make bench_stability
 *   build/bench_stability --benchmark_enable_random_interleaving=true
 *
 * The guard looks at every 32nd step, and who chooses a step at every 16th. */
#include <vector>

#include "lab/bench/Bench.hpp"
#include "lab/methods/Verlet.hpp"
#include "lab/stability/Guard.hpp"
#include "lab/stability/Spectrum.hpp"
#include "lab/stability/StepLimit.hpp"

using namespace lab;

namespace {

/** The cloth of side x side nodes that is asked for. */
struct Course {
  Cloth g;
  ForcePlan force = make_combined_force(GravityForce(), MassSpringForce());
  explicit Course(const benchmark::State& state) {
    const auto side = unsigned(state.range(0));
    build_cloth(g, grid_points(side), grid_quads(side), Mesh::diagonals);
  }
};

void sweep(benchmark::State& state) {
  Course c(state);
  FlatFlow flow;
  for (auto _ : state) flow.accelerate(c.g, 0, c.force, true);
}

void verlet_step(benchmark::State& state) {
  Course c(state);
  const ConstraintPlan pin = PinConstraint(c.g);
  Verlet verlet;
  // so short that the cloth stays where it is
  for (auto _ : state) verlet.step(c.g, 0, 1e-9, c.force, pin);
}

void sharp_estimate(benchmark::State& state) {
  Course c(state);
  const ConstraintPlan pin = PinConstraint(c.g);
  SharpOmega sharp;
  for (auto _ : state) benchmark::DoNotOptimize(sharp(c.g, c.force, pin));
}

void safe_estimate(benchmark::State& state) {
  Course c(state);
  const ConstraintPlan pin = PinConstraint(c.g);
  for (auto _ : state) benchmark::DoNotOptimize(omega_safe(c.g, c.force, pin));
}

void cheap_estimate(benchmark::State& state) {
  Course c(state);
  const ConstraintPlan pin = PinConstraint(c.g);
  for (auto _ : state)
    benchmark::DoNotOptimize(omega_gershgorin(c.g, c.force, pin));
}

void guard_look(benchmark::State& state) {
  Course c(state);
  DivergenceGuard guard(c.g, grav, 0.001);
  for (auto _ : state) benchmark::DoNotOptimize(guard.accept(c.g));
}

void settings(benchmark::internal::Benchmark* b) {
  b->Arg(25)->Arg(100)->Unit(benchmark::kMicrosecond)->Repetitions(7);
}
BENCHMARK(sweep)->Apply(settings);
BENCHMARK(verlet_step)->Apply(settings);
BENCHMARK(sharp_estimate)->Apply(settings);
BENCHMARK(safe_estimate)->Apply(settings);
BENCHMARK(cheap_estimate)->Apply(settings);
BENCHMARK(guard_look)->Apply(settings);

}  // namespace

int main(int argc, char** argv) {
  return bench::main_of_registered(argc, argv);
}
