/** @file 4.1.edge_value.cpp
 * The values of edges: one for each, the same from either end. */
#include "graph.hpp"

namespace kit {
/** An edge by the handles through which it is reached. */
enum Handle { added, added_again, first_end, second_end, indexed };
static const char* name(Handle h) {
  const char* names[] = {"add_edge(a, b)", "add_edge(b, a)", "its first end",
                         "its second end", "edge(i)"};
  return names[h];
}
template <typename S>
static auto handle(S& s, Ends e, Handle h) {
  if (h == first_end) return s.edge_seen_from(e.a, e.b);
  if (h == second_end) return s.edge_seen_from(e.b, e.a);
  if (h == indexed) return s.edge(e.a, e.b);
  return h == added ? add_edge(s.g, s.node(e.a), s.node(e.b))
                    : add_edge(s.g, s.node(e.b), s.node(e.a));
}

/** Can these values be reached by such a handle? What an edge that is added
 * again becomes, and edge(i), are of other tasks. */
template <typename S>
static bool usable(S& s, Handle h) {
  if (h == indexed) return s.works & edge_indices;
  if (h == first_end || h == second_end) return s.works & incident_loop;
  S other(s.m);
  const Ends e = s.m.edges[0];
  const auto before = other.g.num_edges();
  add_edge(other.g, other.node(e.a), other.node(e.b));
  add_edge(other.g, other.node(e.b), other.node(e.a));
  return equal(other.g.num_edges(), before);
}

/** Set all values by one kind of handle, read them by all kinds. */
template <typename S>
static void check_values_set_by(Handle set, const Model& shape) {
  const double more = drawn(1, 0, 2);
  S s(shape);
  if (!usable(s, set)) return;
  using Edge = decltype(handle(s, Ends(0, 1), set));
  constexpr bool there =
      must_compile || (HasValue<Edge> && requires(Edge e) { e.value() = 1.5; });
  need<there>("Graph<int, double> and e.value() = 1.5");
  constexpr bool reads = must_compile || requires(const Edge e) {
    static_cast<double>(e.value());
  };
  need<reads>("value() of a const Edge");
  if constexpr (there && reads) {
    DID(description(shape), "; set the value of each edge by ", name(set));
    for (Ends e : s.m.edges) handle(s, e, set).value() = more + e.value();
    for (Handle get : {added, added_again, first_end, second_end, indexed}) {
      if (!usable(s, get)) continue;
      for (Ends e : s.m.edges) {
        const auto edge = handle(s, e, get);
        const double value = static_cast<double>(edge.value());
        answer(words("values of ", description(shape), ", set by ", name(set),
                     ", read by ", name(get), "?"),
               value);
        check_equal(value, more + e.value(),
                    words("the value of ", name(e), " by ", name(get)));
      }
    }
    if (!(s.works & edge_loop)) return;
    for (auto it = s.g.edge_begin(), end = s.g.edge_end(); !same(it, end); ++it)
      CHECK_EQUAL((*it).value(), more + ends_of(*it).value());
  }
}
}  // namespace kit

TASK("4.1.edge_value", every_edge_has_one_value) {
  for (const Model& shape : {ring(8), wheel(6)})
    for (Handle h : {added, added_again, first_end, second_end, indexed})
      check_values_set_by<TestSubject>(h, shape);
}

namespace kit {
template <typename G>
static void check_values_while_a_graph_grows(G& g) {
  add_node(g, place(0), Mass());
  add_node(g, place(1), Mass());
  auto a = node_at(g, 0), b = node_at(g, 1);
  constexpr bool there = must_compile || requires {
    add_edge(g, a, b).value().K = 1;
  };
  need<there>("Graph<V, SpringValue> and e.value().K = 1");
  if constexpr (there) {
    DID("a graph of 40 nodes grows edge by edge, each with a value of struct ",
        "SpringValue");
    for (int v = 2; v < 40; ++v) {
      add_node(g, place(v), Mass());
      auto n = node_at(g, v), before = node_at(g, v - 1);
      add_edge(g, n, before, SpringValue{v + 0.5, 1});
      add_edge(g, node_at(g, 0), n, SpringValue{-1, -double(v)});
    }
    for (int v = 2; v < 40; ++v) {
      auto n = node_at(g, v);
      for (auto it = n.edge_begin(), end = n.edge_end(); !same(it, end); ++it) {
        auto e = *it;
        const Ends ends = ends_of(e);
        check_equal(e.value().K, ends.a == 0 ? -1 : ends.b + 0.5,
                    words("value().K of ", name(ends)));
        check_equal(e.value().L, ends.a == 0 ? -ends.b : 1,
                    words("value().L of ", name(ends)));
      }
    }
  }
}
}  // namespace kit

TASK("4.1.edge_value", values_stay_while_the_graph_grows) {
  StructGraph g;
  check_values_while_a_graph_grows(g);
}
