#include "lab/stability/Guard.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "lab/fast/Energy.hpp"

namespace lab {

DivergenceGuard::DivergenceGuard(const Cloth& g, double gravity, double dt)
    : gravity_(gravity) {
  const Energies e = energies(g, gravity);
  start_ = e.kinetic + e.elastic, height_ = e.gravitational;
  const double fall = gravity * dt;  // [m/s]
  floor_ = total_mass(g) * fall * fall;
  const double strain =
      std::max(1e-6, std::sqrt(double(std::numeric_limits<Real>::epsilon())));
  for (Edge e : g.edges())
    floor_ += spring_energy((1 + strain) * e.value().L, e.value());
  keep(g);
}

bool DivergenceGuard::accept(const Cloth& g, const EnergyFlow& flow) {
  const Energies e = energies(g, gravity_);
  if (!std::isfinite(e.total())) return false;
  const double released =
      std::max(released_, height_ - e.gravitational - flow.removed);
  const double work = std::max(work_, flow.work);
  const double available = start_ + released + work + floor_;
  if (!(e.kinetic + e.elastic <= margin * available)) return false;
  released_ = released, work_ = work;
  keep(g);
  return true;
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

}  // namespace lab
