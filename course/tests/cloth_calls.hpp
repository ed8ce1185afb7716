/** @file cloth_calls.hpp
 * Part of cloth.hpp: calls of what a submission has, in the forms that the
 * assignment allows. */
#ifndef KIT_CLOTH_CALLS_HPP
#define KIT_CLOTH_CALLS_HPP

namespace kit {

/** @a f as its base Free::Called: a call may be public in that only. */
template <typename Free, typename F>
concept CalledByBase = requires(F& f) {
  static_cast<typename Free::Called&>(f);
};

/** The force of @a f, whether it takes a node by value or by reference. */
template <typename F>
Point force_on(F& f, ClothNode n, double t = 0) {
  if constexpr (!requires { f(n, t); } && CalledByBase<TestForce, F>)
    return static_cast<typename TestForce::Called&>(f)(n, t);
  else
    return f(n, t);
}
template <typename F>
Point force_on(F& f, Cloth& g, int i, double t = 0) {
  return force_on(f, node_of(g, i), t);
}
/** Constrain @a g, whether @a c takes a graph by reference or its address. */
template <typename C>
void constrain(C& c, Cloth& g, double t = 0) {
  if constexpr (requires { c(g, t); })
    c(g, t);
  else if constexpr (requires { c(&g, t); })
    c(&g, t);
  else if constexpr (CalledByBase<TestConstraint, C> &&
                     !std::is_same_v<C, typename TestConstraint::Called>)
    constrain(static_cast<typename TestConstraint::Called&>(c), g, t);
  else
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

/** A force made from nothing, from a graph or from these numbers. */
template <typename F, typename... Numbers>
F* made_force(const char* name, Cloth& g, Numbers... numbers) {
  if constexpr (std::is_default_constructible_v<F>)
    return new F();
  else if constexpr (std::is_constructible_v<F, Cloth&>)
    return new F(g);
  else if constexpr (std::is_constructible_v<F, Numbers...>)
    return new F(numbers...);
  else
    fail(words(name, " to be made from nothing"), "another constructor");
}

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
    } else if constexpr (std::is_constructible_v<Pin, std::vector<Point>&>) {
      hold(points_ = {p0, p1});
    } else if constexpr (std::is_constructible_v<Pin,
                                                 std::vector<ClothNode>&>) {
      hold(nodes_ = {n0, n1});
    } else if constexpr (requires { Pin(nodes_, points_); }) {
      hold(nodes_ = {n0, n1}, points_ = {p0, p1});
    } else if constexpr (requires { Pin(points_, nodes_); }) {
      hold(points_ = {p0, p1}, nodes_ = {n0, n1});
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
    constrain(*first_, g, t);
    if (second_) constrain(*second_, g, t);
  }

 private:
  Pin *first_ = nullptr, *second_ = nullptr;
  // Lists that a pin may keep a reference to.
  std::vector<Point> points_;
  std::vector<ClothNode> nodes_;
  template <typename... Args>
  void hold(Args&&... args) {
    (first_ ? second_ : first_) = new Pin(std::forward<Args>(args)...);
  }
  static ClothNode node_at(Cloth& g, const Point& p) {
    int i = 0;
    while (!(place(g, i) == p) && i + 1 < int(g.num_nodes())) ++i;
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

/** If @a C is made from a Ball, as in the guided starter: test(c, g), with c at
 * (2, 2, 2) of radius 1, and two nodes, the second inside it. */
template <typename C, typename Test, typename Ball = ::Ball>
void with_ball(Test test) {
  if constexpr (requires { C(Ball{Point(2, 2, 2), 1.}); }) {
    did("a ball at (2, 2, 2) of radius 1, and nodes at (0.5, 0.5, -0.5) and "
        "(2.5, 2, 2)");
    Bodies b;
    b.add(Point(0.5, 0.5, -0.5));
    b.add(Point(2.5, 2, 2));
    Cloth g;
    fill(g, b);
    C c(Ball{Point(2, 2, 2), 1.});
    test(c, g);
  }
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
