/** @file test_graph.cpp
 * Properties of Graph and of what it is stored in: long random histories
 * against a plain model, counted work, and a checker that does find faults.
 *
 * The histories are the same in every run. Others, and more of them:
 *   RC_PARAMS="seed=7 max_success=9000 max_size=300" ./test_graph */
#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <iostream>
#include <map>
#include <memory>
#include <random>
#include <set>
#include <span>
#include <stdexcept>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "Graph.hpp"
#include "lab/fast/GraphArrays.hpp"

namespace {

// RapidCheck reads this once, before its first check.
[[maybe_unused]] const int same_in_every_run =
    setenv("RC_PARAMS", "seed=212 max_success=1000 max_size=1000", 0);

std::size_t operations = 0;  // of all histories, for the record

/** What to do, and which of the things there are to do it with. */
struct Command {
  unsigned what, a, b;
};
void showValue(const Command& c, std::ostream& s) {
  s << '{' << c.what << ", " << c.a << ", " << c.b << '}';
}
rc::Gen<std::vector<Command>> histories() {
  auto number = rc::gen::inRange(0u, 100u);
  return rc::gen::container<std::vector<Command>>(
      rc::gen::construct<Command>(number, number, number));
}

// --------------------------------------------------- a graph and what it is to

/** A graph, and beside it what it ought to be: every node and edge has a tag
 * of its own, and the model knows all that is to be true of it. */
class Checked {
  using G = Graph<int, int>;
  struct NodeFacts {
    G::Node handle;
    Point position;
    int value;
    unsigned id;
    std::vector<int> neighbors;  // tags of nodes
    bool as_added = true;        // no edge here was removed so far
  };
  struct EdgeFacts {
    G::Edge handle;
    int from, to;  // tags of nodes
    int value;
    unsigned id;
  };

 public:
  void run(const std::vector<Command>& history) {
    for (const Command& c : history) {
      ++operations;
      apply(c);
      check(c);
    }
    for (auto& [g, nodes, edges] : left_behind) {
      g->check_invariants();
      RC_ASSERT(g->num_nodes() == nodes && g->num_edges() == edges);
    }
  }

 private:
  std::unique_ptr<G> g = std::make_unique<G>();
  std::map<int, NodeFacts> nodes;  // by tag
  std::map<int, EdgeFacts> edges;  // by tag
  std::vector<int> node_at, edge_at;
  int next_tag = 1;
  std::vector<G::Node> dead_nodes;
  std::vector<G::Edge> dead_edges;
  std::set<G::Node> nodes_ever;  // as keys: no two may ever be equal
  std::set<G::Edge> edges_ever;
  std::vector<std::tuple<std::unique_ptr<G>, unsigned, unsigned>> left_behind;

  void apply(const Command& c) {
    bool any = !nodes.empty();
    if (c.what < 18 || (!any && c.what < 90))
      add_node(c);
    else if (c.what < 54)
      add_edge(c);
    else if (c.what < 62)
      remove_node(pick_node(c.a), c.b % 2);
    else if (c.what < 84)
      remove_some_edge(c);
    else if (c.what < 88)
      change_values(c);
    else if (c.what < 90)
      arrays(*g).reindex(), reindexed();
    else if (c.what < 91)
      reindex_in_any_order(c);
    else if (c.what < 93)
      remove_nodes_while_iterating(c);
    else if (c.what < 95)
      remove_edges_while_iterating(c);
    else if (c.what < 97)
      go_on_with_a_copy();
    else if (c.what < 98)
      clear();
    else
      remove_what_is_not_there(c);
  }

  int pick_node(unsigned a) const { return node_at[a % node_at.size()]; }

  void add_node(const Command& c) {
    int tag = next_tag++;
    Point p(tag, c.a, c.b);
    auto n = g->add_node(p, tag);
    RC_ASSERT(n.index() == node_at.size());
    RC_ASSERT(nodes_ever.insert(n).second);
    nodes[tag] = {n, p, tag, n.id(), {}};
    node_at.push_back(tag);
  }

  /** The tag of the edge between two nodes, or 0. */
  int edge_between(int a, int b) const {
    for (auto& [tag, e] : edges)
      if ((e.from == a && e.to == b) || (e.from == b && e.to == a)) return tag;
    return 0;
  }

