/** @file graph.hpp
 * A bridge from the tests to any Graph.hpp of the course. It brings the
 * submission's graph and check.hpp; a test of the graph includes this file and
 * nothing else.
 *
 * Accepts all that the assignment leaves open: Graph<V, E> or Graph<V>;
 * any size_type; members const or not; add_edge() with a value or without;
 * iterators with == or with != alone. So a test calls these functions, not the
 * members of the graph, where they differ.
 *
 * A removal may change indices and invalidate handles, in one graph more than
 * in another. So the tests name the nodes n0, n1, ... as they were added, know
 * each by its position, and ask for a fresh handle for each use. */
#ifndef SUBMITTED_GRAPH
#define SUBMITTED_GRAPH <Graph.hpp>
#endif
#ifndef KIT_GRAPH_HPP
#include "prelude.hpp"
// Before all else that is the kit's:
#include SUBMITTED_GRAPH
#ifdef KIT_UNDEFINED  // ends macros that would change the kit's own code
#include KIT_UNDEFINED
#endif
#endif

#include "check.hpp"

#ifndef KIT_GRAPH_HPP
#define KIT_GRAPH_HPP
#include "model.hpp"

namespace kit {

// ------------------------------------------------- The type of the graph

template <int rank>
struct Prefer : Prefer<rank - 1> {};
template <>
struct Prefer<0> {};

template <template <typename, typename> class G, typename V, typename E>
std::type_identity<G<V, E>> graph_of(Prefer<2>);
template <template <typename> class G, typename V, typename E>
std::type_identity<G<V>> graph_of(Prefer<1>);
template <typename G, typename V, typename E>
std::type_identity<G> graph_of(Prefer<0>);

/** Graph<V, E>; before section 4 Graph<V>; at first just Graph. */
template <typename V, typename E>
using GraphOf = typename decltype(graph_of<Graph, V, E>(Prefer<2>()))::type;
using TestGraph = GraphOf<int, double>;

/** Values as those of a cloth. */
struct Mass {
  double kg = 1;
  Point velocity = Point(0, 0, 0);
};
struct SpringValue {
  double K = 1, L = 2;
};
using StructGraph = GraphOf<Mass, SpringValue>;

// --------------------------------------------------- Members, as they may be

/** That a member is there is a check: without it the test fails, but compiles
 * and so costs no other test. */
template <bool there>
void need(const char* member) {
  checked();
  if constexpr (!there) fail(words(member, " to compile"), "an error");
}

template <typename N>
Point position_of(N n) {
  if constexpr (requires { std::as_const(n).position(); })
    return std::as_const(n).position();
  else
    return n.position();
}

/** A Node or an Edge of TestGraph has value(). */
template <typename T>
concept HasValue = requires(T x) {
  { x.value() } -> std::convertible_to<double>;
};

template <typename A, typename B>
bool same(A a, B b) {
  if constexpr (requires { a == b; })
    return static_cast<bool>(a == b);
  else
    return !static_cast<bool>(a != b);
}

/** Call @a f with *it from @a it to @a end. */
template <typename It, typename End, typename F>
View::Walk walk(It it, End end, std::size_t limit, F f) {
  for (std::size_t steps = 0; !kit::same(it, end); ++it) {
    if (steps++ == limit) return View::endless;
    f(*it);
  }
  return View::ended;
}

template <typename G>
auto node_at(G& g, std::size_t i) {
  return g.node(static_cast<decltype(g.num_nodes())>(i));
}
template <typename G>
auto edge_at(G& g, std::size_t i) {
  return g.edge(static_cast<decltype(g.num_edges())>(i));
}
template <typename G, typename V>
auto add_node(G& g, const Point& p, const V& value) {
  if constexpr (requires { g.add_node(p, value); }) {
    return g.add_node(p, value);
  } else {
    auto n = g.add_node(p);
    if constexpr (requires { n.value() = value; }) n.value() = value;
    return n;
  }
}
/** The value is V() or E(), or what the graph makes of none. */
template <typename G, typename N>
auto add_edge(G& g, N a, N b) {
  if constexpr (requires { g.add_edge(a, b); })
    return g.add_edge(a, b);
  else
    return g.add_edge(a, b, {});
}
/** The edge of this value. */
template <typename G, typename N, typename E>
auto add_edge(G& g, N a, N b, const E& value) {
  if constexpr (requires { kit::add_edge(g, a, b).value() = value; }) {
    auto e = kit::add_edge(g, a, b);
    e.value() = value;
    return e;
  } else if constexpr (requires { g.add_edge(a, b, value); }) {
    return g.add_edge(a, b, value);
  } else {
    return kit::add_edge(g, a, b);
  }
}

// Removals. What they take is a copy that is no temporary. What remove_node()
// returns the assignment does not say: nothing asks for it.
template <typename G, typename N>
void remove_node(G& g, N n) {
  constexpr bool there = must_compile || requires { g.remove_node(n); };
  need<there>("g.remove_node(node)");
  if constexpr (there) g.remove_node(n);
}
/** Remove an edge, or that between two nodes.
 * @return a number or a bool, as a bool: was anything removed? */
template <typename G, typename... What>
bool remove_edge(G& g, What... what) {
  constexpr bool there = must_compile || requires {
    static_cast<bool>(g.remove_edge(what...));
  };
  need<there>(sizeof...(What) == 1
                  ? "g.remove_edge(edge), with a number as its result,"
                  : "g.remove_edge(node, node), with a number as its result,");
  if constexpr (there) return static_cast<bool>(g.remove_edge(what...));
  return false;
}

/** Check what a removal returned: the number removed. */
inline void check_result(bool removed, int expected) {
  check_equal(int(removed), expected, "the result");
}

// ---------------------------------------- What a graph holds, beside its model

template <typename N>
int name_of(N n) {
  return node_named(kit::position_of(n));
}
template <typename E>
Ends ends_of(E e) {
  return {kit::name_of(e.node1()), kit::name_of(e.node2())};
}

template <typename E>
Seen seen(E e) {
  Seen s{kit::ends_of(e), kit::name_of(e.node1()), {}};
  if constexpr (HasValue<E>) s.value = static_cast<double>(e.value());
  return s;
}

/** What tests read of the submission's graph. */
template <typename G>
struct ViewOf final : View {
  G& g;
  explicit ViewOf(G& graph) : g(graph) {}

