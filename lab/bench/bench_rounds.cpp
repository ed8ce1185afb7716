/** @file bench_rounds.cpp
 * How near a step of 1/60 s comes to that of implicit Euler and to the true
 * motion, by the number of rounds: on sheets that have fallen for 0.2 s. Counts
 * no time, but instructions: rounds.py.
 *
 *   build/bench_rounds SIDE K                 # all methods and rounds, as CSV
 *   build/bench_rounds SIDE K METHOD ROUNDS   # measured(), for callgrind
 *
 * Verlet makes ROUNDS steps, mollified-impulse ROUNDS inner steps. K may be
 * mixed, the problem of the charts.
 */
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <memory>
#include <string>

#include "lab/charts/Problem.hpp"
#include "lab/fast/GraphArrays.hpp"
#include "lab/fast/Sweep.hpp"
#include "lab/methods/ImplicitStage.hpp"
#include "lab/methods/Methods.hpp"
#include "lab/methods/Splitting.hpp"
#include "lab/methods/StiffSplit.hpp"
#include "lab/methods/Xpbd.hpp"
#include "lab/stability/Spectrum.hpp"

using namespace lab;
using implicit_detail::LinearSolver;

namespace {

constexpr double frame = 1 / 60.;  // [s]

/** Implicit Euler by so many iterations of Newton's method without a line
 * search; with 0, until it has converged. */
class Newton : public Method {
 public:
  explicit Newton(int rounds, LinearSolver solver = LinearSolver::automatic)
      : rounds_(rounds), stage_(rounds ? 1e-3 : 1e-8, 1000) {
    stage_.use(solver);
  }
  double step(Cloth& g, double t, double dt, const ForcePlan& force,
              const ConstraintPlan& constraint) override {
    auto& stage = stage_.begin("newton", t, dt, g, force, constraint);
    if (rounds_ == 0) stage.solve_newton(t + dt, dt);
    for (int k = 0; k < rounds_; ++k) stage.solve_linearized(t + dt, dt);
    return stage.finish();
  }
  Work work() const override { return stage_.work(); }

 private:
  int rounds_;
  implicit_detail::ImplicitStage stage_;
};

std::unique_ptr<Method> make(const std::string& name, int rounds) {
  if (name == "xpbd") return std::make_unique<Xpbd>(rounds);
  if (name == "newton-gradients")
    return std::make_unique<Newton>(rounds, LinearSolver::gradients);
  if (name == "newton-factor")
    return std::make_unique<Newton>(rounds, LinearSolver::cholesky);
  if (const MethodEntry* entry = find_method(name)) return entry->make();
  throw std::runtime_error("there is no method " + name);
}

[[gnu::noinline]] void measured(Method& method, Start& s, double dt = frame,
                                int steps = 1) {
  method.steps(s.cloth, {0.2, dt}, steps, s.force, s.constraint);
}

void compare(const Problem& p, double K) {
  Start s(p);
  const double omega = omega_safe(s.cloth, s.force, s.constraint);
  Verlet verlet;
  auto move = [&](double t, double time) {  // by half of its limit
    const double n = std::ceil(time * omega);
    for (double k = 0; k < n; ++k)
      verlet.step(s.cloth, t + k * time / n, time / n, s.force, s.constraint);
    return end_of(s);
  };
  const End start = move(0, 0.2);
  const auto node = arrays(s.cloth).node_values();
  const std::vector<NodeData> values(node.begin(), node.end());
  auto end_by = [&](Method& method) {
    std::ranges::copy(start.positions, arrays(s.cloth).positions().begin());
    std::ranges::copy(values, node.begin());
    measured(method, s);
    return end_of(s);
  };
  const End motion = move(0.2, frame);
  Newton newton(0);
  const End step = end_by(newton);
  for (const char* name : {"xpbd", "newton-gradients", "newton-factor"})
    for (int rounds : {1, 2, 5, 10, 20}) {
      const auto method = make(name, rounds);
      const End end = end_by(*method);
      std::printf("%u,%g,%s,%d,%lld,%.4g,%.4g,%.4g\n", s.cloth.num_nodes(), K,
                  name, rounds, method->work().products, distance(p, end, step),
                  distance(p, end, motion), distance(p, start, motion));
    }
}

}  // namespace

int main(int argc, char** argv) try {
  Sweep::set_threads(1);
  const int side = argc > 2 ? std::atoi(argv[1]) : 0;
  const bool mixed = argc == 5 && std::string("mixed") == argv[2];
  const double K = argc > 2 && !mixed ? std::atof(argv[2]) : 1;
  const int rounds = argc > 4 ? std::atoi(argv[4]) : 1;
  if ((argc != 3 && argc != 5) || side < 2 || !(K > 0) || rounds < 1)
    throw std::runtime_error("usage: bench_rounds SIDE K [METHOD ROUNDS]");
  const Problem p =
      mixed ? mixed_problem() : grid_problem("", "", 1, unsigned(side), K);
  if (argc == 3) return compare(p, K), 0;
  Start s(p);
  const auto method = make(argv[3], rounds);
  const bool by_steps = std::string("verlet") == argv[3];
  const double dt =
      mixed ? 0.999 * split_springs(s.cloth, 1, s.constraint).inner_step() *
                  (by_steps ? 1 : rounds)
            : frame;
  // The first step allocates, and leaves its force to the next.
  method->step(s.cloth, 0.2 - dt, dt, s.force, s.constraint);
  const long long before = method->work().products;
  measured(*method, s, dt, by_steps ? rounds : 1);
  std::printf("%lld\n", method->work().products - before);
  return 0;
} catch (const std::exception& e) {
  std::cerr << e.what() << '\n';
  return 2;
}
