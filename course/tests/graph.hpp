/** @file graph.hpp
 * A bridge from the tests to any Graph.hpp of the course. It brings the
 * submission's graph and check.hpp; a test of the graph includes this file and
 * nothing else.
 *
 * What the assignment leaves open is accepted here: Graph<V, E> or Graph<V>;
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
#include "prelude.hpp"
// Before all else that is the kit's:
#include SUBMITTED_GRAPH

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

/** Of a Node or an Edge of TestGraph: it has value(). */
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

/** Call @a f with *it from @a it to @a end.  @return false if the end is not
 * reached in @a limit steps */
template <typename It, typename End, typename F>
bool walk(It it, End end, std::size_t limit, F f) {
  for (std::size_t steps = 0; !kit::same(it, end); ++it) {
    if (steps++ == limit) return false;
    f(*it);
  }
  return true;
}

template <typename G>
auto node_at(G& g, std::size_t i) {
  return g.node(static_cast<decltype(g.num_nodes())>(i));
}
template <typename G>
auto edge_at(G& g, std::size_t i) {
  return g.edge(static_cast<decltype(g.num_edges())>(i));
}
template <typename G>
using NodeOf = decltype(node_at(std::declval<G&>(), 0));

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
template <typename G, typename N>
bool has_edge(G& g, N a, N b) {
  return static_cast<bool>(g.has_edge(a, b));
}

