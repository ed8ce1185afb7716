/** @file bench_solvers.cpp
 * Finds where a Cholesky factor takes less time than conjugate gradients: one
 * step of implicit Euler, which is one linear system, on a sheet of 100 x 100
 * nodes with diagonals that has fallen for 1/3 s.
 *
 *   make solver-chart
 *   build/bench_solvers [REPEATS] > solvers.csv
 *
 * All runs take turns; the first one of each is not counted. */
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <memory>
#include <vector>

#include "lab/fast/Sweep.hpp"
#include "lab/methods/ImplicitEuler.hpp"
#include "lab/stability/Spectrum.hpp"

using namespace lab;
using implicit_detail::LinearSolver;

namespace {

constexpr unsigned side = 100;

struct Sheet {
  Cloth g;
  ForcePlan force = make_combined_force(GravityForce(), MassSpringForce());
  ConstraintPlan pin;
  std::vector<Point> x;
  std::vector<NodeData> node;
  double omega;  // [1/s]

  explicit Sheet(double K) {
    build_cloth(g, grid_points(side), grid_quads(side), MeshSprings::diagonals,
                K);
    pin = PinConstraint(g);
    omega = omega_safe(g, force, pin);
    ImplicitEuler fall;
    for (int n = 0; n < 20; ++n) fall.step(g, n / 60., 1 / 60., force, pin);
    x.assign(g.positions().begin(), g.positions().end());
    node.assign(g.node_values().begin(), g.node_values().end());
  }
  /** A step from 1/3 s.  @return the seconds that it takes */
  double step(Method& method, double dt) {
    std::ranges::copy(x, g.positions().begin());
    std::ranges::copy(node, g.node_values().begin());
    using Clock = std::chrono::steady_clock;
    const auto start = Clock::now();
    method.step(g, 1 / 3., dt, force, pin);
    return std::chrono::duration<double>(Clock::now() - start).count();
  }
};

struct Case {
  const char* solver;
  LinearSolver kind;
  double tolerance, dt;
  std::unique_ptr<ImplicitEuler> method = {};
  Work work = {};
  std::vector<double> seconds = {};
};

void measure(double K, int repeats) {
  Sheet sheet(K);
  std::vector<double> steps = {1. / 60};
  for (double x = 1; x < 4e4; x *= 2) steps.push_back(x / sheet.omega);
  std::ranges::sort(steps);
  std::vector<Case> cases;
  for (double dt : steps)
    for (double tolerance : {1e-8, 1e-3}) {
      cases.push_back({"gradients", LinearSolver::gradients, tolerance, dt});
      cases.push_back({"automatic", LinearSolver::automatic, tolerance, dt});
      if (tolerance == 1e-8)
        cases.push_back({"cholesky", LinearSolver::cholesky, tolerance, dt});
    }
  for (int r = 0; r <= repeats; ++r)
    for (Case& c : cases) {
      if (r == 0) {
        c.method = std::make_unique<ImplicitEuler>(c.tolerance);
        c.method->use(c.kind);
      }
      const Work before = c.method->work();
      const double seconds = sheet.step(*c.method, c.dt);
      c.work.products = c.method->work().products - before.products;
      c.work.factors = c.method->work().factors - before.factors;
      if (r > 0) c.seconds.push_back(seconds);
      if (r == repeats) std::ranges::sort(c.seconds);
    }
  for (const Case& c : cases)
    std::printf("%g,%.6g,%.6g,%s,%g,%lld,%lld,%.4g,%.4g,%.4g\n", K,
                c.dt * sheet.omega, c.dt, c.solver, c.tolerance,
                c.work.products, c.work.factors, c.seconds.front(),
                c.seconds[c.seconds.size() / 2], c.seconds.back());
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  Sweep::set_threads(1);
  const int repeats = argc > 1 ? std::atoi(argv[1]) : 5;
  if (repeats < 1) {
    std::cerr << "usage: bench_solvers [REPEATS], 1 or more; 5 if left out\n";
    return 2;
  }
  std::puts(
      "K,dt_omega,dt,solver,tolerance,products,factors,seconds_min,"
      "seconds_median,seconds_max");
  for (double K : {1e4, 1e6, 1e8}) measure(K, repeats);
}
