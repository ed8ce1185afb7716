// A graph that runs out of memory, or whose values can't be copied: every
// function that changes it is made to fail at each allocation in turn and at
// each copy of a value, and then has changed nothing.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <functional>
#include <new>
#include <tuple>
#include <vector>

#include "Graph.hpp"
#include "lab/fast/GraphArrays.hpp"
#include "tests/Allocations.hpp"

namespace {
int left_to_fail = -1;  // so many may still succeed; negative: all
/** One more step that may fail. */
bool fails() { return left_to_fail >= 0 && left_to_fail-- == 0; }
}  // namespace

namespace {

/** Counts those that there are; a copy of it may fail. */
struct Fragile {
  static inline int alive = 0;
  int number = 0;

  Fragile() { ++alive; }
  Fragile(int n) : number(n) { ++alive; }
  Fragile(const Fragile& f) : number(f.number) { check(), ++alive; }
  Fragile& operator=(const Fragile& f) {
    check();
    number = f.number;
    return *this;
  }
  ~Fragile() { --alive; }
  static void check() {
    if (fails()) throw std::bad_alloc();
  }
};
int number_of(int n) { return n; }
int number_of(const Fragile& f) { return f.number; }

/** All that a user sees of @a g, and the handles of what is in it. */
template <typename G>
struct Seen {
  std::vector<std::tuple<typename G::Node, Point, int, unsigned>> nodes;
  std::vector<std::tuple<typename G::Edge, unsigned, unsigned, int>> edges;
  std::vector<std::vector<unsigned>> lists;
  std::uint64_t version;

