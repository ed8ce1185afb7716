#pragma once
/** @file Variation.hpp
 * A scene with one part less, and a scene with one part more: what shows which
 * parts a question needs. */
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "lab/scenes/Measure.hpp"

namespace lab {

/** A scene that differs from another one in one part. */
struct Variation {
  std::string part;  ///< in the words of the scene
  bool dropped;      ///< else added
  Model model;
};

/** @a m on a grid of @a factor times as many cells along each side of each
 * sheet, at least 2: the same cloth, so the drag of a node goes down as nodes
 * become more.  @pre m has sheets */
inline Model refined(const Model& m, double factor) {
  Model fine = m;
  double before = 0, after = 0;
  for (std::string& text : fine.sheets) {
    Sheet s = read_sheet(text);
    before += double(s.nodes[0]) * s.nodes[1];
    for (unsigned& n : s.nodes)
      n = 1 + unsigned(std::max(2.0, std::round((n - 1) * factor)));
    after += double(s.nodes[0]) * s.nodes[1];
    text = to_words(s);
  }
  fine.with.damping *= before / after;
  return fine;
}

/** The shortest side of a quad where the cloth of @a m starts [m]. */
inline double shortest_side(const Model& m) {
  double least = std::numeric_limits<double>::infinity();
  const PointsAndQuads mesh = mesh_of(m);
  for (const Quad& q : mesh.quads)
    for (auto [i, j] : quad_sides)
      least =
          std::min<double>(least, norm(mesh.points[q[i]] - mesh.points[q[j]]));
  return least;
}

namespace variation_detail {

/** @a text without the word "friction" and its number. */
inline std::string without_friction(const std::string& text) {
  const auto at = text.find("friction");
  if (at == std::string::npos) return text;
  const auto number = text.find_first_not_of(" \t", at + 8);
  const auto end = text.find_first_of(" \t", number);
  return text.substr(0, at) +
         (end == std::string::npos ? "" : text.substr(end + 1));
}

}  // namespace variation_detail

/** @a m without each part that it names, in turn. */
inline std::vector<Variation> without_parts(const Model& m) {
  std::vector<Variation> all;
  auto drop = [&](const std::string& part, auto change) {
    Variation v{part, true, m};
    change(v.model);
    all.push_back(std::move(v));
  };
  const Edges edges = read_edges(m.edges);
  if (edges.diagonals)
    drop("edges: diagonals",
         [&](Model& x) { x.edges = edges.bend ? "sides bend" : "sides"; });
  if (edges.bend)
    drop("edges: bend", [&](Model& x) {
      x.edges = edges.diagonals ? "sides diagonals" : "sides";
    });
  if (m.with.gravity != 0)
    drop("gravity", [](Model& x) { x.with.gravity = 0; });
  if (m.with.damping > 0 && !m.material.drag)
    drop("damping", [](Model& x) { x.with.damping = 0; });
  if (m.material.drag && *m.material.drag > 0)
    drop("drag", [](Model& x) { x.material.drag = 0; });
  using List = std::vector<std::string> Model::*;
  for (auto [name, list] : {std::pair<const char*, List>("pin", &Model::pins),
                            {"plane", &Model::planes},
                            {"sphere", &Model::spheres},
                            {"tear", &Model::tears}})
    for (std::size_t k = 0; k < (m.*list).size(); ++k) {
      const std::string text = (m.*list)[k];
      const std::string part = std::string(name) + ": " + text;
      drop(part, [&, list = list](Model& x) {
        (x.*list).erase((x.*list).begin() + std::ptrdiff_t(k));
      });
      const std::string smooth = variation_detail::without_friction(text);
      if (smooth != text)
        drop("friction of " + part,
             [&, list = list](Model& x) { (x.*list)[k] = smooth; });
    }
  if (m.tear_strain)
    drop("tear-strain", [](Model& x) { x.tear_strain.reset(); });
  if (!m.self_collision.empty()) {
    drop("self-collision", [](Model& x) { x.self_collision.clear(); });
    const std::string smooth =
        variation_detail::without_friction(m.self_collision);
    if (smooth != m.self_collision)
      drop("friction of self-collision",
           [&](Model& x) { x.self_collision = smooth; });
  }
  return all;
}

/** True if @a part is the friction of a part that is @a gone, too. */
inline bool goes_with_another(const std::string& part,
                              const std::vector<std::string>& gone) {
  return std::ranges::any_of(gone, [&](const std::string& other) {
    return part == "friction of " + other;
  });
}

/** @a m without all parts that are @a gone, in the words of without_parts();
 * nothing if it has not got one of them. */
inline std::optional<Model> without_all(Model m,
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

/** @a m with each part that it could have next: diagonals, a grid of twice as
 * many cells along each side, half the step, and self-collision with a
 * thickness that lets no node through a quad of squares. */
inline std::vector<Variation> with_more_parts(const Model& m) {
  std::vector<Variation> all;
  const Edges edges = read_edges(m.edges);
  if (!edges.diagonals) {
    Variation v{"edges: diagonals", false, m};
    v.model.edges += " diagonals";
    all.push_back(std::move(v));
  }
  if (!m.sheets.empty()) all.push_back({"finer grid", false, refined(m, 2)});
  Variation v{"half the step", false, m};
  v.model.with.rule = StepRule::fixed;
  v.model.with.dt = step_of(m) / 2;
  all.push_back(v);
  if (m.self_collision.empty()) {
    Variation c{"self-collision", false, m};
    c.model.self_collision =
        "thickness " + CME212::exact_text(0.75 * shortest_side(m));
    all.push_back(std::move(c));
  }
  return all;
}

}  // namespace lab