  Number num_nodes() override { return static_cast<Number>(g.num_nodes()); }
  Number num_edges() override { return static_cast<Number>(g.num_edges()); }
  Number index(std::size_t i) override {
    return static_cast<Number>(kit::node_at(g, i).index());
  }
  Point position(std::size_t i) override {
    return kit::position_of(kit::node_at(g, i));
  }
  std::optional<double> node_value(std::size_t i) override {
    auto n = kit::node_at(g, i);
    if constexpr (HasValue<decltype(n)>) return static_cast<double>(n.value());
    return {};
  }
  std::optional<Number> degree(std::size_t i) override {
    auto n = kit::node_at(g, i);
    if constexpr (requires { n.degree(); })
      return static_cast<Number>(n.degree());
    return {};
  }
  bool has_edge(std::size_t i, std::size_t j) override {
    auto a = kit::node_at(g, i), b = kit::node_at(g, j);
    return static_cast<bool>(g.has_edge(a, b));
  }
  std::optional<Seen> edge(std::size_t i) override {
    if constexpr (requires { g.edge(g.num_edges()); })
      return kit::seen(kit::edge_at(g, i));
    return {};
  }
  Walk nodes(std::size_t limit, std::vector<int>& all) override {
    if constexpr (requires { g.node_begin(); })
      return kit::walk(g.node_begin(), g.node_end(), limit,
                       [&](auto n) { all.push_back(kit::name_of(n)); });
    return absent;
  }
  Walk edges(std::size_t limit, std::vector<Seen>& all) override {
    if constexpr (requires { g.edge_begin(); })
      return kit::walk(g.edge_begin(), g.edge_end(), limit,
                       [&](auto e) { all.push_back(kit::seen(e)); });
    return absent;
  }
  Walk edges_at(std::size_t i, std::size_t limit,
                std::vector<Seen>& all) override {
    auto n = kit::node_at(g, i);
    if constexpr (requires { n.edge_begin(); })
      return kit::walk(n.edge_begin(), n.edge_end(), limit,
                       [&](auto e) { all.push_back(kit::seen(e)); });
    return absent;
  }
};

/** A graph of the submission's and what it should hold. */
template <typename G>
struct Subject : Beside {
  G g;
  ViewOf<G> view{g};

