#include "lab/fast/Energy.hpp"

#include <algorithm>
#include <cmath>
#include "lab/fast/GraphArrays.hpp"

namespace lab {

namespace {

/** Add @a f(id) over all nodes in use, in the order of memory. */
template <typename F>
double sum_over_nodes(const Cloth& g, F f) {
  double sum = 0;
  for (unsigned i = 0; i < arrays(g).node_slots(); ++i)
    if (arrays(g).node_in_use(i)) sum += f(i);
  return sum;
}

}  // namespace

double kinetic_energy(const Cloth& g) {
  auto node = arrays(g).node_values();
  return sum_over_nodes(
      g, [=](unsigned i) { return 0.5 * node[i].mass * normSq(node[i].vel); });
}

double gravitational_energy(const Cloth& g, double gravity) {
  auto x = arrays(g).positions();
  auto node = arrays(g).node_values();
  return sum_over_nodes(
      g, [=](unsigned i) { return node[i].mass * gravity * x[i].z; });
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
  auto node = arrays(g).node_values();
  return sum_over_nodes(g, [=](unsigned i) { return node[i].mass; });
}

Point center_of_mass(const Cloth& g) {
  auto x = arrays(g).positions();
  auto node = arrays(g).node_values();
  auto moment = [&](double Point::*along) {
    return sum_over_nodes(
        g, [=](unsigned i) { return double(node[i].mass) * x[i].*along; });
  };
  const double mass = total_mass(g);
  if (!(mass > 0)) return Point();
  return Point(moment(&Point::x) / mass, moment(&Point::y) / mass,
               moment(&Point::z) / mass);
}

double max_speed(const Cloth& g) {
  double most = 0;
  for (unsigned i = 0; i < arrays(g).node_slots(); ++i)
    if (arrays(g).node_in_use(i))
      most = std::max(most, normSq(arrays(g).node_values()[i].vel));
  return std::sqrt(most);
}

}  // namespace lab
