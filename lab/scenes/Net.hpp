#pragma once
/** @file Net.hpp
 * Net: what a cloth is built from, as plain data: nodes, faces and springs. */
#include <cmath>
#include <compare>
#include <string>
#include <vector>

#include "CME212/Mesh.hpp"
#include "lab/fast/Energy.hpp"

namespace lab {

/** The face with the corners @a a, @a b, @a c, @a d in their order around it;
 * with three corners a triangle, which is a Quad whose last corner is there
 * twice, at 1 and 3. */
constexpr Quad face_around(unsigned a, unsigned b, unsigned c, unsigned d) {
  return {a, d, b, c};
}
constexpr Quad face_around(unsigned a, unsigned b, unsigned c) {
  return face_around(a, b, c, c);
}
constexpr bool is_triangle(const Quad& face) { return face[1] == face[3]; }

inline bool is_finite(const Point& p) {
  return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
}

/** A spring between two nodes. */
struct Spring {
  unsigned i, j;
  double K = -1;  ///< [N/m]; negative: as the scene gives it to its springs
  double L = -1;  ///< rest length [m]; negative: the distance of i and j
  Acts acts = Acts::both;
  auto operator<=>(const Spring&) const = default;
};

/** A constant force on a node. */
struct Load {
  unsigned node;
  Point force;  ///< [N]
  bool operator==(const Load&) const = default;
};

/** Nodes, and what joins them. */
struct Net {
  std::vector<Point> points = {};  ///< of the nodes [m]
  /** The faces: quads, and triangles by face_around(). Their springs are those
   * that the scene names: sides, diagonals, bend. */
  std::vector<Quad> quads = {};
  /** Velocities of the nodes at t = 0 [m/s]; empty: at rest. */
  std::vector<Point> velocities = {};
  /** More springs. One in the place of a face's spring replaces it; several
   * with the same ends act together. */
  std::vector<Spring> springs = {};
  std::vector<double> masses = {};  ///< [kg]; empty: 1 kg in equal parts
  std::vector<unsigned> held = {};  ///< nodes held where they are
  std::vector<Load> loads = {};     ///< those of one node add up
  /** The faces have no springs: they are surface alone, for area and view. */
  bool bare_faces = false;
  /** Changes that a reader made to the mesh of a file, a sentence each. */
  std::vector<std::string> notes = {};
  bool operator==(const Net&) const = default;
};

}  // namespace lab
