/** @file cloth_bodies.hpp
 * Part of cloth.hpp: a graph that is filled with bodies and compared with
 * them. */
#ifndef KIT_CLOTH_BODIES_HPP
#define KIT_CLOTH_BODIES_HPP
#include "bodies.hpp"

namespace kit {

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

/** Has each edge an L, and a K? A K that it has not is given_K. */
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
inline double spring_constant(double wanted) {
  return has_K ? wanted : given_K;
}

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
/** @a n is where it is at first: some pins read that from its value. */
template <typename N>
void keep_start(N n) {
  if constexpr (requires { start_in(n.value()); })
    if constexpr (is_there<decltype(start_in(n.value()))>)
      *start_in(n.value()) = n.position();
}
/** Fill the empty graph @a g: body i is node(i). */
template <typename G>
void fill(G& g, const Bodies& bodies) {
  for (int i = 0; i < bodies.size; ++i) {
    auto n = g.add_node(bodies.x[i]);
    velocity(n) = bodies.v[i];
    mass(n) = bodies.m[i];
    keep_start(n);
  }
  set_springs(g, bodies);
}

/** Two that move, and a spring between them. */
inline Bodies moving_bodies() {
  Bodies b;
  b.add(Point(0.5, 0.25, 0), 0.25, Point(1, 2, 3));
  b.add(Point(0.25, 1.5, 1), 2, Point(-3, 0, 4));
  b.join(0, 1, given_K, 0.25);
  b.vary();
  return b;
}

/** Answer where the nodes are, and how fast. */
inline void answer_nodes(Cloth& g, int n) {
  for (int i = 0; i < n; ++i) {
    answer("position", place(g, i));
    answer("velocity", velocity(g, i));
  }
}

}  // namespace kit
#endif
