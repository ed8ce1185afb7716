/** @file 7.1.cost.cpp
 * What removals and value() cost, by counting and not by a clock: the basic
 * blocks that run, and 1 for every 8 bytes that memmove() and its like touch.
 * It is counted in a graph of 1,000 nodes and in one of 10,000.
 *
 * Build: counted
 * That is: -O1 -fsanitize-coverage=trace-pc. With KIT_UNCOUNTED nothing is
 * counted: to see under sanitizers where it crashes. */
#include "graph.hpp"

namespace kit {
static volatile bool counting = false;
static volatile double counted = 0;
}  // namespace kit

#ifndef KIT_UNCOUNTED
extern "C" {
// The compiler inserts a call of this into every basic block.
KIT_NOT_COUNTED void __sanitizer_cov_trace_pc() {
  if (kit::counting) kit::counted = kit::counted + 1;
}
}

// The C library's functions that touch many bytes at once are defined here, by
// the names that the linker knows them by: so they count, with any linker.
#define KIT_TEXT(x) #x
#define KIT_PREFIX(x) KIT_TEXT(x)
#define KIT_SYMBOL(name) __asm__(KIT_PREFIX(__USER_LABEL_PREFIX__) name)

namespace kit {
// Volatile: else a compiler may put a call of memcpy() in place of the loop.
using Byte = volatile unsigned char;
typedef volatile std::uint64_t Eight __attribute__((may_alias, aligned(1)));

KIT_NOT_COUNTED static void count_bytes(std::size_t n) {
  if (counting) counted = counted + double(n) / 8;
}
KIT_NOT_COUNTED static void* copy(void* to, const void* from, std::size_t n) {
  count_bytes(n);
  auto* const t = static_cast<Byte*>(to);
  auto* const f = static_cast<const Byte*>(from);
  if (t <= f || t >= f + n) {
    std::size_t i = 0;
    for (; i + 8 <= n; i += 8) *(Eight*)(t + i) = *(const Eight*)(f + i);
    for (; i < n; ++i) t[i] = f[i];
  } else {
    for (; n >= 8; n -= 8) *(Eight*)(t + n - 8) = *(const Eight*)(f + n - 8);
    for (; n > 0; --n) t[n - 1] = f[n - 1];
  }
  return to;
}
}  // namespace kit

extern "C" {
void* kit_memmove(void*, const void*, std::size_t) KIT_SYMBOL("memmove");
void* kit_memcpy(void*, const void*, std::size_t) KIT_SYMBOL("memcpy");
void* kit_memset(void*, int, std::size_t) KIT_SYMBOL("memset");

KIT_NOT_COUNTED void* kit_memmove(void* to, const void* from, std::size_t n) {
  return kit::copy(to, from, n);
}
KIT_NOT_COUNTED void* kit_memcpy(void* to, const void* from, std::size_t n) {
  return kit::copy(to, from, n);
}
KIT_NOT_COUNTED void* kit_memset(void* to, int what, std::size_t n) {
  kit::count_bytes(n);
  auto* const t = static_cast<kit::Byte*>(to);
  const auto byte = static_cast<unsigned char>(what);
  std::size_t i = 0;
  for (; i + 8 <= n; i += 8)
    *(kit::Eight*)(t + i) = byte * std::uint64_t(0x0101010101010101u);
  for (; i < n; ++i) t[i] = byte;
  return to;
}
}
#endif

