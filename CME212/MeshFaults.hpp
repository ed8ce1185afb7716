#pragma once
/** @file MeshFaults.hpp
 * Faults of a mesh that make another cloth of it than was meant. */
#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "CME212/BoundingBox.hpp"
#include "CME212/Mesh.hpp"
#include "CME212/Util.hpp"

/** "face" if one of @a quads is a triangle, else "quad". */
inline const char* face_or_quad(std::span<const Quad> quads) {
  const auto is_triangle = [](const Quad& q) { return q[1] == q[3]; };
  return std::ranges::any_of(quads, is_triangle) ? "face" : "quad";
}

/** Does the side of @a q between corners 0 and @a a cross the opposite one? */
inline bool crosses(std::span<const Point> points, const Quad& q, int a) {
  const Point p = points[q[0]], r = points[q[a]], s = points[q[3 - a]],
              t = points[q[3]];
  // Are the ends of each line on both sides of the other?
  const auto parts = [](const Point& i, const Point& j, const Point& k,
                        const Point& l) {
    return dot(cross(j - i, k - i), cross(j - i, l - i)) < 0;
  };
  return parts(p, r, s, t) && parts(s, t, p, r);
}

/** The number of @a quads whose corners are listed around, a b d c, as other
 * formats do: as Quad, their sides 02 and 13 cross. */
inline std::size_t num_around(std::span<const Point> points,
                              std::span<const Quad> quads) {
  return std::size_t(std::ranges::count_if(
      quads, [&](const Quad& q) { return crosses(points, q, 2); }));
}

/** The positions in @a quads of those with the corners of an earlier one. */
inline std::vector<unsigned> repeated(std::span<const Quad> quads) {
  std::vector<std::pair<Quad, unsigned>> all;
  all.reserve(quads.size());
  for (unsigned k = 0; k < quads.size(); ++k)
    std::ranges::sort(all.emplace_back(quads[k], k).first);
  std::ranges::sort(all);
  std::vector<unsigned> again;
  for (std::size_t k = 1; k < all.size(); ++k)
    if (all[k].first == all[k - 1].first) again.push_back(all[k].second);
  return again;
}

/** Of each point the first one that lies at its place, to 1e-6 of the size of
 * all; a point that is such a first one has itself.  O(n log n) */
inline std::vector<unsigned> first_at_place(std::span<const Point> points) {
  const double near = 1e-6 * CME212::BoundingBox(points).diagonal(),
               side = near > 0 ? 16 * near : 1;
  using Cell = std::array<double, 3>;
  const auto cell_of = [side](const Point& p) {
    const Point cell = p / side;
    return Cell{std::floor(cell.x), std::floor(cell.y), std::floor(cell.z)};
  };
  std::vector<std::pair<Cell, unsigned>> cells;
  std::vector<unsigned> first;
  for (const Point& p : points)
    cells.emplace_back(cell_of(p), unsigned(cells.size()));
  std::ranges::sort(cells);
  for (unsigned i = 0; i < points.size(); ++i) {
    first.push_back(i);
    for (unsigned k = 0; k < 8; ++k) {  // corners of a cube around the point
      const Point sign(k & 1 ? 1 : -1, k & 2 ? 1 : -1, k & 4 ? 1 : -1);
      const Cell cell = cell_of(points[i] + near * sign);
      if (k > 0 && cell == cell_of(points[i] - Point(near))) continue;
      for (auto c = std::ranges::lower_bound(cells, std::pair(cell, 0u));
           c != cells.end() && c->first == cell && c->second < first[i]; ++c)
        if (const unsigned j = c->second;
            first[j] == j && norm(points[j] - points[i]) <= near)
          first[i] = j;
    }
  }
  return first;
}

/** The faults of a mesh, a sentence each.
 * @param springs the ends of springs besides those of the quads
 * Complexity: O((points + quads) log(points + quads) + springs) */
inline std::vector<std::string> mesh_faults(
    std::span<const Point> points, std::span<const Quad> quads,
    std::span<const std::array<unsigned, 2>> springs = {}) {
  using CME212::count_of, std::to_string;
  std::vector<std::string> all;
  const char* const face = face_or_quad(quads);
  const auto are = [](std::size_t n, const char* one, const char* more) {
    return n == 1 ? one : more;
  };
  const auto n = std::size_t(std::ranges::count_if(quads, [&](const Quad& q) {
    return crosses(points, q, 1) || crosses(points, q, 2);
  }));
  if (n > quads.size() / 2)
    all.push_back(to_string(n) + " of " + count_of(quads.size(), face) +
                  are(n, " has", " have") +
                  " sides that cross: .tets lists corners as a b c d with the "
                  "sides ab, ac, bd and cd, other formats list them around");
  if (const auto again = repeated(quads); !again.empty())
    all.push_back(count_of(again.size(), "face") +
                  are(again.size(), " is", " are") + " listed twice, number " +
                  to_string(again[0]) + are(again.size(), "", " first") +
                  ": their area and mass count twice");
  // Points at one place, without those that a face or a spring joins.
  std::vector<std::array<unsigned, 2>> pairs;
  for (unsigned i = 0; const unsigned first : first_at_place(points)) {
    if (first < i) pairs.push_back({first, i});
    ++i;
  }
  std::ranges::sort(pairs);
  std::vector<char> used(points.size());
  const auto join = [&](unsigned i, unsigned j) {
    used[i] = used[j] = 1;
    if (pairs.empty()) return;
    const std::array ends = {std::min(i, j), std::max(i, j)};
    if (const auto p = std::ranges::lower_bound(pairs, ends);
        p != pairs.end() && *p == ends)
      pairs.erase(p);
  };
  for (const auto& [i, j] : springs) join(i, j);
  for (const Quad& q : quads)
    for (unsigned a : {0, 1, 2})
      for (unsigned b = a + 1; b < 4; ++b) join(q[a], q[b]);
  if (const std::size_t n = pairs.size(); n > 0)
    all.push_back(count_of(n, "pair") + " of nodes" + are(n, " lies", " lie") +
                  " at the same point, nodes " + to_string(pairs[0][0]) +
                  " and " + to_string(pairs[0][1]) + are(n, "", " first") +
                  ", and no spring joins them (an export that splits seams): "
                  "the cloth falls into pieces; make each pair one node");
  const auto loose = std::size_t(std::ranges::count(used, 0));
  if (loose == 0) return all;
  const auto first = std::size_t(std::ranges::find(used, 0) - used.begin());
  all.push_back(to_string(loose) + " of " + count_of(used.size(), "node") +
                are(loose, " lies", " lie") + " in no " +
                (springs.empty() ? face : "face or spring") + ", node " +
                to_string(first) + are(loose, "", " first") +
                ": no spring holds " + are(loose, "it", "them") +
                "; use nodes and " + face + "s of the same mesh" +
                (loose == 1 && first == 0
                     ? ", and indices that start at 0, not at 1"
                     : ""));
  return all;
}
