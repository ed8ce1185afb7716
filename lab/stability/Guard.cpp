#include "lab/stability/Guard.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "lab/fast/Energy.hpp"
#include "lab/fast/GraphArrays.hpp"

namespace lab {

DivergenceGuard::DivergenceGuard(const Cloth& g, const Potential& potential,
                                 double dt, const EnergyFlow& flow)
    : potential_(potential), dt_(dt) {
  const Energies e = energies(g, potential, flow);
  start_ = balance(e, flow);
  drag_ = flow.drag;
  available_ = e.internal();
  const double fall = potential.gravity.size() * dt;  // [m/s]
  constexpr double strain = 1e-6;
  for (Edge e : g.edges())
    round_off_ += spring_energy((1 + strain) * e.value().L, e.value());
  floor_ = total_mass(g) * fall * fall + round_off_;
  for (Node n : g.nodes())
    floor_ += dt * dt * normSq(potential.load(n)) / n.value().mass;
  keep(g);
}

bool DivergenceGuard::accept(const Cloth& g, const Energies& e,
                             const EnergyFlow& flow) {
  if (!std::isfinite(e.total())) return false;
  // The internal energy without the method's errors and without what drag has
  // taken; what drag gives, in a wind, is in it.
  const double exact = e.internal() - (balance(e, flow) - start_) +
                       std::max(0., flow.drag - drag_);
  const double available = std::max(available_, exact);
  const double floor = floor_ + e.fall_power * dt_;
  if (!(e.internal() <= margin * (available + floor))) return false;
  available_ = available;
  keep(g);
  return true;
}

bool are_nodes(std::span<const Point> positions,
               std::span<const NodeData> values) {
  return std::ranges::all_of(
             positions,
             [](const Point& x) { return std::isfinite(norm(x)); }) &&
         std::ranges::all_of(values, [](const NodeData& n) {
           return std::isfinite(norm(n.vel) + n.mass) && n.mass > 0;
         });
}

void NodeStates::archive(Archive& a) {
  a(position_)(value_);
  a.require(position_.size() == value_.size() && are_nodes(position_, value_));
}

void NodeStates::keep(const Cloth& g) {
  auto x = arrays(g).positions();
  auto v = arrays(g).node_values();
  position_.assign(x.begin(), x.end());
  value_.assign(v.begin(), v.end());
}

void NodeStates::restore(Cloth& g) const {
  for (Node n : g.nodes()) {
    if (n.id() >= position_.size()) continue;
    n.position() = position_[n.id()];
    n.value() = value_[n.id()];
  }
}

}  // namespace lab
