/** @file cloth_bodies.hpp
 * Part of cloth.hpp: a cloth in plain arrays, which a graph is filled with and
 * compared with. */
#ifndef KIT_CLOTH_BODIES_HPP
#define KIT_CLOTH_BODIES_HPP

namespace kit {

struct Spring {
  int a, b;
  double K, L;  ///< [N/m], [m]
};
/** The bodies that a graph is filled with and compared with. (Plain arrays,
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

  /** With a seed: other places, within @a by [m], velocities that are not 0,
   * and masses. Corners stay. */
  void move(double by) {
    for (int i = 0; i < size; ++i) {
      if (!is_corner(x[i])) x[i] = varied(x[i], by, i);
      v[i] *= varied(Point(1, 1, 1), 0.4, i);
      m[i] = varied(m[i], 0.4 * m[i], i);
    }
  }
  /** Also other L. */
  void vary(double by) {
    move(by);
    for (int k = 0; k < num_springs; ++k)
      springs[k].L = varied(springs[k].L, 0.1 * springs[k].L, k);
  }
  /** The same bodies with other numbers: in the order of their ranks. */
  void reorder(const double* rank) {
    const Bodies old = *this;
    int number_of[most] = {};
    for (int i = 0; i < size; ++i) {
      for (int j = 0; j < size; ++j) number_of[i] += rank[j] < rank[i];
      const int at = number_of[i];
      x[at] = old.x[i], v[at] = old.v[i], m[at] = old.m[i];
    }
    for (int k = 0; k < num_springs; ++k) {
      springs[k].a = number_of[old.springs[k].a];
      springs[k].b = number_of[old.springs[k].b];
    }
  }
  /** With a seed: any order. */
  void shuffle() {
    double rank[most];
    for (int i = 0; i < most; ++i) rank[i] = varied(i, 1e3);
    reorder(rank);
  }
  /** The number of the body at @a p, which has one. */
  int at(const Point& p) const {
    int i = 0;
    while (!(x[i] == p)) ++i;
    return i;
  }
  static bool is_corner(const Point& p) {
    return p == Point(0, 0, 0) || p == Point(1, 0, 0);
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
    if (g.has_edge(node_of(g, s.b), node_of(g, s.a)))
      set_spring(joined(g, node_of(g, s.b), node_of(g, s.a)), s);
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

}  // namespace kit
#endif
