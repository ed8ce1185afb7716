// Measure the order of each explicit method: on a chain of masses whose exact
// motion is known, halving the step divides the error by 2^order.
#include <cmath>
#include <cstdio>
#include "lab/charts/Problem.hpp"
#include "lab/methods/Methods.hpp"
int main() {
  const lab::Problem p = lab::chain_problem("chain", "", 0.8);
  const auto exact = lab::reference(p).end;
  const auto error = [&](const lab::MethodEntry& entry, int steps) {
    const auto method = entry.make();
    return lab::distance(p, lab::run(p, *method, steps).end, exact);
  };
  for (const lab::MethodEntry& entry : lab::methods) {
    if (entry.info.limit == lab::no_limit || entry.info.adaptive) continue;
    const int steps = entry.info.order < 6 ? 800 : 50;  // above round-off
    const double coarse = error(entry, steps), fine = error(entry, 2 * steps);
    std::printf("%-16s order %d, measured %.2f\n", entry.info.name.data(),
                entry.info.order, std::log2(coarse / fine));
  }
}
