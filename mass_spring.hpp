#pragma once
/** @file mass_spring.hpp
 * The assignment, section by section: a cloth of point masses and springs, the
 * step, the forces (5), the constraints (6) and tearing (7). SI units; z up. */
#include <cassert>
#include <memory>
#include <optional>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include "CME212/AnyGraph.hpp"
#include "CME212/Mesh.hpp"
#include "Graph.hpp"

using CME212::edges, CME212::nodes;  // for range-for, of any graph

// ----------------------------------------------- 3 and 4.1: cloth and springs

/** The value of a node: a point mass. */
struct NodeData {
  Point vel;        ///< velocity [m/s]
  double mass = 1;  ///< [kg], > 0
};
/** The value of an edge: a linear spring. */
struct EdgeData {
  double K = 100;  ///< spring constant [N/m], >= 0
  double L = 0;    ///< rest length [m], >= 0
};
using Cloth = Graph<NodeData, EdgeData>;
using GraphType = Cloth;
using Node = Cloth::node_type;
using Edge = Cloth::edge_type;

inline constexpr double grav = 9.81;  ///< acceleration of free fall [m/s^2]

/** Is @a p one of the two corners that the assignment holds fixed? */
inline constexpr bool is_corner(const Point& p) {
  return p == Point(0, 0, 0) || p == Point(1, 0, 0);
}

/** Make the cloth: N nodes of mass 1/N at rest, springs at their rest length.
 * @param K spring constant [N/m]
 * @pre @a g is empty; the indices in @a quads are below points.size()
 * @post node(i) is at points[i]
 * Complexity: O(points + quads), unless a point is in very many quads */
inline void build_cloth(Cloth& g, std::span<const Point> points,
                        std::span<const Quad> quads, MeshSprings::Kind kind,
                        double K = 100) {
  assert(g.num_nodes() == 0);
  const MeshSprings springs(quads, kind);
  CME212::reserve(g, points.size(), springs.expected(points.size()));
  for (const Point& p : points)
    g.add_node(p, {Point(), 1.0 / double(points.size())});
  for (unsigned s = 0; s < springs.size(); ++s) {
    const auto [i, j] = springs[s];
    // BEGIN SOLUTION 4.2.build_cloth
    const double L = norm(points[i] - points[j]);
    g.add_edge(g.node(i), g.node(j)).value() = {K, L};
    // STUB (void)K;
    // STUB g.add_edge(g.node(i), g.node(j));
    // END SOLUTION
  }
}

// ------------------------------------------------------- 3.2 and 6.2: the step

/** Does the step without constraints skip a node at @a p? From 5.2 on it skips
 * the corners: the forces of section 5 act on them, too. */
inline bool is_skipped(const Point& p) {
  // BEGIN SOLUTION 5.2.skip_corners
  return is_corner(p);
  // STUB (void)p;
  // STUB return false;
  // END SOLUTION
}

/** Symplectic Euler: x += dt v;  v += dt F(x, t)/m, for each node that is not
 * skipped.
 * @param t   time at the start of the step [s]   @param dt step [s]
 * @param force  Point(Node, double): the force [N] on a node at time t
 * @return t + dt
 * Complexity: one call of @a force for each node that is not skipped.
 * Order 1. Bounded if dt omega < 2 for each frequency omega [1/s] of the cloth.
 */
template <typename G, typename F>
double symp_euler_step(G& g, double t, double dt, F&& force) {
  // BEGIN SOLUTION 3.2.symp_euler_step
  for (auto n : nodes(g))
    if (!is_skipped(n.position())) n.position() += dt * n.value().vel;
  for (auto n : nodes(g))
    if (!is_skipped(n.position()))
      n.value().vel += (dt / n.value().mass) * force(n, t);
  return t + dt;
  // STUB (void)g, (void)force;
  // STUB return t + dt;
  // END SOLUTION
}

/** The same with a constraint; no node is skipped (6.2):
 * x += dt v;  constrain;  v += dt F(x, t)/m.
 * @param constraint  void(G&, double), called once; may remove nodes */
template <typename G, typename F, typename C>
double symp_euler_step(G& g, double t, double dt, F&& force, C&& constraint) {
  // BEGIN SOLUTION 6.2.symp_euler_step
  for (auto n : nodes(g)) n.position() += dt * n.value().vel;
  constraint(g, t);
  for (auto n : nodes(g)) n.value().vel += (dt / n.value().mass) * force(n, t);
  return t + dt;
  // STUB (void)g, (void)force, (void)constraint;
  // STUB return t + dt;
  // END SOLUTION
}

// ----------------------------------------------------------------- The forces

/** Force [N] of spring @a s on one end, where @a u [m] points to the other end:
 * K (|u| - L) u/|u|; zero if u = 0, which has no direction. */
inline Point spring_force(const Point& u, const EdgeData& s) {
  // BEGIN SOLUTION 3.2.Problem1Force
  const double l = norm(u);
  return l > 0 ? s.K * (l - s.L) / l * u : Point();
  // STUB (void)u, (void)s;
  // STUB return Point();
  // END SOLUTION
}

