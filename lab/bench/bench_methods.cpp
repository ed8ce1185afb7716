// The time of a step of each method over that of Verlet, on the assignment's
// cloth of 25 x 25 nodes with diagonals and drag, up to t = 0.25 s. Steps are
// at Verlet's limit and, for methods without a limit, ten times as long. The
// least of seven runs, with all methods in turn. The output is a script of sed,
// by which `make method-costs` writes the costs to the methods' cards.
#include <algorithm>
#include <cstdio>
#include <ctime>
#include <exception>
#include <vector>

#include "lab/charts/Problem.hpp"
#include "lab/fast/Sweep.hpp"
#include "lab/methods/Methods.hpp"
#include "lab/methods/Splitting.hpp"
#include "lab/stability/Spectrum.hpp"

using namespace lab;

namespace {

/** The time of a step of @a dt [s]; 0 if the method can't make it. */
double seconds_a_step(const Problem& p, const MethodEntry& entry, double dt) {
  Start s(p);
  const auto method = entry.make();
  method->set_tolerance(no_limit);
  const int steps = int(p.t_end / dt);
  std::clock_t start = 0;  // processor time: other programs may run, too
  try {
    method->step(s.cloth, 0, dt, s.force, s.constraint);
    start = std::clock();  // after the first, which allocates
    for (int n = 1; n <= steps;)
      n += method->steps(s.cloth, {n * dt, dt}, steps + 1 - n, s.force,
                         s.constraint);
  } catch (const std::exception&) {
    return 0;
  }
  return double(std::clock() - start) / CLOCKS_PER_SEC / steps;
}

}  // namespace

int main() {
  const Problem p = grid_problem("grid1", "", 0.25, 25);
  const Start s(p);
  const double limit =
      Verlet::info.limit / omega_safe(s.cloth, s.force, s.constraint);
  struct Cost {
    double at_limit = no_limit, at_ten = no_limit;  // [s]
  };
  std::vector<Cost> costs(methods.size());
  Sweep::set_threads(1);
  for (int repeat = 0; repeat < 7; ++repeat)
    for (std::size_t k = 0; k < methods.size(); ++k) {
      auto& [one, ten] = costs[k];
      one = std::min(one, seconds_a_step(p, methods[k], 0.99 * limit));
      if (methods[k].info.limit == no_limit)
        ten = std::min(ten, seconds_a_step(p, methods[k], 10 * limit));
    }
  const double unit =
      costs[std::size_t(&table::verlet - methods.data())].at_limit;
  for (std::size_t k = 0; k < methods.size(); ++k) {
    const auto& [one, ten] = costs[k];
    std::printf("/name = \"%s\"/,/cost =/s/cost = .*/cost = {%.3g",
                methods[k].info.name.data(), one / unit);
    if (ten != no_limit) std::printf(", %.3g", ten / unit);
    std::puts("},/");
  }
}
