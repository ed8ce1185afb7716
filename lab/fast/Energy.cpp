#include "lab/fast/Energy.hpp"

#include <algorithm>
#include <cmath>
#include "lab/fast/GraphArrays.hpp"

namespace lab {

namespace {

/** The sum of @a f(position, value) over all nodes, in the order of memory. */
template <typename F>
auto sum_over_nodes(const Cloth& g, F f) {
  const auto x = arrays(g).positions();
  const auto node = arrays(g).node_values();
  decltype(f(x[0], node[0])) sum{};
  for (unsigned i = 0; i < arrays(g).node_slots(); ++i)
    if (arrays(g).node_in_use(i)) sum += f(x[i], node[i]);
  return sum;
}

}  // namespace

double kinetic_energy(const Cloth& g) {
  return sum_over_nodes(g, [](const Point&, const NodeData& n) {
    return 0.5 * n.mass * normSq(n.vel);
  });
}

double gravitational_energy(const Cloth& g, const Gravity& gravity) {
  return sum_over_nodes(g, [a = gravity.a](const Point& x, const NodeData& n) {
    return n.mass * -a.z * x.z - n.mass * (a.x * x.x + a.y * x.y);
  });
}

double elastic_energy(const Cloth& g) {
  auto x = arrays(g).positions();
  auto spring = arrays(g).edge_values();
  double sum = 0;
  for (unsigned e = 0; e < arrays(g).edge_slots(); ++e)
    if (arrays(g).edge_in_use(e)) {
      auto [i, j] = arrays(g).edge_ends()[e];
      sum += spring_energy(norm(x[j] - x[i]), spring[e]);
    }
  return sum;
}

double total_mass(const Cloth& g) {
  return sum_over_nodes(g,
                        [](const Point&, const NodeData& n) { return n.mass; });
}

Point first_moment(const Cloth& g) {
  return sum_over_nodes(
      g, [](const Point& x, const NodeData& n) { return n.mass * x; });
}

Point center_of_mass(const Cloth& g) {
  const double mass = total_mass(g);
  if (!(mass > 0)) return Point();
  return first_moment(g) / mass;
}

double max_speed(const Cloth& g) {
  double most = 0;
  for (unsigned i = 0; i < arrays(g).node_slots(); ++i)
    if (arrays(g).node_in_use(i))
      most = std::max(most, normSq(arrays(g).node_values()[i].vel));
  return std::sqrt(most);
}

}  // namespace lab
