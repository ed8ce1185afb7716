#pragma once
/** @file Compose.hpp
 * How a scene's cloth, force and constraint are made: those of a Model, which
 * have what it names and nothing else, and those of a stage. */
#include <algorithm>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "lab/fast/OrderedCloth.hpp"
#include "lab/scenes/Model.hpp"
#include "lab/scenes/SelfCollision.hpp"

namespace lab {

/** Something to be seen besides the cloth. */
struct Obstacle {
  enum class Kind { floor, ball, tearing_ball } kind;
  Point at;           ///< on the floor, or the ball's center, at t = 0 [m]
  double radius = 0;  ///< of a ball [m]
  Motion motion = {};
};

/** How a scene is made, as often as it is restarted. */
struct Recipe {
  std::string name;
  /** Into an empty cloth. */
  std::function<void(Cloth&)> build;
  std::function<CombinedForces(const Cloth&)> force;
  std::function<CombinedConstraints(const Cloth&)> constraint;
  std::vector<Obstacle> obstacles;
  std::vector<Point> room;  ///< corners of what to look at; empty: the cloth
};

// ----------------------------------------------------------------- A mesh

/** Points and quads: what a cloth is built from. */
struct PointsAndQuads {
  std::vector<Point> points;  // [m]
  std::vector<Quad> quads;
};

/** Add the points and quads of @a s: the index of a point grows along v first,
 * as in grid_points(). */
inline void add_sheet(PointsAndQuads& mesh, const Sheet& s) {
  const auto [n, m] = s.nodes;
  const auto first = unsigned(mesh.points.size());
  for (const Point& p : grid_points(n, m))
    mesh.points.push_back(s.at + p.x * s.u + p.y * s.v);
  for (Quad q : grid_quads(n, m)) {
    for (unsigned& i : q) i += first;
    mesh.quads.push_back(q);
  }
}

/** The mesh that @a m names.  Throws InputError, SceneError */
inline PointsAndQuads mesh_of(const Model& m) {
  PointsAndQuads mesh;
  if (m.sheets.empty()) {
    mesh.points = load_points(m.nodes);
    mesh.quads = load_quads(m.tets, mesh.points.size());
  }
  for (const std::string& text : m.sheets) add_sheet(mesh, read_sheet(text));
  return mesh;
}

namespace compose_detail {

/** Two points, the quad of which they are a side, and their neighbors along
 * the sides that go on from them. */
struct Side {
  std::array<unsigned, 2> ends;  // the smaller one first
  std::size_t quad;
  std::array<unsigned, 2> beyond;  // the ends of the side across
};

/** All sides of all quads; those of the same ends follow each other. */
inline std::vector<Side> sorted_sides(const std::vector<Quad>& quads) {
  std::vector<Side> all;
  for (std::size_t k = 0; k < quads.size(); ++k)
    for (auto [a, b] : quad_sides) {
      // Corner c of a quad has the neighbors c ^ 1 and c ^ 2 along its sides.
      const unsigned across = (a ^ b) == 1 ? 2 : 1;
      const Quad& q = quads[k];
      Side s = {{q[a], q[b]}, k, {q[a ^ across], q[b ^ across]}};
      if (s.ends[0] > s.ends[1]) {
        std::swap(s.ends[0], s.ends[1]);
        std::swap(s.beyond[0], s.beyond[1]);
      }
      all.push_back(s);
    }
  std::ranges::sort(all, {},
                    [](const Side& s) { return std::pair(s.ends, s.quad); });
  return all;
}

/** Call @a use(p, q, i, j) for each two points @a p and @a q that are two sides
 * apart, across a side that quads i and j share: twice inside a grid. */
template <typename Use>
void each_bend(const std::vector<Quad>& quads, Use use) {
  const auto all = sorted_sides(quads);
  for (std::size_t k = 1; k < all.size(); ++k) {
    const Side &s = all[k - 1], &t = all[k];
    if (s.ends != t.ends) continue;
    for (int end : {0, 1})
      if (s.beyond[end] != t.beyond[end])
        use(s.beyond[end], t.beyond[end], s.quad, t.quad);
  }
}

inline double area(const PointsAndQuads& mesh, const Quad& q) {
  const auto& p = mesh.points;
  return norm(cross(p[q[3]] - p[q[0]], p[q[2]] - p[q[1]])) / 2;
}

/** K of all springs by the modulus Y [N/m]: a spring stands for the width of
 * cloth at its side, so that cloth of squares has K = Y, and half of that in
 * sides at its rim. */
inline void set_stiffness(Cloth& g, const PointsAndQuads& mesh,
                          const Edges& edges, double modulus) {
  for (Edge e : g.edges()) e.value().K = 0;
  auto add = [&](unsigned i, unsigned j, double area_of_width) {
    Edge e = g.add_edge(g.node(i), g.node(j));  // there already
    const double l = e.value().L;
    if (l > 0) e.value().K += Real(modulus * area_of_width / (l * l));
  };
  for (const Quad& q : mesh.quads) {
    const double a = area(mesh, q);
    for (auto [i, j] : quad_sides) add(q[i], q[j], a / 2);
    if (edges.diagonals)
      for (auto [i, j] : quad_diagonals) add(q[i], q[j], 2 * a);
  }
  if (edges.bend)
    each_bend(
        mesh.quads, [&](unsigned p, unsigned q, std::size_t i, std::size_t j) {
          add(p, q, area(mesh, mesh.quads[i]) + area(mesh, mesh.quads[j]));
        });
}

/** The masses by the density [kg/m^2]: each node has a quarter of the quads at
 * it.  Throws SceneError: a node in no quad */
inline void set_masses(Cloth& g, const PointsAndQuads& mesh, double density) {
  std::vector<double> share(mesh.points.size());
  for (const Quad& q : mesh.quads)
    for (unsigned i : q) share[i] += area(mesh, q) / 4;
  for (unsigned i = 0; i < share.size(); ++i) {
    if (!(share[i] > 0))
      throw SceneError("density", "gives no mass to node " + std::to_string(i) +
                                      ", which lies in no quad");
    g.node(i).value().mass = Real(density * share[i]);
  }
}

}  // namespace compose_detail

/** Build the cloth of @a m from @a mesh, that of mesh_of(m), into @a g.
 * @pre g.size() == 0   Throws SceneError */
inline void build_model(Cloth& g, const Model& m, const PointsAndQuads& mesh) {
  using namespace compose_detail;
  const Edges edges = read_edges(m.edges);
  build_ordered_cloth(g, mesh.points, mesh.quads,
                      edges.diagonals ? Mesh::diagonals : Mesh::plain,
                      m.with.stiffness);
  if (edges.bend)
    each_bend(
        mesh.quads, [&](unsigned p, unsigned q, std::size_t, std::size_t) {
          const double l = norm(mesh.points[p] - mesh.points[q]);
          g.add_edge(g.node(p), g.node(q), {Real(m.with.stiffness), Real(l)});
        });
  if (m.material.modulus) set_stiffness(g, mesh, edges, *m.material.modulus);
  if (m.material.density) set_masses(g, mesh, *m.material.density);
}

/** The forces of @a m: gravity and springs, and drag if there is any. */
inline CombinedForces force_of(const Model& m, const PointsAndQuads& mesh) {
  double c = m.with.damping;
  if (m.material.drag) {
    double all = 0;
    for (const Quad& q : mesh.quads) all += compose_detail::area(mesh, q);
    c = *m.material.drag * all / double(mesh.points.size());
  }
  CombinedForces::List forces;
  if (m.with.gravity != 0)
    forces.push_back(std::make_shared<GravityForce>(m.with.gravity));
  forces.push_back(std::make_shared<MassSpringForce>());
  if (c > 0) forces.push_back(std::make_shared<DampingForce>(c));
  return CombinedForces(std::move(forces));
}

/** The constraints of @a m on @a g, which lies as it was built. In this order:
 * tearing, obstacles, pins: where two disagree about a node, the later one has
 * its way. Self-collision goes on with all of these until none is violated.
 * Throws SceneError: a pin that holds no node, a distance that is too large. */
inline CombinedConstraints constraint_of(const Model& m, const Cloth& g) {
  CombinedConstraints::List all;
  auto add = [&](auto constraint) {
    all.push_back(
        std::make_shared<decltype(constraint)>(std::move(constraint)));
  };
  for (const std::string& text : m.tears) add(TearConstraint(read_tear(text)));
  if (m.tear_strain) add(StrainConstraint(*m.tear_strain));
  for (const std::string& text : m.planes) {
    const Wall w = read_plane(text);
    add(WallConstraint(w.at, w.normal, w.motion, w.friction));
  }
  for (const std::string& text : m.spheres) {
    const Solid s = read_sphere(text);
    add(BallConstraint(s.ball, s.motion, s.friction));
  }
  for (const std::string& text : m.pins) {
    const Pin pin = read_pin(text);
    const PinConstraint pins(g,
                             [&pin](const Point& p) { return pin.holds(p); });
    if (pins.pins().empty())
      throw SceneError("pin", "\"" + text + "\" holds no node");
    if (pin.motion.velocity == Point())
      add(pins);
    else
      add(MovingPinConstraint(pins, pin.motion));
  }
  if (m.self_collision.empty()) return CombinedConstraints(std::move(all));
  const Distance d = read_self_collision(m.self_collision);
  if (const double least = nearest_unconnected(g, d.thickness);
      least < d.thickness)
    throw SceneError("self-collision",
                     "has thickness " + CME212::short_text(d.thickness) +
                         " m, but two nodes without a common edge start " +
                         CME212::short_text(least) + " m apart");
  return make_combined_constraints(SelfCollision(
      d.thickness, d.friction, CombinedConstraints(std::move(all))));
}

/** The recipe of @a m.  Throws InputError, SceneError: also of what is made
 * from it. */
inline Recipe recipe_of(const Model& m) {
  auto mesh = std::make_shared<const PointsAndQuads>(mesh_of(m));
  Recipe r;
  r.name = "scene";
  r.build = [m, mesh](Cloth& g) { build_model(g, m, *mesh); };
  r.force = [m, mesh](const Cloth&) { return force_of(m, *mesh); };
  r.constraint = [m](const Cloth& g) { return constraint_of(m, g); };
  using Kind = Obstacle::Kind;
  for (const std::string& text : m.planes) {
    const Wall w = read_plane(text);
    // One that is inclined would hide what lies on it.
    if (w.normal == Point(0, 0, 1))
      r.obstacles.push_back({Kind::floor, w.at, 0, w.motion});
  }
  for (const std::string& text : m.spheres) {
    const Solid s = read_sphere(text);
    r.obstacles.push_back({Kind::ball, s.ball.center, s.ball.radius, s.motion});
  }
  for (const std::string& text : m.tears) {
    const Ball b = read_tear(text);
    r.obstacles.push_back({Kind::tearing_ball, b.center, b.radius});
  }
  return r;
}

}  // namespace lab
