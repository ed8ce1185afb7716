#include "lab/scenes/Compose.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <memory>
#include <utility>

#include "CME212/BoundingBox.hpp"
#include "CME212/Util.hpp"
#include "lab/fast/Drag.hpp"
#include "lab/fast/GraphArrays.hpp"
#include "lab/fast/LoadForce.hpp"
#include "lab/fast/OneWaySprings.hpp"
#include "lab/fast/OrderedCloth.hpp"
#include "lab/scenes/Contact.hpp"
#include "lab/scenes/Memory.hpp"
#include "lab/scenes/SelfCollision.hpp"
#include "lab/scenes/Words.hpp"

namespace lab {

namespace {

void add_sheet(Net& mesh, const Sheet& s) {
  const auto [n, m] = s.nodes;
  const auto first = unsigned(mesh.points.size());
  for (const Point& p : grid_points(n, m))
    mesh.points.push_back(s.at + p.x * s.u + p.y * s.v);
  for (Quad q : grid_quads(n, m)) {
    for (unsigned& i : q) i += first;
    mesh.quads.push_back(q);
  }
  if (n == 1 || m == 1)  // a rope
    for (unsigned i = first + 1; i < mesh.points.size(); ++i)
      mesh.springs.push_back({i - 1, i});
  if (s.velocity == Point() && mesh.velocities.empty()) return;
  mesh.velocities.resize(first);
  mesh.velocities.resize(mesh.points.size(), s.velocity);
}

/** A side of a face: its two points, the face, and the quad's other two points
 * in the order of their neighbors; or the triangle's third one, twice. */
struct Side {
  std::array<unsigned, 2> ends;  // the smaller one first
  std::size_t quad;
  std::array<unsigned, 2> beyond;  // the ends of the opposite side
};

/** All sides of all faces; sides with the same ends are adjacent. */
std::vector<Side> sorted_sides(const std::vector<Quad>& quads) {
  std::vector<Side> all;
  for (std::size_t k = 0; k < quads.size(); ++k)
    for (auto [a, b] : quad_sides) {
      // Corner c of a quad has the neighbors c ^ 1 and c ^ 2 along its sides.
      const unsigned across = (a ^ b) == 1 ? 2 : 1;
      const Quad& q = quads[k];
      if (q[a] == q[b]) continue;  // of a triangle
      Side s = {{q[a], q[b]}, k, {q[a ^ across], q[b ^ across]}};
      if (is_triangle(q)) s.beyond[1] = s.beyond[0];
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
 * apart, across a side that quads i and j share: twice inside a grid; or that
 * are the third points of two triangles i and j with a common side. */
template <typename Use>
void each_bend(const std::vector<Quad>& quads, Use use) {
  const auto all = sorted_sides(quads);
  for (std::size_t k = 1; k < all.size(); ++k) {
    const Side &s = all[k - 1], &t = all[k];
    const bool third = is_triangle(quads[s.quad]);
    if (s.ends != t.ends || third != is_triangle(quads[t.quad])) continue;
    for (int end = 0; end < (third ? 1 : 2); ++end)
      if (s.beyond[end] != t.beyond[end])
        use(s.beyond[end], t.beyond[end], s.quad, t.quad);
  }
}

double area(const Net& mesh, const Quad& q) {
  const auto& p = mesh.points;
  return norm(cross(p[q[3]] - p[q[0]], p[q[2]] - p[q[1]])) / 2;
}

/** Call @a use(i, j, share) for the springs of @a q: those along its sides,
 * then its diagonals. Share: of the area of @a q, the strip that the spring
 * stands for; in a triangle, A. Van Gelder, J. Graphics Tools 3 (1998) 21. */
template <typename Use>
void each_spring(const Quad& q, bool diagonals, Use use) {
  for (auto [i, j] : quad_sides)
    if (q[i] != q[j]) use(q[i], q[j], is_triangle(q) ? 1. : 0.5);
  if (diagonals && !is_triangle(q))
    for (auto [i, j] : quad_diagonals) use(q[i], q[j], 2.);
}

/** Set K of the springs of all faces by the modulus Y [N/m], as build_model()
 * says. */
void set_stiffness(Cloth& g, const Net& mesh, const Edges& edges,
                   double modulus) {
  for (Edge e : g.edges()) e.value().K = 0;
  auto add = [&](unsigned i, unsigned j, double area_of_width) {
    Edge e = g.add_edge(g.node(i), g.node(j));  // there already
    const double l = e.value().L;
    if (l > 0) e.value().K += modulus * area_of_width / (l * l);
  };
  for (const Quad& q : mesh.quads)
    each_spring(q, edges.diagonals,
                [&, a = area(mesh, q)](unsigned i, unsigned j, double share) {
                  add(i, j, share * a);
                });
  if (edges.bend)
    each_bend(
        mesh.quads, [&](unsigned p, unsigned q, std::size_t i, std::size_t j) {
          add(p, q, area(mesh, mesh.quads[i]) + area(mesh, mesh.quads[j]));
        });
}

/** Set K of the kinds of springs that have their own. */
void set_kinds(Cloth& g, const Net& net, const Edges& edges) {
  const auto set = [&g](const SpringKind& kind, unsigned i, unsigned j) {
    if (kind.K) g.add_edge(g.node(i), g.node(j)).value().K = *kind.K;
  };
  if (edges.bend.K)
    each_bend(net.quads, [&](unsigned i, unsigned j, std::size_t, std::size_t) {
      set(edges.bend, i, j);
    });
  if (!edges.sides.K && !edges.diagonals.K) return;
  for (const Quad& q : net.quads)
    each_spring(q, edges.diagonals, [&](unsigned i, unsigned j, double share) {
      set(share == 2 ? edges.diagonals : edges.sides, i, j);
    });
}

/** Add the springs that @a net lists to those of its faces.
 * Throws SceneError: two between the same nodes that are no one spring */
void add_listed(Cloth& g, const Net& net, const Model& m) {
  std::vector<const Spring*> listed(g.num_edges());  // by index of the edge
  for (const Spring& s : net.springs) {
    auto [i, j, K, L, acts] = s;
    Edge e = g.add_edge(g.node(i), g.node(j));
    const bool is_new = e.index() == listed.size();
    if (is_new) listed.push_back(nullptr);
    if (L < 0) L = norm(net.points[i] - net.points[j]);
    if (K < 0 && m.material.modulus && is_new)
      throw SceneError("modulus", "gives no K to the spring of nodes " +
                                      std::to_string(i) + " and " +
                                      std::to_string(j) +
                                      ", which lies in no face");
    if (K < 0) K = m.material.modulus ? e.value().K : m.stiffness;
    EdgeData& all = e.value();
    if (const Spring* other = std::exchange(listed[e.index()], &s); !other)
      all = {K, L};
    else if (all.L == L && other->acts == acts)
      all.K += K;
    else
      throw SceneError(
          "net", "joins nodes " + std::to_string(i) + " and " +
                     std::to_string(j) +
                     " by two springs that differ in more than K, expected "
                     "one; put a node of small mass into one of them");
  }
}

/** The area of each point [m^2]: a quarter of the quads at it, a third of the
 * triangles. */
std::vector<double> areas(const Net& mesh) {
  std::vector<double> share(mesh.points.size());
  for (const Quad& q : mesh.quads)
    for (unsigned k : {0, 1, 2, 3})  // corners 1 and 3 of a triangle are one
      share[q[k]] += area(mesh, q) / (!is_triangle(q) ? 4 : k % 2 ? 6 : 3);
  return share;
}

/** The masses by the density [kg/m^2] and areas().
 * Throws SceneError: a node in no quad */
void set_masses(Cloth& g, const Net& mesh, double density) {
  const std::vector<double> share = areas(mesh);
  for (unsigned i = 0; i < share.size(); ++i) {
    if (!(share[i] > 0))
      throw SceneError("density", "gives no mass to node " + std::to_string(i) +
                                      ", which lies in no face");
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
void check_memory(const Model& m, double nodes, double quads,
                  double listed = 0) {
  const Edges& e = m.edges;
  const double springs =
      nodes + quads * (1 + 2 * e.diagonals + 2 * e.bend) + listed;
  const double needed = needed_memory(nodes, springs),
               available = available_memory();
  auto gb = [](double bytes) {
    return CME212::two_digits(bytes / 1e9) + " GB";
  };
  if (needed > available)
    throw SceneError(!m.sheets.empty() ? "sheet"
                     : m.net.empty()   ? "nodes"
                                       : "net",
                     "gives " + CME212::short_text(nodes) + " nodes and " +
                         CME212::short_text(springs) +
                         " springs, which need at least " + gb(needed) +
                         " of memory; " + gb(available) + " are available");
}

/** The node of @a net that is closest to @a pin, the first one if several are,
 * and its distance [m].  @pre @a net has nodes */
std::pair<unsigned, double> nearest(const Pin& pin, const Net& net) {
  std::pair<unsigned, double> best = {0,
                                      std::numeric_limits<double>::infinity()};
  for (unsigned i = 0; i < net.points.size(); ++i)
    if (const double d = pin.distance(i, net.points[i]); d < best.second)
      best = {i, d};
  return best;
}

}  // namespace

Net mesh_of(const Model& m) {
  Net mesh;
  if (m.sheets.empty()) {
    mesh = load_mesh(m.net.empty() ? m.nodes : m.net, m.tets);
    check_memory(m, double(mesh.points.size()), double(mesh.quads.size()),
                 double(mesh.springs.size()));
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

std::vector<std::vector<unsigned>> points_held(const Model& m, const Net& net) {
  std::vector<std::vector<unsigned>> all;
  for (const Pin& pin : m.pins) {
    auto& held = all.emplace_back();
    const auto take = [&](double within) {
      for (unsigned i = 0; i < net.points.size(); ++i)
        if (pin.distance(i, net.points[i]) < within) held.push_back(i);
    };
    take(Pin::near);
    if (!held.empty()) continue;
    const double least = nearest(pin, net).second;
    if (least < 1e-6 * CME212::BoundingBox(net.points).diagonal())
      take(least + Pin::near);
  }
  if (!net.held.empty()) all.push_back(net.held);
  return all;
}

std::vector<char> is_held(const Model& m, const Net& net) {
  std::vector<char> all(net.points.size());
  for (const auto& held : points_held(m, net))
    for (unsigned i : held) all[i] = 1;
  return all;
}

double shortest_side(const Model& m) {
  double least = std::numeric_limits<double>::infinity();
  const Net mesh = mesh_of(m);
  for (const Quad& q : mesh.quads)
    each_spring(q, false, [&](unsigned i, unsigned j, double) {
      least = std::min<double>(least, norm(mesh.points[i] - mesh.points[j]));
    });
  return least;
}

void build_model(Cloth& g, const Model& m, const Net& mesh) {
  std::vector<Quad> quads, others;  // of more than three corners; triangles
  const bool all_quads = std::ranges::none_of(mesh.quads, is_triangle);
  if (!all_quads && !mesh.bare_faces)
    std::ranges::partition_copy(mesh.quads, std::back_inserter(others),
                                std::back_inserter(quads), is_triangle);
  g.reserve(unsigned(mesh.points.size()),
            unsigned(mesh.springs.size() + 3 * others.size() / 2));
  build_cloth(g, mesh.points,
              all_quads && !mesh.bare_faces ? mesh.quads : quads,
              m.edges.diagonals ? MeshSprings::diagonals : MeshSprings::plain,
              m.stiffness);
  const auto add = [&](unsigned i, unsigned j) {
    g.add_edge(g.node(i), g.node(j),
               {m.stiffness, norm(mesh.points[i] - mesh.points[j])});
  };
  for (const Quad& q : others)
    each_spring(q, false, [&](unsigned i, unsigned j, double) { add(i, j); });
  if (!mesh.bare_faces) {
    if (m.edges.bend)
      each_bend(mesh.quads, [&](unsigned p, unsigned q, std::size_t,
                                std::size_t) { add(p, q); });
    if (m.material.modulus)
      set_stiffness(g, mesh, m.edges, *m.material.modulus);
    set_kinds(g, mesh, m.edges);
  }
  add_listed(g, mesh, m);
  if (m.rest_length != 1)
    for (Edge e : g.edges()) e.value().L *= m.rest_length;
  for (unsigned i = 0; i < mesh.masses.size(); ++i)
    g.node(i).value().mass = mesh.masses[i];
  if (m.material.density) set_masses(g, mesh, *m.material.density);
  for (const Region& r : m.regions) change_region(g, r);
  const auto held = is_held(m, mesh);
  for (unsigned i = 0; i < mesh.velocities.size(); ++i)
    if (!held[i]) g.node(i).value().vel = mesh.velocities[i];
  order_in_memory(g);
}

CombinedForces force_of(const Model& m, const Net& mesh, const Cloth& g) {
  CombinedForces::List forces;
  const Point a = m.gravity.a;
  if (a.z != 0) forces.push_back(std::make_shared<GravityForce>(-a.z));
  if (a.x != 0 || a.y != 0)
    forces.push_back(std::make_shared<SidewaysForce>(a.x, a.y));
  const std::vector<unsigned> ids = ids_of(g);
  if (auto ways = ways_of(mesh, ids, g); !ways.empty())
    forces.push_back(std::make_shared<OneWaySprings>(std::move(ways)));
  else
    forces.push_back(std::make_shared<MassSpringForce>());
  std::vector<double> c(arrays(g).node_slots(), m.damping);
  if (const auto drag = m.material.drag; drag && *drag > 0) {
    const std::vector<double> share = areas(mesh);
    for (unsigned i = 0; i < share.size(); ++i)
      c[g.node(i).id()] = *drag * share[i];
    forces.push_back(std::make_shared<NodeDrag>(c));
  } else if (!drag && m.damping > 0) {
    forces.push_back(std::make_shared<DampingForce>(m.damping));
  }
  if (m.wind)
    forces.push_back(std::make_shared<WindForce>(c, m.wind->velocity));
  if (!mesh.loads.empty()) {
    if (!m.tears.empty())
      throw SceneError("tear",
                       "removes nodes, and what became of the loads of the net "
                       "on them is not known, expected one of both");
    std::vector<Point> load(arrays(g).node_slots());
    for (const auto& [i, force] : mesh.loads) load[ids[i]] += force;
    forces.push_back(std::make_shared<LoadForce>(std::move(load)));
  }
  return CombinedForces(std::move(forces));
}

std::vector<HeldNodes> held_of(const Model& m, const Net& net, const Cloth& g) {
  std::vector<HeldNodes> all;
  for (const auto& points : points_held(m, net)) {
    const std::size_t k = all.size();
    HeldNodes& held = all.emplace_back();
    for (unsigned i : points)
      held.nodes.push_back({g.node(i).id(), net.points[i]});
    std::ranges::sort(held.nodes, {}, &HeldNodes::Held::id);
    if (k == m.pins.size()) break;  // those that the net holds
    held.motion = m.pins[k].motion;
    if (held.nodes.empty() && !m.is_assignment()) {
      const auto [i, distance] = nearest(m.pins[k], net);
      throw SceneError("pin",
                       '"' + to_words(m.pins[k]) + "\" holds no node: " +
                           (std::isfinite(distance)
                                ? "the nearest is node " + std::to_string(i) +
                                      " at " + short_text(net.points[i])
                                : "nodes are 0 to " +
                                      std::to_string(net.points.size() - 1)));
    }
  }
  return all;
}

CombinedConstraints constraint_of(const Model& m, const Net& net,
                                  const Cloth& g) {
  CombinedConstraints all = constraint_of(m, g, held_of(m, net, g));
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
  std::vector<bool> is_held(arrays(g).node_slots());
  for (const HeldNodes& h : held)
    for (const auto& [id, place] : h.nodes) is_held[id] = true;
  const auto add_obstacle = [&](auto obstacle) {
    obstacle.leave(is_held);
    add(std::move(obstacle));
  };
  for (const Ball& b : m.tears) add(TearConstraint(b));
  if (m.tear_strain) add(StrainConstraint(*m.tear_strain));
  for (const Wall& w : m.planes)
    add_obstacle(WallConstraint(w.at, w.out(), w.motion, w.friction));
  for (const Solid& s : m.spheres)
    add_obstacle(BallConstraint(s.ball, s.motion, s.friction));
  for (const HeldNodes& h : held) {
    std::vector<PinConstraint::Pin> pins;
    for (const auto& [id, place] : h.nodes)
      if (arrays(g).node_in_use(id))
        pins.push_back({arrays(g).node_with_id(id), place});
    // A pin at rest has no time at which it stops.
    add(PinnedNodes(pins, h.motion.moves() ? h.motion : Motion()));
  }
  if (!m.self_collision) return CombinedConstraints(std::move(all));
  const auto [thickness, friction] = *m.self_collision;
  return make_combined_constraints(
      SelfCollision(thickness, friction, CombinedConstraints(std::move(all))));
}

std::vector<Obstacle> obstacles_of(const Model& m) {
  using enum Obstacle::Kind;
  std::vector<Obstacle> all;
  for (const Wall& w : m.planes)
    if (w.out() == Point(0, 0, 1)) all.push_back({floor, w.at, 0, w.motion});
  for (const Solid& s : m.spheres)
    all.push_back({ball, s.ball.center, s.ball.radius, s.motion});
  for (const Ball& b : m.tears)
    all.push_back({tearing_ball, b.center, b.radius});
  return all;
}

}  // namespace lab
