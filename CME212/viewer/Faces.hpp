#pragma once
/** @file Faces.hpp
 * The faces of a cloth for a viewer: which of its quads are complete, and
 * their normals. */
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <span>
#include <vector>

#include "CME212/Mesh.hpp"
#include "CME212/Point.hpp"

namespace CME212 {

/** Both ends of an edge, as indices of nodes; the smaller one first. */
using Ends = std::array<std::uint32_t, 2>;
/** The corners of a Quad in their order around it. For a grid seen from above,
 * its front, that is counterclockwise. */
inline constexpr std::array<unsigned, 4> around_quad = {0, 2, 3, 1};

/** quads_with_sides() of @a faces, those of @a edges.
 * @pre all indices are below @a num_nodes
 * Complexity: O(num_nodes + edges + faces), if no node has very many edges */
inline std::vector<Quad> faces_left(std::span<const Quad> faces,
                                    std::span<const Ends> edges,
                                    std::size_t num_nodes) {
  // The larger ends of the edges of each node, one list after the other.
  std::vector<std::uint32_t> begin(num_nodes + 2), ends(edges.size());
  for (const auto& [low, high] : edges) ++begin[low + 2];
  std::partial_sum(begin.begin(), begin.end(), begin.begin());
  for (const auto& [low, high] : edges) ends[begin[low + 1]++] = high;
  return quads_with_sides(faces, [&](std::uint32_t a, std::uint32_t b) {
    const auto [low, high] = std::minmax(a, b);
    const auto last = ends.begin() + begin[low + 1];
    return std::find(ends.begin() + begin[low], last, high) != last;
  });
}

/** Normals of a smooth surface: at each node the sum of the normals of its
 * faces, weighted by area. Zero at a node without faces, and at one that is not
 * finite. They point to the front.
 * @param position position(i) -> Point, of node i < @a num_nodes
 * Complexity: O(num_nodes + faces) */
template <typename F>
std::vector<Point> face_normals(std::span<const Quad> faces,
                                std::size_t num_nodes, F position) {
  std::vector<Point> normals(num_nodes);
  for (const Quad& f : faces) {
    const Point n =
        cross(position(f[3]) - position(f[0]), position(f[1]) - position(f[2]));
    if (!std::isfinite(normSq(n))) continue;
    for (std::uint32_t corner : f) normals[corner] += n;
  }
  return normals;
}

}  // namespace CME212
