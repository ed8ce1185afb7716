/** @file bench_implicit.cpp
 * What a step of mass-augmented Verlet costs, beside one force evaluation and
 * one solution with its matrix: the course's cloth with diagonals.
 *
 *   make bench_implicit
 *   build/bench_implicit --benchmark_min_time=1
 *
 * Steps and sweeps take turns, so that another program on the machine slows
 * both down: `sweeps` is how many of these a step costs. */
#include <chrono>
#include <map>
#include <vector>

#include "lab/bench/Bench.hpp"
#include "lab/methods/AugmentedVerlet.hpp"
#include "lab/methods/ImplicitEuler.hpp"
#include "lab/methods/ImplicitMidpoint.hpp"
#include "lab/methods/TrBdf2.hpp"

using namespace lab;

namespace {

/** Seconds that @a f() takes. */
template <typename F>
double seconds(F f) {
  using Clock = std::chrono::steady_clock;
  const auto start = Clock::now();
  f();
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/** The cloth of side x side nodes, and its factor. */
struct Course {
  static constexpr double dt = 1e-3;  // [s]
  Cloth g;
  ForcePlan force = make_combined_force(GravityForce(), MassSpringForce());
  ConstraintPlan pin;
  AugmentedVerlet method;
  double t = 0;

  explicit Course(unsigned side) {
    build_cloth(g, grid_points(side), grid_quads(side), Mesh::diagonals);
    pin = PinConstraint(g);
    step();  // makes the factor
  }
  void step() { t = method.step(g, t, dt, force, pin); }
};

void step(benchmark::State& state) {
  static std::map<unsigned, Course> made;  // a factor of 10^6 rows takes 20 s
  const auto side = unsigned(state.range(0));
  Course& c = made.try_emplace(side, side).first->second;
  FlatFlow flow;
  double sweeps = 0, steps = 0;
  for (auto _ : state) {
    sweeps += seconds([&] { flow.accelerate(c.g, c.t, c.force, true); });
    const double s = seconds([&] { c.step(); });
    steps += s;
    state.SetIterationTime(s);
  }
  state.counters["sweeps"] = steps / sweeps;
}

/** x of (M + dt^2/4 L) x = b. */
void solve(benchmark::State& state) {
  const int side = int(state.range(0)), n = side * side;
  const double mass = 1.0 / n, stiffness = 1e-6 / 4 * 100;
  std::vector<SparseCholesky<double>::Pair> pairs;
  for (const Quad& q : grid_quads(unsigned(side)))
    for (auto [a, b] : {std::pair(0, 1), {0, 2}, {0, 3}, {1, 2}})
      pairs.push_back({q[a], q[b]});
  SparseCholesky<double> factor;
  factor.analyze(unsigned(n), pairs, 100'000'000);
  for (unsigned i = 0; i < unsigned(n); ++i) factor.add_diagonal(i, mass);
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    factor.add_diagonal(pairs[k].i, stiffness);
    factor.add_diagonal(pairs[k].j, stiffness);
    factor.add(k, -stiffness);
  }
  factor.factorize();
  const std::vector<Point> b(unsigned(n), Point(1, -2, 3));
  std::vector<Point> x;
  for (auto _ : state) {
    x = b;
    state.SetIterationTime(seconds([&] { factor.solve(x); }));
  }
  state.counters["nonzeros_a_row"] = double(factor.entries()) / n;
}

void settings(benchmark::internal::Benchmark* b) {
  b->Unit(benchmark::kMillisecond)->UseManualTime()->Repetitions(7);
  b->ReportAggregatesOnly();
}
BENCHMARK(step)->Arg(50)->Arg(100)->Arg(316)->Arg(1000)->Apply(settings);
BENCHMARK(solve)->Arg(50)->Arg(100)->Arg(316)->Apply(settings);

}  // namespace

int main(int argc, char** argv) {
  return bench::main_of_registered(argc, argv);
}
