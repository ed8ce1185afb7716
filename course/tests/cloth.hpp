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
#include <CME212/SDLViewer.hpp>       // of headless/
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
struct ZeroForce;
struct Force;
struct Problem1Force;
struct GravityForce;
struct MassSpringForce;
struct DampingForce;
struct ZeroConstraint;
struct Constraint;
struct PinConstraint;
struct PlaneConstraint;
struct SphereConstraint;
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
Missing make_combined_force(T&&...) {
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
template <typename T>
concept Present = !std::is_same_v<T, Missing>;

/** The class T, or T<Arg> if it is a template; a template is no base. */
template <typename Arg, typename T>
std::type_identity<T> class_of();
template <typename Arg, template <typename...> class T>
std::type_identity<T<Arg>> class_of();
/** Run @a test<C>(), or fail if the class is missing: it costs this test only,
 * and no other one the time to compile it apart. */
template <typename C, typename Test>
void with(const char* name, Test test) {
  if constexpr (Complete<C>)
    test.template operator()<C>();
  else
    fail(words("a class ", name), "none");
}

#define KIT_FORCE(name) \
  typename decltype(kit::class_of<kit::ClothNode, ::name>())::type
#define KIT_CONSTRAINT(name) \
  typename decltype(kit::class_of<kit::Cloth, ::name>())::type

// --------------------------------------------------------- A cloth, in arrays

struct Spring {
  int a, b;
  double K, L;  ///< [N/m], [m]
};
/** What a graph is filled with, and what it is compared with. (Plain arrays,
 * as every class template that a test uses costs time to compile.) */
struct Bodies {
  static constexpr int most = 32;
  Point x[most], v[most];
  double m[most] = {};
  Spring springs[2 * most] = {};
  int size = 0, num_springs = 0;

  /** @return the number of the new one */
  int add(const Point& place, double mass = 1, const Point& velocity = {}) {
    assert(size < most);
    x[size] = place, v[size] = velocity, m[size] = mass;
    return size++;
  }
  void join(int a, int b, double K, double L) {
    assert(num_springs < 2 * most);
    springs[num_springs++] = {a, b, K, L};
  }

  /** The springs' force on body @a i, by Hooke's law. */
  Point pull(int i) const {
    Point sum(0, 0, 0);
    for (int k = 0; k < num_springs; ++k) {
      const Spring& s = springs[k];
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
  for (int k = 0; k < bodies.num_springs; ++k) {
    const Spring& s = bodies.springs[k];
    set_spring(joined(g, node_of(g, s.a), node_of(g, s.b)), s);
  }
}
/** Fill the empty graph @a g: body i is node(i). */
template <typename G>
void fill(G& g, const Bodies& bodies) {
  for (int i = 0; i < bodies.size; ++i) {
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

/** What a test's force or constraint does: a reference to a function object,
 * which has to outlive it. */
struct ForceLaw {
  const void* f;
  Point (*call)(const void*, ClothNode, double);
  template <typename F>
  ForceLaw(const F& function)
      : f(&function), call([](const void* p, ClothNode n, double t) {
          return Point((*static_cast<const F*>(p))(n, t));
        }) {}
  template <typename F>
  ForceLaw(const F&&) = delete;  // a temporary
};
struct ConstraintLaw {
  const void* f;
  void (*call)(const void*, Cloth&, double);
  template <typename F>
  ConstraintLaw(const F& function)
      : f(&function), call([](const void* p, Cloth& g, double t) {
          (*static_cast<const F*>(p))(g, t);
        }) {}
  template <typename F>
  ConstraintLaw(const F&&) = delete;
};

/** A force or a constraint of the test's: for templates, no base needed. */
class FreeForce {
 public:
  using Law = ForceLaw;
  explicit FreeForce(Law law) : law_(law) {}
  template <typename N>
  Point operator()(N n, double t) const {
    return call(n, t);
  }

 protected:
  Point call(ClothNode n, double t) const {
    life_.look();
    return law_.call(law_.f, n, t);
  }

 private:
  Life life_;
  Law law_;
};
class FreeConstraint {
 public:
  using Law = ConstraintLaw;
  explicit FreeConstraint(Law law) : law_(law) {}
  template <typename G>
  void operator()(G& g, double t) const {
    call(g, t);
  }

 protected:
  void call(Cloth& g, double t) const {
    life_.look();
    law_.call(law_.f, g, t);
  }

 private:
  Life life_;
  Law law_;
};

/** The same as a child of Base, whose virtual call has the type Call. */
template <typename Base, typename Free, typename Call>
struct Child;
template <typename Base, typename Free, typename R, typename C, typename A,
          typename B>
struct Child<Base, Free, R (C::*)(A, B)> : Base, private Free {
  explicit Child(typename Free::Law law) : Free(law) {}
  R operator()(A a, B b) override { return Free::call(a, b); }
};
template <typename Base, typename Free, typename R, typename C, typename A,
          typename B>
struct Child<Base, Free, R (C::*)(A, B) const> : Base, private Free {
  explicit Child(typename Free::Law law) : Free(law) {}
  R operator()(A a, B b) const override { return Free::call(a, b); }
};

template <typename Base>
concept HasVirtualCall =
    Complete<Base> && std::is_polymorphic_v<Base> && requires {
  &Base::operator();
};

/** A child of First or, if that is no base with a virtual call, of the next
 * one; without any a free one. */
template <typename Free, typename First, typename... Others>
auto child_of_one_of() {
  if constexpr (HasVirtualCall<First>)
    return std::type_identity<
        Child<First, Free, decltype(&First::operator())>>();
  else if constexpr (sizeof...(Others) > 0)
    return child_of_one_of<Free, Others...>();
  else
    return std::type_identity<Free>();
}
using TestForce = decltype(child_of_one_of<FreeForce, ::KIT_FORCE_BASE,
                                           ::ZeroForce, ::Force>())::type;
using TestConstraint =
    decltype(child_of_one_of<FreeConstraint, ::KIT_CONSTRAINT_BASE,
                             ::ZeroConstraint, ::Constraint>())::type;

inline TestConstraint no_constraint() {
  static constexpr auto nothing = [](Cloth&, double) {};
  return TestConstraint(nothing);
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

/** Deletes what a test has made by new. (A unique_ptr of each type takes longer
 * to compile.) */
template <typename T>
struct Owned {
  T* made;
  Owned(T* p) : made(p) {}
  Owned(const Owned&) = delete;
  ~Owned() { delete made; }
  T& operator*() const { return *made; }
};

/** The pin of the corners: made from a graph, from nothing, from points or from
 * nodes, all at once or one by one. @a g has its corners in place. */
template <typename Pin>
class Pins {
 public:
  explicit Pins(Cloth& g) {
    const Point p0(0, 0, 0), p1(1, 0, 0);
    const ClothNode n0 = node_at(g, p0), n1 = node_at(g, p1);
    if constexpr (std::is_constructible_v<Pin, Cloth&>) {
      hold(g);
    } else if constexpr (std::is_constructible_v<Pin, Cloth*>) {
      hold(&g);
    } else if constexpr (std::is_default_constructible_v<Pin>) {
      hold();
    } else if constexpr (std::is_constructible_v<Pin, std::vector<Point>>) {
      hold(std::vector<Point>{p0, p1});
    } else if constexpr (std::is_constructible_v<Pin, std::vector<ClothNode>>) {
      hold(std::vector<ClothNode>{n0, n1});
    } else if constexpr (requires { Pin(g, std::vector<Point>()); }) {
      hold(g, std::vector<Point>{p0, p1});
    } else if constexpr (requires { Pin(p0, p1); }) {
      hold(p0, p1);
    } else if constexpr (requires { Pin(n0, n1); }) {
      hold(n0, n1);
    } else if constexpr (requires { Pin(n0, p0); }) {
      hold(n0, p0), hold(n1, p1);
    } else if constexpr (requires { Pin(g, p0); }) {
      hold(g, p0), hold(g, p1);
    } else if constexpr (requires { Pin(g, p0, p1); }) {
      hold(g, p0, p1);
    } else if constexpr (requires { Pin(n0, n1, p0, p1); }) {
      hold(n0, n1, p0, p1);
    } else if constexpr (requires { Pin(p0); }) {
      hold(p0), hold(p1);
    } else if constexpr (requires { Pin(n0); }) {
      hold(n0), hold(n1);
    } else {
      static_assert(
          requires { Pin(0u, 0u); },
          "PinConstraint is made from nothing, a graph or points");
      hold(unsigned(n0.index()), unsigned(n1.index()));
    }
  }
  Pins(const Pins&) = delete;
  ~Pins() { delete first_, delete second_; }
  void operator()(Cloth& g, double t) {
    (*first_)(g, t);
    if (second_) (*second_)(g, t);
  }

 private:
  Pin *first_ = nullptr, *second_ = nullptr;
  template <typename... Args>
  void hold(Args&&... args) {
    (first_ ? second_ : first_) = new Pin(std::forward<Args>(args)...);
  }
  static ClothNode node_at(Cloth& g, const Point& p) {
    int i = 0;
    while (!(place(g, i) == p)) ++i;
    return node_of(g, i);
  }
};

/** The plane z = -0.75 m and the ball, which some make from numbers. */
template <typename C>
C made_plane() {
  if constexpr (std::is_default_constructible_v<C>)
    return C();
  else if constexpr (std::is_constructible_v<C, double>)
    return C(-0.75);
  else
    return C(Point(0, 0, 1), -0.75);
}
template <typename C>
C made_sphere() {
  const Point center(0.5, 0.5, -0.5);
  if constexpr (std::is_default_constructible_v<C>)
    return C();
  else if constexpr (std::is_constructible_v<C, Point, double>)
    return C(center, 0.15);
  else
    return C(0.15, center);
}

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
