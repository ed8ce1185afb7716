/** @file cloth.hpp
 * A bridge from the tests to any mass_spring.hpp or mass_spring.cpp of the
 * course. It brings the submission and check.hpp; a test of the cloth includes
 * this file and nothing else.
 *
 * What the assignment leaves open is accepted here: calls that are const or
 * not, templates or not, that take a node by value or by reference; classes
 * that are made from nothing, from numbers, from points or from a graph; the
 * names in the values of nodes and edges; a base class of the forces or none.
 *
 * A grader may define
 *   KIT_PROGRAM           main() is wanted, too: 7.2.program
 *   KIT_GRAPH             the type of the cloth; else GraphType
 *   KIT_FORCE_BASE        the base of the forces; else ZeroForce or Force
 *   KIT_CONSTRAINT_BASE   of the constraints; else ZeroConstraint, Constraint
 *   KIT_TEAR              the constraint that removes nodes */
#ifndef KIT_CLOTH_HPP
#define KIT_CLOTH_HPP

#if __has_include("mass_spring.hpp")
#include "mass_spring.hpp"
#endif
#if !__has_include("mass_spring.hpp") || defined(KIT_PROGRAM)
#if __has_include("mass_spring.cpp")
#include <CME212/SDLViewer.hpp>  // of headless/
#if __has_include("mass_spring.hpp")  // made from our starter
#define MASS_SPRING_VIEWER
#define STAGE tear
#endif
// As an inline function it takes no time to compile unless a test calls it. A
// main() may end without a return, another function may not.
#define main inline __attribute__((no_sanitize("undefined"))) submitted_main
#include "mass_spring.cpp"
#undef main
#undef STAGE
#define KIT_HAS_MAIN
#endif
#endif

// Macros of a submission have done their work.
#undef K
#undef L
#undef C
#undef G
#undef N
#undef c
#undef g
#undef k
#undef l
#undef m
#undef n
#undef t
#undef v
#undef x
#undef dt
#include "check.hpp"
#include "values.hpp"

// ------------------------------------------ Names that may be missing

// ::ZeroForce is the submission's if it has one. If not, the language looks
// into the namespaces that the global one uses, and finds these.
namespace kit_missing {
struct GraphType;
struct ZeroForce;
struct Force;
struct ZeroConstraint;
struct Constraint;
struct TearConstraint;
struct TearingConstraint;
struct SphereTearConstraint;
struct TearSphereConstraint;
struct SphereRemoveConstraint;
struct RemoveSphereConstraint;
struct RemoveConstraint;
struct SphereConstraint2;
struct Missing {};
inline constexpr Missing K, L;
template <typename... T>
Missing build_cloth(T&&...) {
  return {};
}
template <typename... T>
Missing make_combined_constraint(T&&...) {
  return {};
}
template <typename... T>
Missing make_combined_constraints(T&&...) {
  return {};
}
}  // namespace kit_missing
using namespace kit_missing;

#ifndef KIT_GRAPH
#define KIT_GRAPH GraphType
#endif
#ifndef KIT_FORCE_BASE
#define KIT_FORCE_BASE ZeroForce
#endif
#ifndef KIT_CONSTRAINT_BASE
#define KIT_CONSTRAINT_BASE ZeroConstraint
#endif
#ifndef KIT_TEAR
#define KIT_TEAR TearConstraint
#endif

namespace kit {

using kit_missing::Missing;
using Cloth = ::KIT_GRAPH;
using ClothNode = typename Cloth::node_type;
using ClothEdge = typename Cloth::edge_type;

template <typename T>
concept Complete = requires {
  sizeof(T);
};

/** The class T, or T<Arg> if it is a template; a template is no base. */
template <typename Arg, typename T>
std::type_identity<T> class_of();
template <typename Arg, template <typename...> class T>
std::type_identity<T<Arg>> class_of();
#define KIT_FORCE(name) \
  typename decltype(kit::class_of<kit::ClothNode, ::name>())::type
#define KIT_CONSTRAINT(name) \
  typename decltype(kit::class_of<kit::Cloth, ::name>())::type

// --------------------------------------------------------- A cloth, in arrays

struct Spring {
  int a, b;
  double K, L;  ///< [N/m], [m]
};
/** What a graph is filled with, and what it is compared with. */
struct Bodies {
  std::vector<Point> x, v;
  std::vector<double> m;
  std::vector<Spring> springs;

