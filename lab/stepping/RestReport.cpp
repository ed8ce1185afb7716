#include "lab/stepping/RestReport.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "CME212/Util.hpp"
#include "lab/fast/GraphArrays.hpp"
#include "lab/fast/OneWaySprings.hpp"
#include "lab/methods/Methods.hpp"
#include "lab/scenes/Words.hpp"

namespace lab {

using CME212::short_text;

namespace {

/** @a all, as "nodes 3, 7 and 9". */
std::string in_words(const std::vector<unsigned>& nodes) {
  std::vector<std::string> all;
  for (unsigned i : nodes) all.push_back(std::to_string(i));
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

void check_has_rest(const Model& m) {
  const auto refuse = [](bool wrong, const std::string& what) {
    if (wrong) throw SceneError("rest", "cannot be " + what);
  };
  const auto moves = [](const auto& part) { return part.motion.moves(); };
  refuse(!m.at.empty(), "combined with --at: it is a state at no time");
  refuse(std::ranges::any_of(m.pins, moves) ||
             std::ranges::any_of(m.planes, moves) ||
             std::ranges::any_of(m.spheres, moves),
         "that of moving pins or obstacles: give them no velocity");
  refuse(!m.tears.empty() || m.tear_strain,
         "that of a cloth that tears, whose rest depends on its motion: a mesh "
         "alone is the scene of the assignment, so name its pins");
  refuse(m.self_collision.has_value(),
         "combined with --self-collision: it lets a cloth pass through itself");
}

RestReport::RestReport(Scene& scene) : Rest(*scene.rest()) {
  const Model& m = scene.model();
  const Cloth& g = scene.cloth();
  Equilibrium here(m, scene.cloth(), scene.force(), scene.watched());
  modes = here.modes(10);
  const auto below = [&](double level) {  // the number of such modes
    return std::size_t(std::ranges::count_if(
        modes, [=](const Mode& mode) { return mode.square < level; }));
  };
  growing = below(-here.zero());
  loose = below(here.zero()) - growing;
  for (std::size_t k = 0; k < scene.held().size(); ++k) {
    Point sum;
    for (const auto& held : scene.held()[k].nodes)
      sum += scene.force()(arrays(g).node_with_id(held.id), 0);
    pins.push_back(
        {k < m.pins.size() ? "pin " + to_words(m.pins[k]) : "held by the net",
         sum});
  }
  if (const auto one_way = ForcePlan(scene.force()).potential().one_way)
    for (Edge e : g.edges())
      if (one_way->is_slack(e.id(), e.length(), e.value()))
        slack.push_back({e.node1().index(), e.node2().index()});
  for (Node n : g.nodes()) {
    if (n.id() >= number_.size()) number_.resize(n.id() + 1);
    number_[n.id()] = n.index();
  }
  for (const MethodEntry& method : methods)
    if (method.info.limit > 0 && method.info.limit < no_limit)
      if (const double dt = scene.stepper().limits().sharp(method, 60);
          dt < no_limit)
        steps_ += (steps_.empty() ? " " : ", ") +
                  std::string(method.info.name) + ' ' + short_text(dt);
}

/** The nodes that take part in @a some modes, rising. */
std::vector<unsigned> RestReport::nodes_of(std::span<const Mode> some) const {
  std::vector<double> moves(number_.size());  // how much each node does
  for (const Mode& mode : some)
    for (std::size_t id = 0; id < moves.size(); ++id)
      moves[number_[id]] += normSq(mode.shape[id]);
  std::vector<unsigned> all;
  const double most = moves.empty() ? 0 : std::ranges::max(moves);
  for (unsigned i = 0; i < moves.size(); ++i)
    if (moves[i] > 1e-8 * most) all.push_back(i);
  return all;
}

std::vector<unsigned> RestReport::growing_nodes() const {
  return nodes_of(std::span(modes).first(std::min<std::size_t>(growing, 1)));
}
std::vector<unsigned> RestReport::loose_nodes() const {
  return nodes_of(std::span(modes).subspan(growing, loose));
}

std::vector<double> RestReport::frequencies() const {
  std::vector<double> all(loose);
  for (std::size_t k = growing + loose; k < modes.size(); ++k)
    all.push_back(std::sqrt(modes[k].square) / (2 * std::numbers::pi));
  return all;
}

std::string RestReport::text() const {
  std::string text = "at rest: " + short_text(residual) + " N are left of " +
                     short_text(load) + " N, after " +
                     CME212::count_of(std::size_t(factors), "Cholesky factor") +
                     '\n';
  if (growing > 0)
    text += "unstable: a motion of " + in_words(growing_nodes()) +
            " grows e times every " +
            short_text(1 / std::sqrt(-modes[0].square)) + " s\n";
  if (loose > 0)
    text += "no energy holds " + in_words(loose_nodes()) +
            ", which may move freely" +
            (shift > 0 ? ": a shift of " + short_text(shift) +
                             " 1/s^2 times the mass settled them\n"
                       : "\n");
  if (stable() && !modes.empty())
    text += "stable: the smallest eigenvalue is " +
            short_text(modes[0].square) + " 1/s^2\n";
  for (const auto& [name, force] : pins)
    text += name + ": " + short_text(norm(force)) + " N, " +
            lab::short_text(force) + '\n';
  for (const auto& ends : slack)
    text += (&ends == slack.data() ? "slack: that of " : ", of ") +
            in_words({ends[0], ends[1]});
  if (!slack.empty()) text += '\n';
  const std::vector<double> all = frequencies();
  if (!all.empty()) text += "lowest frequencies [Hz]:";
  for (double f : all) text += ' ' + short_text(f);
  if (!all.empty()) text += '\n';
  if (!steps_.empty()) text += "largest stable steps [s]:" + steps_ + '\n';
  if (const std::size_t slowest = growing + loose; slowest < modes.size())
    text += "the slowest mode is critically damped by a drag over mass of " +
            short_text(2 * std::sqrt(modes[slowest].square)) + " 1/s\n";
  return text;
}

}  // namespace lab
