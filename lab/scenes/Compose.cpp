#include "lab/scenes/Compose.hpp"

#include <algorithm>
#include <array>
#include <iterator>
#include <limits>
#include <memory>
#include <utility>

#include "CME212/Util.hpp"
#include "lab/fast/Drag.hpp"
#include "lab/fast/GraphArrays.hpp"
#include "lab/fast/OrderedCloth.hpp"
#include "lab/scenes/Contact.hpp"
#include "lab/scenes/Memory.hpp"
#include "lab/scenes/SelfCollision.hpp"
#include "lab/scenes/Words.hpp"

namespace lab {

namespace {

void add_sheet(PointsAndQuads& mesh, const Sheet& s) {
  const auto [n, m] = s.nodes;
  const auto first = unsigned(mesh.points.size());
  for (const Point& p : grid_points(n, m))
    mesh.points.push_back(s.at + p.x * s.u + p.y * s.v);
  for (Quad q : grid_quads(n, m)) {
    for (unsigned& i : q) i += first;
    mesh.quads.push_back(q);
  }
  if (s.velocity == Point() && mesh.velocities.empty()) return;
  mesh.velocities.resize(first);
  mesh.velocities.resize(mesh.points.size(), s.velocity);
}

/** A side of a quad: its two points, the quad, and the quad's other two points
 * in the order of their neighbors. */
struct Side {
  std::array<unsigned, 2> ends;  // the smaller one first
  std::size_t quad;
  std::array<unsigned, 2> beyond;  // the ends of the opposite side
};

/** All sides of all quads; sides with the same ends are adjacent. */
std::vector<Side> sorted_sides(const std::vector<Quad>& quads) {
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

/** Call @a use(p, q, i, j) for each pair of points p and q that lie two sides
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

double area(const PointsAndQuads& mesh, const Quad& q) {
  const auto& p = mesh.points;
  return norm(cross(p[q[3]] - p[q[0]], p[q[2]] - p[q[1]])) / 2;
}

/** Set K of all springs by the modulus Y [N/m], as build_model() says. */
void set_stiffness(Cloth& g, const PointsAndQuads& mesh, const Edges& edges,
                   double modulus) {
  for (Edge e : g.edges()) e.value().K = 0;
  auto add = [&](unsigned i, unsigned j, double area_of_width) {
    Edge e = g.add_edge(g.node(i), g.node(j));  // there already
    const double l = e.value().L;
    if (l > 0) e.value().K += modulus * area_of_width / (l * l);
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

/** The area of each point [m^2]: a quarter of the quads at it. */
std::vector<double> areas(const PointsAndQuads& mesh) {
  std::vector<double> share(mesh.points.size());
  for (const Quad& q : mesh.quads)
    for (unsigned i : q) share[i] += area(mesh, q) / 4;
  return share;
}

/** The masses by the density [kg/m^2] and areas().
 * Throws SceneError: a node in no quad */
void set_masses(Cloth& g, const PointsAndQuads& mesh, double density) {
  const std::vector<double> share = areas(mesh);
  for (unsigned i = 0; i < share.size(); ++i) {
    if (!(share[i] > 0))
      throw SceneError("density", "gives no mass to node " + std::to_string(i) +
                                      ", which lies in no quad");
    g.node(i).value().mass = density * share[i];
  }
}

/** Throws SceneError: a region without a node or an edge that it changes. */
void change_region(Cloth& g, const Region& r) {
  auto fail = [&](const char* what) {
    throw SceneError("region", '"' + to_words(r) + "\" holds no " + what);
  };
  unsigned nodes = 0, edges = 0;
  for (Node n : g.nodes())
    if (r.box.holds(n.position())) ++nodes, n.value().mass *= r.mass;
  if (nodes == 0) fail("node");
  if (r.stiffness == 1) return;
  for (Edge e : g.edges())
    if (r.box.holds(e.node1().position()) && r.box.holds(e.node2().position()))
      ++edges, e.value().K *= r.stiffness;
  if (edges == 0) fail("edge");
}

/** Throws SceneError if there is no memory for the cloth of @a m. */
void check_memory(const Model& m, double nodes, double quads) {
  const Edges& e = m.edges;
  const double springs = nodes + quads * (1 + 2 * e.diagonals + 2 * e.bend);
  const double needed = needed_memory(nodes, springs),
               available = available_memory();
  auto gb = [](double bytes) {
    return CME212::two_digits(bytes / 1e9) + " GB";
  };
  if (needed > available)
    throw SceneError(m.sheets.empty() ? "nodes" : "sheet",
                     "gives " + CME212::short_text(nodes) + " nodes and " +
                         CME212::short_text(springs) +
                         " springs, which need at least " + gb(needed) +
                         " of memory; " + gb(available) + " are available");
}

}  // namespace

PointsAndQuads mesh_of(const Model& m) {
  PointsAndQuads mesh;
  if (m.sheets.empty()) {
    mesh = load_mesh(m.nodes, m.tets);
    check_memory(m, double(mesh.points.size()), double(mesh.quads.size()));
  }
  double nodes = 0, quads = 0;
  for (const Sheet& s : m.sheets) {
    nodes += double(s.nodes[0]) * s.nodes[1];
    quads += double(s.nodes[0] - 1) * (s.nodes[1] - 1);
  }
  check_memory(m, nodes, quads);
  for (const Sheet& s : m.sheets) add_sheet(mesh, s);
  return mesh;
}

bool is_held(const Model& m, const Point& start) {
  return std::ranges::any_of(m.pins,
                             [&](const Pin& pin) { return pin.holds(start); });
}

double shortest_side(const Model& m) {
  double least = std::numeric_limits<double>::infinity();
  const PointsAndQuads mesh = mesh_of(m);
  for (const Quad& q : mesh.quads)
    for (auto [i, j] : quad_sides)
      least =
          std::min<double>(least, norm(mesh.points[q[i]] - mesh.points[q[j]]));
  return least;
}

void build_model(Cloth& g, const Model& m, const PointsAndQuads& mesh) {
  build_ordered_cloth(
      g, mesh.points, mesh.quads,
      m.edges.diagonals ? MeshSprings::diagonals : MeshSprings::plain,
      m.stiffness);
  if (m.edges.bend)
    each_bend(mesh.quads,
              [&](unsigned p, unsigned q, std::size_t, std::size_t) {
                const double l = norm(mesh.points[p] - mesh.points[q]);
                g.add_edge(g.node(p), g.node(q), {m.stiffness, l});
              });
  if (m.material.modulus) set_stiffness(g, mesh, m.edges, *m.material.modulus);
  if (m.material.density) set_masses(g, mesh, *m.material.density);
  for (const Region& r : m.regions) change_region(g, r);
  for (unsigned i = 0; i < mesh.velocities.size(); ++i)
    if (!is_held(m, mesh.points[i])) g.node(i).value().vel = mesh.velocities[i];
}

std::vector<Quad> quads_left(const Cloth& g, const BuiltMesh& built) {
  const auto a = arrays(g);
  return quads_with_sides(built.mesh.quads, [&](unsigned i, unsigned j) {
    const unsigned p = built.ids[i], q = built.ids[j];
    return a.node_in_use(p) && a.node_in_use(q) &&
           g.has_edge(a.node_with_id(p), a.node_with_id(q));
  });
}

PointsAndQuads mesh_left(const Cloth& g, const BuiltMesh& built) {
  PointsAndQuads left;
  std::vector<unsigned> number(built.ids.size());
  for (unsigned i = 0; i < number.size(); ++i) {
    if (!arrays(g).node_in_use(built.ids[i])) continue;
    const Node n = arrays(g).node_with_id(built.ids[i]);
    number[i] = unsigned(left.points.size());
    left.points.push_back(n.position());
    left.velocities.push_back(n.value().vel);
  }
  left.quads = quads_left(g, built);
  for (Quad& q : left.quads)
    for (unsigned& i : q) i = number[i];
  return left;
}

CombinedForces force_of(const Model& m, const PointsAndQuads& mesh,
                        const Cloth& g) {
  CombinedForces::List forces;
  if (m.gravity != 0)
    forces.push_back(std::make_shared<GravityForce>(m.gravity));
  forces.push_back(std::make_shared<MassSpringForce>());
  if (const auto drag = m.material.drag; drag && *drag > 0) {
    std::vector<double> c(arrays(g).node_slots());
    const std::vector<double> share = areas(mesh);
    for (unsigned i = 0; i < share.size(); ++i)
      c[g.node(i).id()] = *drag * share[i];
    forces.push_back(std::make_shared<NodeDrag>(std::move(c)));
  } else if (!drag && m.damping > 0) {
    forces.push_back(std::make_shared<DampingForce>(m.damping));
  }
  return CombinedForces(std::move(forces));
}

std::vector<HeldNodes> held_of(const Model& m, const Cloth& g) {
  std::vector<HeldNodes> all;
  for (const Pin& pin : m.pins) {
    HeldNodes& held = all.emplace_back();
    held.motion = pin.motion;
    for (Node n : g.nodes())
      if (pin.holds(n.position())) held.nodes.push_back({n.id(), n.position()});
    std::ranges::sort(held.nodes, {}, &HeldNodes::Held::id);
    if (held.nodes.empty() && !m.is_assignment())
      throw SceneError("pin", '"' + to_words(pin) + "\" holds no node");
  }
  return all;
}

CombinedConstraints constraint_of(const Model& m, const Cloth& g) {
  CombinedConstraints all = constraint_of(m, g, held_of(m, g));
  if (!m.self_collision) return all;
  const double thickness = m.self_collision->thickness;
  if (const double least = nearest_unconnected(g, thickness); least < thickness)
    throw SceneError("self-collision",
                     "has thickness " + CME212::short_text(thickness) +
                         " m, but two nodes without a common edge start " +
                         CME212::short_text(least) + " m apart");
  return all;
}

CombinedConstraints constraint_of(const Model& m, const Cloth& g,
                                  const std::vector<HeldNodes>& held) {
  CombinedConstraints::List all;
  auto add = [&](auto constraint) {
    all.push_back(
        std::make_shared<decltype(constraint)>(std::move(constraint)));
  };
  for (const Ball& b : m.tears) add(TearConstraint(b));
  if (m.tear_strain) add(StrainConstraint(*m.tear_strain));
  for (const Wall& w : m.planes)
    add(WallConstraint(w.at, w.out(), w.motion, w.friction));
  for (const Solid& s : m.spheres)
    add(BallConstraint(s.ball, s.motion, s.friction));
  for (const HeldNodes& h : held) {
    std::vector<PinConstraint::Pin> pins;
    for (const auto& [id, place] : h.nodes)
      if (arrays(g).node_in_use(id))
        pins.push_back({arrays(g).node_with_id(id), place});
    // A pin at rest has no time at which it stops.
    add(MovingPinConstraint(
        pins, h.motion.velocity == Point() ? Motion() : h.motion));
  }
  if (!m.self_collision) return CombinedConstraints(std::move(all));
  const auto [thickness, friction] = *m.self_collision;
  return make_combined_constraints(
      SelfCollision(thickness, friction, CombinedConstraints(std::move(all))));
}

Recipe recipe_of(const Model& m) { return recipe_of(m, mesh_of(m)); }

Recipe recipe_of(const Model& m, PointsAndQuads mesh) {
  auto built = std::make_shared<BuiltMesh>(BuiltMesh{std::move(mesh), {}, {}});
  Recipe r;
  r.name = m.name;
  r.gravity = m.gravity;
  r.build = [m, built](Cloth& g) {
    build_model(g, m, built->mesh);
    built->ids.clear();
    for (Node n : g.nodes()) built->ids.push_back(n.id());
  };
  r.built = built;
  r.force = [m, built](const Cloth& g) {
    built->force = force_of(m, built->mesh, g);
    return *built->force;
  };
  r.constraint = [m](const Cloth& g) { return constraint_of(m, g); };
  r.held = [m](const Cloth& g) { return held_of(m, g); };
  r.holding = [m](const Cloth& g, const std::vector<HeldNodes>& held) {
    return constraint_of(m, g, held);
  };
  using Kind = Obstacle::Kind;
  for (const Wall& w : m.planes)
    // An inclined plane would hide what lies on it.
    if (w.out() == Point(0, 0, 1))
      r.obstacles.push_back({Kind::floor, w.at, 0, w.motion});
  for (const Solid& s : m.spheres)
    r.obstacles.push_back({Kind::ball, s.ball.center, s.ball.radius, s.motion});
  for (const Ball& b : m.tears)
    r.obstacles.push_back({Kind::tearing_ball, b.center, b.radius});
  if (m.view) r.room = {m.view->from, m.view->to};
  return r;
}

}  // namespace lab
