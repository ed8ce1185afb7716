/** @file mass_spring.hpp
 * A right solution in other forms than ours: no include guard, as only the
 * program includes this file; a drag coefficient that main() sets; edges that
 * hold two numbers, by names of their own; calls that are public in the base
 * alone; constraints that take the address of a graph. */
#include "CME212/Point.hpp"
#include "Graph.hpp"

static constexpr double gravity = 9.81;
double c = 0;  // drag coefficient

struct Body {
  Point vel = Point(0, 0, 0);
  double mass = 1;
};
struct Rest {
  double stiffness = 100;
  double without_force = 1;
};
typedef Graph<Body, Rest> Fabric;
typedef Fabric::node_type Node;

bool held(const Point& p) { return p == Point(0, 0, 0) || p == Point(1, 0, 0); }
Point hooke(Node n) {
  Point f(0, 0, 0);
  for (auto it = n.edge_begin(); it != n.edge_end(); ++it) {
    Node m = (*it).node1() == n ? (*it).node2() : (*it).node1();
    const Point d = n.position() - m.position();
    if (norm(d) == 0) continue;
    f -= (*it).value().stiffness * (norm(d) - (*it).value().without_force) /
         norm(d) * d;
  }
  return f;
}

struct Force {
  virtual ~Force() {}
  virtual Point operator()(Node, double) { return Point(0, 0, 0); }
};
class GravityForce : public Force {
  virtual Point operator()(Node n, double) {
    return Point(0, 0, -gravity * n.value().mass);
  }
};
class MassSpringForce : public Force {
  virtual Point operator()(Node n, double) { return hooke(n); }
};
class DampingForce : public Force {
  virtual Point operator()(Node n, double) { return -c * n.value().vel; }
};
struct Problem1Force {
  Point operator()(Node n, double) {
    if (held(n.position())) return Point(0, 0, 0);
    return hooke(n) + Point(0, 0, -gravity * n.value().mass);
  }
};

template <typename A, typename B>
class Sum : public Force {
  A a_;
  B b_;
  virtual Point operator()(Node n, double t) {
    return static_cast<Force&>(a_)(n, t) + static_cast<Force&>(b_)(n, t);
  }

 public:
  Sum(A a, B b) : a_(a), b_(b) {}
};
template <typename A, typename B, typename... More>
auto make_combined_force(A a, B b, More... more) {
  if constexpr (sizeof...(More) == 0)
    return Sum<A, B>(a, b);
  else
    return make_combined_force(Sum<A, B>(a, b), more...);
}

class CombinedForces {
  std::vector<Force*> all_;

 public:
  explicit CombinedForces(std::vector<Force*>& all) : all_(all) {}
  Point operator()(Node n, double t) {
    Point f(0, 0, 0);
    for (std::size_t i = 0; i < all_.size(); ++i) f += (*all_[i])(n, t);
    return f;
  }
};

struct Constraint {
  virtual ~Constraint() {}
  virtual void operator()(Fabric*, double) {}
};
class PinConstraint : public Constraint {
  Fabric* g_;
  std::vector<Node> nodes_;
  std::vector<Point> where_;
  virtual void operator()(Fabric* g, double) {
    for (std::size_t i = 0; i < nodes_.size(); ++i)
      if (g->has_node(nodes_[i])) nodes_[i].position() = where_[i];
  }

 public:
  explicit PinConstraint(Fabric* g) : g_(g) {
    for (auto it = g_->node_begin(); it != g_->node_end(); ++it)
      if (held((*it).position())) {
        nodes_.push_back(*it);
        where_.push_back((*it).position());
      }
  }
};
class PlaneConstraint : public Constraint {
  virtual void operator()(Fabric* g, double) {
    for (auto it = g->node_begin(); it != g->node_end(); ++it) {
      Node n = *it;
      if (n.position().z >= -0.75) continue;
      n.position().z = -0.75;
      n.value().vel.z = 0;
    }
  }
};
const Point center(0.5, 0.5, -0.5);
class SphereConstraint : public Constraint {
  virtual void operator()(Fabric* g, double) {
    for (auto it = g->node_begin(); it != g->node_end(); ++it) {
      Node n = *it;
      const Point d = n.position() - center;
      if (norm(d) >= 0.15) continue;
      n.position() = center + d * (0.15 / norm(d));
      n.value().vel -= dot(n.value().vel, d) / normSq(d) * d;
    }
  }
};
class RemoveConstraint : public Constraint {
  virtual void operator()(Fabric* g, double) {
    for (auto it = g->node_begin(); it != g->node_end();)
      if (norm((*it).position() - center) < 0.15)
        it = g->remove_node(it);
      else
        ++it;
  }
};

template <typename A, typename B>
class Both : public Constraint {
  A a_;
  B b_;
  virtual void operator()(Fabric* g, double t) {
    static_cast<Constraint&>(a_)(g, t);
    static_cast<Constraint&>(b_)(g, t);
  }

 public:
  Both(A a, B b) : a_(a), b_(b) {}
};
template <typename A, typename B, typename... More>
auto make_combined_constraint(A a, B b, More... more) {
  if constexpr (sizeof...(More) == 0)
    return Both<A, B>(a, b);
  else
    return make_combined_constraint(Both<A, B>(a, b), more...);
}

template <typename G, typename F>
double symp_euler_step(G& g, double t, double dt, F force) {
  for (auto it = g.node_begin(); it != g.node_end(); ++it)
    if (!held((*it).position())) (*it).position() += dt * (*it).value().vel;
  for (auto it = g.node_begin(); it != g.node_end(); ++it)
    if (!held((*it).position()))
      (*it).value().vel += dt / (*it).value().mass * force(*it, t);
  return t + dt;
}
template <typename G, typename F, typename C>
double symp_euler_step(G& g, double t, double dt, F force, C constraint) {
  for (auto it = g.node_begin(); it != g.node_end(); ++it)
    (*it).position() += dt * (*it).value().vel;
  static_cast<Constraint&>(constraint)(&g, t);
  for (auto it = g.node_begin(); it != g.node_end(); ++it)
    (*it).value().vel +=
        dt / (*it).value().mass * static_cast<Force&>(force)(*it, t);
  return t + dt;
}