// Removals. Their result, which is a number or a bool, as a bool: was anything
// removed? What they take is a copy that is no temporary.
template <typename G, typename N>
bool remove_node(G& g, N n) {
  constexpr bool there = requires { static_cast<bool>(g.remove_node(n)); };
  need<there>("g.remove_node(node), with a number as its result,");
  if constexpr (there) return static_cast<bool>(g.remove_node(n));
  return false;
}
template <typename G, typename N>
bool remove_edge(G& g, N a, N b) {
  constexpr bool there = requires { static_cast<bool>(g.remove_edge(a, b)); };
  need<there>("g.remove_edge(node, node), with a number as its result,");
  if constexpr (there) return static_cast<bool>(g.remove_edge(a, b));
  return false;
}
template <typename G, typename E>
bool remove_edge(G& g, E e) {
  constexpr bool there = requires { static_cast<bool>(g.remove_edge(e)); };
  need<there>("g.remove_edge(edge), with a number as its result,");
  if constexpr (there) return static_cast<bool>(g.remove_edge(e));
  return false;
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

/** What can be looked at by itself. */
enum Aspect : unsigned {
  by_index = 1,         // num_nodes(), node(i), index(), position()
  node_values = 2,      //
  node_loop = 4,        // node_begin(), node_end()
  edge_count = 8,       // num_edges()
  edge_indices = 16,    // edge(i)
  edge_values = 32,     // of edge(i)
  edge_loop = 64,       // edge_begin(), edge_end()
  incident_loop = 128,  // edge_begin(), edge_end() of a node
  seen_from = 256,      // node1() there
  incident_values = 512,
  degrees = 1024,
  adjacency = 2048,  // has_edge()
  all_aspects = 4095
};

template <typename G>
Fault look_at_nodes(G& g, const Model& m, Aspect what) {
  const std::size_t count = m.nodes.size();
  if (!equal(g.num_nodes(), count))
    return {words("num_nodes() == ", count), text(g.num_nodes())};
  std::vector<int> seen;
  if (what == node_loop) {
    const std::string range = "a loop from node_begin() to node_end()";
    if constexpr (requires { g.node_begin(); }) {
      if (!kit::walk(g.node_begin(), g.node_end(), count,
                     [&](auto n) { seen.push_back(kit::name_of(n)); }))
        return endless(range, count);
      return not_once(seen, m.nodes, range);
    } else {
      return {range + " to compile", "an error"};
    }
  }
  for (std::size_t i = 0; i < count; ++i) {
    auto n = kit::node_at(g, i);
    if (what == by_index) {
      if (!equal(n.index(), i))
        return {words("node(", i, ").index() == ", i), text(n.index())};
      if (!m.has(kit::name_of(n)))
        return {words("node(", i, ").position() to be that of a node added ",
                      "and not removed"),
                text(kit::position_of(n))};
      seen.push_back(kit::name_of(n));
    } else if constexpr (HasValue<decltype(n)>) {
      const int v = kit::name_of(n);
      if (!(n.value() == value_of_node(v)))
        return unequal(words("the value of ", name(v)), value_of_node(v),
                       double(n.value()));
    } else {
      return {"value() of a node to compile", "an error"};
    }
  }
  if (what == by_index) return not_once(seen, m.nodes, "node(i), of all i,");
  return {};
}

template <typename G>
Fault look_at_edges(G& g, const Model& m, Aspect what) {
  const std::size_t count = m.edges.size();
  if (!equal(g.num_edges(), count) && what != edge_loop)
    return {words("num_edges() == ", count), text(g.num_edges())};
  if (what == edge_count) return {};
  std::vector<Ends> seen;
  if (what == edge_loop) {
    const std::string range = "a loop from edge_begin() to edge_end()";
    if constexpr (requires { g.edge_begin(); }) {
      if (!kit::walk(g.edge_begin(), g.edge_end(), count,
                     [&](auto e) { seen.push_back(kit::ends_of(e)); }))
        return endless(range, count);
      return not_once(seen, m.edges, range);
    } else {
      return {range + " to compile", "an error"};
    }
  }
  if constexpr (requires { g.edge(g.num_edges()); }) {
    for (std::size_t i = 0; i < count; ++i) {
      auto e = kit::edge_at(g, i);
      const Ends ends = kit::ends_of(e);
      if (what == edge_indices) {
        seen.push_back(ends);
      } else if constexpr (HasValue<decltype(e)>) {
        if (!(e.value() == ends.value()))
          return unequal(words("the value of edge(i) between ", name(ends.a),
                               " and ", name(ends.b)),
                         ends.value(), double(e.value()));
      } else {
        return {"value() of an edge to compile", "an error"};
      }
    }
    if (what == edge_indices)
      return not_once(seen, m.edges, "edge(i), of all i,");
    return {};
  } else {
    return {"edge(i) to compile", "an error"};
  }
}

template <typename G>
Fault look_at_edges_of_nodes(G& g, const Model& m, Aspect what) {
  if (!equal(g.num_nodes(), m.nodes.size()))
    return {words("num_nodes() == ", m.nodes.size()), text(g.num_nodes())};
  for (std::size_t i = 0; i < m.nodes.size(); ++i) {
    auto n = kit::node_at(g, i);
    const int v = kit::name_of(n);
    const auto expected = m.edges_at(v);
    if (what == degrees) {
      if constexpr (requires { n.degree(); }) {
        if (!equal(n.degree(), expected.size()))
          return {words("degree() of ", name(v), " == ", expected.size()),
                  text(n.degree())};
      } else {
        return {"degree() of a node to compile", "an error"};
      }
      continue;
    }
    if constexpr (requires { n.edge_begin(); }) {
      std::vector<Ends> seen;
      Fault fault;
      bool ended =
          kit::walk(n.edge_begin(), n.edge_end(), expected.size(), [&](auto e) {
            const Ends ends = kit::ends_of(e);
            seen.push_back(ends);
            if (fault) return;
            if (what == seen_from && kit::name_of(e.node1()) != v)
              fault = {words("node1() of each edge at ", name(v), " to be ",
                             name(v)),
                       name(kit::name_of(e.node1()))};
            if (what != incident_values) return;
            if constexpr (HasValue<decltype(e)>) {
              if (!(e.value() == ends.value()))
                fault = unequal(words("the value of ", name(ends),
                                      ", seen from ", name(v), ','),
                                ends.value(), double(e.value()));
            } else {
              fault = {"value() of an edge to compile", "an error"};
            }
          });
      const std::string range =
          words("a loop from edge_begin() to edge_end() of ", name(v));
      if (!ended) return endless(range, expected.size());
      if (what == incident_loop) fault = not_once(seen, expected, range);
      if (fault) return fault;
    } else {
      return {"edge_begin() of a node to compile", "an error"};
    }
  }
  return {};
}

template <typename G>
Fault look_at_adjacency(G& g, const Model& m) {
  for (std::size_t i = 0; i < m.nodes.size(); ++i)
    for (std::size_t j = 0; j < m.nodes.size(); ++j) {
      if (i == j) continue;  // left open
      auto a = kit::node_at(g, i), b = kit::node_at(g, j);
      const int v = kit::name_of(a), w = kit::name_of(b);
      const bool expected = m.has(Ends(v, w));
      if (kit::has_edge(g, a, b) != expected)
        return {words("has_edge(", name(v), ", ", name(w), ") == ", expected),
                text(!expected)};
    }
  return {};
}

template <typename G>
Fault look(G& g, const Model& m, Aspect what) {
  if (what <= node_loop) return look_at_nodes(g, m, what);
  if (what <= edge_loop) return look_at_edges(g, m, what);
  if (what <= degrees) return look_at_edges_of_nodes(g, m, what);
  return look_at_adjacency(g, m);
}
template <typename G>
Fault look_at_all(G& g, const Model& m, unsigned aspects) {
  for (unsigned a = 1; a <= all_aspects; a *= 2)
    if (aspects & a)
      if (Fault fault = kit::look(g, m, Aspect(a))) return fault;
  return {};
}

// ---------------------------------------------------------- A graph under test

/** A graph and what it should hold.
 *
 * A test of a later section starts from what works in this graph: an aspect
 * that is wrong before the test does anything is the fault of another task, and
 * is not looked at. */
template <typename G>
struct Subject {
  G g;
  Model m;
  unsigned works = 0;

  explicit Subject(const Model& shape) : m(shape) {
    for (int v : m.nodes) kit::add_node(g, place(v), value_of_node(v));
    for (Ends e : m.edges)
      kit::add_edge(g, kit::node_at(g, std::size_t(e.a)),
                    kit::node_at(g, std::size_t(e.b)), e.value());
    for (unsigned a = 1; a <= all_aspects; a *= 2)
      if (!kit::look(g, m, Aspect(a))) works |= a;
  }
  Subject(const Subject&) = delete;

  void hold() { hold(works | by_index); }
  void hold(unsigned aspects) {
    checked();
    if (Fault fault = kit::look_at_all(g, m, aspects))
      fail(fault.expected, fault.got);
  }

  /** A fresh handle. */
  auto node(int v) {
    std::size_t i = 0;
    while (i < m.nodes.size() && kit::name_of(kit::node_at(g, i)) != v) ++i;
    if (i == m.nodes.size())
      fail(words("node(i), of all i, to reach ", name(v)), "none there");
    return kit::node_at(g, i);
  }
  /** As an edge at its end @a v. */
  auto edge_seen_from(int v, int w) {
    auto n = node(v);
    auto it = n.edge_begin();
    for (std::size_t steps = 0; !kit::same(it, n.edge_end()); ++it) {
      if (kit::ends_of(*it) == Ends(v, w)) return *it;
      if (++steps > m.edges.size()) break;
    }
    fail(words("a loop over the edges at ", name(v), " to reach ",
               name(Ends(v, w))),
         "none there");
  }
  auto edge(int v, int w) {
    if constexpr (requires { g.edge(g.num_edges()); })
      if (works & edge_indices) {
        for (std::size_t i = 0; i < m.edges.size(); ++i)
          if (kit::ends_of(kit::edge_at(g, i)) == Ends(v, w))
            return kit::edge_at(g, i);
        fail(words("edge(i), of all i, to reach ", name(Ends(v, w))), "none");
      }
    return edge_seen_from(v, w);
  }

  // What a test does to the graph, it does to the model, too.
  void add_node(int v) {
    auto n = kit::add_node(g, place(v), value_of_node(v));
    m.nodes.push_back(v);
    CHECK_EQUAL(n.index(), m.nodes.size() - 1);
  }
  void add_edge(int v, int w) {
    kit::add_edge(g, node(v), node(w), Ends(v, w).value());
    if (!m.has(Ends(v, w))) m.edges.push_back({v, w});
  }
  /** @return true if the graph says that it removed the node */
  bool remove_node(int v) {
    bool removed = kit::remove_node(g, node(v));
    m.remove(v);
    return removed;
  }
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
