#include "lab/scenes/Acting.hpp"

#include <algorithm>
#include <limits>
#include <string_view>

#include "CME212/Util.hpp"
#include "lab/fast/Energy.hpp"
#include "lab/methods/Method.hpp"
#include "lab/scenes/Compose.hpp"
#include "lab/scenes/Fields.hpp"
#include "lab/scenes/Words.hpp"

namespace lab {
namespace {

using CME212::count_of;
using CME212::short_text;

std::string range(double low, double high) {
  return short_text(low) + (low < high ? " to " + short_text(high) : "");
}

std::string of_method(const MethodInfo& info) {
  std::string text = "a step of " + std::string(info.name) + ", order " +
                     std::to_string(info.order) + ": " +
                     count_of(std::size_t(info.sweeps), "force evaluation");
  if (info.adaptive)
    text += " in each of its inner steps";
  else if (info.limit == no_limit)
    text += " and linear solves (cost: --list-methods)";
  return text;
}

std::string of_cloth(const Model& m, const Cloth& g, const Net& mesh) {
  std::string from;
  for (const Sheet& s : m.sheets)
    from += (from.empty() ? "" : " and ") + std::to_string(s.nodes[0]) + " x " +
            std::to_string(s.nodes[1]) + " nodes";
  if (m.sheets.empty())
    from = m.net.empty() ? m.nodes + " and " + m.tets : m.net;
  return "cloth of " + from + ", " + short_text(total_mass(g)) + " kg: " +
         count_of(std::size_t(std::ranges::count(is_held(m, mesh), 0)),
                  "node") +
         " moved";
}

}  // namespace

std::vector<std::string> what_acts(const Model& m, const Cloth& g,
                                   const Net& mesh) {
  std::vector<std::string> all = {of_method(m.method->info)};
  auto add = [&](const std::string& what, const std::string& work) {
    all.push_back("  " + what + ": " + work);
  };
  all.push_back("  " + of_cloth(m, g, mesh));
  const std::string each_node = count_of(g.num_nodes(), "node");
  const std::string times =
      m.method->info.sweeps > 1
          ? std::to_string(m.method->info.sweeps) + " times "
          : "";
  // Forces
  double low = std::numeric_limits<double>::infinity(), high = 0;
  for (Edge e : g.edges()) {
    low = std::min<double>(low, e.value().K);
    high = std::max<double>(high, e.value().K);
  }
  if (g.num_edges() > 0)
    add("springs, K " + range(low, high) + " N/m",
        times + count_of(g.num_edges(), "spring"));
  for (const Acts acts : {Acts::pulls, Acts::pushes})
    if (const auto n = std::ranges::count(mesh.springs, acts, &Spring::acts))
      add(acts == Acts::pulls ? "cables, which only pull"
                              : "struts, which only push",
          std::to_string(n) + " of these");
  if (m.gravity != 0)
    add("gravity " + (m.gravity.is_down()
                          ? short_text(m.gravity.size()) + " m/s^2 down"
                          : to_words(m.gravity) + " m/s^2"),
        times + each_node);
  if (!mesh.loads.empty())
    add("loads of the net", times + count_of(mesh.loads.size(), "load"));
  if (const auto drag = m.material.drag; drag && *drag > 0)
    add("drag " + short_text(*drag) + " kg/(s m^2)", times + each_node);
  else if (!drag && m.damping > 0)
    add("drag " + short_text(m.damping) + " kg/s a node", times + each_node);
  if (m.wind) add("wind " + to_words(*m.wind), times + each_node);
  // Constraints
  Model copy = m;
  for (const Field& f : fields_of(copy)) {
    const std::string_view name = f.name;
    const std::string work =
        name == "tear-strain" ? count_of(g.num_edges(), "spring") : each_node;
    if (f.role == Role::contact)
      for (const std::string& value : f.values())
        add(f.name + (value.empty() ? "" : ' ' + value),
            name == "self-collision"
                ? work + ", each compared with the nodes within that distance"
                : work);
  }
  const auto held = points_held(m, mesh);
  for (std::size_t k = 0; k < held.size(); ++k)
    add(k < m.pins.size() ? "pin " + to_words(m.pins[k]) : "held by the net",
        count_of(held[k].size(), "node"));
  return all;
}

}  // namespace lab
