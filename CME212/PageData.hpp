#pragma once
/** @file PageData.hpp
 * The parts of a cloth that the web pages draw, and the force of their hand,
 * for any graph. A slot numbers a node and stays when others are removed. */
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "CME212/Mesh.hpp"
#include "CME212/Point.hpp"

namespace CME212 {

/** For each slot x y z [m] of its node, and the largest strain of an edge
 * there.
 * @param slot slot(Node)   @param rest rest(Edge), its rest length [m] */
template <typename Nodes, typename Edges, typename Slot, typename Rest>
void set_page_points(std::vector<float>& points, std::size_t slots,
                     Nodes&& nodes, Edges&& edges, Slot slot, Rest rest) {
  points.assign(4 * slots, 0);
  for (auto n : nodes) {
    float* to = &points[4 * std::size_t(slot(n))];
    for (unsigned k = 0; k < 3; ++k)
      to[k] = float(std::as_const(n).position()[k]);
  }
  for (auto e : edges) {
    const auto a = e.node1(), b = e.node2();
    const double L = rest(e), length = norm(a.position() - b.position());
    const auto strain = float(L > 0 ? std::abs(length / L - 1) : 0);
    for (const auto& n : {a, b}) {
      float& most = points[4 * std::size_t(slot(n)) + 3];
      most = std::max(most, strain);
    }
  }
}

/** Numbers of edges, triangles and pinned nodes; then the slots of each. */
inline std::vector<unsigned> page_mesh(
    const std::vector<std::array<unsigned, 2>>& edges,
    const std::vector<Quad>& faces, const std::vector<unsigned>& pins) {
  std::vector<unsigned> mesh = {unsigned(edges.size()),
                                unsigned(2 * faces.size()),
                                unsigned(pins.size())};
  for (const auto& ends : edges)
    mesh.insert(mesh.end(), ends.begin(), ends.end());
  for (const Quad& q : faces)
    for (unsigned k : {0, 1, 2, 1, 3, 2}) mesh.push_back(q[k]);
  mesh.insert(mesh.end(), pins.begin(), pins.end());
  return mesh;
}

/** The line behind a point of the screen, from the near plane to the far one
 * [m]. */
struct Ray {
  Point near, far;
};
/** Does the segment from @a p to @a q meet the surface between the rays @a a
 * and @a b, two triangles? A segment through a side that two triangles share
 * meets exactly one of them, as turns() gets each side in one direction. */
inline bool meets(const Point& p, const Point& q, const Ray& a, const Ray& b) {
  const auto volume = [](const Point& o, const Point& x, const Point& y,
                         const Point& z) {
    return dot(x - o, cross(y - o, z - o));
  };
  // Are p and q on both sides of a triangle?
  const auto parts = [&](const Point& x, const Point& y, const Point& z) {
    return (volume(p, x, y, z) > 0) != (volume(q, x, y, z) > 0);
  };
  // How the line through p and q turns about a side.
  const auto turns = [&](const Point& x, const Point& y) {
    return volume(p, q, x, y) > 0;
  };
  const bool first = turns(a.near, a.far), last = turns(b.near, b.far),
             across = turns(a.near, b.far);
  return (first != across && first == turns(a.far, b.far) &&
          parts(a.near, a.far, b.far)) ||
         (last != across && last == turns(a.near, b.near) &&
          parts(a.near, b.far, b.near));
}

/** The pull [N] of a hand at @a way [m] from a node: K @a way, cut off at
 * @a most [N]. */
inline Point hand_pull(double K, const Point& way, double most) {
  const Point f = K * way;
  const double size = norm(f);
  return size > most ? most / size * f : f;
}

}  // namespace CME212
