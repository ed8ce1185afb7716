#include <time.h>

#include <algorithm>
#include <array>
#include <limits>

#include "CME212/Mesh.hpp"
#include "lab/fast/FlatFlow.hpp"

namespace lab::lanes {

namespace {

// Processor time of this thread [s]: other programs do not count.
double processor_time() {
  timespec now = {};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return double(now.tv_sec) + 1e-9 * double(now.tv_nsec);
}

}  // namespace

Cpu clearly_fastest(std::span<const double> times) {
  std::size_t best = 0;
  for (std::size_t k = 1; k < times.size(); ++k)
    if (times[k] < 0.9 * times[best]) best = k;
  return Cpu(best);
}

Cpu fastest_cpu() {
  const auto count = std::size_t(best_cpu()) + 1;
  if (count == 1) return best_cpu();
  constexpr unsigned side = 24;
  Cloth g;
  build_cloth(g, grid_points(side), grid_quads(side), MeshSprings::diagonals);
  const ForcePlan force = MassSpringForce();
  FlatFlow flow;
  flow.begin(g, force, false);
  // The shortest of several turns: what another program does to the caches
  // counts little. The first steps after a change of registers are slower, so
  // a turn has several. After the first round, only kinds that may win.
  std::array<double, 3> best;
  best.fill(std::numeric_limits<double>::max());
  const Cpu before = cpu;
  for (int round = 0; round < 4; ++round)
    for (std::size_t k = 0; k < count; ++k) {
      if (round > 0 && best[k] > 1.5 * std::ranges::min(best)) continue;
      cpu = Cpu(k);
      for (int step = 0; step < 12; ++step) {
        const double start = processor_time();
        flow.run({.t = 0, .drift = 0, .kick = 0});  // changes no number
        best[k] = std::min(best[k], processor_time() - start);
      }
    }
  cpu = before;
  return clearly_fastest({best.data(), count});
}

}  // namespace lab::lanes