  void add_edge(const Command& c) {
    int a = pick_node(c.a), b = pick_node(c.b);
    if (a == b) return;
    int old = edge_between(a, b);
    auto e = g->add_edge(nodes[a].handle, nodes[b].handle, next_tag);
    RC_ASSERT(e.node1() == nodes[a].handle && e.node2() == nodes[b].handle);
    if (old != 0) {
      RC_ASSERT(e == edges[old].handle);
      return;
    }
    int tag = next_tag++;
    RC_ASSERT(e.index() == edge_at.size());
    RC_ASSERT(edges_ever.insert(e).second);
    edges[tag] = {e, a, b, tag, e.id()};
    edge_at.push_back(tag);
    nodes[a].neighbors.push_back(b);
    nodes[b].neighbors.push_back(a);
  }

  static void fill_hole(std::vector<int>& at, int tag) {
    *std::find(at.begin(), at.end(), tag) = at.back();
    at.pop_back();
  }
  void forget_edge(int tag) {
    EdgeFacts& e = edges[tag];
    dead_edges.push_back(e.handle);
    for (auto [n, m] : {std::pair(e.from, e.to), std::pair(e.to, e.from)}) {
      std::erase(nodes[n].neighbors, m);
      nodes[n].as_added = false;
    }
    edges.erase(tag);
  }
  void forget_node(int tag) {
    auto around = nodes[tag].neighbors;
    for (int m : around) forget_edge(edge_between(tag, m));
    dead_nodes.push_back(nodes[tag].handle);
    fill_hole(node_at, tag);
    nodes.erase(tag);
    if (around.empty()) return;
    // Which edge fills which hole is not promised here: ask.
    edge_at.assign(edges.size(), 0);
    for (auto& [t, e] : edges) {
      RC_ASSERT(e.handle.index() < edge_at.size());
      edge_at[e.handle.index()] = t;
    }
    RC_ASSERT(std::count(edge_at.begin(), edge_at.end(), 0) == 0);
  }

  void remove_node(int tag, bool by_iterator) {
    auto n = nodes[tag].handle;
    if (by_iterator) {
      auto at = g->node_begin() + n.index();
      auto then = g->remove_node(at);
      RC_ASSERT(then == at);
    } else {
      RC_ASSERT(g->remove_node(n) == 1u);
    }
    forget_node(tag);
  }

  void remove_some_edge(const Command& c) {
    if (edges.empty()) return;
    int tag = edge_at[c.a % edge_at.size()];
    EdgeFacts& e = edges[tag];
    auto from = nodes[e.from].handle, to = nodes[e.to].handle;
    if (c.b % 5 == 0) RC_ASSERT(g->remove_edge(e.handle) == 1u);
    if (c.b % 5 == 1) RC_ASSERT(g->remove_edge(from, to) == 1u);
    if (c.b % 5 == 2) RC_ASSERT(g->remove_edge(to, from) == 1u);
    if (c.b % 5 == 3) RC_ASSERT(g->remove_edge(g->add_edge(to, from)) == 1u);
    if (c.b % 5 == 4) {
      auto at = g->edge_begin() + e.handle.index();
      RC_ASSERT(g->remove_edge(at) == at);
    }
    fill_hole(edge_at, tag);
    forget_edge(tag);
  }

  void change_values(const Command& c) {
    NodeFacts& n = nodes[pick_node(c.a)];
    n.handle.position() = n.position = Point(next_tag, 0, 0);
    arrays(*g).node_values()[n.id] = n.value = next_tag;
    if (edges.empty()) return;
    EdgeFacts& e = edges[edge_at[c.b % edge_at.size()]];
    g->add_edge(e.handle.node2(), e.handle.node1()).value() = e.value =
        next_tag++;
  }

  void reindexed() {
    auto by_id = [](auto& facts) {
      return [&](int a, int b) { return facts[a].id < facts[b].id; };
    };
    std::sort(node_at.begin(), node_at.end(), by_id(nodes));
    std::sort(edge_at.begin(), edge_at.end(), by_id(edges));
  }

  void reindex_in_any_order(const Command& c) {
    std::mt19937 random(c.a);
    auto give = [&random](std::vector<int>& at, auto& facts, auto reindex) {
      std::shuffle(at.begin(), at.end(), random);
      std::vector<unsigned> ids;
      for (int tag : at) ids.push_back(facts[tag].id);
      reindex(ids);
    };
    auto version = arrays(*g).version();
    give(node_at, nodes,
         [this](const auto& ids) { arrays(*g).reindex_nodes(ids); });
    RC_ASSERT(arrays(*g).version() != version);
    version = arrays(*g).version();
    give(edge_at, edges,
         [this](const auto& ids) { arrays(*g).reindex_edges(ids); });
    RC_ASSERT(arrays(*g).version() != version);
  }

