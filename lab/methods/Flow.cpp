#include "lab/methods/Flow.hpp"

#include <cmath>

#include "lab/fast/Kernels.hpp"

namespace lab {

void drift(Cloth& g, const Part& part, double h, double c) {
  Point* x = g.positions().data();
  NodeData* node = g.node_values().data();
  unsigned i = part.first;
  if (c == 0) {
    const unsigned blocks = (part.last - part.first) / lanes::width;
    lanes::run<kernels::DriftBlocks>(x + i, node + i, blocks, Real(h));
    for (i += blocks * lanes::width; i < part.last; ++i)
      x[i] += h * node[i].vel;
    return;
  }
  double mass = 0, decay = 1, way = h;  // most nodes weigh the same
  for (; i < part.last; ++i) {
    if (node[i].mass != mass) {
      mass = node[i].mass;
      way = -std::expm1(-c / mass * h) * mass / c;
      decay = std::exp(-c / mass * h);
    }
    x[i] += way * node[i].vel;
    node[i].vel *= decay;
  }
}

void kick(Cloth& g, const Part& part, double h, std::span<const Point> f) {
  NodeData* node = &g.node_values()[part.first];
  const unsigned count = part.last - part.first;
  const unsigned blocks = count / lanes::width;
  lanes::run<kernels::KickBlocks>(node, f.data(), blocks, Real(h));
  for (unsigned k = blocks * lanes::width; k < count; ++k)
    node[k].vel += (h / node[k].mass) * f[k];
}

void without_drag(const Part& part, const ForcePlan& force,
                  std::span<Point> f) {
  const double c = force.drag();
  if (c == 0) return;
  const NodeData* node = &part.g.node_values()[part.first];
  for (unsigned k = 0; k < part.last - part.first; ++k) f[k] += c * node[k].vel;
}

void sweep_without_drag(Sweep& sweep, const Cloth& g, double t,
                        const ForcePlan& force, std::vector<Point>& f) {
  sweep(g, t, force, f, [&](const Part& part, std::span<Point> here) {
    without_drag(part, force, here);
  });
}

}  // namespace lab
