#include "lab/stability/Guard.hpp"

#include <cmath>

#include "CME212/BoundingBox.hpp"
#include "lab/fast/Energy.hpp"

namespace lab {

DivergenceGuard::DivergenceGuard(const Cloth& g, double gravity)
    : gravity_(gravity) {
  CME212::BoundingBox box;
  for (Node n : g.nodes()) box |= n.position();
  if (!box.empty()) top_ = box.max().z;
  double size = box.diagonal() > 0 ? box.diagonal() : 1;
  double start = kinetic_energy(g) + elastic_energy(g);
  double scale = start + total_mass(g) * std::abs(gravity) * size;
  for (Edge e : g.edges()) scale += spring_energy(1.1 * e.value().L, e.value());
  limit_ = start + heights_energy(g) + 3 * scale;
  keep(g);
}

bool DivergenceGuard::accept(const Cloth& g) {
  if (!good(g, ++checks_ % 4 == 0)) return false;
  keep(g);
  return true;
}

bool DivergenceGuard::good(const Cloth& g, bool elastic) const {
  double energy = kinetic_energy(g) + heights_energy(g);
  if (elastic) energy += elastic_energy(g);
  return energy <= limit_;  // not so if it is NaN
}

void DivergenceGuard::keep(const Cloth& g) {
  auto x = g.positions();
  auto v = g.node_values();
  position_.assign(x.begin(), x.end());
  value_.assign(v.begin(), v.end());
}

void DivergenceGuard::restore(Cloth& g) const {
  for (Node n : g.nodes()) {
    if (n.id() >= position_.size()) continue;
    n.position() = position_[n.id()];
    n.value() = value_[n.id()];
  }
}

double DivergenceGuard::heights_energy(const Cloth& g) const {
  return gravitational_energy(g, gravity_) - total_mass(g) * gravity_ * top_;
}

}  // namespace lab
