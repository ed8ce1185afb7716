#include "lab/charts/Growth.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include "lab/charts/Limits.hpp"
#include "lab/methods/Pefrl.hpp"
#include "lab/methods/Srkn.hpp"
#include "lab/methods/Verlet.hpp"
#include "lab/methods/Yoshida4.hpp"
#include "lab/stability/Spectrum.hpp"
#include "lab/stability/StepLimit.hpp"

namespace lab {

namespace {

using Matrix = std::array<double, 4>;  // by rows, on (x, v/omega)

Matrix product(const Matrix& a, const Matrix& b) {
  return {a[0] * b[0] + a[1] * b[2], a[0] * b[1] + a[1] * b[3],
          a[2] * b[0] + a[3] * b[2], a[2] * b[1] + a[3] * b[3]};
}
double spectral_radius(const Matrix& m) {
  return lab::spectral_radius(m[0], m[1], m[2], m[3]);
}

/** The product of the stages of a splitting: A is x' = v, v' = -gamma v; B is a
 * kick of -omega^2 x. */
template <typename Scheme>
Matrix matrix_of(double y, double d) {
  Matrix all = {1, 0, 0, 1};
  bool kick = Scheme::kicks_first;
  for (double part : Scheme::steps) {
    const double way = d > 0 ? -std::expm1(-d * part) / d : part;
    all = product(kick ? Matrix{1, 0, -part * y, 1}
                       : Matrix{1, y * way, 0, std::exp(-d * part)},
                  all);
    kick = !kick;
  }
  return all;
}

}  // namespace

double amplification_by_theory(std::string_view method, double y, double d) {
  if (method == "forward-euler" || method == "rk4") {
    const std::complex<double> root =
        std::sqrt(std::complex(d * d / 4 - y * y));
    const int order = method == "rk4" ? 4 : 1;
    auto R = [order](std::complex<double> z) {
      std::complex<double> sum = 1;
      for (int k = order; k > 0; --k) sum = 1.0 + z / double(k) * sum;
      return std::abs(sum);
    };
    return std::max(R(-d / 2 + root), R(-d / 2 - root));
  }
  if (method == "symplectic-euler")
    return spectral_radius({1, y, -y, 1 - d - y * y});
  if (method == "implicit-euler") {
    const double q = 1 / (1 + d + y * y);
    return spectral_radius({1 - q * y * y, q * y, -q * y, q});
  }
  if (method == "verlet") return spectral_radius(matrix_of<VerletScheme>(y, d));
  if (method == "yoshida4")
    return spectral_radius(matrix_of<Yoshida4Scheme>(y, d));
  if (method == "pefrl") return spectral_radius(matrix_of<PefrlScheme>(y, d));
  if (method == "srkn6b") return spectral_radius(matrix_of<Srkn6bScheme>(y, d));
  throw std::invalid_argument("no formula for " + std::string(method));
}

Problem stretched_sheet(unsigned side, MeshSprings::Kind mesh, double stretch,
                        double gamma) {
  auto rim = [side](const Cloth& g) {
    std::vector<Node> nodes;
    for (Node n : g.nodes()) {
      const unsigned i = n.index() / side, j = n.index() % side;
      if (i == 0 || j == 0 || i + 1 == side || j + 1 == side)
        nodes.push_back(n);
    }
    return make_combined_constraints(PinConstraint(nodes));
  };
  return {.name = std::to_string(side),
          .about = "stretched sheet",
          .t_end = 1,
          .gravity = 0,
          .gamma = gamma,
          .build =
              [=](Cloth& g) {
                build_cloth(g, grid_points(side), grid_quads(side), mesh);
                for (Point& x : g.positions()) x *= stretch;
              },
          .constraint = rim};
}

Growth growth(const Problem& p, const MethodEntry& method, double dt, int steps,
              int every, double enough) {
  Start s(p);
  const std::vector<Point> rest(s.cloth.positions().begin(),
                                s.cloth.positions().end());
  std::vector<double> scale;
  std::vector<spectrum_detail::Spring> springs;
  spectrum_detail::find_scales(s.cloth, s.constraint, scale);
  spectrum_detail::find_springs(s.cloth, s.force, springs);
  // Negative stiffness of compressed springs is left out of the size.
  for (auto& spring : springs) spring.B.across = std::max(0.0, spring.B.across);
  auto x = s.cloth.positions();
  auto node = s.cloth.node_values();
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
           std::max(1.0, omega_gershgorin(s.cloth, s.force, s.constraint)));

  auto made = method.make();
  const double start = size();
  double total = 0, early = 0, now = start;  // total: of renewals so far
  int early_steps = 0;
  for (int n = 1; n <= steps; ++n) {
    made->step(s.cloth, (n - 1) * dt, dt, s.force, s.constraint);
    if (n % every != 0 && n != steps) continue;
    now = size();
    const double so_far = total + std::log(now / start);
    if (!(so_far < enough)) return {no_limit, no_limit};
    if (n <= steps / 2) early = so_far, early_steps = n;
    if (now > 1e3 * start || now < 1e-3 * start) {
      total = so_far;
      multiply(start / now);
      made->restart();
      now = start;
    }
  }
  total += std::log(now / start);
  return {total, (total - early) / (steps - early_steps)};
}

double measured_sheet_limit(const Problem& p, const MethodEntry& method,
                            double low, double high, int steps,
                            double precision) {
  const double most = std::log(10.0);
  return largest_that(
      [&](double dt) {
        return growth(p, method, dt, steps, 5, most).total < most;
      },
      low, high, precision);
}

}  // namespace lab
