#pragma once
/** @file Measure.hpp
 * What is asked of a scene at its end, as numbers that can be compared from
 * grid to grid; and a run that answers. */
#include <algorithm>
#include <chrono>
#include <cmath>
#include <functional>
#include <limits>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "lab/methods/Methods.hpp"
#include "lab/scenes/Scene.hpp"

namespace lab {

/** Numbers in the unit of a measure. Answers of the same kind can be told
 * apart: see distance(). */
using Answer = std::vector<double>;

/** How far apart two answers are: the root of the mean of the squares for
 * positions, else the length of the difference.
 * @pre both to the same question */
inline double distance(const Answer& a, const Answer& b, Measure measure) {
  assert(a.size() == b.size());
  double sum = 0;
  for (std::size_t k = 0; k < a.size(); ++k)
    sum += (a[k] - b[k]) * (a[k] - b[k]);
  if (measure == Measure::positions) sum /= double(a.size()) / 3;
  return std::sqrt(sum);
}

namespace measure_detail {

/** Places on each sheet, along u and along v, whose positions are compared. */
constexpr int samples = 9;

/** The position of the place (s, t) of [0, 1]^2 on a sheet whose first node has
 * index @a first: bilinear between its four nodes. */
inline Point position_on(const Cloth& g, const Sheet& sheet, unsigned first,
                         double s, double t) {
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

inline Answer positions(const Model& m, const Cloth& g) {
  Answer all;
  auto add = [&](const Point& p) {
    all.insert(all.end(), {double(p.x), double(p.y), double(p.z)});
  };
  if (m.sheets.empty())
    for (Node n : g.nodes()) add(n.position());
  unsigned first = 0;
  for (const std::string& text : m.sheets) {
    const Sheet sheet = read_sheet(text);
    for (int i = 0; i < samples; ++i)
      for (int j = 0; j < samples; ++j)
        add(position_on(g, sheet, first, i / double(samples - 1),
                        j / double(samples - 1)));
    first += sheet.nodes[0] * sheet.nodes[1];
  }
  return all;
}

}  // namespace measure_detail

/** What @a m asks, in the state that @a g has now:
 * - com: the center of mass [m]
 * - energy: kinetic, elastic and gravitational [J]
 * - positions: of 9 x 9 places on each sheet, the same on all grids; of all
 *   nodes of a mesh from files [m]
 * - max-stretch: the largest l/L - 1 of an edge; 0 if there is none
 * - drape-height: the height of the lowest node [m]
 * @pre no node was removed, for positions: see check_question() */
inline Answer answer(const Model& m, const Cloth& g) {
  switch (read_measure(m.measure)) {
    case Measure::com: {
      const Point c = center_of_mass(g);
      return {c.x, c.y, c.z};
    }
    case Measure::energy:
      return {kinetic_energy(g) + elastic_energy(g) +
              gravitational_energy(g, m.with.gravity)};
    case Measure::positions:
      return measure_detail::positions(m, g);
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

/** Whether @a m can be asked for that: a cloth that tears keeps no positions.
 */
inline bool can_answer(const Model& m, Measure what) {
  return what != Measure::positions || (m.tears.empty() && !m.tear_strain);
}

/** Throws SceneError: a question that a scene can't answer. */
inline void check_question(const Model& m) {
  if (!can_answer(m, read_measure(m.measure)))
    throw SceneError("measure",
                     "is positions, which a cloth that tears does not keep: "
                     "expected another one");
}

/** What a run of a scene came to. */
struct Trial {
  Answer answer;        // empty: it failed
  std::string failure;  // why
  double work = 0;      // springs looked at: sweeps times edges, summed up
  double seconds = 0;   // of this machine
  double dt = 0;        // [s], the first one
  long long steps = 0;
  bool ok() const { return failure.empty(); }
};

/** The step [s] of @a m: its dt, or what it chooses at the start; a part of
 * t-end, so that a run ends there.  @pre check_model(m)
 * Throws as try_out(). */
inline double step_of(const Model& m) {
  double dt = m.with.dt;
  if (m.with.rule != StepRule::fixed)
    dt = Scene(recipe_of(m), m.with, *find_method(m.method)).dt();
  return m.t_end > 0 ? m.t_end / std::ceil(m.t_end / dt * (1 - 1e-12)) : dt;
}

/** Run @a m to its end, with steps of step_of(m).  @pre check_model(m)
 * @param shake how far nodes start from where they should [m], each of them in
 *        a direction of its own: what an answer makes of that tells whether it
 *        can be had at all
 * @param look at the cloth at the end of a run that did not fail
 * Throws InputError, SceneError; std::invalid_argument as Scene does. */
inline Trial try_out(
    const Model& m, double shake = 0,
    const std::function<void(const Cloth&)>& look = [](const Cloth&) {}) {
  const auto start = std::chrono::steady_clock::now();
  const MethodEntry& method = *find_method(m.method);
  Trial result;
  Parameters with = m.with;
  with.rule = StepRule::fixed;
  with.dt = result.dt = step_of(m);
  Scene scene(recipe_of(m), with, method);
  std::mt19937 random(1);
  std::uniform_real_distribution<double> off(-shake, shake);
  if (shake > 0)
    for (Node n : scene.cloth().nodes())
      n.position() += Point(off(random), off(random), off(random));
  while (scene.time() < m.t_end * (1 - 1e-12) && scene.step())
    result.work += double(scene.cloth().num_edges()) * method.info.sweeps;
  if (scene.check()) {
    result.answer = answer(m, scene.cloth());
    look(scene.cloth());
  }
  result.failure = scene.failure();
  result.steps = scene.steps();
  result.seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start)
          .count();
  return result;
}

}  // namespace lab