  /** @return the number of the new one */
  int add(const Point& place, double mass = 1, const Point& velocity = {}) {
    x.push_back(place);
    v.push_back(velocity);
    m.push_back(mass);
    return int(x.size()) - 1;
  }
  int size() const { return int(x.size()); }

  /** The springs' force on body @a i, by Hooke's law. */
  Point pull(int i) const {
    Point sum(0, 0, 0);
    for (const Spring& s : springs) {
      if (s.a != i && s.b != i) continue;
      const Point u = x[s.a == i ? s.b : s.a] - x[i];
      const double length = std::sqrt(u.x * u.x + u.y * u.y + u.z * u.z);
      sum += s.K * (length - s.L) / length * u;
    }
    return sum;
  }
};

inline ClothNode node_of(Cloth& g, int i) {
  return g.node(static_cast<decltype(g.num_nodes())>(i));
}
inline Point place(Cloth& g, int i) { return node_of(g, i).position(); }
/** The velocity of a node, to be read or set. */
inline Point& velocity(ClothNode n) {
  auto& value = n.value();
  using Found = decltype(velocity_in(value));
  static_assert(is_there<Found>, "NodeData has a velocity: Point vel");
  return *velocity_in(value);
}
inline Point& velocity(Cloth& g, int i) { return velocity(node_of(g, i)); }
inline auto& mass(ClothNode n) {
  auto& value = n.value();
  using Found = decltype(mass_in(value));
  static_assert(is_there<Found>, "NodeData has a mass: double mass");
  return *mass_in(value);
}

/** Has each edge an L, and a K? A K that it has not is 100 N/m. */
template <typename E>
constexpr bool edge_has_L() {
  if constexpr (requires(E e) { e.value(); })
    return is_there<decltype(L_in(std::declval<E&>().value()))>;
  else
    return false;
}
template <typename E>
constexpr bool edge_has_K() {
  if constexpr (requires(E e) { e.value(); })
    return is_there<decltype(K_in(std::declval<E&>().value()))>;
  else
    return false;
}
inline constexpr bool has_L = edge_has_L<ClothEdge>();
inline constexpr bool has_K = edge_has_K<ClothEdge>();
/** @a wanted if edges have a K of their own, else the assignment's. */
inline double spring_constant(double wanted) { return has_K ? wanted : 100; }

/** The edge between two nodes, new or old. */
template <typename G, typename N>
auto joined(G& g, N a, N b) {
  if constexpr (requires { g.add_edge(a, b); })
    return g.add_edge(a, b);
  else
    return g.add_edge(a, b, {});
}
template <typename E>
void set_spring(E e, const Spring& s) {
  if constexpr (edge_has_L<E>()) *L_in(e.value()) = s.L;
  if constexpr (edge_has_K<E>()) *K_in(e.value()) = s.K;
}

/** Give each edge its K and L, from whichever end it is seen. */
template <typename G>
void set_springs(G& g, const Bodies& bodies) {
  for (const Spring& s : bodies.springs)
    set_spring(joined(g, node_of(g, s.a), node_of(g, s.b)), s);
}
/** Fill the empty graph @a g: body i is node(i). */
template <typename G>
void fill(G& g, const Bodies& bodies) {
  for (int i = 0; i < bodies.size(); ++i) {
    auto n = g.add_node(bodies.x[i]);
    velocity(n) = bodies.v[i];
    mass(n) = bodies.m[i];
    if constexpr (requires { start_in(n.value()); })
      if constexpr (is_there<decltype(start_in(n.value()))>)
        *start_in(n.value()) = bodies.x[i];
  }
  set_springs(g, bodies);
}

// ------------------------------------ Forces and constraints that a test makes

/** Tells a copy that lives from a reference to what is gone. */
class Life {
 public:
  Life() = default;
  Life(const Life&) {}
  Life& operator=(const Life&) { return *this; }
  ~Life() { alive_ = 0; }
  void look() const {
    if (alive_ != here)
      fail("what was combined to be kept as a copy",
           "a reference to a temporary that is gone");
  }

