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

/** The nodes that take part in @a modes, as "nodes 3, 7 and 9". */
std::string nodes_of(const Cloth& g, std::span<const Mode> modes) {
  std::vector<double> moves;  // how much each node does
  for (Node n : g.nodes()) {
    moves.push_back(0);
    for (const Mode& mode : modes) moves.back() += normSq(mode.shape[n.id()]);
  }
  std::vector<std::string> all;
  for (unsigned i = 0; i < moves.size(); ++i)
    if (moves[i] > 1e-8 * *std::ranges::max_element(moves))
      all.push_back(std::to_string(i));
  if (constexpr std::size_t named = 5; all.size() > named + 1) {
    const auto more = std::to_string(all.size() - named) + " more";
    all.resize(named), all.push_back(more);
  }
  std::string text = all.size() == 1 ? "node " : "nodes ";
  for (std::size_t k = 0; k < all.size(); ++k)
    text += (k == 0 ? "" : k + 1 == all.size() ? " and " : ", ") + all[k];
  return text;
}

}  // namespace

std::string in_words(const Rest& rest, Scene& scene) {
  using CME212::short_text;
  const Model& m = scene.model();
  const Cloth& g = scene.cloth();
  Equilibrium here(m, scene.cloth(), scene.force(), scene.watched());
  const std::vector<Mode> modes = here.modes(10);
  std::string text =
      "at rest: " + short_text(rest.residual) + " N are left of " +
      short_text(rest.load) + " N, after " +
      CME212::count_of(std::size_t(rest.factors), "Cholesky factor") + '\n';
  const auto below = [&](double level) {  // the number of such modes
    return std::size_t(std::ranges::count_if(
        modes, [=](const Mode& mode) { return mode.square < level; }));
  };
  const std::size_t grow = below(-here.zero()), slow = below(here.zero());
  const auto all = std::span(modes);
  if (grow > 0)
    text += "unstable: a motion of " + nodes_of(g, all.first(1)) +
            " grows e times every " +
            short_text(1 / std::sqrt(-modes[0].square)) + " s\n";
  if (slow > grow)
    text += "no energy holds " + nodes_of(g, all.subspan(grow, slow - grow)) +
            ", which may move freely" +
            (rest.shift > 0 ? ": a shift of " + short_text(rest.shift) +
                                  " 1/s^2 times the mass settled them\n"
                            : "\n");
  if (slow == 0 && !modes.empty())
    text += "stable: the smallest eigenvalue is " +
            short_text(modes[0].square) + " 1/s^2\n";
  for (std::size_t k = 0; k < scene.held().size(); ++k) {
    Point sum;
    for (const auto& held : scene.held()[k].nodes)
      sum += scene.force()(arrays(g).node_with_id(held.id), 0);
    text += (k < m.pins.size() ? "pin " + to_words(m.pins[k])
                               : std::string("held by the net")) +
            ": " + short_text(norm(sum)) + " N, " + lab::short_text(sum) + '\n';
  }
  if (modes.size() > grow) text += "lowest frequencies [Hz]:";
  for (std::size_t k = grow; k < modes.size(); ++k)
    text += ' ' + short_text(k < slow ? 0
                                      : std::sqrt(modes[k].square) /
                                            (2 * std::numbers::pi));
  if (modes.size() > grow) text += '\n';
  std::string steps;
  for (const MethodEntry& method : methods)
    if (method.info.limit > 0 && method.info.limit < no_limit)
      if (const double dt = scene.stepper().limits().sharp(method, 60);
          dt < no_limit)
        steps += (steps.empty() ? " " : ", ") + std::string(method.info.name) +
                 ' ' + short_text(dt);
  if (!steps.empty()) text += "largest stable steps [s]:" + steps + '\n';
  if (slow < modes.size())
    text += "the slowest mode is critically damped by a drag over mass of " +
            short_text(2 * std::sqrt(modes[slow].square)) + " 1/s\n";
  return text;
}

}  // namespace lab
