#include "lab/methods/Flow.hpp"

#include "lab/fast/Kernels.hpp"

namespace lab {

void drift(Cloth& g, const Part& part, double h, const Drag& c) {
  Point* x = g.positions().data();
  NodeData* node = g.node_values().data();
  unsigned i = part.first;
  if (c.none()) {
    const unsigned blocks = (part.last - part.first) / lanes::width;
    lanes::run<kernels::DriftBlocks>(x + i, node + i, blocks, Real(h));
    for (i += blocks * lanes::width; i < part.last; ++i)
      x[i] += h * node[i].vel;
    return;
  }
  double gamma = 0;
  DragFlow flow(gamma, h);
  for (; i < part.last; ++i) {
    const double next = c[i] / node[i].mass;
    if (!DragFlow::is_same(next, gamma)) flow = DragFlow(gamma = next, h);
    x[i] += flow.way * node[i].vel;
    node[i].vel *= flow.decay;
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
  const Drag& c = force.drag();
  if (c.none()) return;
  const NodeData* node = part.g.node_values().data();
  for (unsigned i = part.first; i < part.last; ++i)
    f[i - part.first] += c[i] * node[i].vel;
}

void sweep_without_drag(Sweep& sweep, const Cloth& g, double t,
                        const ForcePlan& force, std::vector<Point>& f) {
  sweep(g, t, force, f, [&](const Part& part, std::span<Point> here) {
    without_drag(part, force, here);
  });
}

}  // namespace lab
