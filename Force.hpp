#pragma once
/** @file Force.hpp
 * The forces on a cloth. A force is anything that can be called as
 * Point(Node n, double t): the force [N] on node n at time t [s]. It may read
 * all positions, and of the velocities that of n only. */
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <typeinfo>
#include <utility>
#include <vector>

#include "Cloth.hpp"

/** Section 3.2 and 4.2: gravity and springs in one; corners feel no force,
 * so that they stay where they are when they start at rest. */
class Problem1Force {
 public:
  /** Each spring by its own K and L (section 4.2). */
  Problem1Force() = default;
  explicit Problem1Force(double gravity) : gravity_(gravity) {}
  /** All springs alike (section 3.2).
   * @param K [N/m]   @param L rest length [m]   @param gravity [m/s^2] */
  Problem1Force(double K, double L, double gravity = grav)
      : same_{{K, L}}, gravity_(gravity) {}

  Point operator()(Node n, double /*t*/) const {
    if (is_corner(n.position())) return Point();
    Point f = n.value().mass * Point(0, 0, -gravity_);
    for (Edge e : n.edges())
      f += spring_force(e.node2().position() - n.position(),
                        same_ ? *same_ : e.value());
    return f;
  }

 private:
  std::optional<EdgeData> same_;
  double gravity_ = grav;
};

/** Called with the ids of two nodes and the stiffness between them. */
using StiffnessVisitor =
    std::function<void(unsigned i, unsigned j, const Stiffness& B)>;

/** No force, and the base of all forces (section 5.2).
 *
 * A child gives the force on one node. Whatever else it gives makes methods
 * faster or possible that would not be otherwise; the defaults are right for
 * every force. */
class ZeroForce {
 public:
  virtual ~ZeroForce() = default;

  /** The force [N] on node @a n at time @a t [s].  O(n.degree()) */
  virtual Point operator()(Node /*n*/, double /*t*/) const { return Point(); }

  /** Add the force on every node of @a g to @a f, which is addressed by
   * Node::id(). The same as calling the force node by node, to round-off, but
   * it may visit each spring once.
   * @pre f.size() == g.node_slots()   Complexity: O(nodes + edges) */
  virtual void add_to(const Cloth& g, double t, std::span<Point> f) const {
    for (Node n : g.nodes()) f[n.id()] += (*this)(n, t);
  }

  /** The energy [J] whose negative gradient the force is; 0 if it has none. */
  virtual double energy(const Cloth& /*g*/) const { return 0; }

  /** c [kg/s] if a part -c v of the force is linear drag, else 0. */
  virtual double drag() const { return 0; }

  /** Call @a use(i, j, B) for each pair of nodes between which there is a force
   * that depends on x_j - x_i, at the positions that @a g has now. All B
   * together, and drag(), are how the force on @a g changes with its state.
   * @return false if the force does not know that: then what @a use was called
   * with is to be forgotten. A child that has more than the call must say what
   * it knows; this base itself knows that no force changes.
   * Complexity: O(nodes + edges) */
  virtual bool add_stiffness(const Cloth& /*g*/,
                             const StiffnessVisitor& /*use*/) const {
    return typeid(*this) == typeid(ZeroForce);
  }
};

/** Weight: f = -m gravity along z [N]. */
class GravityForce : public ZeroForce {
 public:
  /** @param gravity Acceleration of free fall [m/s^2] */
  explicit GravityForce(double gravity = grav) : gravity_(gravity) {}
  Point operator()(Node n, double /*t*/) const override {
    return weight(n.value());
  }
  void add_to(const Cloth& g, double /*t*/, std::span<Point> f) const override {
    auto node = g.node_values();
    for (unsigned i = 0; i < g.node_slots(); ++i) f[i] += weight(node[i]);
  }
  double energy(const Cloth& g) const override {
    return gravitational_energy(g, gravity_);
  }
  bool add_stiffness(const Cloth&, const StiffnessVisitor&) const override {
    return true;  // the same everywhere
  }

 private:
  double gravity_;
  Point weight(const NodeData& n) const {
    return Point(0, 0, -n.mass * gravity_);
  }
};