  void remove_nodes_while_iterating(const Command& c) {
    std::multiset<int> visited, all(node_at.begin(), node_at.end());
    for (auto it = g->node_begin(); it != g->node_end();) {
      int tag = node_at[(*it).index()];
      visited.insert(tag);
      if (unsigned(tag) % 3 == c.a % 3) {
        it = g->remove_node(it);
        forget_node(tag);
      } else {
        ++it;
      }
    }
    RC_ASSERT(visited == all);
  }
  void remove_edges_while_iterating(const Command& c) {
    std::multiset<int> visited, all(edge_at.begin(), edge_at.end());
    for (auto it = g->edge_begin(); it != g->edge_end();) {
      int tag = edge_at[(*it).index()];
      visited.insert(tag);
      if (unsigned(tag) % 3 == c.a % 3) {
        it = g->remove_edge(it);
        fill_hole(edge_at, tag);
        forget_edge(tag);
      } else {
        ++it;
      }
    }
    RC_ASSERT(visited == all);
  }

  /** From here on the copy is the graph; of the old one nothing is in it. */
  void go_on_with_a_copy() {
    auto copy = std::make_unique<G>(*g);
    for (auto& [tag, n] : nodes) {
      dead_nodes.push_back(n.handle);
      n.handle = copy->node(n.handle.index());
      RC_ASSERT(nodes_ever.insert(n.handle).second);
    }
    for (auto& [tag, e] : edges) {
      dead_edges.push_back(e.handle);
      e.handle = copy->edge(e.handle.index());
      RC_ASSERT(edges_ever.insert(e.handle).second);
    }
    left_behind.emplace_back(std::move(g), nodes.size(), edges.size());
    g = std::move(copy);
  }

  void clear() {
    g->clear();
    RC_ASSERT(arrays(*g).node_slots() == 0u && arrays(*g).edge_slots() == 0u);
    for (auto& [tag, n] : nodes) dead_nodes.push_back(n.handle);
    for (auto& [tag, e] : edges) dead_edges.push_back(e.handle);
    nodes.clear();
    edges.clear();
    node_at.clear();
    edge_at.clear();
  }

  void remove_what_is_not_there(const Command& c) {
    auto version = arrays(*g).version();
    auto before = *g;
    if (!dead_nodes.empty()) {
      auto n = dead_nodes[c.a % dead_nodes.size()];
      RC_ASSERT(g->remove_node(n) == 0u);
      if (!nodes.empty())
        RC_ASSERT(g->remove_edge(n, nodes[pick_node(c.b)].handle) == 0u);
    }
    if (!dead_edges.empty())
      RC_ASSERT(g->remove_edge(dead_edges[c.a % dead_edges.size()]) == 0u);
    RC_ASSERT(g->remove_node(G::Node()) == 0u);
    RC_ASSERT(g->remove_edge(G::Edge()) == 0u);
    if (before.num_nodes() > 0) RC_ASSERT(g->remove_node(before.node(0)) == 0u);
    RC_ASSERT(arrays(*g).version() == version);
  }

