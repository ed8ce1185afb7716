#include "lab/scenes/Measure.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <optional>
#include <random>

#include "CME212/Util.hpp"
#include "lab/Interrupt.hpp"
#include "lab/fast/Energy.hpp"
#include "lab/scenes/Scene.hpp"

namespace lab {

double distance(const Answer& a, const Answer& b, Measure measure) {
  assert(a.size() == b.size());
  double sum = 0;
  for (std::size_t k = 0; k < a.size(); ++k)
    sum += (a[k] - b[k]) * (a[k] - b[k]);
  if (measure == Measure::positions) sum /= double(a.size()) / 3;
  return std::sqrt(sum);
}

namespace {

/** Sampled places on each sheet, along u and along v. */
constexpr int samples = 9;

/** The position of the place (s, t) of [0, 1]^2 on a sheet whose first node has
 * index @a first: bilinear between its four nodes. */
Point position_on(const Cloth& g, const Sheet& sheet, unsigned first, double s,
                  double t) {
  const unsigned n = sheet.nodes[0], m = sheet.nodes[1];
  const double a = s * (n - 1), b = t * (m - 1);
  const unsigned i = std::min(unsigned(a), n - 2),
                 j = std::min(unsigned(b), m - 2);
  const double p = a - i, q = b - j;
  auto at = [&](unsigned di, unsigned dj) {
    return g.node(first + (i + di) * m + j + dj).position();
  };
  return (1 - p) * ((1 - q) * at(0, 0) + q * at(0, 1)) +
         p * ((1 - q) * at(1, 0) + q * at(1, 1));
}

Answer positions(const Model& m, const Cloth& g) {
  Answer all;
  auto add = [&](const Point& p) {
    all.insert(all.end(), {double(p.x), double(p.y), double(p.z)});
  };
  if (m.sheets.empty())
    for (Node n : g.nodes()) add(n.position());
  unsigned first = 0;
  for (const Sheet& sheet : m.sheets) {
    for (int i = 0; i < samples; ++i)
      for (int j = 0; j < samples; ++j)
        add(position_on(g, sheet, first, i / double(samples - 1),
                        j / double(samples - 1)));
    first += sheet.nodes[0] * sheet.nodes[1];
  }
  return all;
}

/** The curvature between two points of a line, per cell squared: of the second
 * differences at both ends the smaller one, 0 if their signs differ. A sheet
 * that lies on a floor up to a node gets no dip beside it. */
double curvature(std::optional<double> a, std::optional<double> b) {
  if (!a || !b) return a ? *a : b.value_or(0);
  return *a * *b <= 0 ? 0 : std::abs(*a) < std::abs(*b) ? *a : *b;
}

/** Where the parabola of curvature @a c from @a a at 0 to @a b at 1 is lowest,
 * in [0, 1]. */
double lowest_at(double a, double b, double c) {
  return c > 0 ? std::clamp(0.5 - (b - a) / c, 0.0, 1.0) : b < a ? 1 : 0;
}

/** The lowest height of a sheet's surface [m]: in the cells around its lowest
 * node, quadratic along each grid line (ENO interpolation: Harten, Engquist,
 * Osher, Chakravarthy, J. Comput. Phys. 71, 1987).
 * @param first index of the sheet's first node */
double lowest_height(const Cloth& g, const Sheet& sheet, unsigned first) {
  const int n = int(sheet.nodes[0]), m = int(sheet.nodes[1]);
  auto z = [&](int i, int j) {
    return double(g.node(first + unsigned(i * m + j)).position().z);
  };
  int i = 0, j = 0;
  for (int a = 0; a < n; ++a)
    for (int b = 0; b < m; ++b)
      if (z(a, b) < z(i, j)) i = a, j = b;
  auto bend_u = [&](int a, int b) -> std::optional<double> {
    if (a < 1 || a > n - 2) return {};
    return z(a - 1, b) - 2 * z(a, b) + z(a + 1, b);
  };
  auto bend_v = [&](int a, int b) -> std::optional<double> {
    if (b < 1 || b > m - 2) return {};
    return z(a, b - 1) - 2 * z(a, b) + z(a, b + 1);
  };
  double lowest = z(i, j);
  for (int di : {-1, 1})
    for (int dj : {-1, 1}) {
      const int a = i + di, b = j + dj;
      if (a < 0 || a >= n || b < 0 || b >= m) continue;
      const double cu = curvature(bend_u(i, j), bend_u(a, j)),
                   cv = curvature(bend_v(i, j), bend_v(i, b));
      // Lowest along u and along v in turn: this converges quickly, as the
      // cell's twist is small against its curvatures.
      double s = 0, t = 0;
      for (int k = 0; k < 8; ++k) {
        s = lowest_at(std::lerp(z(i, j), z(i, b), t),
                      std::lerp(z(a, j), z(a, b), t), cu);
        t = lowest_at(std::lerp(z(i, j), z(a, j), s),
                      std::lerp(z(i, b), z(a, b), s), cv);
      }
      lowest =
          std::min(lowest, std::lerp(std::lerp(z(i, j), z(a, j), s),
                                     std::lerp(z(i, b), z(a, b), s), t) -
                               cu * s * (1 - s) / 2 - cv * t * (1 - t) / 2);
    }
  return lowest;
}

/** The lowest height of @a g [m]; 0 if it has no nodes. Of a mesh from files,
 * and of a cloth that may have torn, the height of the lowest node. */
double lowest_height(const Model& m, const Cloth& g) {
  if (g.num_nodes() == 0) return 0;
  double lowest = std::numeric_limits<double>::infinity();
  unsigned first = 0;
  for (const Sheet& sheet : m.sheets) first += sheet.nodes[0] * sheet.nodes[1];
  if (first != g.num_nodes() || m.tear_strain) {
    for (Node n : g.nodes()) lowest = std::min(lowest, double(n.position().z));
    return lowest;
  }
  first = 0;
  for (const Sheet& sheet : m.sheets) {
    lowest = std::min(lowest, lowest_height(g, sheet, first));
    first += sheet.nodes[0] * sheet.nodes[1];
  }
  return lowest;
}

}  // namespace

Answer answer(const Model& m, const Cloth& g, Measure what) {
  switch (what) {
    case Measure::com: {
      const Point c = center_of_mass(g);
      return {c.x, c.y, c.z};
    }
    case Measure::energy:
      return {kinetic_energy(g) + elastic_energy(g) +
              gravitational_energy(g, m.gravity)};
    case Measure::positions:
      return positions(m, g);
    case Measure::max_stretch: {
      double most = 0;
      for (Edge e : g.edges())
        if (e.value().L > 0)
          most = std::max(most, double(e.length() / e.value().L) - 1);
      return {most};
    }
    case Measure::drape_height:
      return {lowest_height(m, g)};
  }
  return {};
}

void check_question(const Model& m) {
  if (!can_answer(m, m.measure))
    throw SceneError("measure",
                     "is positions, which cannot be compared in a cloth that "
                     "tears: expected another measure");
}

double step_of(const Model& m) {
  const double dt = m.step.fixed() ? m.step.dt : Scene(m).dt();
  return m.t_end > 0 ? m.t_end / std::ceil(m.t_end / dt * (1 - 1e-12)) : dt;
}

Trial try_out(const Model& m, const Shake& shake,
              const std::function<void(const Cloth&)>& look,
              const std::function<void(Scene&)>& after) {
  const CME212::Clock clock;
  Trial result;
  result.dt = step_of(m);
  Scene scene(recipe_of(m), {.dt = result.dt}, *m.method);
  std::mt19937 random(shake.seed);
  std::uniform_real_distribution<double> off(-shake.size, shake.size);
  if (shake.size > 0) {
    for (Node n : scene.cloth().nodes())
      n.position() += Point(off(random), off(random), off(random));
    // The guard starts anew: it would take these strains for a divergence.
    scene.change_method(*m.method, {.dt = result.dt});
  }
  const bool ok = scene.run_to(m.t_end, [&] {
    end_if_interrupted();
    after(scene);
    if (scene.failure().empty())
      result.work += double(scene.cloth().num_edges()) * m.method->info.sweeps;
  });
  if (ok) {
    result.answer = answer(m, scene.cloth());
    look(scene.cloth());
  }
  result.failure = scene.failure();
  result.steps = scene.steps();
  result.seconds = clock.seconds();
  return result;
}

}  // namespace lab
