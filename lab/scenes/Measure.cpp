#include "lab/scenes/Measure.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
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
    case Measure::drape_height: {
      double lowest = std::numeric_limits<double>::infinity();
      for (Node n : g.nodes())
        lowest = std::min(lowest, double(n.position().z));
      return {g.num_nodes() > 0 ? lowest : 0};
    }
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