  void check(const Command& c) const {
    g->check_invariants();
    RC_ASSERT(g->num_nodes() == nodes.size() && g->size() == nodes.size());
    RC_ASSERT(g->num_edges() == edges.size());
    for (unsigned i = 0; i < node_at.size(); ++i) {
      const NodeFacts& fact = nodes.at(node_at[i]);
      auto n = g->node(i);
      RC_ASSERT(n == fact.handle && n.index() == i);
      RC_ASSERT(g->has_node(n) && g->node(n.index()) == n);
      RC_ASSERT(n.id() == fact.id && arrays(*g).node_with_id(n.id()) == n);
      RC_ASSERT(n.position() == fact.position && n.value() == fact.value);
      RC_ASSERT(n.degree() == fact.neighbors.size());
      std::vector<int> around;
      for (auto e : n.edges()) {
        RC_ASSERT(e.node1() == n);
        RC_ASSERT(g->has_edge(e) && g->edge(e.index()) == e);
        around.push_back(node_at[e.node2().index()]);
      }
      if (fact.as_added)
        RC_ASSERT(around == fact.neighbors);
      else
        RC_ASSERT(std::is_permutation(around.begin(), around.end(),
                                      fact.neighbors.begin(),
                                      fact.neighbors.end()));
    }
    for (unsigned i = 0; i < edge_at.size(); ++i) {
      const EdgeFacts& fact = edges.at(edge_at[i]);
      auto e = g->edge(i);
      RC_ASSERT(e == fact.handle && e.index() == i && g->has_edge(e));
      RC_ASSERT(e.id() == fact.id && e.value() == fact.value);
      RC_ASSERT(e.node1() == nodes.at(fact.from).handle);
      RC_ASSERT(e.node2() == nodes.at(fact.to).handle);
      RC_ASSERT(fact.handle.node1() == nodes.at(fact.from).handle ||
                fact.handle.node1() == nodes.at(fact.to).handle);
    }
    check_pairs(c);
    for (const auto& n : dead_nodes) RC_ASSERT(!g->has_node(n));
    for (const auto& e : dead_edges) RC_ASSERT(!g->has_edge(e));
    check_dead_slots();
    // Nothing that happens may disturb the order of the keys.
    RC_ASSERT(std::is_sorted(nodes_ever.begin(), nodes_ever.end()));
    RC_ASSERT(std::is_sorted(edges_ever.begin(), edges_ever.end()));
  }

  /** has_edge() of all pairs; in a larger graph, of all with one node. */
  void check_pairs(const Command& c) const {
    for (std::size_t i = 0; i < node_at.size(); ++i) {
      if (node_at.size() > 12 && i != c.a % node_at.size()) continue;
      const NodeFacts& a = nodes.at(node_at[i]);
      std::set<int> around(a.neighbors.begin(), a.neighbors.end());
      for (int tag : node_at) {
        const auto& b = nodes.at(tag).handle;
        bool expected = around.count(tag) > 0;
        RC_ASSERT(g->has_edge(a.handle, b) == expected);
        RC_ASSERT(g->has_edge(b, a.handle) == expected);
      }
    }
  }

