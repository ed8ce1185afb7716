#include "lab/advice/Variation.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "lab/scenes/Compose.hpp"
#include "lab/scenes/Measure.hpp"
#include "lab/scenes/Words.hpp"

namespace lab {

Model refined(const Model& m, double factor) {
  Model fine = m;
  double before = 0, after = 0;
  for (Sheet& s : fine.sheets) {
    before += double(s.nodes[0]) * s.nodes[1];
    for (unsigned& n : s.nodes)
      n = 1 + unsigned(std::max(2.0, std::round((n - 1) * factor)));
    after += double(s.nodes[0]) * s.nodes[1];
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

/** Collects a scene without one part, and then without another one. */
class Dropper {
 public:
  explicit Dropper(const Model& m) : m_(m) {}

  template <typename Change>
  void drop(const std::string& part, Change change) {
    Variation v{part, true, m_};
    change(v.model);
    all_.push_back(std::move(v));
  }
  /** Each part of a kind, and its friction. */
  template <typename Part>
  void drop_each(const std::string& key, std::vector<Part> Model::*list) {
    for (std::size_t k = 0; k < (m_.*list).size(); ++k) {
      const std::string words = to_words((m_.*list)[k]);
      const std::string part = key + (words.empty() ? "" : ": " + words);
      drop(part, [&](Model& x) {
        (x.*list).erase((x.*list).begin() + std::ptrdiff_t(k));
      });
      if constexpr (requires(Part p) { p.friction; })
        if ((m_.*list)[k].friction > 0)
          drop("friction of " + part,
               [&](Model& x) { (x.*list)[k].friction = 0; });
    }
  }
  std::vector<Variation> all() && { return std::move(all_); }

 private:
  const Model& m_;
  std::vector<Variation> all_;
};

}  // namespace

std::vector<Variation> without_parts(const Model& m) {
  Dropper d(m);
  if (m.edges.diagonals)
    d.drop("edges: diagonals", [](Model& x) { x.edges.diagonals = false; });
  if (m.edges.bend)
    d.drop("edges: bend", [](Model& x) { x.edges.bend = false; });
  if (m.gravity != 0) d.drop("gravity", [](Model& x) { x.gravity = 0; });
  if (m.damping > 0 && !m.material.drag)
    d.drop("damping", [](Model& x) { x.damping = 0; });
  if (m.material.drag && *m.material.drag > 0)
    d.drop("drag", [](Model& x) { x.material.drag = 0; });
  d.drop_each("region", &Model::regions);
  d.drop_each("pin", &Model::pins);
  d.drop_each("plane", &Model::planes);
  d.drop_each("sphere", &Model::spheres);
  d.drop_each("tear", &Model::tears);
  if (m.tear_strain)
    d.drop("tear-strain", [](Model& x) { x.tear_strain.reset(); });
  if (m.self_collision) {
    d.drop("self-collision", [](Model& x) { x.self_collision.reset(); });
    if (m.self_collision->friction > 0)
      d.drop("friction of self-collision",
             [](Model& x) { x.self_collision->friction = 0; });
  }
  return std::move(d).all();
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

std::vector<Variation> with_more_parts(const Model& m) {
  std::vector<Variation> all;
  auto add = [&](const std::string& part, auto change) {
    all.push_back({part, false, m});
    change(all.back().model);
  };
  if (!m.edges.diagonals)
    add("edges: diagonals", [](Model& x) { x.edges.diagonals = true; });
  if (!m.sheets.empty()) add("finer grid", [](Model& x) { x = refined(x, 2); });
  add("half the step", [](Model& x) { x.step = {.dt = step_of(x) / 2}; });
  if (!m.self_collision)
    add("self-collision", [](Model& x) {
      x.self_collision = Distance{.thickness = 0.75 * shortest_side(x)};
    });
  return all;
}

}  // namespace lab