  explicit Seen(const G& g) : version(arrays(g).version()) {
    g.check_invariants();
    for (auto n : g.nodes()) {
      nodes.push_back({n, n.position(), number_of(n.value()), n.id()});
      lists.emplace_back();
      for (auto e : n.edges()) lists.back().push_back(e.id());
      EXPECT_TRUE(g.has_node(n));
    }
    for (auto e : g.edges())
      edges.push_back(
          {e, e.node1().id(), e.node2().id(), number_of(e.value())});
  }
  bool operator==(const Seen&) const = default;
};

/** Make step k of @a change fail, for k = 0, 1, ... until all succeed; each on
 * a graph that @a make fills.  @return how often it failed */
template <typename G>
int fail_each(const std::function<void(G&)>& make,
              const std::function<void(G&)>& change) {
  for (int k = 0;; ++k) {
    G g;
    make(g);
    const Seen<G> old(g);
    bool failed = false;
    left_to_fail = k;
    try {
      change(g);
    } catch (const std::bad_alloc&) {
      failed = true;
    }
    const bool all = left_to_fail >= 0;  // nothing was made to fail
    left_to_fail = -1;
    EXPECT_TRUE(!failed || Seen<G>(g) == old) << k;
    g.check_invariants();
    // It goes on as if nothing had been.
    auto a = g.add_node(Point(7), 7), b = g.add_node(Point(8), 8);
    g.add_edge(a, b, 9);
    g.remove_node(a);
    EXPECT_EQ(number_of(b.value()), 8);
    EXPECT_EQ(b.degree(), 0u);
    g.check_invariants();
    if (!all) continue;
    EXPECT_FALSE(failed);
    return k;
  }
}

template <typename G>
class GraphMemory : public ::testing::Test {
 protected:
  GraphMemory() { allocation_fails = fails; }
  /** So many nodes, each with edges to the @a back before it. */
  static void fill(G& g, unsigned nodes, unsigned back) {
    for (unsigned i = 0; i < nodes; ++i) {
      g.add_node(Point(i), int(i));
      for (unsigned k = 1; k <= std::min(i, back); ++k)
        g.add_edge(g.node(i), g.node(i - k), int(100 * i + k));
    }
  }
  /** Graphs that are new, full to the brim in some vector, with free slots,
   * or dense. */
  static std::vector<std::function<void(G&)>> graphs() {
    std::vector<std::function<void(G&)>> all;
    for (unsigned n : {4u, 5u, 8u, 9u, 16u})
      for (unsigned back : {1u, 4u})
        for (unsigned removed : {0u, 1u, 2u})
          all.push_back([=](G& g) {
            fill(g, n, back);
            for (unsigned i = 0; i < removed; ++i) g.remove_node(g.node(i));
          });
    for (int removed : {4, 5, 6, 12})
      all.push_back([=](G& g) {
        fill(g, 20, 20);
        for (int i = 0; i < removed; ++i) g.remove_edge(g.edge(0));
      });
    all.push_back([](G& g) { fill(g, 9, 4), g.clear(), fill(g, 4, 1); });
    return all;
  }
  /** Each of these functions at least once fails at all if @a must. */
  static void test(const std::function<void(G&)>& change, bool must = true) {
    int failures = 0;
    for (const auto& make : graphs()) failures += fail_each<G>(make, change);
    EXPECT_EQ(failures > 0, must);
    EXPECT_EQ(Fragile::alive, 0);
  }
};

using Graphs = ::testing::Types<Graph<int, int>, Graph<Fragile, Fragile>>;
TYPED_TEST_SUITE(GraphMemory, Graphs);

TYPED_TEST(GraphMemory, AddNode) {
  this->test([](auto& g) { g.add_node(Point(1), 5); });
}
TYPED_TEST(GraphMemory, AddEdge) {
  this->test([](auto& g) { g.add_edge(g.node(0), g.node(g.size() - 1), 5); });
}
TYPED_TEST(GraphMemory, RemoveNode) {
  this->test([](auto& g) { g.remove_node(g.node(1)); });
  this->test([](auto& g) { g.remove_node(++g.node_begin()); });
}
TYPED_TEST(GraphMemory, RemoveEdge) {
  this->test([](auto& g) { g.remove_edge(g.edge(0)); });
  this->test([](auto& g) { g.remove_edge(g.edge_begin()); });
  this->test([](auto& g) {
    auto e = g.edge(g.num_edges() - 1);
    g.remove_edge(e.node1(), e.node2());
  });
}
TYPED_TEST(GraphMemory, Reserve) {
  this->test([](auto& g) { g.reserve(1000, 4000); });
}
TYPED_TEST(GraphMemory, Reindex) {
  this->test([](auto& g) { arrays(g).reindex(); });
  this->test([](auto& g) {
    std::vector<unsigned> ids;
    left_to_fail += left_to_fail >= 0;  // not of the graph
    ids.resize(g.size());
    for (auto n : g.nodes()) ids[g.size() - 1 - n.index()] = n.id();
    arrays(g).reindex_nodes(ids);
  });
  this->test([](auto& g) {
    std::vector<unsigned> ids;
    left_to_fail += left_to_fail >= 0;
    ids.resize(g.num_edges());
    for (auto e : g.edges()) ids[g.num_edges() - 1 - e.index()] = e.id();
    arrays(g).reindex_edges(ids);
  });
}
TYPED_TEST(GraphMemory, Copy) {
  this->test([](auto& g) {
    auto copy = g;
    copy.check_invariants();
  });
}

// What has no copy to make and no memory to take.
TYPED_TEST(GraphMemory, ClearAndReorderNeverFail) {
  const auto never = [](auto&& change) {
    for (const auto& make : GraphMemory<TypeParam>::graphs())
      for (int k = 0; k < 50; ++k) {
        TypeParam g;
        make(g);
        left_to_fail = k;
        EXPECT_NO_THROW(change(g));
        left_to_fail = -1;
        g.check_invariants();
      }
  };
  never([](auto& g) { g.clear(); });
  never([](auto& g) {
    auto n = g.node(0);
    std::array<unsigned, 100> ids;
    unsigned k = n.degree();
    for (auto e : n.edges()) ids[--k] = e.id();
    arrays(g).reorder_edges(n, {ids.data(), n.degree()});
  });
}

}  // namespace
