#include "lab/advice/Variation.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>

#include "lab/scenes/Compose.hpp"
#include "lab/scenes/Fields.hpp"
#include "lab/scenes/Measure.hpp"

namespace lab {

Model refined(const Model& m, const Sides& sides) {
  if (sides.empty()) return m;
  Model fine = m;
  double before = 0, after = 0;
  for (std::size_t k = 0; k < sides.size(); ++k) {
    auto& n = fine.sheets[k].nodes;
    before += double(n[0]) * n[1];
    for (unsigned along : {0, 1})
      if (n[along] > 1)  // else a rope
        n[along] = 1 + unsigned(std::max(
                           2.0, std::round((n[along] - 1) * sides[k][along])));
    after += double(n[0]) * n[1];
  }
  fine.damping *= before / after;
  // On a grid with nodes nearer than the thickness it goes down with the grid.
  if (fine.self_collision) {
    const double apart =
        shortest_side(fine) * (fine.edges.diagonals ? 2 : std::sqrt(2));
    double& d = fine.self_collision->thickness;
    if (d < shortest_side(m) * 2) d = std::min(d, 0.95 * apart);
  }
  return fine;
}

namespace {

/** @a words without the friction that they name; nullopt if they name none. */
std::optional<std::string> without_friction(std::string words) {
  auto from = words.find("friction ");
  if (from == std::string::npos) return std::nullopt;
  const auto end = words.find(' ', from + sizeof "friction");
  if (end == std::string::npos && from > 0) --from;  // the blank before it
  return words.erase(from, end == std::string::npos ? end : end + 1 - from);
}

}  // namespace

std::vector<Variation> without_parts(const Model& m) {
  std::vector<Variation> all;
  auto drop = [&](const std::string& part, auto change) {
    all.push_back({part, m});
    change(all.back().model);
  };
  const bool ropes = std::ranges::all_of(m.sheets, [](const Sheet& s) {
    return s.nodes[0] == 1 || s.nodes[1] == 1;
  });
  if (m.edges.diagonals && (!ropes || m.sheets.empty()))
    drop("edges: diagonals", [](Model& x) { x.edges.diagonals = false; });
  if (m.edges.bend) drop("edges: bend", [](Model& x) { x.edges.bend = false; });
  // Without gravity its energy would be another quantity.
  if (m.gravity != 0 && m.measure.quantity != Measure::energy)
    drop("gravity", [](Model& x) { x.gravity = 0; });
  if (m.damping > 0 && !m.material.drag)
    drop("damping", [](Model& x) { x.damping = 0; });
  if (m.material.drag && *m.material.drag > 0)
    drop("drag", [](Model& x) { x.material.drag = 0; });
  Model copy = m;
  for (const Field& f : fields_of(copy)) {
    if (f.role != Role::acts && f.role != Role::contact) continue;
    const auto values = f.values();
    for (std::size_t k = 0; k < values.size(); ++k) {
      std::string part = f.name;
      if (f.repeats() && !values[k].empty()) part += ": " + values[k];
      auto others = values;
      others.erase(others.begin() + std::ptrdiff_t(k));
      drop(part, [&](Model& x) { set_field(x, f.name, others); });
      if (const auto smooth = without_friction(values[k])) {
        others.insert(others.begin() + std::ptrdiff_t(k), *smooth);
        drop("friction of " + part,
             [&](Model& x) { set_field(x, f.name, others); });
      }
    }
  }
  return all;
}

bool goes_with_another(const std::string& part,
                       const std::vector<std::string>& gone) {
  return std::ranges::any_of(gone, [&](const std::string& other) {
    return part == "friction of " + other;
  });
}

std::optional<Model> without_all(Model m,
                                 const std::vector<std::string>& gone) {
  for (const std::string& part : gone) {
    if (goes_with_another(part, gone)) continue;
    const auto all = without_parts(m);
    auto it = std::ranges::find(all, part, &Variation::part);
    if (it == all.end()) return std::nullopt;
    m = it->model;
  }
  return m;
}

}  // namespace lab