  explicit Subject(const Model& shape) : Beside(shape) {
    for (int v : m.nodes) kit::add_node(g, place(v), value_of_node(v));
    for (Ends e : m.edges)
      kit::add_edge(g, kit::node_at(g, std::size_t(e.a)),
                    kit::node_at(g, std::size_t(e.b)), e.value());
    begin(view);
  }

  /** Fresh handles. */
  auto node(int v) { return kit::node_at(g, index_of(v)); }
  /** As an edge at its end @a v. */
  auto edge_seen_from(int v, int w) {
    auto n = node(v);
    auto it = n.edge_begin();
    for (std::size_t steps = 0; !kit::same(it, n.edge_end()); ++it) {
      if (kit::ends_of(*it) == Ends(v, w)) return *it;
      if (++steps > m.edges.size()) break;
    }
    fail(words("a loop over the edges at ", name(v), " to reach ",
               name(Ends(v, w)), " once"),
         "never");
  }
  auto edge(int v, int w) {
    if constexpr (requires { g.edge(g.num_edges()); })
      if (works & edge_indices) return kit::edge_at(g, index_of(Ends(v, w)));
    return edge_seen_from(v, w);
  }

  // Each change is made to the graph and to the model.
  void add_node(int v) {
    auto n = kit::add_node(g, place(v), value_of_node(v));
    CHECK_EQUAL(n.index(), m.nodes.size());
    m.add(v);
  }
  void add_edge(int v, int w) {
    kit::add_edge(g, node(v), node(w), Ends(v, w).value());
    m.add(Ends(v, w));
  }
  // The same for a test of another task, which it must not fail.
  // @return what works after it, of what worked before
  unsigned try_to_remove_node(int v) {
    auto i = find(v);
    auto n = kit::node_at(g, 0);
    if constexpr (requires { g.remove_node(n); }) {
      if (!i) return 0;
      auto gone = kit::node_at(g, *i);
      g.remove_node(gone);
      m.remove(v);
    }
    return works & still_works();
  }
  unsigned try_to_remove_edge(int v, int w) {
    auto i = find(v), j = find(w);
    auto n = kit::node_at(g, 0);
    if constexpr (requires { g.remove_edge(n, n); }) {
      if (!i || !j) return 0;
      auto a = kit::node_at(g, *i), b = kit::node_at(g, *j);
      g.remove_edge(a, b);
      m.remove(Ends(v, w));
    }
    return works & still_works();
  }
  void remove_node(int v) {
    kit::remove_node(g, node(v));
    m.remove(v);
  }
  /** @return true if the graph says that it removed the edge */
  bool remove_edge(int v, int w) {
    bool removed = kit::remove_edge(g, node(v), node(w));
    m.remove(Ends(v, w));
    return removed;
  }
  template <typename E>
  bool remove_edge(E e) {
    const Ends ends = kit::ends_of(e);
    bool removed = kit::remove_edge(g, e);
    m.remove(ends);
    return removed;
  }
};
using TestSubject = Subject<TestGraph>;

}  // namespace kit
#endif
