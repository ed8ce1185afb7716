/** @file 4.1.edge_value.cpp
 * The values of edges: one for each, the same from either end. */
#include "graph.hpp"

namespace kit {
/** A failure with words, not with the compiler's, if there is no value(). */
template <typename G>
static void need_values_of_edges() {
  constexpr bool there = requires(G g) { (*g.edge_begin()).value(); }
  || requires(G g) { g.edge(g.num_edges()).value(); }
  || requires(G g) { (*g.node(g.num_nodes()).edge_begin()).value(); };
  need<there>("Graph<V, E> and e.value()");
}

/** Set the value of every edge of @a s by the handle that @a set_by gives, and
 * read it by all others. */
template <typename S, typename F>
static void check_values_of_edges(S& s, F set_by) {
  if constexpr (requires(decltype(set_by(s, Ends(0, 1))) e) {
                  e.value() = 0.5;
                }) {
    for (Ends e : s.m.edges) set_by(s, e).value() = e.value();
    for (Ends e : s.m.edges) {
      CHECK_EQUAL(set_by(s, e).value(), e.value());
      for (auto [from, to] : {std::pair(e.a, e.b), std::pair(e.b, e.a)}) {
        auto seen = s.edge_seen_from(from, to);
        check_equal(
            seen.value(), e.value(),
            words("value() of ", name(e), ", seen from ", name(from), ','));
        check_equal(add_edge(s.g, s.node(from), s.node(to)).value(), e.value(),
                    words("add_edge(", name(from), ", ", name(to),
                          "), of an edge that is there, .value()"));
      }
    }
    if (s.works & edge_indices)
      for (std::size_t i = 0; i < s.m.edges.size(); ++i) {
        auto e = edge_at(s.g, i);
        check_equal(e.value(), ends_of(e).value(),
                    words("edge(", i, ").value()"));
      }
    if (s.works & edge_loop)
      for (auto it = s.g.edge_begin(), end = s.g.edge_end(); !same(it, end);
           ++it)
        check_equal((*it).value(), ends_of(*it).value(), "(*it).value()");
  } else {
    need<false>("e.value() = 0.5");
  }
}

template <typename G>
static void check_values_set_by_all_handles() {
  need_values_of_edges<G>();
  if constexpr (requires(G g) {
                  {
                    (*g.node(g.num_nodes()).edge_begin()).value()
                    } -> std::convertible_to<double>;
                }) {
    for (const Model& shape : {ring(8), wheel(6)}) {
      const auto graph = words(" = x for each edge of a graph of ",
                               shape.nodes.size(), " nodes");
      DID("add_edge(a, b).value()", graph);
      Subject<G> by_add(shape);
      check_values_of_edges(by_add, [](auto& s, Ends e) {
        return add_edge(s.g, s.node(e.a), s.node(e.b));
      });
      DID("value()", graph, ", each seen from its first end");
      Subject<G> by_first(shape);
      check_values_of_edges(
          by_first, [](auto& s, Ends e) { return s.edge_seen_from(e.a, e.b); });
      DID("value()", graph, ", each seen from its second end");
      Subject<G> by_second(shape);
      check_values_of_edges(by_second, [](auto& s, Ends e) {
        return s.edge_seen_from(e.b, e.a);
      });
      Subject<G> by_index(shape);
      if (!(by_index.works & edge_indices)) continue;
      DID("edge(i).value()", graph);
      check_values_of_edges(by_index,
                            [](auto& s, Ends e) { return s.edge(e.a, e.b); });
    }
  } else {
    need<false>("double x = e.value()");
  }
}
}  // namespace kit

TASK("4.1.edge_value", every_edge_has_one_value) {
  check_values_set_by_all_handles<TestGraph>();
}

namespace kit {
struct Spring {
  double K = 1, L = 2;
};

template <typename G>
static void check_values_while_a_graph_grows() {
  need_values_of_edges<G>();
  if constexpr (requires(G g) {
                  (*g.node(g.num_nodes()).edge_begin()).value().K = 1;
                }) {
    DID("a graph of 40 nodes grows edge by edge; each edge gets a value of ",
        "struct Spring");
    G g;
    for (int v = 0; v < 40; ++v) add_node(g, place(v), v);
    for (int v = 1; v < 40; ++v) {
      auto n = node_at(g, v), before = node_at(g, v - 1);
      add_edge(g, n, before, Spring{v + 0.5, 1});
      if (v > 1) add_edge(g, node_at(g, 0), n, Spring{-1, -double(v)});
    }
    for (int v = 2; v < 40; ++v) {
      auto n = node_at(g, v), before = node_at(g, v - 1);
      CHECK_EQUAL(add_edge(g, n, before).value().K, v + 0.5);
      CHECK_EQUAL(add_edge(g, before, n).value().L, 1);
      CHECK_EQUAL(add_edge(g, n, node_at(g, 0)).value().L, -v);
    }
  } else {
    need<false>("Graph<V, Spring> and e.value().K = 1");
  }
}
}  // namespace kit

TASK("4.1.edge_value", values_stay_while_the_graph_grows) {
  check_values_while_a_graph_grows<GraphOf<int, Spring>>();
}
