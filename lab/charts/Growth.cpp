#include "lab/charts/Growth.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "lab/fast/GraphArrays.hpp"
#include "lab/stability/Spectrum.hpp"

namespace lab {

Problem stretched_sheet(unsigned side, MeshSprings::Kind mesh, double stretch,
                        double gamma) {
  Model m;
  m.name = std::to_string(side), m.t_end = 1, m.gravity = 0;
  m.sheets = {{.u = Point(stretch, 0, 0),
               .v = Point(0, stretch, 0),
               .nodes = {side, side}}};
  m.rest_length = 1 / stretch;
  m.edges.diagonals = mesh == MeshSprings::diagonals;
  m.damping = gamma / (side * side);
  m.pins = {{.x = 0}, {.x = stretch}, {.y = 0}, {.y = stretch}};
  return {m, "stretched sheet"};
}

double growth(const Problem& p, const MethodEntry& method, double dt, int steps,
              int every, double enough) {
  Start s(p);
  const std::vector<Point> rest(arrays(s.cloth).positions().begin(),
                                arrays(s.cloth).positions().end());
  std::vector<double> scale;
  std::vector<spectrum_detail::Spring> springs;
  spectrum_detail::find_scales(s.cloth, s.constraint, scale);
  spectrum_detail::find_springs(s.cloth, s.force, springs);
  // Negative stiffness of compressed springs is left out of the size.
  for (auto& spring : springs) spring.B.across = std::max(0.0, spring.B.across);
  auto x = arrays(s.cloth).positions();
  auto node = arrays(s.cloth).node_values();
  auto size = [&] {
    double sum = 2 * kinetic_energy(s.cloth);
    for (const auto& spring : springs) {
      const Point u =
          (x[spring.j] - rest[spring.j]) - (x[spring.i] - rest[spring.i]);
      sum += dot(u, spring.B * u);
    }
    return std::sqrt(sum);
  };
  auto multiply = [&](double factor) {
    for (unsigned i = 0; i < rest.size(); ++i) {
      x[i] = rest[i] + factor * (x[i] - rest[i]);
      node[i].vel *= factor;
    }
  };

  std::mt19937 random(1);
  for (unsigned i = 0; i < rest.size(); ++i)
    for (unsigned k = 0; k < 3;
         ++k)  // the generator is drawn for held ones too
      node[i].vel[k] = (double(random()) / double(random.max()) - 0.5) *
                       (scale[i] > 0 ? 1.0 : 0.0);
  // In the fastest wave this is a displacement of 1e-7 of a spring.
  double length = no_limit;
  for (const auto& spring : springs)
    length = std::min(length, norm(rest[spring.i] - rest[spring.j]));
  multiply(1e-7 * length *
           std::max(1.0, omega_safe(s.cloth, s.force, s.constraint)));

  auto made = method.make();
  const double start = size();
  double total = 0, now = start;  // total: of renewals so far
  for (int n = 1; n <= steps; ++n) {
    made->step(s.cloth, (n - 1) * dt, dt, s.force, s.constraint);
    if (n % every != 0 && n != steps) continue;
    now = size();
    const double so_far = total + std::log(now / start);
    if (!(so_far < enough)) return no_limit;
    if (now > 1e3 * start || now < 1e-3 * start) {
      total = so_far;
      multiply(start / now);
      made->restart();
      now = start;
    }
  }
  return total + std::log(now / start);
}

double measured_sheet_limit(const Problem& p, const MethodEntry& method,
                            double low, double high, int steps,
                            double precision) {
  const double most = std::log(10.0);
  while (high - low > precision * low) {
    const double middle = (low + high) / 2;
    (growth(p, method, middle, steps, 5, most) < most ? low : high) = middle;
  }
  return low;
}

}  // namespace lab
