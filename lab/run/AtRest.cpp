#include "lab/run/AtRest.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "CME212/Util.hpp"
#include "lab/fast/GraphArrays.hpp"
#include "lab/methods/Methods.hpp"
#include "lab/scenes/Words.hpp"

namespace lab {
namespace {

using CME212::count_of;
using CME212::short_text;

/** The nodes that take part in @a modes, as "nodes 3, 7 and 9". */
std::string nodes_of(const Cloth& g, std::span<const Mode> modes) {
  std::vector<std::pair<double, unsigned>> all;  // how much each moves
  double most = 0;
  for (Node n : g.nodes()) {
    double sum = 0;
    for (const Mode& mode : modes) sum += normSq(mode.shape[n.id()]);
    all.emplace_back(sum, n.index());
    most = std::max(most, sum);
  }
  std::erase_if(all, [&](const auto& a) { return a.first < 1e-8 * most; });
  constexpr std::size_t named = 5;
  const std::size_t n = all.size(), shown = n > named + 1 ? named : n;
  std::string text = n == 1 ? "node " : "nodes ";
  for (std::size_t k = 0; k < shown; ++k)
    text += (k == 0       ? ""
             : k + 1 == n ? " and "
                          : ", ") +
            std::to_string(all[k].second);
  return shown == n ? text
                    : text + " and " + std::to_string(n - shown) + " more";
}

std::string stability(const Rest& rest, const Cloth& g,
                      std::span<const Mode> modes, double zero) {
  const auto is_below = [&](double level) {
    const auto first = std::ranges::find_if(
        modes, [=](const Mode& m) { return m.square >= level; });
    return modes.first(std::size_t(first - modes.begin()));
  };
  const auto growing = is_below(-zero);
  const auto neutral = is_below(zero).subspan(growing.size());
  std::string text;
  if (!growing.empty())
    text += "unstable: a motion of " + nodes_of(g, growing.first(1)) +
            " grows e times every " +
            short_text(1 / std::sqrt(-growing[0].square)) + " s\n";
  if (!neutral.empty())
    text += "no energy holds " + nodes_of(g, neutral) +
            ", which may move freely" +
            (rest.shift > 0 ? ": a shift of " + short_text(rest.shift) +
                                  " 1/s^2 times the mass settled them"
                            : "") +
            '\n';
  if (text.empty() && !modes.empty())
    text = "stable: the smallest eigenvalue is " + short_text(modes[0].square) +
           " 1/s^2\n";
  return text;
}

std::string forces_at_pins(const Scene& scene) {
  const Model& m = scene.model();
  std::string text;
  for (std::size_t k = 0; k < scene.held().size(); ++k) {
    Point sum;
    for (const auto& held : scene.held()[k].nodes)
      sum += scene.force()(arrays(scene.cloth()).node_with_id(held.id), 0);
    text += (k < m.pins.size() ? "pin " + to_words(m.pins[k])
                               : std::string("held by the net")) +
            ": " + short_text(norm(sum)) + " N, " + lab::short_text(sum) + '\n';
  }
  return text;
}

}  // namespace

std::string in_words(const Rest& rest, Scene& scene) {
  const Cloth& g = scene.cloth();
  Equilibrium here(scene.model(), scene.cloth(), scene.force(),
                   scene.watched());
  const std::vector<Mode> modes = here.modes(10);
  std::string text = "at rest: " + short_text(rest.residual) +
                     " N are left of " + short_text(rest.load) + " N, after " +
                     count_of(std::size_t(rest.factors), "Cholesky factor") +
                     '\n' + stability(rest, g, modes, here.zero()) +
                     forces_at_pins(scene);
  double slowest = 0;  // omega [1/s]
  std::string frequencies, steps;
  for (const Mode& mode : modes) {
    if (mode.square < -here.zero()) continue;  // it grows
    const double omega = mode.square > here.zero() ? std::sqrt(mode.square) : 0;
    if (slowest == 0) slowest = omega;
    frequencies += ' ' + short_text(omega / (2 * std::numbers::pi));
  }
  if (!frequencies.empty())
    text += "lowest frequencies [Hz]:" + frequencies + '\n';
  for (const MethodEntry& m : methods)
    if (m.info.limit > 0 && m.info.limit < no_limit && !m.info.adaptive)
      if (const double dt = scene.stepper().limits().sharp(m, 60);
          dt < no_limit)
        steps += (steps.empty() ? " " : ", ") + std::string(m.info.name) + ' ' +
                 short_text(dt);
  if (!steps.empty()) text += "largest stable steps [s]:" + steps + '\n';
  if (slowest > 0)
    text += "the slowest mode is critically damped by a drag over mass of " +
            short_text(2 * slowest) + " 1/s\n";
  return text;
}

}  // namespace lab