/** 3.2 and 4.2: gravity plus springs; no force on a corner, so it stays. */
class Problem1Force {
 public:
  /** Each spring has its own K and L (4.2). */
  Problem1Force() = default;
  /** All springs have the same K [N/m] and rest length L [m] (3.2). */
  Problem1Force(double K, double L) : same_{{K, L}} {}

  template <typename NODE>
  Point operator()(NODE n, double /*t*/) const {
    // BEGIN SOLUTION 3.2.Problem1Force
    if (is_corner(n.position())) return Point();
    Point f = n.value().mass * Point(0, 0, -grav);
    for (auto e : edges(n))  // seen from n, so that node2() is the other end
      f += spring_force(e.node2().position() - n.position(), spring_of(e));
    return f;
    // STUB (void)n;
    // STUB return Point();
    // END SOLUTION
  }

 private:
  std::optional<EdgeData> same_;  // K and L of all springs

  /** K and L of the spring at @a e. */
  template <typename EDGE>
  EdgeData spring_of(EDGE e) const {
    if (same_) return *same_;
    // BEGIN SOLUTION 4.2.Problem1Force
    return e.value();
    // STUB (void)e;
    // STUB return {.K = 0, .L = 0};
    // END SOLUTION
  }
};

// BEGIN GUIDED
/** 5.1: the base class of all forces; by itself no force. */
struct ZeroForce {
  virtual ~ZeroForce() = default;
  /** The force [N] on @a n at time @a t [s]. It may depend on all positions,
   * and on the velocity of @a n. */
  virtual Point operator()(Node /*n*/, double /*t*/) const { return Point(); }
};
// OPEN // 5.1: the class ZeroForce, from which the three forces are derived.

/** Weight: f = -m g along z. */
struct GravityForce : ZeroForce {
  double gravity;  ///< acceleration of free fall [m/s^2]
  explicit GravityForce(double g = grav) : gravity(g) {}
  Point operator()(Node n, double /*t*/) const override {
    // BEGIN SOLUTION 5.1.GravityForce
    return n.value().mass * Point(0, 0, -gravity);
    // STUB (void)n;
    // STUB return Point();
    // END SOLUTION
  }
};

/** The springs at a node, each with its own K and L. */
struct MassSpringForce : ZeroForce {
  Point operator()(Node n, double /*t*/) const override {
    // BEGIN SOLUTION 5.1.MassSpringForce
    Point f;
    for (Edge e : edges(n))
      f += spring_force(e.node2().position() - n.position(), e.value());
    return f;
    // STUB (void)n;
    // STUB return Point();
    // END SOLUTION
  }
};

/** Linear drag: f = -c v. It dissipates the power c |v|^2 [W]. */
struct DampingForce : ZeroForce {
  double c;  ///< [kg/s], >= 0; in the assignment 1/N for N nodes
  explicit DampingForce(double drag) : c(drag) { assert(c >= 0); }
  Point operator()(Node n, double /*t*/) const override {
    // BEGIN SOLUTION 5.1.DampingForce
    return -c * n.value().vel;
    // STUB (void)n;
    // STUB return Point();
    // END SOLUTION
  }
};

/** A function Point(Node, double) as a ZeroForce. */
template <typename F>
struct FunctionForce : ZeroForce {
  static_assert(std::is_invocable_r_v<Point, F&, Node&, double&>,
                "A force needs a public call: Point operator()(Node, double).");
  mutable F function;  // its call need not be const
  explicit FunctionForce(F f) : function(std::move(f)) {}
  Point operator()(Node n, double t) const override { return function(n, t); }
};

/** 5.2: the sum of several forces, which copies of it share. */
struct CombinedForces : ZeroForce {
  using List = std::vector<std::shared_ptr<const ZeroForce>>;
  List parts;  ///< none is null
  explicit CombinedForces(List forces) : parts(std::move(forces)) {}
  Point operator()(Node n, double t) const override {
    // BEGIN SOLUTION 5.2.CombinedForces
    Point f;
    for (const auto& force : parts) f += (*force)(n, t);
    return f;
    // STUB (void)n, (void)t;
    // STUB return Point();
    // END SOLUTION
  }
};

/** The sum of any number of forces. It copies them: they may be temporaries. */
template <typename... Fs>
CombinedForces make_combined_force(Fs... fs) {
  // BEGIN SOLUTION 5.2.make_combined_force
  return CombinedForces(CombinedForces::List{
      std::make_shared<FunctionForce<Fs>>(std::move(fs))...});
  // STUB ((void)fs, ...);
  // STUB return CombinedForces(CombinedForces::List());
  // END SOLUTION
}

// END GUIDED

// ------------------------------------------------------------ The constraints

// BEGIN GUIDED
/** 6.1: the base class of all constraints; by itself no constraint. */
struct ZeroConstraint {
  virtual ~ZeroConstraint() = default;
  /** Reset the nodes of @a g that violate it at time @a t [s]. */
  virtual void operator()(Cloth& /*g*/, double /*t*/) const {}
};
// OPEN // 6.1: the class ZeroConstraint, from which the three are derived.