  void check_dead_slots() const {
    unsigned in_use = 0;
    for (unsigned i = 0; i < arrays(*g).node_slots(); ++i) {
      in_use += arrays(*g).node_in_use(i);
      if (!arrays(*g).node_in_use(i))
        RC_ASSERT(arrays(std::as_const(*g)).positions()[i] == Point() &&
                  arrays(std::as_const(*g)).node_values()[i] == 0);
    }
    RC_ASSERT(in_use == g->num_nodes());
    in_use = 0;
    for (unsigned i = 0; i < arrays(*g).edge_slots(); ++i) {
      in_use += arrays(*g).edge_in_use(i);
      if (!arrays(*g).edge_in_use(i))
        RC_ASSERT(arrays(std::as_const(*g)).edge_values()[i] == 0 &&
                  arrays(*g).edge_ends()[i] == (std::array<unsigned, 2>{0, 0}));
    }
    RC_ASSERT(in_use == g->num_edges());
  }
};

TEST(Graph, DoesWhatTheModelDoes) {
  operations = 0;
  EXPECT_TRUE(rc::check([] {
    Checked graph;
    graph.run(*histories());
  }));
  RecordProperty("operations", std::to_string(operations));
  std::cout << "Checked operations on graphs: " << operations << '\n';
}

TEST(Graph, StoresTheExampleOfItsDocument) {  // docs/graph.md
  Graph<char> g;
  std::map<char, Graph<char>::Node> n;
  for (char c : {'a', 'b', 'c', 'd'}) n[c] = g.add_node(Point(c), c);
  for (std::string ends : {"ab", "bc", "ca", "cd"})
    g.add_edge(n[ends[0]], n[ends[1]]);
  g.remove_node(n['b']);

  auto around = [&](char c) {
    std::string s;
    for (auto e : n[c].edges()) s += e.node2().value();
    return s;
  };
  EXPECT_EQ(around('a'), "c");
  EXPECT_EQ(around('c'), "da");
  EXPECT_EQ(around('d'), "c");
  std::vector<unsigned> node_ids, edge_ids;
  for (auto m : g.nodes()) node_ids.push_back(m.id());
  for (auto e : g.edges()) edge_ids.push_back(e.id());
  EXPECT_EQ(node_ids, (std::vector<unsigned>{0, 3, 2}));
  EXPECT_EQ(edge_ids, (std::vector<unsigned>{3, 2}));
  using Ends = std::array<unsigned, 2>;
  auto ends = arrays(g).edge_ends();
  EXPECT_EQ(std::vector<Ends>(ends.begin(), ends.end()),
            (std::vector<Ends>{{0, 0}, {0, 0}, {2, 0}, {2, 3}}));
  EXPECT_EQ(arrays(g).positions()[1], Point());
  EXPECT_EQ(n['d'].index(), 1u);
}

// --------------------------------------------------------------- counted work

// What an operation moves, and how often it copies values. What it reads is
// measured for every graph of the course by course/tests/7.1.cost.cpp.

/** A value that counts how often one of its kind is copied or moved. */
struct Traced {
  static inline std::size_t transfers = 0;
  Traced() = default;
  Traced(const Traced&) { ++transfers; }
  Traced(Traced&&) noexcept { ++transfers; }
  Traced& operator=(const Traced&) { return ++transfers, *this; }
  Traced& operator=(Traced&&) noexcept { return ++transfers, *this; }
};

using Grid = Graph<Traced, int>;

/** side x side nodes with all sides and diagonals of the quads. */
void make_grid(Grid& g, unsigned side) {
  for (unsigned i = 0; i < side * side; ++i) g.add_node(Point());
  for (unsigned i = 0; i < side * side; ++i) {
    bool right = (i + 1) % side != 0, down = i + side < side * side;
    auto n = g.node(i);
    if (right) g.add_edge(n, g.node(i + 1));
    if (down) g.add_edge(n, g.node(i + side));
    if (right && down) {
      g.add_edge(n, g.node(i + side + 1));
      g.add_edge(g.node(i + 1), g.node(i + side));
    }
  }
}

/** Number of indices and of entries of neighbor lists that differ. */
std::size_t moves_between(const Grid& a, const Grid& b) {
  std::size_t moves = 0;
  for (unsigned id = 0; id < arrays(a).node_slots(); ++id) {
    if (!arrays(a).node_in_use(id) || !arrays(b).node_in_use(id)) continue;
    moves += arrays(a).node_with_id(id).index() !=
             arrays(b).node_with_id(id).index();
    auto before = arrays(a).neighbors(id), after = arrays(b).neighbors(id);
    for (std::size_t k = 0; k < std::min(before.size(), after.size()); ++k)
      moves += before[k].edge != after[k].edge;
  }
  for (unsigned id = 0; id < arrays(a).edge_slots(); ++id)
    if (arrays(a).edge_in_use(id) && arrays(b).edge_in_use(id))
      moves += arrays(a).edge_with_id(id).index() !=
               arrays(b).edge_with_id(id).index();
  return moves;
}

struct Cost {
  std::size_t moves, transfers;
};
/** What @a f costs, which changes @a g. */
template <typename F>
Cost cost_of(const Grid& g, F f) {
  const Grid before(g);
  Traced::transfers = 0;
  f();
  const std::size_t transfers = Traced::transfers;
  return {moves_between(before, g), transfers};
}
TEST(Work, StaysBelowWhatTheHeaderSays) {
  Grid g;
  make_grid(g, 32);
  auto check = [](Cost c, std::size_t moves, std::size_t transfers) {
    EXPECT_LE(c.moves, moves);
    EXPECT_LE(c.transfers, transfers);
  };
  for (unsigned i = 0; i < g.num_nodes(); i += 7) {
    auto a = g.node(i);
    if (a.degree() == 0) continue;
    auto b = (*a.edge_begin()).node2();
    auto c = g.node((i + 500) % g.num_nodes());
    check(cost_of(g, [&] { (void)g.has_edge(a, b); }), 0, 0);
    check(cost_of(g, [&] { g.add_edge(b, a); }), 0, 0);
    check(cost_of(g, [&] { g.add_edge(a, c); }), 0, 0);
    check(cost_of(g, [&] { g.remove_edge(a, c); }), 3, 0);
    check(cost_of(g, [&] { g.remove_edge(*a.edge_begin()); }), 3, 0);
    check(cost_of(g, [&] { g.remove_node(a); }), 2 * a.degree() + 1, 1);
    check(cost_of(g, [&] { arrays(g).reindex(); }),
          g.num_nodes() + g.num_edges(), 0);
  }
}

// As docs/graph.md says of a node with 8 edges, on a grid of any size.
TEST(Work, OfANodeAwayFromTheRim) {
  for (unsigned side : {32u, 320u}) {
    Grid g;
    make_grid(g, side);
    g.remove_node(g.node(0));  // the first one makes the lists of indices
    const auto inner = g.node(side / 2 * side + side / 2);
    ASSERT_EQ(inner.degree(), 8u);
    const Cost c = cost_of(g, [&] { g.remove_node(inner); });
    EXPECT_EQ(c.moves, 16u) << side;
    EXPECT_EQ(c.transfers, 1u) << side;
  }
}

TEST(Work, AddNodeTransfersValuesAnAmortizedConstantNumberOfTimes) {
  Grid g;
  const std::size_t many = 100000;
  auto c = cost_of(g, [&] {
    for (std::size_t i = 0; i < many; ++i) g.add_node(Point());
  });
  EXPECT_LE(c.transfers, 5 * many);  // in and out of the copy, and growth
  EXPECT_EQ(c.moves, 0u);
}

// ------------------------------------------------ the checker itself can fail

// An explicit instantiation may name private members ([temp.spec]): this is how
// the tests reach in to damage what nobody else can.
template <typename Key, auto member>
struct Open {
  friend constexpr auto open(Key) { return member; }
};
#define OPEN(Key, member)            \
  struct Key {                       \
    friend constexpr auto open(Key); \
  };                                 \
  template struct Open<Key, &member>

using G = Graph<int, int>;
using Slots = graph_detail::SlotMap;
OPEN(Nodes, G::nodes_);
OPEN(EdgesOf, G::edges_);
OPEN(Positions, G::position_);
OPEN(Lists, G::neighbors_of_);
OPEN(Ends, G::ends_);
OPEN(Generations, Slots::generation_);
OPEN(IdAt, Slots::ids_);
OPEN(Size, Slots::size_);

/** A good graph with holes, then damaged: is the damage found? */
template <typename Damage>
bool found(Damage damage) {
  G g;
  std::vector<G::Node> n;
  for (int i = 0; i < 8; ++i) n.push_back(g.add_node(Point(i)));
  for (int i = 0; i < 8; ++i)
    for (int k = 0; k < i; ++k) g.add_edge(n[i], n[k]);
  g.remove_node(n[2]);
  g.remove_node(n[5]);
  g.remove_edge(n[0], n[1]);
  g.check_invariants();
  damage(g);
  try {
    g.check_invariants();
  } catch (const std::logic_error&) {
    return true;
  }
  return false;
}

TEST(CheckInvariants, FindsNothingWrongInAGoodGraph) {
  EXPECT_FALSE(found([](G&) {}));
}

TEST(CheckInvariants, FindsDamagedSlots) {
  auto nodes = [](G& g) -> Slots& { return g.*open(Nodes()); };
  EXPECT_TRUE(found([&](G& g) { ++(nodes(g).*open(Size())); }));
  EXPECT_TRUE(found([&](G& g) { (nodes(g).*open(IdAt())).clear(); }));
  EXPECT_TRUE(found([&](G& g) { ++(nodes(g).*open(Generations()))[3]; }));
  EXPECT_TRUE(found([&](G& g) {
    auto& at = nodes(g).*open(IdAt());
    std::swap(at[0], at[1]);
  }));
}

TEST(CheckInvariants, FindsDamagedEdges) {
  auto ends = [](G & g) -> auto& { return g.*open(Ends()); };
  auto lists = [](G & g) -> auto& { return g.*open(Lists()); };
  auto edge = [](G& g) { return g.edge(0).id(); };
  // Which end is the first one nobody else knows: that can't be found.
  EXPECT_TRUE(found([&](G& g) { ends(g)[edge(g)][0] = 7; }));
  EXPECT_TRUE(found([&](G& g) { (g.*open(Positions())).pop_back(); }));
  EXPECT_TRUE(found([&](G& g) { lists(g)[0].pop_back(); }));
  EXPECT_TRUE(found([&](G& g) { lists(g)[0][0].edge ^= 1; }));
  // The same neighbor twice.
  EXPECT_TRUE(found([&](G& g) { lists(g)[0][0] = lists(g)[0][1]; }));
  EXPECT_TRUE(found([&](G& g) {  // an edge dies without leaving the lists
    (g.*open(EdgesOf())).release(edge(g));
  }));
}

}  // namespace