/** The springs of all edges, each by its own K and L: see spring_force(). */
class MassSpringForce : public ZeroForce {
 public:
  Point operator()(Node n, double /*t*/) const override {
    Point f;
    for (Edge e : n.edges())
      f += spring_force(e.node2().position() - n.position(), e.value());
    return f;
  }
  /** Each spring once: half the square roots of the call node by node. */
  void add_to(const Cloth& g, double /*t*/, std::span<Point> f) const override {
    auto x = g.positions();
    auto ends = g.edge_ends();
    auto spring = g.edge_values();
    for (unsigned e = 0; e < g.edge_slots(); ++e) {
      if (!g.edge_in_use(e)) continue;
      auto [i, j] = ends[e];
      Point pull = spring_force(x[j] - x[i], spring[e]);
      f[i] += pull;
      f[j] -= pull;
    }
  }
  double energy(const Cloth& g) const override { return elastic_energy(g); }
  /** One call an edge, in the order of their ids: see spring_stiffness(). */
  bool add_stiffness(const Cloth& g,
                     const StiffnessVisitor& use) const override {
    auto x = g.positions();
    for (unsigned e = 0; e < g.edge_slots(); ++e) {
      if (!g.edge_in_use(e)) continue;
      auto [i, j] = g.edge_ends()[e];
      use(i, j, spring_stiffness(x[j] - x[i], g.edge_values()[e]));
    }
    return true;
  }
};

/** Linear drag: f = -c v [N]. Takes c |v|^2 of power [W] and never gives. */
class DampingForce : public ZeroForce {
 public:
  /** @param c Drag coefficient [kg/s], usually 1/N.  @pre @a c >= 0 */
  explicit DampingForce(double c = 0) : c_(c) { assert(c >= 0); }
  Point operator()(Node n, double /*t*/) const override {
    return -c_ * n.value().vel;
  }
  void add_to(const Cloth& g, double /*t*/, std::span<Point> f) const override {
    auto node = g.node_values();
    for (unsigned i = 0; i < g.node_slots(); ++i) f[i] -= c_ * node[i].vel;
  }
  double drag() const override { return c_; }
  bool add_stiffness(const Cloth&, const StiffnessVisitor&) const override {
    return true;  // it does not depend on positions
  }

 private:
  double c_;
};

/** Any function or functor Point(Node, double) as a ZeroForce. */
template <typename F>
class FunctionForce : public ZeroForce {
 public:
  explicit FunctionForce(F f) : f_(std::move(f)) {}
  Point operator()(Node n, double t) const override { return f_(n, t); }

 private:
  mutable F f_;  // a functor of the assignment need not be const
};

/** The sum of several forces. Copies share the forces they are made of. */
class CombinedForces : public ZeroForce {
 public:
  using Forces = std::vector<std::shared_ptr<const ZeroForce>>;
  /** @pre no pointer is null */
  explicit CombinedForces(Forces forces) : forces_(std::move(forces)) {}

  Point operator()(Node n, double t) const override {
    Point f;
    for (const auto& force : forces_) f += (*force)(n, t);
    return f;
  }
  void add_to(const Cloth& g, double t, std::span<Point> f) const override {
    for (const auto& force : forces_) force->add_to(g, t, f);
  }
  double energy(const Cloth& g) const override {
    double sum = 0;
    for (const auto& force : forces_) sum += force->energy(g);
    return sum;
  }
  double drag() const override {
    double sum = 0;
    for (const auto& force : forces_) sum += force->drag();
    return sum;
  }
  /** Known only if each of them knows its own. */
  bool add_stiffness(const Cloth& g,
                     const StiffnessVisitor& use) const override {
    for (const auto& force : forces_)
      if (!force->add_stiffness(g, use)) return false;
    return true;
  }

 private:
  Forces forces_;
};

/** The sum of any number of forces: children of ZeroForce, and functions of
 * their signature. Each is copied, so temporaries are fine. */
template <typename... Fs>
CombinedForces make_combined_force(Fs... forces) {
  return CombinedForces(CombinedForces::Forces{
      cloth_detail::shared_as<ZeroForce, FunctionForce>(std::move(forces))...});
}