/** Keeps nodes at rest, at the positions that they had when it was made. Pinned
 * nodes may be removed.  Complexity: O(pins) a call */
struct PinConstraint : ZeroConstraint {
  struct Pin {
    Node node;
    Point place;  ///< [m]
  };
  std::vector<Pin> pins;
  /** Pin the two corners. */
  explicit PinConstraint(const Cloth& g) {
    // BEGIN SOLUTION 6.1.PinConstraint
    for (Node n : nodes(g))
      if (is_corner(n.position())) pins.push_back({n, n.position()});
    // STUB (void)g;
    // END SOLUTION
  }
  /** Pin @a nodes.  @pre all in one graph */
  explicit PinConstraint(std::span<const Node> nodes) {
    for (Node n : nodes) pins.push_back({n, n.position()});
  }
  void operator()(Cloth& g, double /*t*/) const override {
    // BEGIN SOLUTION 6.1.PinConstraint
    for (auto [n, place] : pins)
      if (g.has_node(n)) n.position() = place, n.value().vel = Point();
    // STUB (void)g;
    // END SOLUTION
  }
};

/** A floor at height z. @post No node is below; one that was has v_z = 0. */
struct PlaneConstraint : ZeroConstraint {
  double z;  ///< [m]
  explicit PlaneConstraint(double height = -0.75) : z(height) {}
  void project(Node n) const {
    // BEGIN SOLUTION 6.1.PlaneConstraint
    if (n.position().z < z) n.position().z = z, n.value().vel.z = 0;
    // STUB (void)n;
    // END SOLUTION
  }
  void operator()(Cloth& g, double /*t*/) const override {
    for (Node n : nodes(g)) project(n);
  }
};

struct Ball {
  Point center = Point(0.5, 0.5, -0.5);  ///< [m]
  double radius = 0.15;                  ///< [m]
  /** Strictly inside? */
  bool holds(const Point& p) const {
    return normSq(p - center) < radius * radius;
  }
};

/** A solid ball. @post No node is inside by more than round-off. One that was
 * is at the nearest point of the surface (at the top, if it was at the center)
 * and has no velocity normal to it. */
struct SphereConstraint : ZeroConstraint {
  Ball ball;
  explicit SphereConstraint(const Ball& b = {}) : ball(b) {}
  void project(Node n) const {
    // BEGIN SOLUTION 6.1.SphereConstraint
    if (!ball.holds(n.position())) return;
    const Point r = n.position() - ball.center;
    const Point normal = norm(r) > 0 ? r / norm(r) : Point(0, 0, 1);
    n.position() = ball.center + ball.radius * normal;
    n.value().vel -= dot(n.value().vel, normal) * normal;
    // STUB (void)n;
    // END SOLUTION
  }
  void operator()(Cloth& g, double /*t*/) const override {
    for (Node n : nodes(g)) project(n);
  }
};

/** 7.2: a ball that removes every node that enters it.
 * Invalidates: as Graph::remove_node(), for each node removed. */
struct TearConstraint : ZeroConstraint {
  Ball ball;
  explicit TearConstraint(const Ball& b = {}) : ball(b) {}
  void operator()(Cloth& g, double /*t*/) const override {
    // BEGIN SOLUTION 7.2.TearConstraint
    for (auto it = g.node_begin(); it != g.node_end();)
      if (ball.holds((*it).position()))
        it = g.remove_node(it);  // now at the node that took its index
      else
        ++it;
    // STUB (void)g;
    // END SOLUTION
  }
};

/** A function void(Cloth&, double) as a ZeroConstraint. */
template <typename C>
struct FunctionConstraint : ZeroConstraint {
  static_assert(
      std::is_invocable_v<C&, Cloth&, double&>,
      "A constraint needs a public call: void operator()(Cloth&, double).");
  mutable C function;
  explicit FunctionConstraint(C c) : function(std::move(c)) {}
  void operator()(Cloth& g, double t) const override { function(g, t); }
};

/** 6.2: several constraints, applied in their order: if two disagree about a
 * node, the last one wins. Copies of it share them. */
struct CombinedConstraints : ZeroConstraint {
  using List = std::vector<std::shared_ptr<const ZeroConstraint>>;
  List parts;  ///< none is null
  explicit CombinedConstraints(List constraints)
      : parts(std::move(constraints)) {}
  void operator()(Cloth& g, double t) const override {
    // BEGIN SOLUTION 6.2.make_combined_constraints
    for (const auto& c : parts) (*c)(g, t);
    // STUB (void)g, (void)t;
    // END SOLUTION
  }
};

/** Any number of constraints, applied in this order. It copies them. */
template <typename... Cs>
CombinedConstraints make_combined_constraints(Cs... cs) {
  // BEGIN SOLUTION 6.2.make_combined_constraints
  return CombinedConstraints(CombinedConstraints::List{
      std::make_shared<FunctionConstraint<Cs>>(std::move(cs))...});
  // STUB ((void)cs, ...);
  // STUB return CombinedConstraints(CombinedConstraints::List());
  // END SOLUTION
}
// END GUIDED
