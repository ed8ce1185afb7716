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
  std::array<double, 3> best;
  best.fill(std::numeric_limits<double>::max());
  const lanes::Cpu before = lanes::cpu;
  // The shortest of many times: what another program takes away counts little.
  for (int turn = 0; turn < 40; ++turn)
    for (std::size_t k = 0; k < count; ++k) {
      lanes::cpu = lanes::Cpu(k);
      const CME212::Clock clock;
      flow.run({.t = 0, .kick = 0, .keep = true});
      best[k] = std::min(best[k], clock.seconds());
    }
  lanes::cpu = before;
  return lanes::Cpu(std::min_element(best.begin(), best.begin() + count) -
                    best.begin());
}

}  // namespace lab
