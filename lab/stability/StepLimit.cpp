#include "lab/stability/StepLimit.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace lab {

namespace {
constexpr double round_off = 1e-12;
}

double spectral_radius(double a, double b, double c, double d) {
  const double half = (a + d) / 2, det = a * d - b * c;
  const double root = half * half - det;
  return root > 0 ? std::abs(half) + std::sqrt(root) : std::sqrt(det);
}

double amplification(Method& method, double dt, double omega, double gamma) {
  Cloth g;
  g.add_node(Point());
  Node mass = g.add_node(Point(1, 0, 0));
  g.add_edge(g.node(0), mass, {omega * omega, 0});
  auto force = make_combined_force(MassSpringForce(), DampingForce(gamma));
  const std::array wall = {g.node(0)};
  PinConstraint pin(wall);
  auto image = [&](double x, double v) {  // of (x, v/omega)
    mass.position() = Point(x, 0, 0);
    mass.value().vel = Point(v * omega, 0, 0);
    method.restart();
    method.step(g, 0, dt, force, pin);
    return std::array<double, 2>{mass.position().x, mass.value().vel.x / omega};
  };
  const auto [xx, vx] = image(1, 0);
  const auto [xv, vv] = image(0, 1);
  return spectral_radius(xx, xv, vx, vv);
}

double step_limit(const MethodEntry& method, double omega, double gamma) {
  const MethodInfo& info = method.info;
  if (info.limit == no_limit || info.adaptive || !(omega > 0)) return no_limit;
  double high = (info.limit > 0 ? info.limit : 2) / omega;
  if (!(gamma > 0)) return info.limit > 0 ? high : 0;
  auto made = method.make();
  auto stable = [&](double dt) {
    return amplification(*made, dt, omega, gamma) <= 1 + round_off;
  };
  if (info.limit > 0 && stable(high * (1 - 1e-6))) return high;
  double low = 0;
  for (int k = 0; k < 50; ++k) {
    const double middle = (low + high) / 2;
    (stable(middle) ? low : high) = middle;
  }
  return low;
}

double mild_step(const MethodEntry& method, double dt, double omega,
                 double gamma, double share) {
  auto made = method.make();
  auto mild = [&](double h) {
    const double taken = -2 * std::log(amplification(*made, h, omega, gamma));
    return taken <= (1 + share) * gamma * h + round_off;
  };
  if (method.info.adaptive || !(omega > 0) || mild(dt)) return no_limit;
  const double least = dt / 16;
  do dt *= 0.9;
  while (dt > least && !mild(dt));
  return std::max(dt, least);
}

double largest_gamma(const Cloth& g, const Drag& c) {
  double most = 0;
  for (Node n : g.nodes()) most = std::max(most, c[n.id()] / n.value().mass);
  return most;
}

}  // namespace lab
