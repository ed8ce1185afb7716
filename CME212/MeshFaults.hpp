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

/** The number of @a quads whose corners are listed around, a b d c, as other
 * formats do: as Quad their sides would cross. Where corners 0 2 and 1 3 are
 * opposite, the area between these diagonals is the larger one. */
inline std::size_t num_around(std::span<const Point> points,
                              std::span<const Quad> quads) {
  const auto area = [&](const Quad& q, int a, int b, int c, int d) {
    return norm(
        cross(points[q[a]] - points[q[b]], points[q[c]] - points[q[d]]));
  };
  return std::size_t(std::ranges::count_if(quads, [&](const Quad& q) {
    return q[1] != q[3] && area(q, 0, 2, 1, 3) > 1.5 * area(q, 0, 3, 1, 2);
  }));
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

/** The pairs of points that lie at one place, to 1e-6 of the size of all: of
 * several there, each with the next one. */
inline std::vector<std::array<unsigned, 2>> coincident(
    std::span<const Point> points) {
  const CME212::BoundingBox box(points);
  const double unit = 1e-6 * box.diagonal();
  std::vector<std::pair<std::array<double, 3>, unsigned>> cells;
  cells.reserve(points.size());
  for (unsigned i = 0; i < points.size(); ++i) {
    auto& cell = cells.emplace_back(std::array<double, 3>(), i).first;
    for (int k : {0, 1, 2})
      cell[k] = unit > 0 ? std::round((points[i][k] - box.min()[k]) / unit) : 0;
  }
  std::ranges::sort(cells);
  std::vector<std::array<unsigned, 2>> pairs;
  for (std::size_t k = 1; k < cells.size(); ++k)
    if (cells[k].first == cells[k - 1].first)
      pairs.push_back({cells[k - 1].second, cells[k].second});
  return pairs;
}

/** The faults of a mesh, a sentence each.
 * @param springs the ends of springs besides those of the quads
 * Complexity: O((points + quads) log(points + quads) + springs) */
inline std::vector<std::string> mesh_faults(
    std::span<const Point> points, std::span<const Quad> quads,
    std::span<const std::array<unsigned, 2>> springs = {}) {
  using CME212::count_of, std::to_string;
  std::vector<std::string> all;
  const auto are = [](std::size_t n, const char* one, const char* more) {
    return n == 1 ? one : more;
  };
  if (const auto n = num_around(points, quads); n > quads.size() / 2)
    all.push_back(to_string(n) + " of " + count_of(quads.size(), "quad") +
                  are(n, " lists", " list") +
                  " the corners around, as a b d c: springs cross; list them "
                  "as a b c d with the sides ab, ac, bd and cd");
  if (const auto again = repeated(quads); !again.empty())
    all.push_back(count_of(again.size(), "face") +
                  are(again.size(), " is", " are") + " listed twice, number " +
                  to_string(again[0]) + are(again.size(), "", " first") +
                  ": their area and mass count twice");
  // Points at one place, without those that a face or a spring joins.
  auto pairs = coincident(points);
  for (auto& [i, j] : pairs)
    if (i > j) std::swap(i, j);
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
  all.push_back(
      to_string(loose) + " of " + count_of(used.size(), "node") +
      are(loose, " lies", " lie") + " in no " +
      (springs.empty() ? "quad" : "face or spring") + ", node " +
      to_string(first) + are(loose, "", " first") + ": no spring holds " +
      are(loose, "it", "them") + "; use nodes and quads of the same mesh" +
      (loose == 1 && first == 0 ? ", and indices that start at 0, not at 1"
                                : ""));
  return all;
}