 private:
  static constexpr unsigned here = 0x6c697665;
  volatile unsigned alive_ = here;
};

using ForceLaw = std::function<Point(ClothNode, double)>;
using ConstraintLaw = std::function<void(Cloth&, double)>;

/** A force or a constraint of the test's: for templates, no base needed. */
class FreeForce {
 public:
  explicit FreeForce(ForceLaw law)
      : law_(std::make_shared<ForceLaw>(std::move(law))) {}
  template <typename N>
  Point operator()(N n, double t) const {
    return call(n, t);
  }

 protected:
  Point call(ClothNode n, double t) const {
    life_.look();
    auto law = law_;  // lives on, whatever becomes of this
    return (*law)(n, t);
  }

 private:
  Life life_;
  std::shared_ptr<ForceLaw> law_;
};
class FreeConstraint {
 public:
  explicit FreeConstraint(ConstraintLaw law)
      : law_(std::make_shared<ConstraintLaw>(std::move(law))) {}
  template <typename G>
  void operator()(G& g, double t) const {
    call(g, t);
  }

 protected:
  void call(Cloth& g, double t) const {
    life_.look();
    auto law = law_;
    (*law)(g, t);
  }

 private:
  Life life_;
  std::shared_ptr<ConstraintLaw> law_;
};

/** The same as a child of Base, whose virtual call has the type Call. */
template <typename Base, typename Law, typename Call>
struct Child;
template <typename Base, typename Law, typename R, typename C, typename A,
          typename B>
struct Child<Base, Law, R (C::*)(A, B)> : Base, private Law {
  template <typename F>
  explicit Child(F law) : Law(std::move(law)) {}
  R operator()(A a, B b) override { return Law::call(a, b); }
};
template <typename Base, typename Law, typename R, typename C, typename A,
          typename B>
struct Child<Base, Law, R (C::*)(A, B) const> : Base, private Law {
  template <typename F>
  explicit Child(F law) : Law(std::move(law)) {}
  R operator()(A a, B b) const override { return Law::call(a, b); }
};

template <typename Base>
concept HasVirtualCall =
    Complete<Base> && std::is_polymorphic_v<Base> && requires {
  &Base::operator();
};

/** A child of First or, if that is no base with a virtual call, of the next
 * one; without any the law itself. */
template <typename Law, typename First, typename... Others>
auto child_of_one_of() {
  if constexpr (HasVirtualCall<First>)
    return std::type_identity<
        Child<First, Law, decltype(&First::operator())>>();
  else if constexpr (sizeof...(Others) > 0)
    return child_of_one_of<Law, Others...>();
  else
    return std::type_identity<Law>();
}
using TestForce = decltype(child_of_one_of<FreeForce, ::KIT_FORCE_BASE,
                                           ::ZeroForce, ::Force>())::type;
using TestConstraint =
    decltype(child_of_one_of<FreeConstraint, ::KIT_CONSTRAINT_BASE,
                             ::ZeroConstraint, ::Constraint>())::type;

/** A force that is @a f everywhere, plus @a per_second times t. */
inline TestForce constant_force(const Point& f, const Point& per_second = {}) {
  return TestForce([=](ClothNode, double t) { return f + t * per_second; });
}
inline TestConstraint no_constraint() {
  return TestConstraint([](Cloth&, double) {});
}

// ---------------------------------------------------- What a submission calls

/** The force of @a f, whether it takes a node by value or by reference. */
template <typename F>
Point force_on(F& f, ClothNode n, double t = 0) {
  return f(n, t);
}
template <typename F>
Point force_on(F& f, Cloth& g, int i, double t = 0) {
  return force_on(f, node_of(g, i), t);
}
template <typename C>
void constrain(C& c, Cloth& g, double t = 0) {
  c(g, t);
}

/** The pin of the corners: made from a graph, from nothing, from points or from
 * nodes, all at once or one by one. @a g has its corners in place. */
template <typename Pin>
class Pins {
 public:
  explicit Pins(Cloth& g) {
    std::vector<Point> p = {Point(0, 0, 0), Point(1, 0, 0)};
    std::vector<ClothNode> n;
    for (const Point& corner : p)
      for (int i = 0; i < int(g.num_nodes()); ++i)
        if (place(g, i) == corner) n.push_back(node_of(g, i));
    auto i = [&](int k) { return static_cast<unsigned>(n[k].index()); };
    if constexpr (std::is_constructible_v<Pin, Cloth&>) {
      hold(g);
    } else if constexpr (std::is_constructible_v<Pin, Cloth*>) {
      hold(&g);
    } else if constexpr (std::is_default_constructible_v<Pin>) {
      hold();
    } else if constexpr (std::is_constructible_v<Pin, decltype((p))>) {
      hold(p);
    } else if constexpr (std::is_constructible_v<Pin, decltype((n))>) {
      hold(n);
    } else if constexpr (requires { Pin(g, p); }) {
      hold(g, p);
    } else if constexpr (requires { Pin(p[0], p[1]); }) {
      hold(p[0], p[1]);
    } else if constexpr (requires { Pin(n[0], n[1]); }) {
      hold(n[0], n[1]);
    } else if constexpr (requires { Pin(n[0], p[0]); }) {
      hold(n[0], p[0]), hold(n[1], p[1]);
    } else if constexpr (requires { Pin(g, p[0]); }) {
      hold(g, p[0]), hold(g, p[1]);
    } else if constexpr (requires { Pin(g, p[0], p[1]); }) {
      hold(g, p[0], p[1]);
    } else if constexpr (requires { Pin(n[0], n[1], p[0], p[1]); }) {
      hold(n[0], n[1], p[0], p[1]);
    } else if constexpr (requires { Pin(p[0]); }) {
      hold(p[0]), hold(p[1]);
    } else if constexpr (requires { Pin(n[0]); }) {
      hold(n[0]), hold(n[1]);
    } else {
      static_assert(
          requires { Pin(i(0), i(1)); },
          "PinConstraint is made from nothing, a graph or points");
      hold(i(0), i(1));
    }
  }
  void operator()(Cloth& g, double t) {
    for (auto& pin : pins_) (*pin)(g, t);
  }

 private:
  std::vector<std::shared_ptr<Pin>> pins_;
  template <typename... Args>
  void hold(Args&&... args) {
    pins_.emplace_back(new Pin(std::forward<Args>(args)...));
  }
};

/** Is there a step without a constraint? A program of section 6 may have the
 * other one alone. */
template <typename G>
constexpr bool steps_freely() {
  return requires(G & g, double t, TestForce& f) {
    ::symp_euler_step(g, t, t, f);
  };
}
/** A step without a constraint, or with one that does nothing. */
template <typename G, typename F>
double free_step(G& g, double t, double dt, F& force) {
  if constexpr (steps_freely<G>()) {
    return ::symp_euler_step(g, t, dt, force);
  } else {
    auto nothing = no_constraint();
    return ::symp_euler_step(g, t, dt, force, nothing);
  }
}

}  // namespace kit
#endif

#include "check.hpp"
