#include "lab/charts/Limits.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "lab/methods/Verlet.hpp"
#include "lab/stability/Spectrum.hpp"
#include "lab/stability/StepLimit.hpp"

namespace lab {

Problem cloth_for_limits(unsigned side, MeshSprings::Kind mesh, double t_end) {
  Problem p = grid_problem(std::to_string(side), "", t_end, side);
  p.build = [side, mesh](Cloth& g) {
    build_cloth(g, grid_points(side), grid_quads(side), mesh);
  };
  return p;
}

double Path::top() const {
  return omega.empty() ? 0 : *std::ranges::max_element(omega);
}

Path find_path(const Problem& p) {
  Start s(p);
  Path path;
  path.safe = omega_safe(s.cloth, s.force, s.constraint);
  path.gamma = largest_gamma(s.cloth, s.force.drag());
  const double dt = 0.8 * Verlet::info.limit / path.safe;
  path.dt = 4 * dt;
  Verlet verlet;
  SharpOmega sharp;
  const auto steps = static_cast<long long>(std::ceil(p.t_end / dt));
  for (long long n = 1; n <= steps; ++n) {
    verlet.step(s.cloth, double(n - 1) * dt, dt, s.force, s.constraint);
    if (n % 4 == 0)
      path.omega.push_back(sharp(s.cloth, s.force, s.constraint, 20));
  }
  return path;
}

double predicted_limit(const MethodEntry& method, const Path& path,
                       double growth) {
  const double limit = method.info.limit, top = path.top();
  // ln amplification per step against dt omega/limit, from 0.9 to 1.7
  constexpr int cells = 400;
  constexpr double first = 0.9, width = 0.8 / cells;
  std::array<double, cells + 1> rate;
  auto made = method.make();
  for (int k = 0; k <= cells; ++k)
    rate[std::size_t(k)] = std::log(amplification(
        *made, limit * (first + width * k), 1, path.gamma / path.safe));
  auto rate_at = [&](double y) {
    const double cell = std::clamp((y - first) / width, 0.0, cells - 1e-9);
    const auto k = static_cast<std::size_t>(cell);
    return rate[k] + (cell - double(k)) * (rate[k + 1] - rate[k]);
  };
  auto blows_up = [&](double dt) {
    double sum = 0;
    for (double omega : path.omega) {
      sum += path.dt / dt * rate_at(dt * omega / limit);
      sum = std::max(0.0, sum);
      if (sum > std::log(growth)) return true;
    }
    return false;
  };
  // Upwards, since a method may be stable again beyond its limit: PEFRL is.
  double dt = 0.9 * limit / top;
  while (dt < 1.6 * limit / top && !blows_up(dt)) dt *= 1.001;
  return dt;
}

bool stays_bounded(const Problem& p, const MethodEntry& method, double dt) {
  Start s(p);
  const double share = method.info.order > 1 ? 0.001 : 0.02;
  const double most_gain = share * total_mass(s.cloth) * p.gravity;  // [J]
  double lowest = s.energy();
  auto made = method.make();
  const auto steps = static_cast<long long>(std::ceil(p.t_end / dt));
  for (long long n = 0; n < steps; ++n) {
    made->step(s.cloth, double(n) * dt, dt, s.force, s.constraint);
    if (n % 8 != 7 && n + 1 != steps) continue;
    const double now = s.energy();
    if (!(now <= lowest + most_gain)) return false;
    lowest = std::min(lowest, now);
  }
  return true;
}

double measured_limit(const Problem& p, const MethodEntry& method, double low,
                      double high, double precision) {
  return largest_that([&](double dt) { return stays_bounded(p, method, dt); },
                      low, high, precision);
}

}  // namespace lab
