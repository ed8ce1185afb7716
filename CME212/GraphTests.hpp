#pragma once
/** @file GraphTests.hpp
 * What test_nodes and test_edges share: a main() that runs each test in a
 * process of its own, and calls of what the assignment leaves open. */
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <concepts>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <iostream>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>

#include "CME212/AnyGraph.hpp"
#include "CME212/Util.hpp"

namespace CME212 {

// ------------------------------------------ Each test in a process of its own

/** Prints what failed, and nothing else. */
struct FailurePrinter : testing::EmptyTestEventListener {
  void OnTestPartResult(const testing::TestPartResult& part) override {
    if (part.failed())
      std::cout << part.file_name() << ':' << part.line_number() << ": "
                << part.message() << std::endl;
  }
};

/** Run the test called @a name in a new process, for 60 s at most.
 * @return why it failed; empty if it passed */
inline std::string run_alone(const std::string& name) {
  std::cout << "[ RUN      ] " << name << std::endl;
  const pid_t child = fork();
  if (child == 0) {
    alarm(60);
    testing::GTEST_FLAG(filter) = name;
    auto& listeners = testing::UnitTest::GetInstance()->listeners();
    delete listeners.Release(listeners.default_result_printer());
    listeners.Append(new FailurePrinter);
    std::exit(RUN_ALL_TESTS());
  }
  int status = 0;
  if (child < 0 || waitpid(child, &status, 0) != child)
    return "can't be run in a process of its own";
  if (WIFSIGNALED(status) && WTERMSIG(status) == SIGALRM)
    return "ended after 60 s";
  if (WIFSIGNALED(status))
    return std::string("crashed: ") + strsignal(WTERMSIG(status));
  return status == 0 ? "" : "failed";
}

/** Run all tests, each by itself: one that crashes or does not end hides no
 * other. With arguments, as GoogleTest does, in this process: for gdb. */
inline int run_tests(int argc, char** argv) {
  const bool apart = argc == 1;
  testing::InitGoogleTest(&argc, argv);
  if (!apart) return RUN_ALL_TESTS();
  int passed = 0;
  std::vector<std::string> failed;
  const auto& all = *testing::UnitTest::GetInstance();
  for (int i = 0; i < all.total_test_suite_count(); ++i) {
    const auto& suite = *all.GetTestSuite(i);
    for (int k = 0; k < suite.total_test_count(); ++k) {
      const std::string name =
          std::string(suite.name()) + '.' + suite.GetTestInfo(k)->name();
      const std::string why = run_alone(name);
      std::cout << (why.empty() ? "[       OK ] " : "[  FAILED  ] ") << name
                << (why.empty() ? "" : ": " + why) << std::endl;
      if (why.empty())
        ++passed;
      else
        failed.push_back(name + ": " + why);
    }
  }
  std::cout << "[  PASSED  ] " << count_of(passed, "test") << ".\n";
  if (failed.empty()) return 0;
  std::cout << "[  FAILED  ] " << count_of(failed.size(), "test")
            << ", listed below:\n";
  for (const auto& name : failed) std::cout << "[  FAILED  ] " << name << '\n';
  return 1;
}

// ---------------------------------------- What the assignment leaves open

/** Are two iterators equal? They may have == or != alone. */
template <typename It>
bool same(It a, It b) {
  if constexpr (requires { a == b; })
    return static_cast<bool>(a == b);
  else
    return !static_cast<bool>(a != b);
}

/** A new handle of the node of value @a v. */
template <typename G>
auto find_node(G& g, int v) {
  for (typename G::size_type i = 0; i < g.num_nodes(); ++i)
    if (g.node(i).value() == v) return g.node(i);
  throw std::runtime_error("node(i) reaches every node: not the one of value " +
                           std::to_string(v));
}

/** The edge of index @a i, also if the graph has no edge(i). */
template <typename G>
auto edge_at(G& g, typename G::size_type i) {
  if constexpr (requires { g.edge(i); }) {
    return g.edge(i);
  } else {
    auto it = g.edge_begin();
    while (i-- > 0) ++it;
    return *it;
  }
}

/** The result of @a remove() if it is a number, as 0 or 1. Some removals return
 * something else, or nothing; then @a expected is as good. */
template <typename Remove>
int removed(Remove remove, int expected) {
  if constexpr (std::convertible_to<decltype(remove()), int>)
    return static_cast<int>(remove());
  else
    return remove(), expected;
}

/** Does remove_node(node) say how many it removed? Then a node of another graph
 * is a case of its own. */
template <typename G>
concept CountsRemovals = requires(G g, typename G::node_type n) {
  { g.remove_node(n) } -> std::convertible_to<int>;
};

// Removals: how many were removed. Without the member the test fails, and all
// others are compiled.
template <typename G, typename N>
int remove_node(G& g, N n, int expected = 1) {
  if constexpr (requires { g.remove_node(n); })
    return removed([&] { return g.remove_node(n); }, expected);
  ADD_FAILURE() << "the graph has remove_node(node)";
  return 0;
}
template <typename G, typename N>
int remove_edge(G& g, N a, N b, int expected = 1) {
  if constexpr (requires { g.remove_edge(a, b); })
    return removed([&] { return g.remove_edge(a, b); }, expected);
  ADD_FAILURE() << "the graph has remove_edge(node, node)";
  return 0;
}
template <typename G, typename E>
int remove_edge(G& g, E e) {
  if constexpr (requires { g.remove_edge(e); })
    return removed([&] { return g.remove_edge(e); }, 1);
  ADD_FAILURE() << "the graph has remove_edge(edge)";
  return 0;
}
/** Where the loop goes on. */
template <typename G, typename It>
It remove_node_at(G& g, It it) {
  if constexpr (requires { it = g.remove_node(it); }) return g.remove_node(it);
  ADD_FAILURE() << "the graph has remove_node(iterator), which returns one";
  return g.node_end();
}
template <typename G, typename It>
It remove_edge_at(G& g, It it) {
  if constexpr (requires { it = g.remove_edge(it); }) return g.remove_edge(it);
  ADD_FAILURE() << "the graph has remove_edge(iterator), which returns one";
  return g.edge_end();
}

}  // namespace CME212
