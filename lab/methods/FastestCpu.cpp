#include "lab/methods/FastestCpu.hpp"

#include <algorithm>
#include <array>
#include <limits>

#include "CME212/Mesh.hpp"
#include "CME212/Util.hpp"
#include "lab/methods/FlatFlow.hpp"

namespace lab {

lanes::Cpu fastest_cpu() {
  const auto count = std::size_t(lanes::best_cpu()) + 1;
  if (count == 1) return lanes::best_cpu();
  constexpr unsigned side = 24;
  Cloth g;
  build_cloth(g, grid_points(side), grid_quads(side), MeshSprings::diagonals);
  const ForcePlan force = MassSpringForce();
  FlatFlow flow;
  flow.begin(g, force, false);
  // The shortest of many times: what another program takes away counts little.
  // Several steps in a row, because the first ones after a change of registers
  // are slower. After the first round, only kinds that may win.
  std::array<double, 3> best;
  best.fill(std::numeric_limits<double>::max());
  const lanes::Cpu before = lanes::cpu;
  for (int round = 0; round < 3; ++round)
    for (std::size_t k = 0; k < count; ++k) {
      if (round > 0 && best[k] > 1.25 * std::ranges::min(best)) continue;
      lanes::cpu = lanes::Cpu(k);
      for (int step = 0; step < 16; ++step) {
        const CME212::Clock clock;
        flow.run({.t = 0, .drift = 0, .kick = 0});  // changes no number
        best[k] = std::min(best[k], clock.seconds());
      }
    }
  lanes::cpu = before;
  return lanes::Cpu(std::ranges::min_element(best) - best.begin());
}

}  // namespace lab
