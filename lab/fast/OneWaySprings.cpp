#include "lab/fast/OneWaySprings.hpp"

#include "lab/fast/GraphArrays.hpp"

namespace lab {

/** Call use(i, j, u, s, slack) for each edge, in the order of their ids: its
 * ends, the way from i to j [m], its value, whether it does not act. */
template <typename Use>
void OneWaySprings::each(const Cloth& g, Use use) const {
  const auto x = arrays(g).positions();
  for (unsigned e = 0; e < arrays(g).edge_slots(); ++e) {
    if (!arrays(g).edge_in_use(e)) continue;
    const auto [i, j] = arrays(g).edge_ends()[e];
    const Point u = x[j] - x[i];
    const EdgeData& s = arrays(g).edge_values()[e];
    use(i, j, u, s, is_slack(e, norm(u), s));
  }
}

Point OneWaySprings::operator()(Node n, double /*t*/) const {
  Point f;
  for (Edge e : n.edges())
    f += pull(e.id(), e.node2().position() - n.position(), e.value());
  return f;
}

void OneWaySprings::add_to(const Part& part, double /*t*/,
                           std::span<Point> f) const {
  const auto x = arrays(part.g).positions();
  const auto spring = arrays(part.g).edge_values();
  for (unsigned i = part.first; i < part.last; ++i)
    for (const auto& [j, edge] : arrays(part.g).neighbors(i))
      f[i - part.first] += pull(edge, x[j] - x[i], spring[edge]);
}

double OneWaySprings::energy(const Cloth& g) const {
  double sum = 0;
  each(g, [&sum](auto, auto, auto& u, auto& s, bool slack) {
    if (!slack) sum += spring_energy(norm(u), s);
  });
  return sum;
}

bool OneWaySprings::add_stiffness(const Cloth& g,
                                  const StiffnessVisitor& use) const {
  each(g, [&use](auto i, auto j, auto& u, auto& s, bool slack) {
    use(i, j, slack ? Stiffness{Point(1, 0, 0)} : spring_stiffness(u, s));
  });
  return true;
}

void OneWaySprings::add_slack(const Cloth& g,
                              const StiffnessVisitor& use) const {
  each(g, [&use](auto i, auto j, auto& u, auto& s, bool slack) {
    if (slack) use(i, j, {spring_stiffness(u, s).direction, s.K, 0});
  });
}

}  // namespace lab