namespace kit {
/** Counts while it lives. */
struct Count {
  Count() { counting = true; }
  ~Count() { counting = false; }
};

/** A graph of n nodes: a ring, or squares in rows of 100 nodes. */
template <typename G>
static void build(G& g, int n, bool squares) {
  std::vector<decltype(add_node(g, place(0), 0))> nodes;
  for (int v = 0; v < n; ++v) nodes.push_back(add_node(g, place(v), v));
  auto join = [&](int a, int b) { add_edge(g, nodes[a], nodes[b]); };
  for (int v = 0; v < n; ++v) {
    if (!squares || v % 100 != 99) join(v, (v + 1) % n);
    if (squares && v + 100 < n) join(v, v + 100);
  }
}

enum Call {
  node_goes,
  edge_goes,
  ends_go,
  node_value_is_read,
  edge_value_is_read
};
static const char* name(Call call) {
  const char* names[] = {"remove_node(n)", "remove_edge(e)",
                         "remove_edge(a, b)", "n.value()", "e.value()"};
  return names[call];
}

// Another task tests what a removal returns.
template <typename G, typename... What>
static void take_out_node(G& g, What... what) {
  if constexpr (must_compile || requires { g.remove_node(what...); })
    g.remove_node(what...);
  else
    need<false>("g.remove_node(node)");
}
template <typename G, typename... What>
static void take_out_edge(G& g, What... what) {
  if constexpr (must_compile || requires { g.remove_edge(what...); })
    g.remove_edge(what...);
  else
    need<false>("g.remove_edge(edge) and g.remove_edge(node, node)");
}

/** What one of 100 calls costs on average: a vector may grow once in a while.
 * It gives up as soon as the average must exceed @a limit. */
template <typename G>
static double cost(G& g, Call call, double limit) {
  Dice dice{71};
  const int calls = 100;
  const auto edges_before = g.num_edges();
  counted = 0;
  for (int i = 0; i < calls && counted <= limit * calls; ++i) {
    const auto nodes = g.num_nodes();
    auto a = node_at(g, std::size_t(dice(std::size_t(nodes))));
    if (call == node_goes) {
      {
        Count count;
        take_out_node(g, a);
      }
      CHECK_EQUAL(g.num_nodes(), nodes - 1);
    } else if (call == node_value_is_read) {
      if constexpr (HasValue<decltype(a)>) {
        Count count;
        [[maybe_unused]] volatile double x = a.value();
      }
    } else {
      auto at = a.edge_begin(), end = a.edge_end();
      if (same(at, end)) continue;  // it lost all its edges
      // In turn the first one and the last, which mostly were added from either
      // end: some find an edge from one alone, which is of another task, too.
      int behind = 0;  // an iterator that counts need not be assignable
      for (auto next = at; i % 2 == 1 && !same(++next, end);) ++behind;
      while (behind-- > 0) ++at;
      auto e = *at;
      if (call == edge_value_is_read) {
        if constexpr (HasValue<decltype(e)>) {
          Count count;
          [[maybe_unused]] volatile double x = e.value();
        }
        continue;
      }
      auto b = name_of(e.node1()) == name_of(a) ? e.node2() : e.node1();
      if (call == edge_goes) {
        Count count;
        take_out_edge(g, e);
      } else {
        Count count;
        take_out_edge(g, a, b);
      }
    }
  }
  // That each call removes its edge is of another task.
  if (call == edge_goes || call == ends_go)
    CHECK(g.num_edges() < edges_before, "edges to be removed");
  return counted / calls;
}

/** That steps are counted at all: else no cost would ever grow. */
static void check_that_it_counts() {
  counted = 0;
  {
    Count count;
    std::vector<int> some;
    for (int i = 0; i < 1000; ++i) some.push_back(i);
  }
  check(counted > 1000,
        "the program is compiled with -fsanitize-coverage=trace-pc");
}

/** At most 1.5 times as much with 10 times as many nodes for value(), and 15
 * times for a removal, which may look at all nodes and edges. That leaves room
 * for a search in a tree, which takes 4/3 of the steps; the few steps more are
 * for what costs next to nothing. */
template <typename G>
static void check_costs(bool squares) {
  const char* shape = squares ? "grid" : "ring";
  DID("a ", shape, " of 1000 nodes and one of 10000");
  G small, large;
  build(small, 1000, squares);
  build(large, 10000, squares);
  for (Call call : {node_value_is_read, edge_value_is_read, edge_goes, ends_go,
                    node_goes}) {
    DID("a ", shape, " of 1000 nodes and one of 10000; ", name(call),
        " of a hundred");
    const double few = cost(small, call, 1e9);
    const bool removes =
        call == edge_goes || call == ends_go || call == node_goes;
    const double limit = (removes ? 15 : 1.5) * few + 10;
    checked();
    if (!(cost(large, call, limit) <= limit))
      fail(words("at most ", std::round(limit), " steps a call with 10000 ",
                 "nodes (", std::round(few), " with 1000)"),
           "more");
  }
}
}  // namespace kit

namespace kit {
/** That these calls remove anything: nodes without edges, and edges that share
 * no node, the last one first. No list that a wrong removal leaves behind is
 * read here, as that is of other tasks. */
template <typename G>
static void answer_what_goes(G& nodes_go, G& edges_go) {
  const std::size_t pairs = 100, go = std::size_t(drawn(50, 20, 80));
  for (std::size_t i = 0; i < 2 * pairs; ++i) {
    add_node(nodes_go, place(int(i)), int(i));
    add_node(edges_go, place(int(i)), int(i));
  }
  for (std::size_t i = 0; i < pairs; ++i)
    add_edge(edges_go, node_at(edges_go, 2 * i), node_at(edges_go, 2 * i + 1));
  const double edges = double(edges_go.num_edges());
  for (std::size_t i = 1; i <= go; ++i) {
    auto n = node_at(nodes_go, 2 * pairs - i);
    take_out_node(nodes_go, n);
    auto a = node_at(edges_go, 2 * (pairs - i));
    auto at = a.edge_begin(), end = a.edge_end();
    if (same(at, end)) continue;  // an earlier removal took it, too
    auto e = *at;
    take_out_edge(edges_go, e);
  }
  answer("nodes", double(nodes_go.num_nodes()));
  // How many there are is of other tasks.
  answer("edges gone", edges - double(edges_go.num_edges()));
}
}  // namespace kit

TASK("7.1.cost", what_is_counted_removes) {
  TestGraph nodes_go, edges_go;
  answer_what_goes(nodes_go, edges_go);
}

TASK("7.1.cost", cost_does_not_grow_with_the_graph) {
#ifndef KIT_UNCOUNTED
  check_that_it_counts();
#endif
  for (bool squares : {false, true}) check_costs<TestGraph>(squares);
}
